//! Factors of a covariance against dense matrices.
use cylwatch_estimator::filter::UdFactors;
use nalgebra::{DMatrix, DVector};

use crate::linear_model::{LinearModel, covariance, covariance_difference, rng, uniform};

#[test]
fn ud_factors_follow_dense_matrices() {
    let mut rng = rng(11);
    for (n, leading, outputs) in [(1, 1, 1), (3, 2, 1), (6, 6, 2), (9, 5, 4), (15, 9, 3)] {
        let model = LinearModel::random(&mut rng, n, leading, outputs);
        let mut p = covariance(&mut rng, n);
        let mut factors = UdFactors::from_covariance(&p).unwrap();
        let mut gain = DVector::zeros(n);
        for step in 0..30 {
            let dt_s = 0.1 * (1 + step % 7) as f64;
            let (f, q) = model.discrete(dt_s);
            p = &f * &p * f.transpose() + q;
            factors.predict(&model.linearisation(dt_s));
            for j in 0..outputs {
                let (h, r) = (model.h.row(j).transpose(), model.r[j]);
                let s = h.dot(&(&p * &h)) + r;
                let k = &p * &h / s;
                assert!(((factors.quadratic(h.as_slice()) + r) / s - 1.0).abs() < 1e-10);
                assert!((factors.update(h.as_slice(), r, gain.as_mut_slice()) / s - 1.0).abs() < 1e-10);
                assert!((&gain - &k).amax() < 1e-10 * k.amax());
                let left = DMatrix::identity(n, n) - &k * h.transpose();
                p = &left * &p * left.transpose() + r * &k * k.transpose();
            }
            if step % 5 == 4 {
                let v = uniform(&mut rng, n, 1).column(0).into_owned();
                p += 0.2 * &v * v.transpose();
                factors.add_rank_one(0.2, v.as_slice());
            }
            assert!(covariance_difference(&factors.covariance(), &p) < 1e-10, "n = {n}, step {step}");
            assert!((0..n).all(|i| (factors.variance(i) / p[(i, i)] - 1.0).abs() < 1e-10));
        }
    }
}

#[test]
fn scaling_a_state_of_ud_factors_scales_its_row_and_column_of_the_covariance() {
    let mut rng = rng(29);
    for n in [1, 2, 7, 19] {
        let mut dense = covariance(&mut rng, n);
        let mut factors = UdFactors::from_covariance(&dense).unwrap();
        for (step, i) in (0..n).chain((0..n).rev()).enumerate() {
            let factor = 0.3 + 0.5 * (step % 4) as f64;
            factors.scale(i, factor);
            let mut scaling = DMatrix::identity(n, n);
            scaling[(i, i)] = factor;
            dense = &scaling * dense * &scaling;
            assert!(covariance_difference(&factors.covariance(), &dense) < 1e-12, "n = {n}, state {i}");
        }
    }
}

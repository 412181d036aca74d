//! Every covariance form against dense matrices, and against what dense matrices cannot do.
use cylwatch_estimator::filter::{CovarianceForm, Joseph, UdFactors};
use nalgebra::{Const, DMatrix, DVector, Dyn};

use crate::linear_model::{LinearModel, covariance, covariance_difference, rng, uniform};

fn assert_form_follows_dense_matrices<F: CovarianceForm>(make: impl Fn(&DMatrix<f64>) -> F, seed: u64) {
    let mut rng = rng(seed);
    for (n, leading, outputs) in [(1, 1, 1), (3, 2, 1), (6, 6, 2), (9, 5, 4), (15, 9, 3)] {
        let model = LinearModel::random(&mut rng, n, leading, outputs);
        let mut p = covariance(&mut rng, n);
        let mut form = make(&p);
        let mut gain = DVector::zeros(n);
        for step in 0..30 {
            let dt_s = 0.1 * (1 + step % 7) as f64;
            let (f, q) = model.discrete(dt_s);
            p = &f * &p * f.transpose() + q;
            form.predict(&model.linearisation(dt_s));
            for j in 0..outputs {
                let (h, r) = (model.h.row(j).transpose(), model.r[j]);
                let s = h.dot(&(&p * &h)) + r;
                let k = &p * &h / s;
                assert!(
                    (form.innovation_variance(h.as_slice(), r, gain.as_mut_slice()) / s - 1.0).abs() < 1e-10
                );
                assert!((form.update(h.as_slice(), r, gain.as_mut_slice()) / s - 1.0).abs() < 1e-10);
                assert!((&gain - &k).amax() < 1e-10 * k.amax());
                let left = DMatrix::identity(n, n) - &k * h.transpose();
                p = &left * &p * left.transpose() + r * &k * k.transpose();
            }
            if step % 5 == 4 {
                let v = uniform(&mut rng, n, 1).column(0).into_owned();
                p += 0.2 * &v * v.transpose();
                form.add_rank_one(0.2, v.as_slice());
            }
            assert!(covariance_difference(&form.to_dense(), &p) < 1e-10, "n = {n}, step {step}");
            assert!((0..n).all(|i| (form.variance(i) / p[(i, i)] - 1.0).abs() < 1e-10));
        }
    }
}

#[test]
fn ud_factors_follow_dense_matrices() {
    assert_form_follows_dense_matrices(|p| UdFactors::<Dyn>::from_covariance(p).unwrap(), 11);
}

#[test]
fn joseph_follows_dense_matrices() {
    assert_form_follows_dense_matrices(|p| Joseph::<Dyn>::from_covariance(p).unwrap(), 13);
}

#[test]
fn forms_of_static_size_follow_those_of_dynamic_size() {
    let mut rng = rng(15);
    let model = LinearModel::random(&mut rng, 6, 4, 1);
    let p = covariance(&mut rng, 6);
    let fixed = p.fixed_view::<6, 6>(0, 0).into_owned();
    let h = model.h.row(0).transpose();
    fn run<F: CovarianceForm>(mut form: F, model: &LinearModel, h: &DVector<f64>) -> DMatrix<f64> {
        form.predict(&model.linearisation(0.3));
        form.update(h.as_slice(), 0.1, &mut [0.0; 6]);
        form.to_dense()
    }
    let joseph = run(Joseph::<Const<6>>::from_covariance(&fixed).unwrap(), &model, &h);
    assert_eq!(joseph, run(Joseph::<Dyn>::from_covariance(&p).unwrap(), &model, &h));
}

#[test]
fn scaling_a_state_of_ud_factors_scales_its_row_and_column_of_the_covariance() {
    let mut rng = rng(29);
    for n in [1, 2, 7, 19] {
        let mut dense = covariance(&mut rng, n);
        let mut factors = UdFactors::<Dyn>::from_covariance(&dense).unwrap();
        for (step, i) in (0..n).chain((0..n).rev()).enumerate() {
            let factor = 0.3 + 0.5 * (step % 4) as f64;
            factors.scale(i, factor);
            let mut scaling = DMatrix::identity(n, n);
            scaling[(i, i)] = factor;
            dense = &scaling * dense * &scaling;
            assert!(covariance_difference(&factors.to_dense(), &dense) < 1e-12, "n = {n}, state {i}");
        }
    }
}

//! Steady states against long filtering and closed forms.
use cylwatch_estimator::EstimatorError;
use cylwatch_estimator::filter::{UdFactors, steady_state};
use nalgebra::{DMatrix, DVector};

use crate::linear_model::{LinearModel, covariance_difference, rng};

/// `P - (F P F^T - F P H^T S^-1 H P F^T + Q)`, relative to the standard deviations.
fn residual(f: &DMatrix<f64>, h: &DMatrix<f64>, q: &DMatrix<f64>, r: &DVector<f64>, p: &DMatrix<f64>) -> f64 {
    let s = h * p * h.transpose() + DMatrix::from_diagonal(r);
    let gain = p * h.transpose() * s.try_inverse().unwrap();
    covariance_difference(&(f * (p - &gain * h * p) * f.transpose() + q), p)
}

#[test]
fn steady_state_solves_its_equation_and_is_the_limit_of_the_filter() {
    let mut rng = rng(51);
    for (n, outputs) in [(1, 1), (2, 1), (5, 2), (9, 3), (13, 3)] {
        let model = LinearModel::random(&mut rng, n, n, outputs);
        let (f, q) = model.discrete(0.3);
        let steady = steady_state(&f, &model.h, &q, &model.r).unwrap();
        assert!(residual(&f, &model.h, &q, &model.r, &steady.predicted) < 1e-12);
        let mut form = UdFactors::from_covariance(&DMatrix::identity(n, n)).unwrap();
        let mut gain = vec![0.0; n];
        let linear = model.linearisation(0.3);
        for _ in 0..3000 {
            form.predict(&linear);
            for j in 0..outputs {
                form.update(model.h.row(j).transpose().as_slice(), model.r[j], &mut gain);
            }
        }
        assert!(covariance_difference(&steady.updated, &form.covariance()) < 1e-10);
        form.predict(&linear);
        assert!(covariance_difference(&steady.predicted, &form.covariance()) < 1e-10);
        // The gain in its other form, from the updated covariance.
        let inverse_r = DMatrix::from_diagonal(&model.r.map(|r| 1.0 / r));
        let gain = form_gain(&steady.updated, &model.h, &inverse_r);
        assert!((&steady.gain - &gain).amax() < 1e-11 * gain.amax());
    }
}

fn form_gain(updated: &DMatrix<f64>, h: &DMatrix<f64>, inverse_r: &DMatrix<f64>) -> DMatrix<f64> {
    updated * h.transpose() * inverse_r
}

#[test]
fn steady_state_of_a_random_walk_is_the_closed_form() {
    // P^2 = q (P + r) for x' = x + w, z = x + v.
    for (q, r) in [(1.0, 1.0), (1e-8, 1.0), (4.0, 1e-6), (1e-3, 50.0)] {
        let one = |v: f64| DMatrix::from_element(1, 1, v);
        let steady = steady_state(&one(1.0), &one(1.0), &one(q), &DVector::from_element(1, r)).unwrap();
        let expected = 0.5 * (q + (q * q + 4.0 * q * r).sqrt());
        assert!((steady.predicted[(0, 0)] / expected - 1.0).abs() < 1e-12);
        assert!((steady.gain[(0, 0)] / (expected / (expected + r)) - 1.0).abs() < 1e-12);
    }
}

#[test]
fn an_unstable_process_has_a_steady_state_if_it_is_seen() {
    let f = DMatrix::from_row_slice(2, 2, &[1.3, 0.4, 0.0, 0.9]);
    let (q, r) = (DMatrix::identity(2, 2), DVector::from_element(1, 0.5));
    let seen = DMatrix::from_row_slice(1, 2, &[1.0, 0.0]);
    let steady = steady_state(&f, &seen, &q, &r).unwrap();
    assert!(residual(&f, &seen, &q, &r, &steady.predicted) < 1e-13);
    let unseen = DMatrix::from_row_slice(1, 2, &[0.0, 1.0]);
    assert!(matches!(steady_state(&f, &unseen, &q, &r), Err(EstimatorError::NoSteadyState)));
    assert!(matches!(
        steady_state(&DMatrix::identity(2, 2), &seen, &q, &r),
        Err(EstimatorError::NoSteadyState)
    ));
    assert!(matches!(
        steady_state(&f, &seen, &q, &DVector::from_element(1, 0.0)),
        Err(EstimatorError::NoiseNotPositive { .. })
    ));
}

#[test]
fn constants_count_as_known_in_the_steady_state() {
    let mut rng = rng(52);
    let model = LinearModel::random(&mut rng, 5, 3, 2);
    let (f, q) = model.discrete(0.4);
    let steady = steady_state(&f, &model.h, &q, &model.r).unwrap();
    let leading = |a: &DMatrix<f64>| a.view((0, 0), (3, 3)).into_owned();
    let alone =
        steady_state(&leading(&f), &model.h.columns(0, 3).into_owned(), &leading(&q), &model.r).unwrap();
    assert!(covariance_difference(&leading(&steady.predicted), &alone.predicted) < 1e-13);
    assert!(steady.predicted.view((0, 3), (5, 2)).iter().all(|p| *p == 0.0));
}

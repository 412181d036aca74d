//! Steady states against long filtering, and the stationary filter against the full one.
use cylwatch_estimator::EstimatorError;
use cylwatch_estimator::filter::{
    CovarianceForm, ExtendedKalman, GateSettings, KalmanSettings, Outcome, Stationary, StationarySettings,
    StepError, UdFactors, steady_state,
};
use nalgebra::{DMatrix, DVector, Dyn};
use rand::RngExt;

use crate::linear_model::{LinearModel, covariance_difference, normal, rng, state_difference};

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
        let mut form = UdFactors::<Dyn>::from_covariance(&DMatrix::identity(n, n)).unwrap();
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

/// A stationary and a full filter that start in the same steady state.
fn pair(
    model: &LinearModel,
    x0: &DVector<f64>,
    gate: Option<GateSettings>,
) -> (Stationary<LinearModel>, ExtendedKalman<LinearModel, UdFactors<Dyn>>) {
    let settings = StationarySettings { gate, tolerance: 1e-12, ..StationarySettings::new(0.5) };
    let stationary = Stationary::try_new(model.clone(), x0.as_slice(), x0.as_slice(), &settings).unwrap();
    let form = UdFactors::from_covariance(&stationary.steady_state().updated).unwrap();
    let settings = KalmanSettings { gate, ..KalmanSettings::default() };
    (stationary, ExtendedKalman::try_new(model.clone(), x0.as_slice(), form, &settings).unwrap())
}

#[test]
fn stationary_filter_is_the_full_filter_with_gaps_and_irregular_samples() {
    let mut rng = rng(53);
    for (n, outputs) in [(2, 1), (6, 2), (12, 3)] {
        let model = LinearModel::random(&mut rng, n, n, outputs);
        let x0 = normal(&mut rng, n);
        let (mut stationary, mut full) = pair(&model, &x0, None);
        let dt_s: Vec<f64> =
            (0..300).map(|k| if k % 100 == 99 { rng.random_range(0.1..2.0) } else { 0.5 }).collect();
        let mut z = model.readings(&mut rng, &x0, &dt_s, 0.0);
        for k in (20..300).step_by(60) {
            z[k][0] = f64::NAN;
            z[k + 1].fill(f64::NAN);
        }
        let mut settled = 0;
        for (dt_s, z) in dt_s.iter().zip(&z) {
            let nis = stationary.step(*dt_s, z).unwrap().nis;
            let full_nis = full.step(*dt_s, z).unwrap().nis;
            let p = full.form().to_dense();
            assert!(
                state_difference(stationary.state(), &DVector::from_column_slice(full.state()), &p) < 1e-10
            );
            assert!(covariance_difference(&stationary.covariance(), &p) < 1e-10);
            assert!((nis - full_nis).abs() < 1e-9 * full_nis.max(1.0));
            settled += usize::from(stationary.is_settled());
        }
        assert!((50..280).contains(&settled), "{settled} of 300 steps in the steady state");
    }
}

#[test]
fn stationary_filter_treats_a_rejected_reading_as_the_full_filter_does() {
    let mut rng = rng(54);
    let model = LinearModel::random(&mut rng, 4, 4, 2);
    let x0 = normal(&mut rng, 4);
    let gate = GateSettings { probability: 0.9999, reacquire_after: 4 };
    let (mut stationary, mut full) = pair(&model, &x0, Some(gate));
    let mut z = model.readings(&mut rng, &x0, &[0.5; 60], 0.0);
    z[10][1] += 50.0;
    (30..40).for_each(|k| z[k][0] += 20.0);
    for (k, z) in z.iter().enumerate() {
        let outcomes: Vec<Outcome> =
            stationary.step(0.5, z).unwrap().outputs.iter().map(|output| output.outcome).collect();
        let expected: Vec<Outcome> =
            full.step(0.5, z).unwrap().outputs.iter().map(|output| output.outcome).collect();
        assert_eq!(outcomes, expected, "step {k}");
        let p = full.form().to_dense();
        assert!(state_difference(stationary.state(), &DVector::from_column_slice(full.state()), &p) < 1e-10);
        assert!(!(stationary.is_settled() && k == 10), "without its reading the covariance is another");
    }
    assert_eq!(stationary.gate_counts(), full.gate_counts());
    assert!(full.gate_counts()[0].reacquired > 0 && full.gate_counts()[1].rejected > 0);
}

#[test]
fn stationary_filter_without_interval_is_refused() {
    let model = LinearModel::random(&mut rng(55), 2, 2, 1);
    for interval_s in [0.0, -1.0, f64::NAN] {
        let made =
            Stationary::try_new(model.clone(), &[0.0; 2], &[0.0; 2], &StationarySettings::new(interval_s));
        assert!(matches!(made, Err(StepError::Filter(EstimatorError::IntervalNotPositive { .. }))));
    }
}

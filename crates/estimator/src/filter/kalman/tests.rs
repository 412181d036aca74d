use approx::assert_relative_eq;
use nalgebra::{DMatrix, DVector, Dyn};

use super::*;
use crate::filter::{GateSettings, Joseph, Outcome, UdFactors};

/// A constant seen through outputs `z_0 = x^2`, `z_1 = x`; it refuses to go on beyond `x = 100`.
#[derive(Clone, Debug)]
struct Square {
    noise: [f64; 2],
}

#[derive(Debug, PartialEq, thiserror::Error)]
#[error("beyond the domain")]
struct Beyond;

impl StateSpace for Square {
    type Error = Beyond;

    fn states(&self) -> usize {
        1
    }

    fn leading(&self) -> usize {
        1
    }

    fn noises(&self) -> usize {
        1
    }

    fn outputs(&self) -> usize {
        2
    }

    fn propagate(
        &mut self,
        x: &mut [f64],
        dt_s: f64,
        linear: Option<&mut Linearisation>,
    ) -> Result<(), Beyond> {
        if x[0] > 100.0 {
            return Err(Beyond);
        }
        if let Some(linear) = linear {
            linear.phi[(0, 0)] = 1.0;
            linear.g[(0, 0)] = 1.0;
            linear.q[0] = 0.01 * dt_s;
        }
        Ok(())
    }

    fn output(&mut self, j: usize, x: &[f64], h: Option<&mut [f64]>) -> Result<f64, Beyond> {
        let (value, slope) = if j == 0 { (x[0] * x[0], 2.0 * x[0]) } else { (x[0], 1.0) };
        if let Some(h) = h {
            h[0] = slope;
        }
        if x[0] < -50.0 { Err(Beyond) } else { Ok(value) }
    }

    fn noise_variance(&self, j: usize, _x: &[f64]) -> f64 {
        self.noise[j]
    }
}

fn filter(
    x: f64,
    variance: f64,
    noise: [f64; 2],
    settings: &KalmanSettings,
) -> ExtendedKalman<Square, UdFactors<Dyn>> {
    let form = UdFactors::from_covariance(&DMatrix::from_element(1, 1, variance)).unwrap();
    ExtendedKalman::try_new(Square { noise }, &[x], form, settings).unwrap()
}

const NONE: f64 = f64::NAN;

#[test]
fn iterated_update_finds_the_mode_of_the_posterior() {
    let settings = KalmanSettings { iterations: 30, tolerance: 1e-10, ..KalmanSettings::default() };
    let (x0, p0, r, z) = (1.0, 0.5, 0.02, 3.0);
    let mut iterated = filter(x0, p0, [r, 1.0], &settings);
    let report = iterated.update(&[z, NONE]).unwrap();
    assert!(report.converged && report.iterations > 1);
    // Root of the derivative of (x - x0)^2/p0 + (z - x^2)^2/r by bisection.
    let slope = |x: f64| (x - x0) / p0 - 2.0 * x * (z - x * x) / r;
    let (mut low, mut high) = (1.2, 2.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if slope(middle) > 0.0 { high = middle } else { low = middle }
    }
    assert_relative_eq!(iterated.state()[0], low, max_relative = 1e-9);
    assert_relative_eq!(
        iterated.form().variance(0),
        1.0 / (1.0 / p0 + 4.0 * low * low / r),
        max_relative = 1e-8
    );
    let mut plain = filter(x0, p0, [r, 1.0], &KalmanSettings::default());
    plain.update(&[z, NONE]).unwrap();
    assert!((plain.state()[0] - low).abs() > 0.1, "one linearisation is not enough here");
}

#[test]
fn iteration_that_does_not_converge_leaves_the_plain_update_and_says_so() {
    let settings = KalmanSettings { iterations: 1, tolerance: 1e-12, ..KalmanSettings::default() };
    let mut iterated = filter(1.0, 0.5, [0.02, 1.0], &settings);
    let mut plain = filter(1.0, 0.5, [0.02, 1.0], &KalmanSettings::default());
    plain.update(&[3.0, 1.1]).unwrap();
    let report = iterated.update(&[3.0, 1.1]).unwrap();
    assert!(!report.converged);
    assert_eq!(iterated.state(), plain.state());
    assert_eq!(iterated.form().to_dense(), plain.form().to_dense());
}

#[test]
fn a_wild_reading_is_rejected_and_the_other_sensor_is_used() {
    let settings = KalmanSettings { gate: Some(GateSettings::default()), ..KalmanSettings::default() };
    let mut gated = filter(1.0, 0.01, [0.01, 0.01], &settings);
    let mut without = filter(1.0, 0.01, [0.01, 0.01], &settings);
    let report = gated.step(1.0, &[50.0, 1.05]).unwrap().clone();
    without.step(1.0, &[NONE, 1.05]).unwrap();
    assert_eq!(
        (report.outputs[0].outcome, report.outputs[1].outcome),
        (Outcome::Rejected, Outcome::Accepted)
    );
    assert_eq!(gated.state(), without.state());
    // P- = 0.02: S = 4 * 0.02 + 0.01.
    assert_relative_eq!(report.outputs[0].variance, 0.09, max_relative = 1e-12);
    assert_relative_eq!(report.outputs[0].innovation, 49.0, max_relative = 1e-12);
    assert_relative_eq!(report.nis, 49.0_f64.powi(2) / 0.09 + 0.05_f64.powi(2) / 0.03, max_relative = 1e-12);
    assert_relative_eq!(report.nis_accepted, 0.05_f64.powi(2) / 0.03, max_relative = 1e-12);
    assert_eq!((report.dof, report.dof_accepted), (2, 1));
    assert_eq!(gated.gate_counts()[0], GateCount { in_row: 1, rejected: 1, reacquired: 0 });
}

#[test]
fn the_gate_passes_the_stated_share() {
    // Quantiles of chi-square with one degree of freedom are squares of those of the normal distribution.
    for (probability, normal) in
        [(0.95, 1.959963984540054), (0.99, 2.575829303548901), (0.9999, 3.890591886413124)]
    {
        let limit = GateSettings { probability, reacquire_after: 3 }.limit().unwrap();
        assert_relative_eq!(limit, normal * normal, max_relative = 1e-6);
    }
    assert!(GateSettings { probability: 1.0, reacquire_after: 3 }.limit().is_err());
}

#[test]
fn a_sensor_rejected_too_often_is_taken_up_again() {
    let gate = GateSettings { probability: 0.99, reacquire_after: 3 };
    let settings = KalmanSettings { gate: Some(gate), ..KalmanSettings::default() };
    let mut lost = filter(1.0, 1e-4, [1.0, 0.01], &settings);
    for _ in 0..3 {
        assert_eq!(lost.update(&[NONE, 5.0]).unwrap().outputs[1].outcome, Outcome::Rejected);
        assert_eq!(lost.update(&[NONE, NONE]).unwrap().outputs[1].outcome, Outcome::Missing);
    }
    assert_eq!(lost.update(&[NONE, 5.0]).unwrap().outputs[1].outcome, Outcome::Reacquired);
    assert_eq!(lost.gate_counts()[1], GateCount { in_row: 0, rejected: 3, reacquired: 1 });
    // With P grown until S = nu^2 / limit: K = 1 - r/S, and the posterior variance is K r.
    let s = 16.0 / gate.limit().unwrap();
    assert_relative_eq!(lost.state()[0], 1.0 + 4.0 * (1.0 - 0.01 / s), max_relative = 1e-12);
    assert_relative_eq!(lost.form().variance(0), 0.01 * (1.0 - 0.01 / s), max_relative = 1e-12);
    assert_eq!(lost.update(&[NONE, 5.0]).unwrap().outputs[1].outcome, Outcome::Accepted);
}

#[test]
fn a_refused_step_leaves_the_filter_as_it_was() {
    let mut filter = filter(1.0, 0.5, [0.1, 0.1], &KalmanSettings::default());
    let (x, p) = (filter.state().to_vec(), filter.form().to_dense());
    assert!(matches!(
        filter.step(-1.0, &[1.0, 1.0]),
        Err(StepError::Filter(EstimatorError::IntervalNegative { .. }))
    ));
    assert!(matches!(
        filter.step(1.0, &[1.0]),
        Err(StepError::Filter(EstimatorError::ReadingsLength { readings: 1, outputs: 2 }))
    ));
    filter.model_mut().noise[1] = 0.0;
    assert!(matches!(
        filter.step(1.0, &[1.0, 1.0]),
        Err(StepError::Filter(EstimatorError::NoiseNotPositive { .. }))
    ));
    assert_eq!((filter.state(), filter.form().to_dense()), (x.as_slice(), p.clone()));
    filter.state_mut()[0] = 101.0;
    assert!(matches!(filter.step(1.0, &[1.0, NONE]), Err(StepError::Model(Beyond))));
    filter.state_mut()[0] = -51.0;
    assert!(matches!(filter.step(1.0, &[1.0, NONE]), Err(StepError::Model(Beyond))));
    assert_eq!((filter.state()[0], filter.form().to_dense()), (-51.0, p));
}

#[test]
fn settings_that_do_not_fit_are_refused() {
    let form = Joseph::<Dyn>::from_covariance(&DMatrix::identity(1, 1)).unwrap();
    let build = |x: &[f64], settings: &KalmanSettings| {
        ExtendedKalman::try_new(Square { noise: [1.0; 2] }, x, form.clone(), settings).map(|_| ())
    };
    let consider = KalmanSettings { consider: vec![1], ..KalmanSettings::default() };
    assert!(matches!(build(&[1.0], &consider), Err(EstimatorError::StateUnknown { state: 1, states: 1 })));
    let plain = KalmanSettings::default();
    assert!(matches!(build(&[1.0, 2.0], &plain), Err(EstimatorError::StateLength { length: 2, states: 1 })));
    assert!(matches!(build(&[NONE], &plain), Err(EstimatorError::StateNotFinite { state: 0 })));
    let gate = Some(GateSettings { probability: 0.0, reacquire_after: 1 });
    assert!(build(&[1.0], &KalmanSettings { gate, ..plain }).is_err());
}

#[test]
fn predicting_and_updating_apart_is_one_step() {
    let mut together = filter(1.0, 0.5, [0.1, 0.1], &KalmanSettings::default());
    let mut apart = together.clone();
    together.step(2.0, &[1.5, 1.2]).unwrap();
    apart.predict(2.0).unwrap();
    assert_relative_eq!(apart.form().variance(0), 0.52, max_relative = 1e-14);
    apart.update(&[1.5, 1.2]).unwrap();
    assert_eq!(DVector::from_column_slice(together.state()), DVector::from_column_slice(apart.state()));
    assert_eq!(together.form().to_dense(), apart.form().to_dense());
}

use std::convert::Infallible;

use approx::assert_relative_eq;

use super::*;
use crate::filter::Outcome;

/// `x` stays, or `x <- x^2` where `square`; outputs `x^2` and `x`.
#[derive(Clone, Debug)]
struct Scalar {
    noise: [f64; 2],
    square: bool,
}

impl StateSpace for Scalar {
    type Error = Infallible;

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
    ) -> Result<(), Infallible> {
        if let Some(linear) = linear {
            linear.phi[(0, 0)] = if self.square { 2.0 * x[0] } else { 1.0 };
            linear.g[(0, 0)] = 1.0;
            linear.q[0] = 0.01 * dt_s;
        }
        if self.square {
            x[0] *= x[0];
        }
        Ok(())
    }

    fn output(&mut self, j: usize, x: &[f64], _h: Option<&mut [f64]>) -> Result<f64, Infallible> {
        Ok(if j == 0 { x[0] * x[0] } else { x[0] })
    }

    fn noise_variance(&self, j: usize, _x: &[f64]) -> f64 {
        self.noise[j]
    }
}

const NONE: f64 = f64::NAN;

fn filter(x: f64, p: f64, noise: [f64; 2], settings: &UnscentedSettings) -> Unscented<Scalar> {
    Unscented::try_new(Scalar { noise, square: false }, &[x], &DMatrix::from_element(1, 1, p), settings)
        .unwrap()
}

/// Points that match the fourth moment of a normal distribution in one dimension.
const FOURTH_MOMENT: UnscentedSettings =
    UnscentedSettings { alpha: 1.0, beta: 0.0, kappa: 2.0, redraw: false, gate: None };

#[test]
fn a_square_of_a_normal_variable_has_its_exact_mean_and_variance() {
    let (mu, p, r) = (1.5, 0.3, 0.05);
    let mut filter = filter(mu, p, [r, 1.0], &FOURTH_MOMENT);
    let z = 3.0;
    let report = filter.step(0.0, &[z, NONE]).unwrap().outputs[0];
    assert_relative_eq!(report.innovation, z - (mu * mu + p), max_relative = 1e-14);
    let s = 4.0 * mu * mu * p + 2.0 * p * p + r;
    assert_relative_eq!(report.variance, s, max_relative = 1e-14);
    let gain = 2.0 * mu * p / s;
    assert_relative_eq!(filter.state()[0], mu + gain * (z - mu * mu - p), max_relative = 1e-14);
    assert_relative_eq!(filter.covariance()[(0, 0)], p - gain * gain * s, max_relative = 1e-13);
    let mut moved = filter.clone();
    moved.model_mut().square = true;
    let (mu, p) = (filter.state()[0], filter.covariance()[(0, 0)]);
    moved.step(3.0, &[NONE, NONE]).unwrap();
    assert_relative_eq!(moved.state()[0], mu * mu + p, max_relative = 1e-14);
    let variance = 4.0 * mu * mu * p + 2.0 * p * p + 0.03;
    assert_relative_eq!(moved.covariance()[(0, 0)], variance, max_relative = 1e-13);
}

#[test]
fn a_covariance_that_is_lost_is_an_error_and_leaves_the_estimate() {
    // A large negative weight of the middle point makes the predicted variance negative.
    let settings = UnscentedSettings { beta: -30.0, ..FOURTH_MOMENT };
    let mut filter = filter(0.1, 1.0, [1.0, 1.0], &settings);
    filter.model_mut().square = true;
    let before = filter.clone();
    assert!(matches!(
        filter.step(1.0, &[NONE, 1.0]),
        Err(StepError::Filter(EstimatorError::CovarianceIndefinite { state: 0, .. }))
    ));
    assert_eq!((filter.state(), filter.covariance()), (before.state(), before.covariance()));
}

#[test]
fn a_wild_reading_is_rejected_and_a_lost_filter_is_taken_up_again() {
    let gate = GateSettings { probability: 0.99, reacquire_after: 2 };
    for redraw in [false, true] {
        let settings = UnscentedSettings { gate: Some(gate), redraw, ..UnscentedSettings::default() };
        let mut lost = filter(1.0, 1e-4, [1.0, 0.01], &settings);
        for _ in 0..2 {
            let outcome = lost.step(0.0, &[NONE, 5.0]).unwrap().outputs[1].outcome;
            assert_eq!((outcome, lost.state()), (Outcome::Rejected, [1.0].as_slice()));
        }
        assert_eq!(lost.step(0.0, &[NONE, 5.0]).unwrap().outputs[1].outcome, Outcome::Reacquired);
        // P grows until S = nu^2 / limit: K = 1 - r/S, and the posterior variance is K r.
        let s = 16.0 / gate.limit().unwrap();
        assert_relative_eq!(lost.state()[0], 1.0 + 4.0 * (1.0 - 0.01 / s), max_relative = 1e-12);
        assert_relative_eq!(lost.covariance()[(0, 0)], 0.01 * (1.0 - 0.01 / s), max_relative = 1e-10);
        assert_eq!(lost.gate_counts()[1], GateCount { in_row: 0, rejected: 2, reacquired: 1 });
    }
}

#[test]
fn points_without_spread_are_refused() {
    for (alpha, kappa) in [(0.0, 0.0), (1.0, -1.0), (f64::NAN, 0.0)] {
        let settings = UnscentedSettings { alpha, kappa, ..UnscentedSettings::default() };
        let model = Scalar { noise: [1.0; 2], square: false };
        let made = Unscented::try_new(model, &[0.0], &DMatrix::identity(1, 1), &settings);
        assert!(matches!(made, Err(EstimatorError::SigmaPoints { .. })));
    }
}

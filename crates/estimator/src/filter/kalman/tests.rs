use approx::assert_relative_eq;
use nalgebra::DMatrix;

use super::*;
use crate::filter::Dimensions;

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

    fn dimensions(&self) -> Dimensions {
        Dimensions { states: 1, leading: 1, noises: 1, outputs: 2 }
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

fn filter(x: f64, variance: f64, noise: [f64; 2]) -> ExtendedKalman<Square> {
    let p = UdFactors::from_covariance(&DMatrix::from_element(1, 1, variance)).unwrap();
    ExtendedKalman::try_new(Square { noise }, &[x], p).unwrap()
}

const NONE: f64 = f64::NAN;

#[test]
fn a_refused_step_leaves_the_filter_as_it_was() {
    let mut filter = filter(1.0, 0.5, [0.1, 0.1]);
    let (x, p) = (filter.state().to_vec(), filter.factors().covariance());
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
    assert_eq!((filter.state(), filter.factors().covariance()), (x.as_slice(), p.clone()));
    for beyond in [101.0, -51.0] {
        filter.x[0] = beyond;
        assert!(matches!(filter.step(1.0, &[1.0, NONE]), Err(StepError::Model(Beyond))));
        assert_eq!((filter.state()[0], filter.factors().covariance()), (beyond, p.clone()));
    }
}

#[test]
fn a_start_that_does_not_fit_is_refused() {
    let build = |x: &[f64]| {
        let p = UdFactors::from_covariance(&DMatrix::identity(1, 1)).unwrap();
        ExtendedKalman::try_new(Square { noise: [1.0; 2] }, x, p).map(|_| ())
    };
    assert!(matches!(build(&[1.0, 2.0]), Err(EstimatorError::StateLength { length: 2, states: 1 })));
    assert!(matches!(build(&[NONE]), Err(EstimatorError::StateNotFinite { state: 0 })));
}

#[test]
fn both_outputs_are_linearised_at_the_prediction() {
    let mut filter = filter(1.0, 0.01, [0.01, 0.01]);
    let innovations = filter.step(1.0, &[1.3, 1.05]).unwrap();
    // P- = 0.02: S = 4 * 0.02 + 0.01, K = 0.04 / S, and then P = 0.02 (1 - 0.08 / S).
    let (first, second) = (innovations[0], innovations[1]);
    assert_relative_eq!(first.s, 0.09, max_relative = 1e-12);
    assert_relative_eq!(first.nu, 0.3, max_relative = 1e-12);
    assert_relative_eq!(second.s, 0.02 * (1.0 - 0.08 / 0.09) + 0.01, max_relative = 1e-12);
    assert_relative_eq!(second.nu, 0.05 - 0.3 * 0.04 / 0.09, max_relative = 1e-12);
}

//! What stops a filter's step.
use super::state_space::Linearisation;
use crate::EstimatorError;

/// Why a step could not be taken. The filter is then as it was before the step.
#[derive(Debug, thiserror::Error)]
pub enum StepError<E> {
    /// The process or an output refused.
    #[error(transparent)]
    Model(E),
    /// The filter refused.
    #[error(transparent)]
    Filter(#[from] EstimatorError),
}

/// Lengths of the arguments of a step: the interval not negative, one reading per output.
pub(crate) fn check_sample(dt_s: f64, readings: usize, outputs: usize) -> Result<(), EstimatorError> {
    if !dt_s.is_finite() || dt_s < 0.0 {
        return Err(EstimatorError::IntervalNegative { interval_s: dt_s });
    }
    if readings != outputs {
        return Err(EstimatorError::ReadingsLength { readings, outputs });
    }
    Ok(())
}

/// A predicted state must be finite.
pub(crate) fn check_state(x: &[f64]) -> Result<(), EstimatorError> {
    match x.iter().position(|x| !x.is_finite()) {
        Some(state) => Err(EstimatorError::StateNotFinite { state }),
        None => Ok(()),
    }
}

/// Whether all values are finite. It looks at all of them, which is faster than to stop at the first.
fn all_finite(values: &[f64]) -> bool {
    values.iter().fold(true, |finite, value| finite & value.is_finite())
}

/// A linearisation must be finite, its noise variances not negative.
pub(crate) fn check_linearisation(linear: &Linearisation) -> Result<(), EstimatorError> {
    let q = linear.q.as_slice();
    let finite = all_finite(linear.phi.as_slice()) && all_finite(linear.g.as_slice()) && all_finite(q);
    if !finite || q.iter().any(|q| *q < 0.0) {
        return Err(EstimatorError::LinearisationUnusable);
    }
    Ok(())
}

/// Value and gradient of an output must be finite, its noise variance positive.
pub(crate) fn check_output(output: usize, y: f64, h: &[f64], variance: f64) -> Result<(), EstimatorError> {
    if !y.is_finite() || !all_finite(h) {
        return Err(EstimatorError::OutputNotFinite { output });
    }
    if !variance.is_finite() || variance <= 0.0 {
        return Err(EstimatorError::NoiseNotPositive { variance });
    }
    Ok(())
}

/// A state, or the covariance of one, must have the length of the process.
pub(crate) fn check_length(length: usize, states: usize) -> Result<(), EstimatorError> {
    if length == states { Ok(()) } else { Err(EstimatorError::StateLength { length, states }) }
}

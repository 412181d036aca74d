//! What a moving-horizon estimator can be told.
use crate::EstimatorError;

/// Cost `rho(r)` of a measurement residual `r`, in standard deviations of its noise.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Loss {
    /// `r^2 / 2`: Gaussian noise.
    #[default]
    Quadratic,
    /// `r^2 / 2` up to `|r| = delta`, then linear with the slope reached there: one reading pulls with at most `delta`.
    Huber {
        /// Where the loss turns linear, standard deviations; 1.345 keeps 95 % efficiency under Gaussian noise.
        delta: f64,
    },
}

impl Loss {
    /// `rho(r)`.
    pub(crate) fn value(self, r: f64) -> f64 {
        match self {
            Self::Huber { delta } if r.abs() > delta => delta * (r.abs() - 0.5 * delta),
            _ => 0.5 * r * r,
        }
    }

    /// Derivative `psi(r)` of `rho`.
    pub(crate) fn slope(self, r: f64) -> f64 {
        match self {
            Self::Huber { delta } => r.clamp(-delta, delta),
            Self::Quadratic => r,
        }
    }

    /// `psi(r) / r`, from 0 to 1: a quadratic cost with this weight has the same slope at `r`.
    pub(crate) fn weight(self, r: f64) -> f64 {
        match self {
            Self::Huber { delta } if r.abs() > delta => delta / r.abs(),
            _ => 1.0,
        }
    }
}

/// Settings of a [`MovingHorizon`](super::MovingHorizon).
#[derive(Clone, Debug, PartialEq)]
pub struct HorizonSettings {
    /// Samples in the window, at least 1.
    pub samples: usize,
    /// Cost of the measurement residuals.
    pub loss: Loss,
    /// Gauss-Newton iterations per sample at most, at least 1. A linear problem needs one.
    pub iterations_max: usize,
    /// Stop iterating when a step moves the trajectory by less than this many posterior standard deviations.
    pub tolerance: f64,
}

impl Default for HorizonSettings {
    fn default() -> Self {
        Self { samples: 20, loss: Loss::Quadratic, iterations_max: 4, tolerance: 1e-3 }
    }
}

impl HorizonSettings {
    /// Check every setting.
    ///
    /// # Errors
    /// [`EstimatorError::HorizonSetting`] names the first setting out of its range.
    pub(crate) fn validate(&self) -> Result<(), EstimatorError> {
        let refuse = |name, value, bound| Err(EstimatorError::HorizonSetting { name, value, bound });
        if self.samples == 0 {
            return refuse("samples", 0.0, "at least 1");
        }
        if self.iterations_max == 0 {
            return refuse("iterations_max", 0.0, "at least 1");
        }
        if !(self.tolerance > 0.0 && self.tolerance < 1.0) {
            return refuse("tolerance", self.tolerance, "above 0 and below 1");
        }
        match self.loss {
            // A NaN is no valid bend either.
            Loss::Huber { delta } if delta.is_nan() || delta <= 0.0 => refuse("loss.delta", delta, "above 0"),
            _ => Ok(()),
        }
    }
}

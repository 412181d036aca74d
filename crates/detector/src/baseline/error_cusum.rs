//! The textbook's cumulative sum on the error, as if errors were independent: what correlation costs is seen on it.
use serde::{Deserialize, Serialize};

use super::{PressureError, Reading};
use crate::statistic::{Cusum, Statistic};
use crate::{DetectorError, error::positive};

/// [`Cusum`] of `(e - mean)/sd`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ErrorCusum {
    error: PressureError,
    mean_pa: f64,
    sd_pa: f64,
    cusum: Cusum,
}

impl ErrorCusum {
    /// Errors of mean `mean_pa` and standard deviation `sd_pa` without a leak, reference value in standard deviations.
    ///
    /// # Errors
    /// `sd_pa` is not positive, mean or reference are not finite.
    pub fn try_new(
        error: PressureError,
        (mean_pa, sd_pa): (f64, f64),
        reference: f64,
    ) -> Result<Self, DetectorError> {
        if !mean_pa.is_finite() {
            return Err(DetectorError::Setting { setting: "mean_pa", value: mean_pa, bound: "finite" });
        }
        Ok(Self { error, mean_pa, sd_pa: positive("sd_pa", sd_pa)?, cusum: Cusum::try_new(reference)? })
    }
}

impl Statistic for ErrorCusum {
    type Sample = Reading;

    fn update(&mut self, reading: Reading) -> f64 {
        if let Some(error_pa) = self.error.step(reading) {
            self.cusum.update((error_pa - self.mean_pa) / self.sd_pa);
        }
        self.cusum.value()
    }

    fn value(&self) -> f64 {
        self.cusum.value()
    }

    fn reset(&mut self) {
        self.error.reset();
        self.cusum.reset();
    }
}

//! What an observer has learnt of a cylinder, to be saved and given to its successor.
use alloc::borrow::ToOwned;
use alloc::string::String;
use alloc::vec::Vec;
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use super::states::States;
use crate::EstimatorError;
use crate::thermal::vessel::Vessel;

/// Constants with their joint uncertainty: film and capacity multipliers, offsets, couplings, coefficients. Plain data.
///
/// # Shapes
/// `names`, `mean`: (k); `covariance`: (k, k), row by row.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Learned {
    /// Version of this format.
    pub version: u32,
    /// Name of the vessel.
    pub vessel: String,
    /// Names of the quantities, with their units.
    pub names: Vec<String>,
    /// Means.
    pub mean: Vec<f64>,
    /// Covariance.
    pub covariance: Vec<f64>,
}

impl Learned {
    /// Version written by this program.
    pub const VERSION: u32 = 1;

    pub(super) fn of(vessel: &str, states: &States, x: &[f64], p: &DMatrix<f64>) -> Self {
        let learnt: Vec<usize> = states.constants().collect();
        Self {
            version: Self::VERSION,
            vessel: vessel.to_owned(),
            names: learnt.iter().map(|&i| states.names[i].clone()).collect(),
            mean: learnt.iter().map(|&i| x[i]).collect(),
            covariance: learnt.iter().flat_map(|&i| learnt.iter().map(move |&j| p[(i, j)])).collect(),
        }
    }

    /// Checks what another program has learnt of a vessel.
    ///
    /// # Errors
    /// It is of another version or another vessel, lengths do not fit, or a number is none.
    pub fn validate(&self, vessel: &Vessel) -> Result<(), EstimatorError> {
        let (found, expected) = (self.version, Self::VERSION);
        if found != expected {
            return Err(EstimatorError::LearnedVersion { found, expected });
        }
        let k = self.names.len();
        let numbers = self.mean.iter().chain(&self.covariance).all(|value| value.is_finite());
        if !(self.mean.len() == k && Some(self.covariance.len()) == k.checked_mul(k) && numbers) {
            return Err(EstimatorError::LearnedInconsistent);
        }
        if self.vessel != vessel.name {
            let (learned, vessel) = (self.vessel.clone(), vessel.name.clone());
            return Err(EstimatorError::LearnedForeign { learned, vessel });
        }
        Ok(())
    }

    /// Overwrite mean and covariance of the states that were learnt; states without a counterpart keep their prior.
    pub(super) fn put_into(&self, names: &[String], mean: &mut [f64], covariance: &mut DMatrix<f64>) {
        let at: Vec<Option<usize>> =
            self.names.iter().map(|name| names.iter().position(|other| other == name)).collect();
        let k = at.len();
        for (i, state) in at.iter().enumerate() {
            let Some(state) = *state else { continue };
            mean[state] = self.mean[i];
            for (j, other) in at.iter().enumerate() {
                if let Some(other) = *other {
                    covariance[(state, other)] = self.covariance[i * k + j];
                }
            }
        }
    }
}

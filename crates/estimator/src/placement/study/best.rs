//! The best layouts of a number of sensors, and how far they can be from the optimum.
use serde::{Deserialize, Serialize};

use crate::EstimatorError;
use crate::placement::search::{Layout, Method};

/// The best layouts of a number of sensors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BestLayouts {
    /// Number of sensors.
    pub sensors: usize,
    /// Layouts within the tolerance of the best, the best first, by the criterion, in its SI unit.
    pub layouts: Vec<Layout>,
    /// What no layout of so many sensors falls below.
    pub bound: f64,
    /// Where the bound comes from.
    pub proof: Proof,
    /// What no layout falls below by the convex relaxation, if the criterion has one.
    pub relaxation: Option<f64>,
    /// The same by the gap of Frank and Wolfe.
    pub frank_wolfe: Option<f64>,
    /// How it was searched.
    pub method: Method,
    /// Layouts that were evaluated.
    pub evaluated: u64,
    /// Best of so many over best of one less, less one: what the last sensor brought, negative if it helped.
    pub marginal: Option<f64>,
    /// The search was stopped.
    pub partial: bool,
}

impl BestLayouts {
    /// Distance of the best from the bound, relative to the best.
    pub fn gap(&self) -> Option<f64> {
        self.layouts.first().map(|best| (1.0 - self.bound / best.value).max(0.0))
    }

    /// Distance of the best from what the relaxation proves, relative to the best.
    pub fn relaxation_gap(&self) -> Option<f64> {
        let (best, bound) = self.layouts.first().zip(self.relaxation)?;
        Some((1.0 - bound / best.value).max(0.0))
    }
}

/// A number of sensors for which no layout was found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Infeasible {
    /// Number of sensors.
    pub sensors: usize,
    /// Why.
    pub reason: String,
}

/// Why there is a layout of no number of sensors: the first contradiction after what is not seen with fewer.
pub(super) fn no_number(errors: Vec<(usize, EstimatorError)>) -> EstimatorError {
    let mut unseen = None;
    for (sensors, error) in errors {
        let EstimatorError::PlacementConstraints { what } = error else {
            unseen = Some(error);
            continue;
        };
        let what = match unseen {
            Some(unseen) => format!("with fewer than {sensors} {unseen}; of {sensors}, {what}"),
            None => what,
        };
        return EstimatorError::PlacementConstraints { what };
    }
    unseen.unwrap_or(EstimatorError::NoSteadyState)
}

/// Where a bound comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Proof {
    /// Every layout was looked at, or could be left out.
    Search,
    /// The convex relaxation.
    Relaxation,
    /// None: the bound is zero.
    None,
}

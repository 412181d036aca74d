//! The map: one thermometer beside what is required, at every place.
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::Placement;
use crate::EstimatorError;
use crate::placement::candidate::Status;
use crate::placement::scenario::ScenarioMeasure;
use crate::placement::steady::SteadyAccuracy;

/// A candidate alone with what is required.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Position {
    /// Index of the candidate.
    pub sensor: usize,
    /// Height above the outer bottom along the axis, m; `None`: not on the wall.
    pub height_m: Option<f64>,
    /// At rest; `None`: it does not see every state.
    #[serde(rename = "certainty")]
    pub steady: Option<SteadyAccuracy>,
    /// Time until the leak of the settings is found, s.
    pub delay_s: Option<f64>,
    /// Mean standard deviation of the gas temperature with model error in each scenario, K.
    pub robust_k: Vec<f64>,
}

impl Placement {
    /// Every candidate that is not required, forbidden ones too as a reference.
    pub(super) fn positions(&self) -> Result<Vec<Position>, EstimatorError> {
        let list = &self.candidates().list;
        let required: Vec<usize> =
            (0..list.len()).filter(|&index| list[index].status == Status::Required).collect();
        let position = |sensor: usize| {
            let mut layout = required.clone();
            layout.push(sensor);
            layout.sort_unstable();
            let height_m = list[sensor].height_m;
            let Ok(judged) = self.evaluate(&layout) else {
                return Position { sensor, height_m, steady: None, delay_s: None, robust_k: Vec::new() };
            };
            Position {
                sensor,
                height_m,
                steady: Some(judged.steady),
                delay_s: judged.delay_s,
                robust_k: judged
                    .scenarios
                    .iter()
                    .map(|scenario| ScenarioMeasure::Schmidt.of(scenario))
                    .collect(),
            }
        };
        let free: Vec<usize> = (0..list.len()).filter(|index| !required.contains(index)).collect();
        Ok(free.into_par_iter().map(position).collect())
    }
}

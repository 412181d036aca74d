//! Layouts by every number.
use std::sync::atomic::Ordering;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::{ALL_LAYOUTS, BestLayouts, LAYOUTS_EVALUATED, Placement, Proof};
use crate::EstimatorError;
use crate::placement::criterion::Criterion;
use crate::placement::scenario::ScenarioAccuracy;
use crate::placement::search::{Method, SearchControl, search};
use crate::placement::steady::SteadyAccuracy;

/// A layout by every number.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EvaluatedLayout {
    /// Indices of its candidates, increasing.
    pub sensors: Vec<usize>,
    /// Its cost.
    pub cost: f64,
    /// At rest.
    #[serde(rename = "certainty")]
    pub steady: SteadyAccuracy,
    /// Time until the leak of the settings is found, s; `None`: never.
    pub delay_s: Option<f64>,
    /// Along each scenario.
    #[serde(rename = "along")]
    pub scenarios: Vec<ScenarioAccuracy>,
}

impl EvaluatedLayout {
    /// The number of a criterion, in SI; `None` for a measure of a scenario where there is none.
    pub fn number(&self, criterion: Criterion) -> Option<f64> {
        Some(match criterion {
            Criterion::GasTemperature => self.steady.gas_sd_k,
            Criterion::Mass => self.steady.mass_sd_kg,
            Criterion::LeakRate => self.steady.leak_sd_kg_s,
            Criterion::SmallestLeak => self.steady.smallest_leak_kg_s,
            Criterion::Scenario(measure) => measure.of(self.scenarios.first()?),
        })
    }
}

impl Placement {
    /// A layout by every number.
    ///
    /// # Errors
    /// [`EstimatorError::Unseen`]: it does not see every state.
    pub fn evaluate(&self, layout: &[usize]) -> Result<EvaluatedLayout, EstimatorError> {
        Ok(EvaluatedLayout {
            sensors: layout.to_vec(),
            cost: layout.iter().map(|&index| self.candidates.list[index].cost).sum(),
            steady: self.steady.accuracy(layout)?,
            delay_s: self.steady.delay_s(layout, self.settings.leak_kg_s)?,
            scenarios: self.in_scenarios(layout)?,
        })
    }

    /// The best by the criterion, then those that are best by another number, for each number of sensors.
    pub(super) fn evaluate_all(
        &self,
        numbers: &[BestLayouts],
        control: &SearchControl,
    ) -> Result<Vec<EvaluatedLayout>, EstimatorError> {
        let mut judged = Vec::new();
        for number in numbers {
            let mut layouts: Vec<Vec<usize>> =
                number.layouts.iter().take(LAYOUTS_EVALUATED).map(|layout| layout.sensors.clone()).collect();
            // What the search has proven needs no second one.
            let is_known = |of: &Criterion| *of == self.settings.criterion && number.proof == Proof::Search;
            for criterion in Criterion::AT_REST.into_iter().filter(|of| !is_known(of)) {
                if control.stop.load(Ordering::Relaxed) {
                    break;
                }
                let best = self.best_by(criterion, number.sensors, control)?;
                layouts.extend(best.filter(|best| !layouts.contains(best)));
            }
            let of_number: Vec<EvaluatedLayout> =
                layouts.par_iter().map(|layout| self.evaluate(layout)).collect::<Result<_, _>>()?;
            judged.extend(of_number);
        }
        Ok(judged)
    }

    fn best_by(
        &self,
        criterion: Criterion,
        sensors: usize,
        control: &SearchControl,
    ) -> Result<Option<Vec<usize>>, EstimatorError> {
        let objective = criterion.objective(&self.steady, &self.scenarios)?;
        let method = if self.layouts(sensors) <= ALL_LAYOUTS { Method::Exhaustive } else { Method::Greedy };
        let found = search(&objective, &self.constraints(sensors), method, 0.0, control)?;
        Ok(found.best().map(|best| best.sensors.clone()))
    }
}

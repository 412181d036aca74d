//! What layouts are ranked by.
use serde::{Deserialize, Serialize};

use super::objective::{Objective, Relaxed};
use super::scenario::{ScenarioAnalysis, ScenarioMeasure, ScenarioObjective};
use super::steady::{SmallestLeak, SteadyAnalysis};
use super::{GroupedProblem, Quantity};
use crate::EstimatorError;

/// One physical number by which layouts are ranked; the smaller, the better.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Criterion {
    /// Standard deviation of the mean gas temperature at rest, K.
    GasTemperature,
    /// Of the mass, kg.
    Mass,
    /// Of the leak rate, kg/s.
    LeakRate,
    /// Smallest leak that is found in time, kg/s.
    SmallestLeak,
    /// A measure of the gas temperature along the first scenario, K.
    #[serde(rename = "course")]
    Scenario(ScenarioMeasure),
}

impl Criterion {
    /// Those of a cylinder at rest.
    pub(crate) const AT_REST: [Self; 4] =
        [Self::GasTemperature, Self::Mass, Self::LeakRate, Self::SmallestLeak];

    /// All, in the order of a list.
    pub const ALL: [Self; 8] = [
        Self::GasTemperature,
        Self::Mass,
        Self::LeakRate,
        Self::SmallestLeak,
        Self::Scenario(ScenarioMeasure::Mean),
        Self::Scenario(ScenarioMeasure::Worst),
        Self::Scenario(ScenarioMeasure::Schmidt),
        Self::Scenario(ScenarioMeasure::WorstCase),
    ];

    /// One word.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::GasTemperature => "gas-temperature",
            Self::Mass => "mass",
            Self::LeakRate => "leak-rate",
            Self::SmallestLeak => "smallest-leak",
            Self::Scenario(ScenarioMeasure::Mean) => "course-mean",
            Self::Scenario(ScenarioMeasure::Worst) => "course-worst",
            Self::Scenario(ScenarioMeasure::Schmidt) => "robust-mean",
            Self::Scenario(ScenarioMeasure::WorstCase) => "robust-worst",
        }
    }

    /// Description for reports.
    pub fn description(self) -> &'static str {
        match self {
            Self::GasTemperature => "sd of the mean gas temperature",
            Self::Mass => "sd of the gas mass",
            Self::LeakRate => "sd of the leak rate",
            Self::SmallestLeak => "smallest leak found in time",
            Self::Scenario(ScenarioMeasure::Mean) => "mean sd of the gas temperature along the scenario",
            Self::Scenario(ScenarioMeasure::Worst) => "largest sd of the gas temperature along the scenario",
            Self::Scenario(ScenarioMeasure::Schmidt) => "mean sd of the gas temperature with model error",
            Self::Scenario(ScenarioMeasure::WorstCase) => {
                "largest error of the gas temperature in the worst variant"
            }
        }
    }

    /// Whether it is convex in the weights of sensors, so that a bound can be proven without looking at every layout.
    pub fn is_convex(self) -> bool {
        matches!(self, Self::GasTemperature | Self::Mass | Self::LeakRate)
    }

    /// Its objective for a search.
    ///
    /// # Errors
    /// [`EstimatorError::PlacementConstraints`]: a measure of a scenario, but there is none.
    pub(super) fn objective<'a>(
        self,
        steady: &'a SteadyAnalysis,
        scenarios: &'a [ScenarioAnalysis],
    ) -> Result<CriterionObjective<'a>, EstimatorError> {
        let quantity = match self {
            Self::GasTemperature => Quantity::GasTemperature,
            Self::Mass => Quantity::Mass,
            Self::LeakRate => Quantity::LeakRate,
            Self::SmallestLeak => return Ok(CriterionObjective::SmallestLeak(SmallestLeak(steady))),
            Self::Scenario(measure) => {
                let what = format!("the criterion {} is that of a scenario; name one", self.as_str());
                let scenario = scenarios.first().ok_or(EstimatorError::PlacementConstraints { what })?;
                return Ok(CriterionObjective::Scenario(ScenarioObjective { scenario, measure }, steady));
            }
        };
        Ok(CriterionObjective::Steady(steady.problem(quantity)))
    }
}

/// The square of a criterion as an objective.
#[derive(Clone, Copy, Debug)]
pub(super) enum CriterionObjective<'a> {
    Steady(&'a GroupedProblem),
    SmallestLeak(SmallestLeak<'a>),
    /// Of layouts that observe every state at rest: a scenario ends before the error of an unobserved one has grown.
    Scenario(ScenarioObjective<'a>, &'a SteadyAnalysis),
}

impl Objective for CriterionObjective<'_> {
    fn candidates(&self) -> usize {
        match self {
            Self::Steady(of) => of.candidates(),
            Self::SmallestLeak(of) => of.candidates(),
            Self::Scenario(of, _) => of.candidates(),
        }
    }

    fn value(&self, layout: &[usize]) -> f64 {
        match self {
            Self::Steady(of) => of.value(layout),
            Self::SmallestLeak(of) => of.value(layout),
            Self::Scenario(_, steady) if steady.accuracy(layout).is_err() => f64::INFINITY,
            Self::Scenario(of, _) => of.value(layout),
        }
    }

    fn relaxed(&self, weights: &[f64]) -> Option<Relaxed> {
        match self {
            Self::Steady(of) => of.relaxed(weights),
            Self::SmallestLeak(of) => of.relaxed(weights),
            Self::Scenario(of, _) => of.relaxed(weights),
        }
    }
}

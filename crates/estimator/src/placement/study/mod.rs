//! The study: which layouts are best, what the next sensor is worth, what is lost with one, and where on the wall it matters.
//!
//! Layouts are searched by one [`Criterion`], but never ranked by one alone: what is found is judged by all ([`EvaluatedLayout`]), beside the
//! best layouts by the other numbers. Each part says of itself what it is:
//!
//! | part | what it says |
//! |---|---|
//! | [`BestLayouts`] | best layouts of so many sensors, bound and gap, what the last sensor brought |
//! | [`EvaluatedLayout`] | a layout by every number, and by every scenario |
//! | [`Front`] | layouts that none is better than at their cost |
//! | [`Failure`] | what is left without a sensor, and how large a fault of it is found and told from all others |
//! | [`Bias`] | what a sensor's offset, its mounting and the sun do to the estimates |
//! | [`Position`] | one thermometer anywhere on the wall |
//! | [`PublishedComparison`] | the same positions by the paper's measure |
//!
//! A study that is stopped keeps what it has and says that it is partial.
mod best;
mod evaluated;
mod failure;
mod front;
mod position;
mod published;

use std::ops::RangeInclusive;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use serde::{Deserialize, Serialize};

use super::PublishedSettings;
use super::candidate::Candidates;
use super::certificate::{CertificateSettings, certify};
use super::constraints::Constraints;
use super::criterion::Criterion;
use super::scenario::{ScenarioAccuracy, ScenarioAnalysis};
use super::search::{Layout, Method, SearchControl, search};
use super::steady::{SteadyAnalysis, SteadySettings};
use crate::EstimatorError;
use crate::thermal::scenario::Scenario;
use crate::thermal::vessel::Vessel;
use best::no_number;

pub use best::{BestLayouts, Infeasible, Proof};
pub use evaluated::EvaluatedLayout;
pub use failure::{Bias, BiasSource, Failure};
pub use front::{Front, Point};
pub use position::Position;
pub use published::PublishedComparison;

/// Layouts up to which all are looked at if no method is asked for.
const ALL_LAYOUTS: f64 = 20_000.0;
/// Layouts by one criterion that are judged by all others, for each number of sensors.
pub const LAYOUTS_EVALUATED: usize = 5;

/// What is asked of a study.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StudySettings {
    /// How layouts are judged at rest.
    #[serde(rename = "site")]
    pub steady: SteadySettings,
    /// Most sensors of a layout, those that it must have among them.
    pub sensors: usize,
    /// Largest cost of a layout.
    pub budget: f64,
    /// What is searched by.
    pub criterion: Criterion,
    /// How; `None`: all layouts as long as there are no more than 20 000, or along a scenario 400, else greedy with swaps.
    pub method: Option<Method>,
    /// Part of the best within which layouts are listed, of the number itself.
    pub within: f64,
    /// Leak whose delay is told, kg/s.
    pub leak_kg_s: f64,
    /// The paper's measure.
    pub published: PublishedSettings,
}

impl Default for StudySettings {
    /// Up to four sensors by the leak rate, at any cost, and the delay of 10 g/h.
    fn default() -> Self {
        Self {
            steady: SteadySettings::default(),
            sensors: 4,
            budget: f64::INFINITY,
            criterion: Criterion::LeakRate,
            method: None,
            within: 0.02,
            leak_kg_s: 0.01 / 3600.0,
            published: PublishedSettings::default(),
        }
    }
}

/// A study.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Study {
    /// Name of the vessel.
    pub vessel: String,
    /// Names of the candidates.
    pub candidates: Vec<String>,
    /// Height of each above the outer bottom, m.
    pub heights_m: Vec<Option<f64>>,
    /// Names of the scenarios.
    pub scenarios: Vec<String>,
    /// What was asked.
    pub settings: StudySettings,
    /// By number of sensors.
    pub numbers: Vec<BestLayouts>,
    /// Numbers of sensors for which there is no layout.
    pub refused: Vec<Infeasible>,
    /// Layouts by every number: the best by the criterion first, for each number of sensors.
    pub judged: Vec<EvaluatedLayout>,
    /// Cost against the standard deviation of the gas temperature.
    pub accuracy_front: Front,
    /// Cost against the delay of the leak.
    pub delay_front: Front,
    /// Of the best layout of most sensors: what a lost sensor leaves.
    pub failures: Vec<Failure>,
    /// What disturbs the estimates of that layout, and how much.
    pub biases: Vec<Bias>,
    /// One thermometer beside what is required, anywhere.
    pub positions: Vec<Position>,
    /// The same positions by the paper's measure; `None`: it was stopped before.
    pub published: Option<PublishedComparison>,
    /// It was stopped before its end.
    pub partial: bool,
}

/// Everything that layouts of a vessel are judged by.
#[derive(Debug)]
pub struct Placement {
    candidates: Candidates,
    steady: SteadyAnalysis,
    scenarios: Vec<ScenarioAnalysis>,
    vessel: Vessel,
    settings: StudySettings,
    abandoned: Arc<AtomicBool>,
}

impl Placement {
    /// A vessel with candidates and scenarios.
    ///
    /// # Errors
    /// A setting is out of its bounds, a scenario cannot be simulated, or a candidate has no place.
    pub fn new(
        vessel: &Vessel,
        candidates: &Candidates,
        scenarios: &[Scenario],
        settings: &StudySettings,
    ) -> Result<Self, EstimatorError> {
        let steady = SteadyAnalysis::new(vessel, &candidates.sensors(), &settings.steady)?;
        let analysis = |scenario| {
            ScenarioAnalysis::new(vessel, scenario, &candidates.sensors(), &steady.settings().observer)
        };
        let scenarios = scenarios.iter().map(analysis).collect::<Result<_, _>>()?;
        Ok(Self {
            candidates: candidates.clone(),
            steady,
            scenarios,
            vessel: vessel.clone(),
            settings: settings.clone(),
            abandoned: Arc::default(),
        })
    }

    /// The same, given up when `abandoned` is set: [`SearchControl::stop`] keeps and judges what there is, this drops it.
    #[must_use]
    pub fn abandoned_by(self, abandoned: &Arc<AtomicBool>) -> Self {
        Self { abandoned: abandoned.clone(), ..self }
    }

    /// Accuracy of a layout in each scenario.
    fn in_scenarios(&self, layout: &[usize]) -> Result<Vec<ScenarioAccuracy>, EstimatorError> {
        if self.abandoned.load(Ordering::Relaxed) {
            return Err(EstimatorError::Abandoned);
        }
        self.scenarios.iter().map(|scenario| scenario.accuracy(layout)).collect()
    }

    /// The candidates.
    pub fn candidates(&self) -> &Candidates {
        &self.candidates
    }

    /// The vessel.
    pub fn vessel(&self) -> &Vessel {
        &self.vessel
    }

    /// The analysis at rest.
    pub fn steady(&self) -> &SteadyAnalysis {
        &self.steady
    }

    fn constraints(&self, sensors: usize) -> Constraints {
        self.candidates.constraints(sensors, self.settings.budget)
    }

    /// Numbers of sensors, from those that a layout must have.
    fn sensors(&self) -> RangeInclusive<usize> {
        let most = self.settings.sensors;
        self.constraints(most).must.len().max(1)..=most
    }

    /// Layouts that a search looks at in the worst case.
    pub(crate) fn layouts(&self, sensors: usize) -> f64 {
        let constraints = self.constraints(sensors);
        let free = constraints.free(self.candidates.list.len()).len();
        let wanted = sensors.saturating_sub(constraints.must.len());
        (0..wanted).map(|taken| free.saturating_sub(taken) as f64 / (taken + 1) as f64).product()
    }

    /// Layouts that the searches of a study look at, for a progress bar; `None` where one of them is no exhaustive one.
    pub fn evaluations(&self) -> Option<f64> {
        // By the criterion, by each other number at rest, and for the fronts.
        let others = Criterion::AT_REST.iter().filter(|of| **of != self.settings.criterion);
        let searches = (2 + others.count()) as f64;
        let mut numbers = self.sensors();
        let all: f64 = numbers.clone().map(|sensors| self.layouts(sensors)).sum();
        let exhaustive = numbers.all(|sensors| self.method(sensors) == Method::Exhaustive);
        (exhaustive && all <= ALL_LAYOUTS).then_some(searches * all)
    }

    /// How layouts of so many sensors are searched.
    pub(crate) fn method(&self, sensors: usize) -> Method {
        // A layout along a scenario takes a thousand times as long as one at rest.
        let most = if let Criterion::Scenario(_) = self.settings.criterion { 400.0 } else { ALL_LAYOUTS };
        let usual = if self.layouts(sensors) <= most { Method::Exhaustive } else { Method::Greedy };
        self.settings.method.unwrap_or(usual)
    }

    /// Run the study. What is stopped by the control is left out and said to be partial.
    ///
    /// # Errors
    /// The constraints contradict each other, or no layout sees what it should: the state is named.
    pub fn run(&self, control: &SearchControl) -> Result<Study, EstimatorError> {
        let (numbers, refused) = self.numbers_and_infeasible(control)?;
        let judged = self.evaluate_all(&numbers, control)?;
        let (accuracy_front, delay_front) = self.fronts(&judged, control)?;
        let going = || !control.stop.load(Ordering::Relaxed);
        let (failures, biases) = match numbers.last() {
            Some(most) if going() => {
                let best = &most.layouts[0].sensors;
                (self.failures(best)?, self.biases(best)?)
            }
            _ => (Vec::new(), Vec::new()),
        };
        let positions = if going() { self.positions()? } else { Vec::new() };
        let published = if going() { Some(self.by_paper()?) } else { None };
        let list = &self.candidates.list;
        Ok(Study {
            vessel: self.vessel.name.clone(),
            candidates: list.iter().map(|candidate| candidate.sensor.name.clone()).collect(),
            heights_m: list.iter().map(|candidate| candidate.height_m).collect(),
            scenarios: self.scenarios.iter().map(|scenario| scenario.name().to_owned()).collect(),
            settings: self.settings.clone(),
            numbers,
            refused,
            judged,
            accuracy_front,
            delay_front,
            failures,
            biases,
            positions,
            published,
            partial: !going(),
        })
    }

    /// The best layouts for each number of sensors that can see what they should.
    ///
    /// # Errors
    /// As [`Placement::run`].
    pub fn numbers(&self, control: &SearchControl) -> Result<Vec<BestLayouts>, EstimatorError> {
        Ok(self.numbers_and_infeasible(control)?.0)
    }

    fn numbers_and_infeasible(
        &self,
        control: &SearchControl,
    ) -> Result<(Vec<BestLayouts>, Vec<Infeasible>), EstimatorError> {
        let most = self.settings.sensors;
        let at_any_cost = self.candidates.constraints(most, f64::INFINITY);
        at_any_cost.validate(self.candidates.list.len())?;
        let mut numbers: Vec<BestLayouts> = Vec::new();
        let mut errors = Vec::new();
        for sensors in self.sensors() {
            match self.best_layouts(sensors, control) {
                Ok(Some(mut number)) => {
                    let before = numbers.last().map(|before| before.layouts[0].value);
                    number.marginal = before.map(|before| number.layouts[0].value / before - 1.0);
                    numbers.push(number);
                }
                Ok(None) => {}
                // Fewer or more may do: what is dear may not be, what is few may not see.
                Err(error) => errors.push((sensors, error)),
            }
            if control.stop.load(Ordering::Relaxed) {
                return Ok((numbers, Vec::new()));
            }
        }
        if numbers.is_empty() {
            return Err(no_number(errors));
        }
        let refused =
            |(sensors, error): (usize, EstimatorError)| Infeasible { sensors, reason: error.to_string() };
        Ok((numbers, errors.into_iter().map(refused).collect()))
    }

    /// `None`: it was stopped before any layout was looked at.
    fn best_layouts(
        &self,
        sensors: usize,
        control: &SearchControl,
    ) -> Result<Option<BestLayouts>, EstimatorError> {
        let constraints = self.constraints(sensors);
        let criterion = self.settings.criterion;
        let objective = criterion.objective(&self.steady, &self.scenarios)?;
        let method = self.method(sensors);
        // The objective is the square of the number that people read.
        let within = (1.0 + self.settings.within).powi(2) - 1.0;
        let found = search(&objective, &constraints, method, within, control)?;
        let is_stopped = control.stop.load(Ordering::Relaxed);
        if found.layouts.is_empty() {
            return if is_stopped { Ok(None) } else { Err(self.nothing_found(&constraints)) };
        }
        let certificate = if criterion.is_convex() && !is_stopped {
            Some(certify(&objective, &constraints, &CertificateSettings::default())?)
        } else {
            None
        };
        let relaxation = certificate.as_ref().map(|of| of.bound().max(0.0).sqrt());
        let (bound, proof) = match (found.bound, relaxation) {
            (Some(bound), _) => (bound.sqrt(), Proof::Search),
            (None, Some(bound)) => (bound, Proof::Relaxation),
            (None, None) => (0.0, Proof::None),
        };
        let root = |layout: Layout| Layout { value: layout.value.sqrt(), ..layout };
        Ok(Some(BestLayouts {
            sensors,
            layouts: found.layouts.into_iter().map(root).collect(),
            bound,
            proof,
            relaxation,
            frank_wolfe: certificate.map(|of| of.frank_wolfe.max(0.0).sqrt()),
            method,
            evaluated: found.evaluated,
            marginal: None,
            partial: found.partial,
        }))
    }

    /// Why no layout was found: what not even all that may be taken see, or nothing is allowed.
    fn nothing_found(&self, constraints: &Constraints) -> EstimatorError {
        let mut all = constraints.free(self.candidates.list.len());
        all.extend(&constraints.must);
        all.sort_unstable();
        if let Err(error) = self.steady.accuracy(&all) {
            return error;
        }
        match self.cheapest_allowed(constraints) {
            Some(layout) => self.steady.slow().unseen_error(&layout),
            None => EstimatorError::PlacementConstraints {
                what: format!(
                    "of {} sensors none meets groups, distances and the budget {} together",
                    constraints.sensors, constraints.budget
                ),
            },
        }
    }

    /// A layout that is allowed, whatever it is worth.
    fn cheapest_allowed(&self, constraints: &Constraints) -> Option<Vec<usize>> {
        let costs = super::search::Costs(&constraints.costs);
        let found = search(&costs, constraints, Method::Greedy, 0.0, &SearchControl::default()).ok()?;
        found.best().map(|best| best.sensors.clone())
    }
}

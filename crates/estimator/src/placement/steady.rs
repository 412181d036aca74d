//! Accuracy of a layout at rest, in the steady state of the ordinary observer.
//!
//! The members of its bank do what they do there: the first gives the mass, the middle one of those with a leak rate gives the gas temperature, the
//! rate and the innovations that a leak is found by.
use serde::{Deserialize, Serialize};

use super::GroupedProblem;
use super::cylinder::{Conditions, InstrumentedCylinder, Quantity};
use super::objective::{Objective, Relaxed};
use super::response::{DetectionSettings, Disturbance, Response};
use crate::EstimatorError;
use crate::observer::{LeakHypothesis, ObserverSettings, middle_slow};
use crate::sensor::Sensor;
use crate::thermal::vessel::Vessel;

/// Wall nodes of the observer: places between them count as one.
const WALL_NODES: usize = 6;

/// Settings of the steady-state analysis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SteadySettings {
    /// The observer; a finer wall than in a vehicle tells heights apart.
    pub observer: ObserverSettings,
    /// State in which the cylinder rests; its film is taken at the difference of wall and gas that noise makes.
    pub conditions: Conditions,
    /// When a leak counts as found.
    pub detection: DetectionSettings,
}

impl Default for SteadySettings {
    fn default() -> Self {
        Self {
            observer: ObserverSettings { wall_nodes: WALL_NODES, ..ObserverSettings::default() },
            conditions: Conditions::default(),
            detection: DetectionSettings::default(),
        }
    }
}

/// Steady-state analysis of a vessel with all candidates, for the members of the bank.
#[derive(Clone, Debug)]
pub struct SteadyAnalysis {
    settings: SteadySettings,
    slow: InstrumentedCylinder,
    first: InstrumentedCylinder,
    gas: GroupedProblem,
    mass: GroupedProblem,
    leak: GroupedProblem,
}

/// Accuracy of the observer at rest with a layout.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SteadyAccuracy {
    /// Standard deviation of the mean gas temperature, K.
    pub gas_sd_k: f64,
    /// Of the mass against the filling, kg.
    pub mass_sd_kg: f64,
    /// Of the leak rate, kg/s.
    pub leak_sd_kg_s: f64,
    /// Smallest leak that is found in the time of [`DetectionSettings`], kg/s.
    pub smallest_leak_kg_s: f64,
}

impl SteadyAnalysis {
    /// A vessel with candidates. There are never more wall nodes than the vessel has columns.
    ///
    /// # Errors
    /// As [`InstrumentedCylinder::new`]; or no member of the bank has a leak rate.
    pub fn new(
        vessel: &Vessel,
        candidates: &[Sensor],
        settings: &SteadySettings,
    ) -> Result<Self, EstimatorError> {
        let mut settings = settings.clone();
        let columns = crate::thermal::wall::mesh::Mesh::new(&vessel.geometry).columns.len();
        settings.observer.wall_nodes = settings.observer.wall_nodes.min(columns);
        settings.conditions = settings.conditions.at_typical_difference(vessel, &settings.observer)?;
        let bank = &settings.observer.bank;
        let no_rate = EstimatorError::PlacementQuantity { quantity: Quantity::LeakRate };
        let slow = middle_slow(bank).ok_or(no_rate)?;
        let cylinder = |member: &LeakHypothesis| {
            InstrumentedCylinder::new(vessel, candidates, &settings.observer, member, &settings.conditions)
        };
        let (slow, first) = (cylinder(&bank[slow])?, cylinder(&bank[0])?);
        Ok(Self {
            gas: slow.problem(Quantity::GasTemperature)?,
            leak: slow.problem(Quantity::LeakRate)?,
            mass: first.problem(Quantity::Mass)?,
            slow,
            first,
            settings,
        })
    }

    /// The settings.
    pub fn settings(&self) -> &SteadySettings {
        &self.settings
    }

    /// The first member of the bank, and the one that gives gas temperature, leak rate and the innovations that tell a leak.
    pub fn members(&self) -> (&LeakHypothesis, &LeakHypothesis) {
        let bank = &self.settings.observer.bank;
        (&bank[0], &bank[middle_slow(bank).unwrap_or(0)])
    }

    /// The member that gives gas temperature and leak rate.
    pub fn slow(&self) -> &InstrumentedCylinder {
        &self.slow
    }

    /// The member that gives the mass.
    pub fn first(&self) -> &InstrumentedCylinder {
        &self.first
    }

    /// The search for the least variance of a quantity.
    pub fn problem(&self, quantity: Quantity) -> &GroupedProblem {
        match quantity {
            Quantity::GasTemperature => &self.gas,
            Quantity::Mass => &self.mass,
            Quantity::LeakRate => &self.leak,
        }
    }

    /// Standard deviations and smallest leak with a layout.
    ///
    /// # Errors
    /// [`EstimatorError::Unseen`]: it does not see every state.
    pub fn accuracy(&self, layout: &[usize]) -> Result<SteadyAccuracy, EstimatorError> {
        let sd = |quantity| {
            let variance = self.problem(quantity).value(layout);
            if variance.is_finite() { Ok(variance.sqrt()) } else { Err(self.slow.unseen_error(layout)) }
        };
        Ok(SteadyAccuracy {
            gas_sd_k: sd(Quantity::GasTemperature)?,
            mass_sd_kg: sd(Quantity::Mass)?,
            leak_sd_kg_s: sd(Quantity::LeakRate)?,
            smallest_leak_kg_s: self.smallest_leak_kg_s(layout)?,
        })
    }

    /// Response of the member whose innovations tell a leak.
    ///
    /// # Errors
    /// As [`InstrumentedCylinder::response`].
    pub fn response(
        &self,
        layout: &[usize],
        disturbances: &[Disturbance],
    ) -> Result<Response, EstimatorError> {
        self.slow.response(&self.leak, layout, disturbances)
    }

    /// Samples within which a leak is to be found.
    pub(crate) fn samples(&self) -> u64 {
        self.settings.detection.samples(self.settings.conditions.interval_s)
    }

    /// Smallest leak that is found in time, kg/s.
    ///
    /// # Errors
    /// As [`SteadyAnalysis::accuracy`].
    pub fn smallest_leak_kg_s(&self, layout: &[usize]) -> Result<f64, EstimatorError> {
        let response = self.response(layout, &[Disturbance::Leak])?;
        Ok(self.settings.detection.smallest(response.information(self.samples())[(0, 0)]))
    }

    /// Time until a leak of a rate, kg/s, is found, s; `None`: never.
    ///
    /// # Errors
    /// As [`SteadyAnalysis::accuracy`].
    pub fn delay_s(&self, layout: &[usize], rate_kg_s: f64) -> Result<Option<f64>, EstimatorError> {
        let needed = (self.settings.detection.needed_sd() / rate_kg_s).powi(2);
        let samples = self.response(layout, &[Disturbance::Leak])?.samples_to(0, needed);
        Ok(samples.map(|samples| samples as f64 * self.settings.conditions.interval_s))
    }
}

/// The smallest leak as an objective: its square, kg²/s², the variance that stands for it. It has no relaxation, hence no certificate: every
/// layout has to be looked at.
#[derive(Clone, Copy, Debug)]
pub(super) struct SmallestLeak<'a>(pub &'a SteadyAnalysis);

impl Objective for SmallestLeak<'_> {
    fn candidates(&self) -> usize {
        self.0.slow.candidates()
    }

    fn value(&self, layout: &[usize]) -> f64 {
        self.0.smallest_leak_kg_s(layout).map_or(f64::INFINITY, |rate| rate * rate)
    }

    fn relaxed(&self, _: &[f64]) -> Option<Relaxed> {
        None
    }
}

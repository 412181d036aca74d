//! The cylinder with every candidate on it: the observer's own equations, linearised where the cylinder stands.
//!
//! No second model: [`Cylinder`] is built with all candidates as its sensors, and its transition, its noise, the gradients of the readings
//! and their noise variances are those that the observer uses. To its leading states come the slow ones, which return to their priors
//! (`x <- a x + w`), so that all of them settle:
//!
//! `[x; c] <- [F F_c; 0 diag(a)] [x; c] + w`, `y_j = h_j^T x + h_cj^T c + v_j`.
//!
//! A state that neither moves nor walks, such as the leak rate of a member that supposes none, is left out. So is a transmitter's constant offset:
//! nothing tells it from the mass, which is therefore that against the filling. What a candidate
//! brings (offset, coupling, lag) belongs to it alone ([`GroupedProblem`]).
//!
//! Assumes that wall, gas and surroundings have come to rest at the conditions:
//! the covariance along a scenario is that of the observer run through it. The accuracy is the observer's own, with the errors that it supposes of its model.
use nalgebra::{DMatrix, DVector, DVectorView};
use serde::{Deserialize, Serialize};

use super::grouped::GroupedProblem;
use super::problem::{CandidateOutput, LinearProblem};
use crate::EstimatorError;
use crate::filter::{LinearSystem, Plant, StateSpace};
use crate::observer::cylinder::Cylinder;
use crate::observer::states::{StateKind, States};
use crate::observer::{Commissioning, LeakHypothesis, ObserverSettings};
use crate::sensor::Sensor;
use crate::thermal::vessel::Vessel;

/// Departure of a state from itself over an interval, relative, within which it does not move.
const CONSTANT_TOLERANCE: f64 = 1e-12;

/// Where the cylinder stands, and how often it is read.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Conditions {
    /// Pressure of the filling, Pa, and its temperature, K.
    pub filling: (f64, f64),
    /// Temperature of wall and gas, K.
    pub body_k: f64,
    /// Temperature of the surroundings, K.
    pub air_k: f64,
    /// Interval of the readings, s.
    pub interval_s: f64,
    /// Difference of wall and gas that the film between them is linearised for, K: the mean of the gas so much warmer and so much colder.
    /// At rest, 0, that film is the least there is: it grows with the cubic root of the difference, and noise always makes one.
    #[serde(default)]
    pub apart_k: f64,
}

impl Default for Conditions {
    /// 200 bar at 15 °C, at rest at that temperature, read every minute.
    fn default() -> Self {
        Self { filling: (200e5, 288.15), body_k: 288.15, air_k: 288.15, interval_s: 60.0, apart_k: 0.0 }
    }
}

/// Difference for which the film's slope is its mean over differences `N(0, 1)`: `d^(1/3) = E |z|^(1/3)`.
const TYPICAL: f64 = 0.6307;
/// Doublings of the interval until wall and gas are as far apart as they get.
const APART_DOUBLINGS: usize = 11;

impl Conditions {
    /// The same with the difference of wall and gas that the process noise of the settings itself makes: statistical linearisation (Gelb 1974,
    /// chapter 6) of a film that goes with the cubic root.
    ///
    /// # Errors
    /// As [`InstrumentedCylinder::new`].
    pub fn at_typical_difference(
        self,
        vessel: &Vessel,
        settings: &ObserverSettings,
    ) -> Result<Self, EstimatorError> {
        // A difference of d makes one that goes with d^(-1/6): each iteration leaves a sixth of the error.
        const ITERATIONS: usize = 6;
        const START_K: f64 = 0.1;
        let mut conditions = Self { apart_k: START_K, ..self };
        for _ in 0..ITERATIONS {
            let cylinder = InstrumentedCylinder::new(vessel, &[], settings, &settings.bank[0], &conditions)?;
            conditions.apart_k = TYPICAL * cylinder.wall_to_gas_sd_k();
        }
        Ok(conditions)
    }
}

/// What is to be known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quantity {
    /// Mean gas temperature, K.
    GasTemperature,
    /// Gas mass, kg.
    Mass,
    /// Leak rate, kg/s.
    LeakRate,
}

/// The linearised cylinder with all candidates.
#[derive(Clone, Debug)]
pub struct InstrumentedCylinder {
    /// Of the states that are kept.
    names: Vec<String>,
    kinds: Vec<StateKind>,
    owners: Vec<Option<usize>>,
    scales: Vec<f64>,
    point: Vec<f64>,
    transition: DMatrix<f64>,
    process_noise: DMatrix<f64>,
    outputs: Vec<CandidateOutput>,
    leak_drive: DVector<f64>,
    sun_drive: Option<DVector<f64>>,
}

impl InstrumentedCylinder {
    /// A vessel with candidates, as one member of the observer's bank sees it.
    ///
    /// # Errors
    /// As [`Cylinder::new`]; or the conditions are no state of the gas.
    pub fn new(
        vessel: &Vessel,
        candidates: &[Sensor],
        settings: &ObserverSettings,
        member: &LeakHypothesis,
        conditions: &Conditions,
    ) -> Result<Self, EstimatorError> {
        let mut cylinder = Cylinder::new(vessel, candidates, settings)?;
        cylinder.suppose(member);
        let (n, m) = (cylinder.states(), cylinder.leading());
        let point = state_at(&mut cylinder, vessel, conditions)?;
        let linear = linear_around(&mut cylinder, &point, conditions)?;
        let mut f = DMatrix::zeros(n, n);
        let mut q = DMatrix::zeros(n, n);
        f.rows_mut(0, m).copy_from(&linear.phi);
        q.view_mut((0, 0), (m, m)).copy_from(&linear.q);
        for state in m..n {
            (f[(state, state)], q[(state, state)]) = cylinder.slow_process(state).over(conditions.interval_s);
        }
        let is_known =
            |state: usize| q[(state, state)] == 0.0 && (f[(state, state)] - 1.0).abs() < CONSTANT_TOLERANCE;
        let kept: Vec<usize> = (0..n).filter(|&state| !is_known(state)).collect();
        let States { kinds, names, leak, sun, .. } = cylinder.state_map();
        let scales: Vec<f64> = kept.iter().map(|&state| scale(&kinds[state], candidates)).collect();
        let output = |(gradient, variance): (DVectorView<'_, f64>, &f64)| {
            let scaled = |(&state, scale): (&usize, &f64)| gradient[state] * scale;
            CandidateOutput {
                gradient: DVector::from_iterator(kept.len(), kept.iter().zip(&scales).map(scaled)),
                variance: *variance,
            }
        };
        let outputs = linear.h.column_iter().zip(&linear.r).map(output).collect();
        let scaled = |of: &DMatrix<f64>, columns: fn(f64) -> f64| {
            DMatrix::from_fn(kept.len(), kept.len(), |i, j| {
                of[(kept[i], kept[j])] * columns(scales[j]) / scales[i]
            })
        };
        // What comes on top of a state is not in the state itself.
        let drive = |by: usize| {
            let at = |state: usize| if state == by { 0.0 } else { f[(state, by)] };
            let each = kept.iter().zip(&scales).map(|(&state, scale)| at(state) / scale);
            DVector::from_iterator(kept.len(), each)
        };
        let (leak_drive, sun_drive) = (drive(*leak), sun.map(drive));
        let kinds: Vec<StateKind> = kept.iter().map(|&state| kinds[state].clone()).collect();
        let owner = |kind: &StateKind| match *kind {
            StateKind::Lag { sensor } | StateKind::Parameter { sensor, .. } => Some(sensor),
            _ => None,
        };
        Ok(Self {
            names: kept.iter().map(|&state| names[state].clone()).collect(),
            owners: kinds.iter().map(owner).collect(),
            kinds,
            point: kept.iter().map(|&state| point[state]).collect(),
            transition: scaled(&f, |scale| scale),
            process_noise: scaled(&q, f64::recip),
            outputs,
            scales,
            leak_drive,
            sun_drive,
        })
    }

    /// Standard deviation of the difference of gas and mean wall that is not read, K.
    fn wall_to_gas_sd_k(&self) -> f64 {
        let is_wall = |kind: &&StateKind| matches!(kind, StateKind::Wall(_));
        let nodes = self.kinds.iter().filter(is_wall).count() as f64;
        let part = |kind: &StateKind| match kind {
            StateKind::Gas => 1.0,
            StateKind::Wall(_) => -nodes.recip(),
            _ => 0.0,
        };
        let difference = DVector::from_iterator(self.kinds.len(), self.kinds.iter().map(part));
        let (mut transition, mut p) = (self.transition.clone(), self.process_noise.clone());
        for _ in 0..APART_DOUBLINGS {
            p += &transition * &p * transition.transpose();
            transition = &transition * &transition;
        }
        difference.dot(&(p * &difference)).sqrt()
    }

    /// Names of the states, in the order of the matrices.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// What one of each state is in the matrices, K, kg, ...: (n). Numbers near one keep the Riccati equation well posed.
    pub fn scales(&self) -> &[f64] {
        &self.scales
    }

    /// The state that everything is linearised at, in SI: (n).
    pub fn point(&self) -> &[f64] {
        &self.point
    }

    /// Transition over an interval of the readings: (n, n).
    pub fn transition(&self) -> &DMatrix<f64> {
        &self.transition
    }

    /// Covariance of the process noise over it: (n, n).
    pub fn process_noise(&self) -> &DMatrix<f64> {
        &self.process_noise
    }

    /// What each candidate reads.
    pub fn outputs(&self) -> &[CandidateOutput] {
        &self.outputs
    }

    /// The search for the layout that knows a quantity best: its criterion is the variance of the observer's estimate in the steady state,
    /// K², kg² or kg²/s².
    ///
    /// # Errors
    /// [`EstimatorError::PlacementQuantity`]: the member does not estimate it.
    pub fn problem(&self, quantity: Quantity) -> Result<GroupedProblem, EstimatorError> {
        let functional = self.functional(quantity)?;
        let outputs = self.outputs.clone();
        let whole =
            LinearProblem::new(self.transition.clone(), self.process_noise.clone(), functional, outputs)?;
        GroupedProblem::new(whole, &self.owners)
    }

    /// Change of the states over an interval by what comes on top of them, in their scales: (n). By a leak of 1 kg/s.
    pub(super) fn leak_drive(&self) -> &DVector<f64> {
        &self.leak_drive
    }

    /// By 1 W of sun on the wall; `None` where no sun is supposed.
    pub(super) fn sun_drive(&self) -> Option<&DVector<f64>> {
        self.sun_drive.as_ref()
    }

    /// Number of candidates.
    pub(crate) fn candidates(&self) -> usize {
        self.outputs.len()
    }

    /// Index of a quantity's state.
    fn state_of(&self, quantity: Quantity) -> Result<usize, EstimatorError> {
        let wanted = match quantity {
            Quantity::GasTemperature => StateKind::Gas,
            Quantity::Mass => StateKind::Mass,
            Quantity::LeakRate => StateKind::Leak,
        };
        let state = self.kinds.iter().position(|kind| *kind == wanted);
        state.ok_or(EstimatorError::PlacementQuantity { quantity })
    }

    /// The functional of a quantity: (n).
    ///
    /// # Errors
    /// [`EstimatorError::PlacementQuantity`]: the member does not estimate it.
    pub(super) fn functional(&self, quantity: Quantity) -> Result<DVector<f64>, EstimatorError> {
        let state = self.state_of(quantity)?;
        let mut functional = DVector::zeros(self.kinds.len());
        functional[state] = self.scales[state];
        Ok(functional)
    }

    /// The state that a layout does not see, where it has no steady state: of those that do not return by themselves that whose variance grows most in
    /// a second day.
    pub fn unseen(&self, layout: &[usize]) -> Option<&str> {
        let problem = self.problem(Quantity::Mass).ok()?;
        let states = problem.states_of(layout);
        let growth = problem.of_layout(layout).growth();
        let most = growth.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
        Some(&self.names[states[most.0]])
    }
}

/// The linearisation at a point; of what temperatures do to each other, the mean of those with the gas warmer and colder than it.
///
/// What mass, films and constants do stays that at the point: beside it heat flows, and the mass is in its effect on the temperature of the gas. The
/// two sides do not quite cancel, and a mass that nobody reads would seem to be seen.
fn linear_around(
    cylinder: &mut Cylinder,
    point: &[f64],
    conditions: &Conditions,
) -> Result<LinearSystem, EstimatorError> {
    let gas = cylinder.state_map().gas;
    let mut at = |apart_k: f64| {
        let mut beside = point.to_vec();
        beside[gas] += apart_k;
        LinearSystem::at(cylinder, &beside, conditions.interval_s)
    };
    let mut linear = at(0.0)?;
    if conditions.apart_k == 0.0 {
        return Ok(linear);
    }
    let (warm, cold) = (at(conditions.apart_k)?, at(-conditions.apart_k)?);
    let is_temperature = |kind: &StateKind| {
        matches!(
            kind,
            StateKind::Wall(_) | StateKind::Valve | StateKind::Gas | StateKind::Air | StateKind::Sun
        )
    };
    let kinds = &cylinder.state_map().kinds;
    let temperatures: Vec<usize> =
        (0..linear.phi.nrows()).filter(|&state| is_temperature(&kinds[state])).collect();
    for &row in &temperatures {
        let mut gained = 0.0;
        for &column in &temperatures {
            let mean =
                |warm: &DMatrix<f64>, cold: &DMatrix<f64>| 0.5 * (warm[(row, column)] + cold[(row, column)]);
            let by = mean(&warm.phi, &cold.phi);
            if kinds[column] != StateKind::Sun {
                gained += by - linear.phi[(row, column)];
            }
            linear.phi[(row, column)] = by;
            linear.q[(row, column)] = mean(&warm.q, &cold.q);
        }
        // What is as warm as everything else stays so: else the film, which changes with the temperature, would hold it.
        linear.phi[(row, row)] -= gained;
    }
    linear.r = warm.r.iter().zip(&cold.r).map(|(warm, cold)| 0.5 * (warm + cold)).collect();
    Ok(linear)
}

/// A typical size of a state's error.
fn scale(kind: &StateKind, candidates: &[Sensor]) -> f64 {
    let reading = |sensor: usize| match candidates[sensor].quantity() {
        crate::log::Quantity::Pressure => 1e5,
        crate::log::Quantity::Temperature => 1.0,
    };
    match *kind {
        StateKind::Mass => 1e-2,
        StateKind::Leak => 1e-4 / 3600.0,
        StateKind::Lag { sensor } => reading(sensor),
        StateKind::Parameter { sensor, parameter } => {
            let sd = candidates[sensor].parameters()[parameter].sd;
            if sd > 0.0 { sd } else { reading(sensor) }
        }
        StateKind::Wall(_) | StateKind::Valve | StateKind::Gas | StateKind::Air | StateKind::Sun => 1.0,
        StateKind::OutsideFilm
        | StateKind::InsideFilm
        | StateKind::Capacity
        | StateKind::FilmSlope
        | StateKind::ValveSun => 0.1,
    }
}

/// The state of a cylinder at rest, its surroundings at a temperature of their own.
///
/// # Errors
/// The filling is no state of the gas.
pub fn state_at(
    cylinder: &mut Cylinder,
    vessel: &Vessel,
    conditions: &Conditions,
) -> Result<Vec<f64>, EstimatorError> {
    let Conditions { filling: (pressure_pa, temperature_k), body_k, air_k, .. } = *conditions;
    let mass_kg = Commissioning::filled(pressure_pa, temperature_k).mass_kg(vessel, temperature_k)?;
    let present_pa = cylinder.model().settled_pressure_pa(mass_kg, body_k)?;
    let sensors = cylinder.sensors();
    let value = |kind: &StateKind| match *kind {
        StateKind::Wall(_) | StateKind::Valve | StateKind::Gas => body_k,
        StateKind::Mass => mass_kg,
        StateKind::Air => air_k,
        StateKind::Lag { sensor } => match sensors[sensor].quantity() {
            crate::log::Quantity::Pressure => present_pa,
            crate::log::Quantity::Temperature => body_k,
        },
        StateKind::Parameter { sensor, parameter } => sensors[sensor].parameters()[parameter].mean,
        StateKind::Leak
        | StateKind::OutsideFilm
        | StateKind::Sun
        | StateKind::InsideFilm
        | StateKind::Capacity
        | StateKind::FilmSlope
        | StateKind::ValveSun => 0.0,
    };
    Ok(cylinder.state_map().kinds.iter().map(value).collect())
}

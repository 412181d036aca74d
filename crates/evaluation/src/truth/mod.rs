//! Truth for judging: mismatched cylinders in random weather, simulated with stratified gas, all from seeds.
//!
//! An observer works with a nominal cylinder in unknown surroundings. A truth is what it is judged by: a
//! cylinder whose properties are drawn around the nominal ones ([`draw_cylinder`]), surroundings drawn for a
//! [`Course`] ([`draw_weather`]), the simulation of both ([`simulate_truth`]) and what imperfect sensors read of it
//! ([`generate`]). The same seed gives the same truth; a longer course begins like a shorter one.
mod course;
mod cylinder;
pub mod disturbance;
mod file;
pub mod matched;
pub mod process;
mod railway;
mod readings;
pub mod score;
mod weather;

use cylwatch_thermal::flow::{Flow, FlowKind};
use cylwatch_thermal::simulate::{SimulationSettings, simulate};
use cylwatch_thermal::trajectory::Trajectory;
use cylwatch_thermal::vessel::{Vessel, presets};
use serde::{Deserialize, Serialize};

use crate::EvaluationError;
use crate::estimator::log::Log;

pub use course::Course;
pub use cylinder::{
    Cylinder, CylinderParameters, PressureSensor, SensorParameters, TemperatureSensor, draw_cylinder,
};
pub use process::{Happenings, Process};
pub use railway::{Passage, passages};
pub use weather::draw_weather;

/// Interval of the samples while an observer learns, s.
const LEARNING_SAMPLE_S: f64 = 60.0;

/// How a truth is computed.
#[derive(Clone, Debug, PartialEq)]
pub struct TruthSettings {
    /// Built-in vessel that cylinders are drawn around.
    pub vessel: String,
    /// Axial wall cells of the cylindrical part; bottom, shoulder and neck have their own.
    pub cylinder_cells: usize,
    /// Radial cells of each layer of the wall.
    pub radial_cells: usize,
    /// Stacked gas cells; 1: well mixed.
    pub gas_cells: usize,
    /// Relative tolerance of the simulation.
    pub relative_tolerance: f64,
    /// Spacing of the knots of turbulence and gusts, s: wider is faster to simulate.
    pub weather_spacing_s: f64,
    /// A leak, if any.
    pub leak: Option<TruthLeak>,
}

/// A constant leak.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TruthLeak {
    /// Mass flow out, kg/s.
    pub rate_kg_s: f64,
    /// When it begins, s from the start of the whole course.
    pub start_s: f64,
}

impl Default for TruthSettings {
    fn default() -> Self {
        Self {
            vessel: "nitrogen-20l".into(),
            cylinder_cells: 6,
            radial_cells: 1,
            gas_cells: 10,
            relative_tolerance: 1e-6,
            weather_spacing_s: weather::SPACING_S,
            leak: None,
        }
    }
}

impl TruthSettings {
    /// Well-mixed gas behind a coarser wall, tolerance 1e-4 and knots of the weather 5 min apart: some thirty times as fast, for
    /// hundreds of years. Parameters, sensors, tunnels, trips, sun and climate are those of the default.
    pub fn fast() -> Self {
        Self {
            cylinder_cells: 3,
            gas_cells: 1,
            relative_tolerance: 1e-4,
            weather_spacing_s: 300.0,
            ..Self::default()
        }
    }

    /// Check the settings.
    ///
    /// # Errors
    /// [`EvaluationError::TruthSetting`] with the first value outside its range.
    pub fn validate(&self) -> Result<(), EvaluationError> {
        let check = |setting: &'static str, value: f64, low: f64, high: f64| {
            if value >= low && value <= high {
                Ok(())
            } else {
                Err(EvaluationError::TruthSetting { setting, value, low, high })
            }
        };
        check("cylinder_cells", self.cylinder_cells as f64, 1.0, 1000.0)?;
        check("radial_cells", self.radial_cells as f64, 1.0, 1000.0)?;
        check("gas_cells", self.gas_cells as f64, 1.0, 1000.0)?;
        check("weather_spacing_s", self.weather_spacing_s, 1.0, 3600.0)?;
        if let Some(leak) = self.leak {
            check("leak.rate_kg_s", leak.rate_kg_s, 0.0, 1.0)?;
            check("leak.start_s", leak.start_s, 0.0, 1e9)?;
        }
        check("relative_tolerance", self.relative_tolerance, 1e-12, 1e-2)
    }
}

/// What really happened, sampled, and what the sensors read of it. Every vector has the length of `time_s`.
#[derive(Clone, Debug)]
pub struct Truth {
    /// What the cylinder went through.
    pub course: Course,
    /// Seed of everything that was drawn.
    pub seed: u64,
    /// How the cylinder differs from the nominal one.
    pub parameters: CylinderParameters,
    /// What its sensors are like.
    pub sensors: SensorParameters,
    /// The leak, if any.
    pub leak: Option<TruthLeak>,
    /// Sample times, s, increasing.
    pub time_s: Vec<f64>,
    /// Mass-weighted mean gas temperature, K.
    pub gas_mean_k: Vec<f64>,
    /// Gas mass, kg.
    pub mass_kg: Vec<f64>,
    /// Gas pressure, Pa.
    pub pressure_pa: Vec<f64>,
    /// Air temperature at half the height, K.
    pub ambient_k: Vec<f64>,
    /// Mean wall temperature, K.
    pub wall_mean_k: Vec<f64>,
    /// Surface temperature of the shoulder, K.
    pub shoulder_k: Vec<f64>,
    /// Temperature of the valve, K.
    pub valve_k: Vec<f64>,
    /// Surface temperature of the middle, K.
    pub middle_k: Vec<f64>,
    /// Surface temperature of the bottom, K.
    pub bottom_k: Vec<f64>,
    /// Readings: `shoulder`, `valve`, `wall_middle`, `wall_bottom`, `pressure`.
    pub log: Log,
}

/// The truth of a course and a seed with default settings; samples every `sample_time_s`, s, but every minute
/// while an observer learns.
///
/// # Errors
/// As [`generate_with`].
pub fn generate(course: &Course, seed: u64, sample_time_s: f64) -> Result<Truth, EvaluationError> {
    generate_with(course, seed, sample_time_s, &TruthSettings::default())
}

/// The truth of a course and a seed.
///
/// # Errors
/// Settings out of range, or a simulation that fails.
pub fn generate_with(
    course: &Course,
    seed: u64,
    sample_time_s: f64,
    settings: &TruthSettings,
) -> Result<Truth, EvaluationError> {
    generate_through(course, seed, sample_time_s, settings, &Happenings::default())
}

/// The truth of a course and a seed with what happens on top of it.
///
/// # Errors
/// As [`generate_with`].
pub fn generate_through(
    course: &Course,
    seed: u64,
    sample_time_s: f64,
    settings: &TruthSettings,
    happenings: &Happenings,
) -> Result<Truth, EvaluationError> {
    let (cylinder, trajectory) = simulate_through(course, seed, sample_time_s, settings, happenings)?;
    let learning_s = course.opening_s();
    let every = ((LEARNING_SAMPLE_S / sample_time_s).round() as usize).max(1);
    let kept = |&index: &usize| trajectory.time_s[index] >= learning_s || index % every == 0;
    let samples: Vec<usize> = (0..trajectory.time_s.len()).filter(kept).collect();
    Truth::sample(course, seed, settings.leak, &cylinder, &trajectory, &samples)
}

/// The simulation behind a truth, with every wall and gas cell, at every `sample_time_s`, s.
///
/// # Errors
/// Settings out of range, or a simulation that fails.
pub fn simulate_truth(
    course: &Course,
    seed: u64,
    sample_time_s: f64,
    settings: &TruthSettings,
) -> Result<(Cylinder, Trajectory), EvaluationError> {
    simulate_through(course, seed, sample_time_s, settings, &Happenings::default())
}

/// The same with what happens on top of the course.
///
/// # Errors
/// As [`simulate_truth`].
pub fn simulate_through(
    course: &Course,
    seed: u64,
    sample_time_s: f64,
    settings: &TruthSettings,
    happenings: &Happenings,
) -> Result<(Cylinder, Trajectory), EvaluationError> {
    simulate_around(&presets::load(&settings.vessel)?, course, seed, sample_time_s, settings, happenings)
}

/// The same with a cylinder that is drawn around any vessel, instead of the built-in one that the settings name.
///
/// # Errors
/// As [`simulate_truth`].
pub fn simulate_around(
    nominal: &Vessel,
    course: &Course,
    seed: u64,
    sample_time_s: f64,
    settings: &TruthSettings,
    happenings: &Happenings,
) -> Result<(Cylinder, Trajectory), EvaluationError> {
    let cylinder = draw_cylinder(nominal, settings, seed)?;
    let mut scenario =
        cylinder.parameters.expose(weather::draw_spaced(course, seed, settings.weather_spacing_s)?)?;
    scenario.sample_time_s = sample_time_s;
    scenario.flows.extend(settings.leak.map(flow));
    happenings.apply(&cylinder.vessel, &mut scenario)?;
    let simulation = SimulationSettings {
        relative_tolerance: settings.relative_tolerance,
        ..SimulationSettings::default()
    };
    let trajectory = simulate(&cylinder.vessel, &scenario, &simulation, &mut |_| {})?;
    Ok((cylinder, trajectory))
}

fn flow(leak: TruthLeak) -> Flow {
    Flow {
        name: "leak".into(),
        kind: FlowKind::Leak { mass_flow_kg_s: leak.rate_kg_s },
        start_s: leak.start_s,
        stop_s: f64::INFINITY,
        opens_above_pa: None,
        closes_below_pa: None,
        closes_above_pa: None,
    }
}

#[cfg(test)]
mod tests;

//! What happens to a cylinder: fill, surroundings, flows, events, duration.
//!
//! `ScenarioSpec` is the raw content of a scenario file; `ScenarioSpec::build` checks it (and reads the
//! CSV files it names) and gives a [`Scenario`].
mod build;
mod flows;
mod opening;
pub mod presets;
mod read;
pub(crate) mod series;
mod signal;
pub mod spec;

pub use read::{read_scenario, schema};
pub use series::Series;
pub(crate) use spec::ScenarioSpec;

use crate::flow::Flow;
use crate::sensor::MountedSensor;
use crate::vessel::Fill;

/// A validated scenario. All values SI, time from 0.
#[derive(Clone, Debug)]
pub struct Scenario {
    /// Name for people.
    pub name: String,
    /// State at time 0.
    pub initial: Initial,
    /// What surrounds the cylinder.
    pub surroundings: Surroundings,
    /// Leaks, discharges, refills.
    pub flows: Vec<Flow>,
    /// Pressures whose crossing (either way) is reported as an event, Pa.
    pub pressure_limits_pa: Vec<f64>,
    /// Sensors of the scenario, for the simulated log.
    pub sensors: Vec<MountedSensor>,
    /// End time, s.
    pub duration_s: f64,
    /// Interval of the output samples, s.
    pub sample_time_s: f64,
}

/// How much gas is inside at time 0, and how warm everything is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Initial {
    /// What fixes the gas mass.
    pub fill: Fill,
    /// Temperature of wall and valve at time 0, K.
    pub wall_temperature_k: f64,
    /// Temperature of the gas at time 0, K.
    pub gas_temperature_k: f64,
}

/// What surrounds the cylinder, as functions of time.
#[derive(Clone, Debug)]
pub struct Surroundings {
    /// Air temperature, K.
    pub air_k: Series,
    /// Outside film.
    pub film: OutsideFilm,
    /// Temperature that the surface radiates to, K; `None`: no separate radiation (e.g. contained in the coefficient).
    pub radiation_k: Option<Series>,
    /// Sun on a part of the surface.
    pub sun: Option<Sun>,
    /// How film and air change along the axis.
    pub axial: AxialVariation,
}

/// Change of the surroundings from the bottom to the top; none by default. Heights are fractions of the inner height,
/// the valve counts as the top.
#[derive(Clone, Debug, Default)]
pub struct AxialVariation {
    /// Relative change of the outside film (not of radiation): it is multiplied by `1 + film_slope (z/H - 1/2)`.
    pub film_slope: f64,
    /// Air temperature at the top minus that at the bottom, K, linear between; none: the same air everywhere.
    pub air_difference_k: Option<Series>,
}

/// Outside film.
#[derive(Clone, Debug)]
pub enum OutsideFilm {
    /// Coefficient, W/(m² K).
    Coefficient {
        /// Coefficient against time, W/(m² K).
        film_w_m2_k: Series,
    },
    /// Natural convection blended with cross flow, from air temperature and wind.
    Convection {
        /// Wind speed across the axis, m/s.
        wind_m_s: Series,
        /// Multiplier for calibration, 1 by default.
        multiplier: f64,
    },
}

impl OutsideFilm {
    /// The signal behind the film: the coefficient, or the wind.
    pub fn signal(&self) -> &Series {
        match self {
            Self::Coefficient { film_w_m2_k } => film_w_m2_k,
            Self::Convection { wind_m_s, .. } => wind_m_s,
        }
    }
}

/// Direct sun on a stretch of the surface. The lit cells absorb
/// `absorptivity * irradiance * A_outer / pi` (projected area of a cylinder).
#[derive(Clone, Debug)]
pub struct Sun {
    /// Irradiance normal to the rays, W/m².
    pub irradiance_w_m2: Series,
    /// Lower end of the lit stretch as a fraction of the outer height.
    pub from_fraction: f64,
    /// Upper end of the lit stretch as a fraction of the outer height.
    pub to_fraction: f64,
    /// Whether the valve is lit too.
    pub valve: bool,
}

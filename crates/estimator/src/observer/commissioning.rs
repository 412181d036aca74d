//! What is known when the observer starts.
use super::settings::ObserverSettings;
use super::states::{StateKind, States};
use crate::EstimatorError;
use crate::sensor::{Sensor, SensorKind};
use crate::thermal::scenario::Fill;
use crate::thermal::vessel::Vessel;

/// Temperature that is assumed where nobody measures one, K.
const ASSUMED_K: f64 = 288.15;
const ASSUMED_SD_K: f64 = 20.0;
/// Rate and coefficient that a fill of 200 bar and 15 °C knows: 1 K and 1 bar are 19 g each.
const DEFAULT_MASS_SD_KG: f64 = 0.045;

/// What is known of the cylinder at the first sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Commissioning {
    /// What fixes the gas mass.
    pub fill: Fill,
    /// Standard deviation of that mass, kg: 45 g stands for 1.7 K and 1.7 bar together.
    pub mass_sd_kg: f64,
    /// Whether wall and gas have one temperature at the first sample.
    pub settled: bool,
}

impl Commissioning {
    /// A settled cylinder that was filled to a pressure at a temperature.
    pub fn filled(pressure_pa: f64, temperature_k: f64) -> Self {
        let fill = Fill::Settled { pressure_pa, temperature_k };
        Self { fill, mass_sd_kg: DEFAULT_MASS_SD_KG, settled: true }
    }

    /// Gas mass that the fill stands for, kg.
    ///
    /// # Errors
    /// The fill is outside the fluid's domain or not a positive mass.
    pub fn mass_kg(&self, vessel: &Vessel, temperature_k: f64) -> Result<f64, EstimatorError> {
        let at = |p: f64, t: f64| -> Result<f64, EstimatorError> {
            Ok(vessel.fluid.density_from_pressure_temperature(p, t)? * vessel.volume.volume_m3(t, p))
        };
        let mass_kg = match self.fill {
            Fill::Mass { mass_kg } => mass_kg,
            Fill::Settled { pressure_pa, temperature_k } => at(pressure_pa, temperature_k)?,
            Fill::Pressure { pressure_pa } => at(pressure_pa, temperature_k)?,
        };
        let require = |setting, value: f64| {
            if value > 0.0 && value.is_finite() {
                return Ok(());
            }
            Err(EstimatorError::ObserverSetting { setting, value, bound: "positive and finite" })
        };
        require("commissioning.mass_kg", mass_kg)?;
        require("commissioning.mass_sd_kg", self.mass_sd_kg)?;
        Ok(mass_kg)
    }
}

/// Mean and variances of the state before the first sample.
#[derive(Clone, Debug)]
pub(super) struct Prior {
    /// Mean: (n).
    pub mean: Vec<f64>,
    /// Variances: (n); the prior has no correlations.
    pub variance: Vec<f64>,
}

/// The prior of the member that supposes nothing of its own, from the first readings (NaN: missing).
pub(super) fn prior(
    states: &States,
    sensors: &[Sensor],
    settings: &ObserverSettings,
    commissioning: &Commissioning,
    vessel: &Vessel,
    readings: &[f64],
) -> Result<Prior, EstimatorError> {
    let mean_of = |wanted: fn(&SensorKind) -> bool| -> Option<f64> {
        let values: Vec<f64> = sensors
            .iter()
            .zip(readings)
            .filter(|(sensor, value)| wanted(&sensor.kind) && value.is_finite())
            .map(|(_, value)| *value)
            .collect();
        (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
    };
    let surface = mean_of(|kind| matches!(kind, SensorKind::Surface { .. }));
    let gas = mean_of(|kind| matches!(kind, SensorKind::Gas { .. }));
    let air = mean_of(|kind| matches!(kind, SensorKind::Ambient));
    let body_k = surface.or(gas).or(air);
    let (body_k, body_sd) = match (body_k, commissioning.settled) {
        (Some(body_k), true) => (body_k, 1.0),
        (Some(body_k), false) => (body_k, 5.0),
        (None, _) => (ASSUMED_K, ASSUMED_SD_K),
    };
    let gas_sd = if commissioning.settled { body_sd } else { 10.0 };
    let mass_kg = commissioning.mass_kg(vessel, gas.unwrap_or(body_k))?;
    let mut out = Prior { mean: Vec::new(), variance: Vec::new() };
    for kind in &states.kinds {
        let (mean, sd) = match *kind {
            StateKind::Wall(_) | StateKind::Valve => (body_k, body_sd),
            StateKind::Gas => (gas.unwrap_or(body_k), gas_sd),
            StateKind::Mass => (mass_kg, commissioning.mass_sd_kg),
            StateKind::Leak => (0.0, 0.0),
            StateKind::Air => (air.unwrap_or(body_k), settings.air.prior_sd.max(body_sd)),
            StateKind::OutsideFilm => (0.0, settings.ln_outside_film.prior_sd),
            StateKind::Sun => (0.0, settings.sun.prior_sd),
            StateKind::InsideFilm => (0.0, settings.ln_inside_film.prior_sd),
            StateKind::Capacity => (0.0, settings.ln_capacity.prior_sd),
            StateKind::FilmSlope => (0.0, settings.film_slope.prior_sd),
            StateKind::Lag { sensor } => lagged(sensors, readings, sensor, body_k),
            StateKind::Parameter { sensor, parameter } => {
                let parameter = &sensors[sensor].parameters()[parameter];
                (parameter.mean, parameter.sd)
            }
        };
        out.mean.push(mean);
        out.variance.push(sd * sd);
    }
    Ok(out)
}

/// What a lagging sensor shows at the start: its own reading, if it has one.
fn lagged(sensors: &[Sensor], readings: &[f64], sensor: usize, body_k: f64) -> (f64, f64) {
    let pressure = matches!(sensors[sensor].kind, SensorKind::Pressure { .. });
    let (assumed, sd) = if pressure { (2e7, 1e7) } else { (body_k, ASSUMED_SD_K) };
    let reading = readings[sensor];
    if reading.is_finite() { (reading, if pressure { 1e5 } else { 1.0 }) } else { (assumed, sd) }
}

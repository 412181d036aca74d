//! What is known when the observer starts, and how it starts or starts again.
use alloc::vec::Vec;
use cylwatch_thermal::real::powi;
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use super::settings::{LeakHypothesis, ObserverSettings};
use super::states::{StateKind, States};
use super::{Observer, REFERENCE_AFTER_S, SETTLE_S};
use crate::EstimatorError;
use crate::log::Quantity;
use crate::sensor::{Sensor, Site};
use crate::thermal::vessel::Fill;
use crate::thermal::vessel::Vessel;

/// Temperature that is assumed where none is measured, K.
const ASSUMED_K: f64 = 288.15;
const ASSUMED_SD_K: f64 = 20.0;
/// How well a stated fill is known, as a part of its mass: at 200 bar and 15 °C, 1 K and 1 bar are 0.43 % each.
const DEFAULT_MASS_SD: f64 = 0.01;
/// How far what the first sample reads may be from the temperature of a cylinder, K,
const BODY_SD_K: f64 = 1.0;
/// and wall, valve and gas of a settled one from each other: the turbulence of the air and a shoulder in the wind.
const SETTLED_SD_K: f64 = 0.2;
/// The same where an estimate begins again, of a cylinder that has been watched.
const AGAIN_SD_K: f64 = 5.0;

/// What is known of the cylinder at the first sample.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Commissioning {
    /// What fixes the gas mass.
    pub fill: Fill,
    /// Standard deviation of that mass as a part of it: 1 % stands for 1.7 K and 1.7 bar together at 200 bar.
    pub mass_sd: f64,
    /// Whether wall and gas have one temperature at the first sample.
    pub settled: bool,
}

impl Commissioning {
    /// How far what thermometers on the wall first read may be from wall, valve and gas of a cylinder that is not settled, K, beside how far they are apart: in a tunnel they
    /// read 10 K more than a wall that is 65 K colder than the air.
    pub const UNSETTLED_SD_K: f64 = 10.0;

    /// Standard deviation of the air about such a cylinder, K: a train may leave a tunnel.
    pub const UNSETTLED_AIR_SD_K: f64 = 20.0;

    /// A settled cylinder that was filled to a pressure at a temperature.
    pub fn filled(pressure_pa: f64, temperature_k: f64) -> Self {
        let fill = Fill::Settled { pressure_pa, temperature_k };
        Self { fill, mass_sd: DEFAULT_MASS_SD, settled: true }
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
        require("commissioning.mass_sd", self.mass_sd)?;
        Ok(mass_kg)
    }
}

/// How an estimate begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Start {
    /// With wall and gas at one temperature.
    Settled,
    /// In the middle of whatever the surroundings do.
    Anywhere,
    /// Once more.
    Again,
}

/// What the present estimate began from.
#[derive(Clone, Debug)]
pub(super) struct BegunFrom {
    commissioning: Commissioning,
    start: Start,
    readings: Vec<f64>,
}

impl BegunFrom {
    /// Nothing yet.
    pub(super) fn new(commissioning: &Commissioning, sensors: usize) -> Self {
        Self { commissioning: *commissioning, start: Start::Anywhere, readings: vec![f64::NAN; sensors] }
    }
}

/// Standard deviations of the temperatures at the start: common to all, and of each by itself, K.
#[derive(Clone, Copy)]
struct Spread {
    common_k: f64,
    each_k: f64,
}

impl Spread {
    /// Of a cylinder whose thermometers, if there are any, are so far apart at first, K.
    fn of(start: Start, apart_k: Option<f64>) -> Self {
        let common_k = match (apart_k, start) {
            (None, _) => ASSUMED_SD_K,
            (Some(_), Start::Settled) => BODY_SD_K,
            (Some(_), _) => 0.0,
        };
        let each_k = match start {
            Start::Settled => SETTLED_SD_K,
            Start::Anywhere => libm::hypot(Commissioning::UNSETTLED_SD_K, apart_k.unwrap_or_default()),
            Start::Again => AGAIN_SD_K,
        };
        Self { common_k, each_k }
    }

    /// Add what is common to the temperatures of wall, valve and gas.
    fn couple(self, states: &States, covariance: &mut DMatrix<f64>) {
        let is_body =
            |kind: &StateKind| matches!(kind, StateKind::Wall(_) | StateKind::Valve | StateKind::Gas);
        let body = || (0..states.count()).filter(|&state| is_body(&states.kinds[state]));
        for (i, j) in body().flat_map(|i| body().map(move |j| (i, j))) {
            covariance[(i, j)] += self.common_k * self.common_k;
        }
    }
}

/// Write mean (n) and covariance (n, n) of the member that supposes nothing of its own, before the first readings (NaN: missing) are taken. Only the
/// temperatures of a settled cylinder are correlated.
fn write_prior(
    (states, sensors, settings): (&States, &[Sensor], &ObserverSettings),
    BegunFrom { commissioning, start, readings }: &BegunFrom,
    vessel: &Vessel,
    mean: &mut [f64],
    covariance: &mut DMatrix<f64>,
) -> Result<(), EstimatorError> {
    let first = |is_it: fn(&Sensor) -> bool| -> Option<(f64, f64)> {
        let readings = sensors.iter().zip(readings).filter(|(sensor, _)| is_it(sensor));
        mean_and_range(readings.map(|(_, value)| *value).filter(|value| value.is_finite()))
    };
    let surface = first(Sensor::is_on_surface);
    let gas = first(|sensor| matches!(sensor.site(), Site::Gas(_)));
    let air = first(|sensor| sensor.site() == Site::Air);
    let measured = surface.or(gas).or(air);
    let [gas, air] = [gas, air].map(|of| of.map(|(mean_k, _)| mean_k));
    let body_k = measured.map_or(ASSUMED_K, |(mean_k, _)| mean_k);
    let spread = Spread::of(*start, measured.map(|(_, apart_k)| apart_k));
    let mass_kg = commissioning.mass_kg(vessel, gas.unwrap_or(body_k))?;
    covariance.fill(0.0);
    for (state, kind) in states.kinds.iter().enumerate() {
        let (of_mean, of_sd) = match *kind {
            StateKind::Wall(_) | StateKind::Valve => (body_k, spread.each_k),
            StateKind::Gas => (gas.unwrap_or(body_k), spread.each_k),
            StateKind::Mass => (mass_kg, commissioning.mass_sd * mass_kg),
            StateKind::Leak => (0.0, 0.0),
            StateKind::Air => {
                (air.unwrap_or(body_k), settings.air.prior_sd.max(spread.common_k.max(spread.each_k)))
            }
            StateKind::OutsideFilm => (0.0, settings.ln_outside_film.prior_sd),
            StateKind::Sun => (0.0, settings.sun.prior_sd),
            StateKind::InsideFilm => (0.0, settings.ln_inside_film.prior_sd),
            StateKind::Capacity => (0.0, settings.ln_capacity.prior_sd),
            StateKind::FilmSlope => (0.0, settings.film_slope.prior_sd),
            StateKind::ValveSun => (0.0, settings.valve_sun.prior_sd),
            StateKind::Lag { sensor } => lagged(sensors, readings, sensor, body_k),
            StateKind::Parameter { sensor, parameter } => {
                let parameter = &sensors[sensor].parameters()[parameter];
                (parameter.mean, parameter.sd)
            }
        };
        mean[state] = of_mean;
        covariance[(state, state)] = of_sd * of_sd;
    }
    spread.couple(states, covariance);
    Ok(())
}

/// Mean and range of values, if there are any.
fn mean_and_range(values: impl Iterator<Item = f64> + Clone) -> Option<(f64, f64)> {
    let [low, high] = [values.clone().reduce(f64::min)?, values.clone().reduce(f64::max)?];
    Some((values.clone().sum::<f64>() / values.count() as f64, high - low))
}

/// What a lagging sensor shows at the start: its own reading, if it has one.
fn lagged(sensors: &[Sensor], readings: &[f64], sensor: usize, body_k: f64) -> (f64, f64) {
    let pressure = sensors[sensor].quantity() == Quantity::Pressure;
    let (assumed, sd) = if pressure { (2e7, 1e7) } else { (body_k, ASSUMED_SD_K) };
    let reading = readings[sensor];
    if reading.is_finite() { (reading, if pressure { 1e5 } else { 1.0 }) } else { (assumed, sd) }
}

impl Observer {
    /// Begin from the prior at a sample, and use its readings if they lead to a state that can be.
    pub(super) fn start(&mut self, time_s: f64, readings: &[f64]) -> Result<(), EstimatorError> {
        self.reset(time_s, readings)?;
        if self.update(readings).is_ok() && self.is_possible() {
            return Ok(());
        }
        self.reset(time_s, readings)?;
        // Those of further sensors count as missing all the same.
        self.update(&[f64::NAN; 8][..readings.len().min(8)])
    }

    /// Every member as the prior has it.
    fn reset(&mut self, time_s: f64, readings: &[f64]) -> Result<(), EstimatorError> {
        // Where the estimate has to begin again, nothing says that the cylinder is settled then.
        self.begun_from.start = match self.clock.time_s {
            None if self.commissioning.settled => Start::Settled,
            None => Start::Anywhere,
            Some(_) => Start::Again,
        };
        self.begun_from.commissioning = self.commissioning;
        self.begun_from.readings.copy_from_slice(readings);
        let Self { cylinder, vessel, begun_from, mean, prior, learned_prior, .. } = self;
        let of = (cylinder.state_map(), cylinder.sensors(), cylinder.settings());
        write_prior(of, begun_from, vessel, mean, prior)?;
        if let (Some(learned), Some(to)) = (&self.learned, &mut *learned_prior) {
            to.copy_from(prior);
            learned.put_into(&cylinder.state_map().names, mean, to);
        }
        let covariance = learned_prior.as_ref().unwrap_or(prior);
        let leak = cylinder.state_map().leak;
        // One covariance, but for the leak rate, of which each member has its own.
        let of_member = |_: usize, hypothesis: &LeakHypothesis, p: &mut DMatrix<f64>| {
            p.copy_from(covariance);
            p.row_mut(leak).fill(0.0);
            p.column_mut(leak).fill(0.0);
            p[(leak, leak)] = powi(hypothesis.rate.prior_sd, 2);
        };
        let engine = cylinder.bank_engine();
        self.bank.begin(cylinder, &engine, mean, &mut self.factors, of_member)?;
        self.clock.await_reference(time_s + REFERENCE_AFTER_S);
        self.clock.pulled_until_s = time_s + SETTLE_S;
        for sensor in 0..readings.len() {
            self.cylinder.set_interval_s(sensor, f64::INFINITY);
        }
        Ok(())
    }

    /// The prior covariance that the present estimate began with: (n, n).
    pub(super) fn prior_of_the_beginning(&self) -> Result<DMatrix<f64>, EstimatorError> {
        let n = self.cylinder.state_map().count();
        let (mut mean, mut prior) = (vec![0.0; n], DMatrix::zeros(n, n));
        let of = (self.cylinder.state_map(), self.cylinder.sensors(), self.cylinder.settings());
        write_prior(of, &self.begun_from, &self.vessel, &mut mean, &mut prior)?;
        Ok(prior)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observer::cylinder::Cylinder;
    use crate::thermal::vessel::presets;
    use approx::assert_relative_eq;

    fn prior_of(settled: bool, readings: &[f64]) -> ((Vec<f64>, DMatrix<f64>), States) {
        let vessel = presets::load("nitrogen-20l").unwrap();
        let sensors: Vec<Sensor> =
            ["shoulder", "valve", "pressure"].iter().map(|name| Sensor::typical(name).unwrap()).collect();
        let settings = ObserverSettings::default();
        let cylinder = Cylinder::new(&vessel, &sensors, &settings).unwrap();
        let filled = Commissioning::filled(2e7, 288.15);
        let start = if settled { Start::Settled } else { Start::Anywhere };
        let begun_from = BegunFrom { commissioning: filled, start, readings: readings.to_vec() };
        let states = cylinder.state_map().clone();
        let (mut mean, mut p) = (vec![0.0; states.count()], DMatrix::zeros(states.count(), states.count()));
        write_prior((&states, &sensors, &settings), &begun_from, &vessel, &mut mean, &mut p).unwrap();
        ((mean, p), states)
    }

    #[test]
    fn a_settled_cylinder_has_one_temperature_that_is_known_less_well_than_its_differences() {
        let ((mean, p), states) = prior_of(true, &[280.0, 281.0, 2e7]);
        let (gas, valve) = (states.gas, states.valve.unwrap());
        assert_eq!((mean[gas], mean[valve], mean[0]), (280.5, 280.5, 280.5));
        // One kelvin together, and 0.2 K each.
        assert_relative_eq!(p[(gas, gas)], 1.04, max_relative = 1e-12);
        for other in [valve, 0, states.wall - 1] {
            let difference = p[(gas, gas)] + p[(other, other)] - 2.0 * p[(gas, other)];
            assert_relative_eq!(difference, 0.08, max_relative = 1e-12);
        }
        assert!(p.row(states.mass).iter().enumerate().all(|(j, &v)| (v != 0.0) == (j == states.mass)));
    }

    #[test]
    fn a_cylinder_that_is_not_settled_may_have_any_temperatures() {
        let ((_, p), states) = prior_of(false, &[280.0, 281.0, 2e7]);
        // Ten kelvins, and one that the thermometers are apart.
        let [wall, gas] = [0, states.gas].map(|state| p[(state, state)]);
        assert_relative_eq!(wall, 101.0, max_relative = 1e-12);
        assert_eq!((gas, p[(0, states.gas)]), (wall, 0.0));
        // Without a thermometer not even the level is known.
        let ((_, p), _) = prior_of(false, &[f64::NAN, f64::NAN, 2e7]);
        assert_eq!((p[(0, 0)], p[(0, states.gas)]), (500.0, 400.0));
    }
}

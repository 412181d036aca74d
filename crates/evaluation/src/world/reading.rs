//! What imperfect sensors read of a simulated cylinder.
//!
//! Between samples of the simulation surfaces and pressure are linear in time; the air is the signal itself. A lag is then exact: for an
//! input `u` that is linear over `dt`, `y' = u' - s + (y - u + s) exp(-dt/tau)` with `s = tau (u' - u)/dt`.
use cylwatch_estimator::log::{Channel, Log, Quantity};
use cylwatch_thermal::scenario::{OutsideFilm, Surroundings};
use cylwatch_thermal::transfer::outside::{Body, convection_w_m2_k};
use cylwatch_thermal::units::{ATMOSPHERE_PA, ZERO_CELSIUS_K};
use cylwatch_thermal::vessel::Vessel;

use super::samples::Samples;
use super::sensors::{SensorDraw, Thermometer, Transmitter};
use crate::random::{Purpose, Random};

/// Heights of the thermometers above the middle, as fractions of the vessel's.
const SHOULDER_ABOVE: f64 = 0.4;
const VALVE_ABOVE: f64 = 0.5;

/// Film by convection at which a mounting has its stated coupling, W/(m² K).
const COUPLING_FILM_W_M2_K: f64 = 10.0;
const COUPLING_EXPONENT: f64 = 0.3;
/// Temperature of its electronics at which a transmitter has no temperature error, K.
const ELECTRONICS_K: f64 = 288.15;
/// Ends of a transmitter's current loop, of its range (NAMUR NE 43).
const LOOP: (f64, f64) = (-0.0125, 1.03125);

/// A simulated cylinder that sensors read.
pub(super) struct Scene<'a> {
    pub vessel: &'a Vessel,
    pub surroundings: &'a Surroundings,
    pub samples: &'a Samples,
    pub seed: u64,
    /// Streams of the noise of shoulder, valve and pressure.
    pub noise: [Purpose; 3],
}

impl Scene<'_> {
    /// Readings of shoulder, valve and pressure at times of the simulation, s, in increasing order, with their stamps, s, and the
    /// pressures at those times, Pa.
    pub(super) fn read(
        &self,
        sensors: &SensorDraw,
        times_s: &[f64],
        stamp_s: Vec<f64>,
        pressure_pa: &[f64],
    ) -> Log {
        let (samples, geometry) = (self.samples, &self.vessel.geometry);
        let diameter_m = geometry.inner_diameter_m + 2.0 * geometry.thickness_m();
        let cylinder =
            Body { orientation: geometry.orientation, diameter_m, height_m: geometry.outer_height_m() };
        let valve_m = self.vessel.valve.as_ref().map_or(diameter_m, |valve| valve.diameter_m);
        let valve = Body { diameter_m: valve_m, height_m: valve_m, ..cylinder };
        let [shoulder_noise, valve_noise, pressure_noise] = self.noise;
        let place = |body, surface_k, above_middle, noise| Place {
            surroundings: self.surroundings,
            body,
            samples,
            surface_k,
            above_middle,
            noise,
        };
        let shoulder = place(cylinder, &samples.shoulder_k, SHOULDER_ABOVE, shoulder_noise);
        let valve = place(valve, &samples.valve_k, VALVE_ABOVE, valve_noise);
        let electronics_k: Vec<f64> = times_s.iter().map(|&t| samples.at(&samples.valve_k, t)).collect();
        let noise = Random::new(self.seed, pressure_noise);
        let columns = [
            shoulder.read(&sensors.shoulder, times_s, self.seed),
            valve.read(&sensors.valve, times_s, self.seed),
            read_pressure(&sensors.pressure, pressure_pa, &electronics_k, noise),
        ];
        let channel = |name: &str, quantity| Channel { name: name.into(), quantity };
        Log {
            channels: vec![
                channel("shoulder", Quantity::Temperature),
                channel("valve", Quantity::Temperature),
                channel("pressure", Quantity::Pressure),
            ],
            time_s: stamp_s,
            values: (0..times_s.len())
                .flat_map(|row| columns.iter().map(move |column| column[row]))
                .collect(),
        }
    }
}

/// Where a thermometer sits and what surrounds it.
pub(super) struct Place<'a> {
    pub surroundings: &'a Surroundings,
    pub body: Body,
    /// Samples of the simulation, and of the surface in it, K.
    pub samples: &'a Samples,
    pub surface_k: &'a [f64],
    /// Height above the middle as a fraction of the vessel's.
    pub above_middle: f64,
    pub noise: Purpose,
}

impl Place<'_> {
    /// Static reading at a time of the simulation, K.
    fn static_k(&self, sensor: &Thermometer, t_s: f64) -> f64 {
        let around = self.surroundings;
        let surface_k = self.samples.at(self.surface_k, t_s);
        let difference_k = around.axial.air_difference_k.as_ref().map_or(0.0, |series| series.at(t_s));
        let air_k = around.air_k.at(t_s) + self.above_middle * difference_k;
        let film = match &around.film {
            OutsideFilm::Coefficient { film_w_m2_k } => film_w_m2_k.at(t_s),
            OutsideFilm::Convection { wind_m_s, multiplier } => {
                multiplier * convection_w_m2_k(&self.body, surface_k, air_k, wind_m_s.at(t_s))
            }
        };
        let film = film * (1.0 + around.axial.film_slope * self.above_middle);
        let coupling = (sensor.air_coupling * (film / COUPLING_FILM_W_M2_K).powf(COUPLING_EXPONENT)).min(1.0);
        surface_k + coupling * (air_k - surface_k) + sensor.offset_k
    }

    /// Readings behind the lag, without noise, K.
    fn lagged_k(&self, sensor: &Thermometer, times_s: &[f64]) -> Vec<f64> {
        if sensor.lag_s <= 0.0 {
            return times_s.iter().map(|&t| self.static_k(sensor, t)).collect();
        }
        let mut knots: Vec<f64> = self.samples.times_s().chain(self.surroundings.air_k.edges_s()).collect();
        let until_s = times_s.last().copied().unwrap_or(0.0);
        knots.retain(|&t| t >= 0.0 && t <= until_s);
        knots.extend_from_slice(times_s);
        knots.sort_by(f64::total_cmp);
        knots.dedup();
        let mut input = self.static_k(sensor, knots[0]);
        let (mut before_s, mut lagged) = (knots[0], input);
        let mut wanted = times_s.iter().peekable();
        let mut readings = Vec::with_capacity(times_s.len());
        for t in knots {
            let next = self.static_k(sensor, t);
            if t > before_s {
                let behind = sensor.lag_s * (next - input) / (t - before_s);
                lagged = next - behind + (lagged - input + behind) * (-(t - before_s) / sensor.lag_s).exp();
            }
            (before_s, input) = (t, next);
            while wanted.next_if(|&&at| at == t).is_some() {
                readings.push(lagged);
            }
        }
        readings
    }

    /// Readings at times of the simulation, s, in increasing order.
    pub(super) fn read(&self, sensor: &Thermometer, times_s: &[f64], seed: u64) -> Vec<f64> {
        let mut noise = Random::new(seed, self.noise);
        let read = |value: f64| {
            let degc = value - ZERO_CELSIUS_K + sensor.noise_k * noise.normal();
            ZERO_CELSIUS_K + stepped(degc, sensor.resolution_k)
        };
        self.lagged_k(sensor, times_s).into_iter().map(read).collect()
    }
}

/// Readings of a transmitter, from pressures, Pa, and the temperatures of its electronics, K.
pub(super) fn read_pressure(
    sensor: &Transmitter,
    pressure_pa: &[f64],
    electronics_k: &[f64],
    mut noise: Random,
) -> Vec<f64> {
    let zero_pa = if sensor.is_gauge { ATMOSPHERE_PA } else { 0.0 };
    let (low_pa, high_pa) = (LOOP.0 * sensor.full_scale_pa, LOOP.1 * sensor.full_scale_pa);
    let read = |(&pressure_pa, &electronics_k): (&f64, &f64)| {
        let error_pa = sensor.offset_pa + sensor.coefficient_pa_k * (electronics_k - ELECTRONICS_K);
        let value = pressure_pa - zero_pa + error_pa + sensor.noise_pa * noise.normal();
        stepped(value, sensor.resolution_pa).clamp(low_pa, high_pa)
    };
    pressure_pa.iter().zip(electronics_k).map(read).collect()
}

fn stepped(value: f64, step: f64) -> f64 {
    if step > 0.0 { step * (value / step).round() } else { value }
}

//! From a simulated trajectory to samples and what drawn sensors read of them.
use cylwatch_thermal::scenario::{OutsideFilm, Scenario};
use cylwatch_thermal::trajectory::Trajectory;

use super::{Course, Cylinder, TemperatureSensor, Truth, TruthLeak};
use crate::EvaluationError;
use crate::estimator::log::{Channel, Log};
use crate::estimator::sensor::{Exposure, Sensor};
use crate::random::{Purpose, Random};

/// Film by convection at which a mounting has its stated coupling, W/(m² K).
const COUPLING_FILM_W_M2_K: f64 = 10.0;
const COUPLING_EXPONENT: f64 = 0.3;
const NOISE_K: f64 = 0.05;
const NOISE_PA: f64 = 1000.0;

impl Truth {
    /// Chosen samples of a trajectory, read by the cylinder's sensors.
    pub fn sample(
        course: &Course,
        seed: u64,
        leak: Option<TruthLeak>,
        cylinder: &Cylinder,
        trajectory: &Trajectory,
        samples: &[usize],
    ) -> Result<Self, EvaluationError> {
        let pick = |values: &[f64]| samples.iter().map(|&i| values[i]).collect::<Vec<f64>>();
        let place = |name: &'static str| {
            let values = trajectory.surface_k(name).ok_or(EvaluationError::NoSuchPlace { place: name })?;
            Ok::<_, EvaluationError>(pick(&values))
        };
        let mut truth = Self {
            course: course.clone(),
            seed,
            parameters: cylinder.parameters,
            sensors: cylinder.sensors,
            leak,
            time_s: pick(&trajectory.time_s),
            gas_mean_k: pick(&trajectory.gas_mean_k),
            mass_kg: pick(&trajectory.mass_kg),
            pressure_pa: pick(&trajectory.pressure_pa),
            ambient_k: pick(&trajectory.ambient_k),
            wall_mean_k: pick(&trajectory.wall_mean_k),
            shoulder_k: place("shoulder")?,
            valve_k: place("valve")?,
            middle_k: place("middle")?,
            bottom_k: place("bottom")?,
            log: Log::default(),
        };
        truth.log = truth.readings(&trajectory.scenario)?;
        Ok(truth)
    }

    fn readings(&self, scenario: &Scenario) -> Result<Log, EvaluationError> {
        let s = &self.sensors;
        let surface = |name, place: &Place<'_>| self.read_surface(name, place, scenario);
        let columns = [
            surface("shoulder", &Place::new(&s.shoulder, &self.shoulder_k, 0.4, Purpose::ShoulderNoise))?,
            surface("valve", &Place::new(&s.valve, &self.valve_k, 0.5, Purpose::ValveNoise))?,
            surface("wall_middle", &Place::new(&s.middle, &self.middle_k, 0.0, Purpose::MiddleNoise))?,
            surface("wall_bottom", &Place::new(&s.bottom, &self.bottom_k, -0.5, Purpose::BottomNoise))?,
            self.read_pressure("pressure")?,
        ];
        let values = (0..self.time_s.len())
            .flat_map(|row| columns.iter().map(move |(_, values)| values[row]))
            .collect();
        let channels = columns.iter().map(|(channel, _)| channel.clone()).collect();
        Ok(Log { channels, time_s: self.time_s.clone(), values })
    }

    fn read_surface(
        &self,
        name: &str,
        place: &Place<'_>,
        scenario: &Scenario,
    ) -> Result<Column, EvaluationError> {
        let sensor = Sensor::typical(name)?;
        let mut noise = Random::new(self.seed, place.noise);
        let read = |(&t_s, &body_k): (&f64, &f64)| {
            let (air_k, film_w_m2_k) = surroundings(scenario, place.above_middle, t_s);
            let coupling =
                place.sensor.air_coupling * (film_w_m2_k / COUPLING_FILM_W_M2_K).powf(COUPLING_EXPONENT);
            let exposure = Exposure { body_k, air_k, ..Exposure::default() };
            sensor.predict(&exposure, &[place.sensor.offset_k, coupling]).value + NOISE_K * noise.normal()
        };
        let values = self.time_s.iter().zip(place.body_k).map(read).collect();
        Ok((Channel { name: name.into(), quantity: sensor.quantity() }, values))
    }

    fn read_pressure(&self, name: &str) -> Result<Column, EvaluationError> {
        let sensor = Sensor::typical(name)?;
        let mut noise = Random::new(self.seed, Purpose::PressureNoise);
        let parameters = [self.sensors.pressure.offset_pa, self.sensors.pressure.coefficient_pa_k, 0.0];
        let read = |(&pressure_pa, &electronics_k): (&f64, &f64)| {
            let exposure = Exposure { pressure_pa, electronics_k, ..Exposure::default() };
            sensor.predict(&exposure, &parameters).value + NOISE_PA * noise.normal()
        };
        let values = self.pressure_pa.iter().zip(&self.valve_k).map(read).collect();
        Ok((Channel { name: name.into(), quantity: sensor.quantity() }, values))
    }
}

/// A channel and its readings.
type Column = (Channel, Vec<f64>);

/// Where a surface sensor sits.
struct Place<'a> {
    sensor: &'a TemperatureSensor,
    /// Temperature of the surface at every sample, K.
    body_k: &'a [f64],
    /// Height above the middle as a fraction of the vessel's.
    above_middle: f64,
    noise: Purpose,
}

impl<'a> Place<'a> {
    fn new(sensor: &'a TemperatureSensor, body_k: &'a [f64], above_middle: f64, noise: Purpose) -> Self {
        Self { sensor, body_k, above_middle, noise }
    }
}

/// Air, K, and film by convection, W/(m² K), at a height as a fraction above the middle.
fn surroundings(scenario: &Scenario, above_middle: f64, t_s: f64) -> (f64, f64) {
    let around = &scenario.surroundings;
    let difference_k = around.axial.air_difference_k.as_ref().map_or(0.0, |series| series.at(t_s));
    let film_w_m2_k = match &around.film {
        OutsideFilm::Coefficient { film_w_m2_k } => film_w_m2_k.at(t_s),
        OutsideFilm::Convection { .. } => COUPLING_FILM_W_M2_K,
    };
    let film = film_w_m2_k * (1.0 + around.axial.film_slope * above_middle);
    (around.air_k.at(t_s) + above_middle * difference_k, film)
}

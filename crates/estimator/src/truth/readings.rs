//! From a simulated trajectory to samples and what drawn sensors read of them.
use cylwatch_thermal::scenario::{OutsideFilm, Scenario};
use cylwatch_thermal::trajectory::Trajectory;

use super::random::{Purpose, Random};
use super::{Course, Cylinder, TemperatureSensor, Truth, TruthLeak};
use crate::EstimatorError;
use crate::log::{Channel, Log, Quantity};

/// Film by convection at which a mounting has its stated coupling, W/(m² K).
const FILM_MEAN_W_M2_K: f64 = 10.0;
const COUPLING_EXPONENT: f64 = 0.3;
const NOISE_K: f64 = 0.05;
const NOISE_PA: f64 = 1000.0;
const COEFFICIENT_REFERENCE_K: f64 = 288.15;

impl Truth {
    /// Chosen samples of a trajectory, read by the cylinder's sensors.
    pub(super) fn sample(
        course: &Course,
        seed: u64,
        leak: Option<TruthLeak>,
        cylinder: &Cylinder,
        trajectory: &Trajectory,
        samples: &[usize],
    ) -> Result<Self, EstimatorError> {
        let pick = |values: &[f64]| samples.iter().map(|&i| values[i]).collect::<Vec<f64>>();
        let place = |name: &'static str| {
            let values = trajectory.surface_k(name).ok_or(EstimatorError::NoSuchPlace { place: name })?;
            Ok::<_, EstimatorError>(pick(&values))
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
        truth.log = truth.readings(&trajectory.scenario);
        Ok(truth)
    }

    fn readings(&self, scenario: &Scenario) -> Log {
        let surface = |sensor: &TemperatureSensor, at_k: &[f64], above_middle: f64, purpose| {
            self.read_surface(sensor, at_k, &|t| exposure(scenario, above_middle, t), purpose)
        };
        let s = &self.sensors;
        let columns = [
            ("shoulder", surface(&s.shoulder, &self.shoulder_k, 0.4, Purpose::ShoulderNoise)),
            ("valve", surface(&s.valve, &self.valve_k, 0.5, Purpose::ValveNoise)),
            ("wall_middle", surface(&s.middle, &self.middle_k, 0.0, Purpose::MiddleNoise)),
            ("wall_bottom", surface(&s.bottom, &self.bottom_k, -0.5, Purpose::BottomNoise)),
            ("pressure", self.read_pressure()),
        ];
        let quantity = |name: &str| match name {
            "pressure" => Quantity::Pressure,
            _ => Quantity::Temperature,
        };
        Log {
            channels: columns
                .iter()
                .map(|(name, _)| Channel { name: (*name).into(), quantity: quantity(name) })
                .collect(),
            time_s: self.time_s.clone(),
            values: (0..self.time_s.len())
                .flat_map(|row| columns.iter().map(move |(_, values)| values[row]))
                .collect(),
        }
    }

    fn read_surface(
        &self,
        sensor: &TemperatureSensor,
        at_k: &[f64],
        exposure: &dyn Fn(f64) -> (f64, f64),
        purpose: Purpose,
    ) -> Vec<f64> {
        let mut noise = Random::new(self.seed, purpose);
        let read = |(&t_s, &surface_k): (&f64, &f64)| {
            let (air_k, film_w_m2_k) = exposure(t_s);
            let coupling = sensor.air_coupling * (film_w_m2_k / FILM_MEAN_W_M2_K).powf(COUPLING_EXPONENT);
            surface_k + coupling * (air_k - surface_k) + sensor.offset_k + NOISE_K * noise.normal()
        };
        self.time_s.iter().zip(at_k).map(read).collect()
    }

    fn read_pressure(&self) -> Vec<f64> {
        let mut noise = Random::new(self.seed, Purpose::PressureNoise);
        let sensor = &self.sensors.pressure;
        let read = |(&pressure_pa, &valve_k): (&f64, &f64)| {
            let drift = sensor.coefficient_pa_k * (valve_k - COEFFICIENT_REFERENCE_K);
            pressure_pa + sensor.offset_pa + drift + NOISE_PA * noise.normal()
        };
        self.pressure_pa.iter().zip(&self.valve_k).map(read).collect()
    }
}

/// Air, K, and film by convection, W/(m² K), at a height as a fraction above the middle.
fn exposure(scenario: &Scenario, above_middle: f64, t_s: f64) -> (f64, f64) {
    let around = &scenario.surroundings;
    let difference_k = around.axial.air_difference_k.as_ref().map_or(0.0, |series| series.at(t_s));
    let film_w_m2_k = match &around.film {
        OutsideFilm::Coefficient { film_w_m2_k } => film_w_m2_k.at(t_s),
        OutsideFilm::Convection { .. } => FILM_MEAN_W_M2_K,
    };
    let film = film_w_m2_k * (1.0 + around.axial.film_slope * above_middle);
    (around.air_k.at(t_s) + above_middle * difference_k, film)
}

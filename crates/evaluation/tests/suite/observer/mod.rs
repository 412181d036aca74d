//! The cylinder's observer on simulated cylinders that are not the observer's model.
mod bad_input;
mod engines;
mod events;
mod fast_leak;
mod saved;
mod smoothing;

use std::sync::OnceLock;

use cylwatch_estimator::observer::{Commissioning, Engine, Estimate, Observer, ObserverSettings};
use cylwatch_estimator::sensor::Sensor;
use cylwatch_estimator::thermal::vessel::{Vessel, presets};
use cylwatch_evaluation::thermal::trajectory::Trajectory;
use cylwatch_evaluation::world::chamber::{Chamber, ChamberRequest};

/// Sensors of the observer, in the order of their readings.
const SENSORS: [&str; 3] = ["shoulder", "valve", "pressure"];
const SHOULDER: usize = 0;
const VALVE: usize = 1;
const PRESSURE: usize = 2;
/// Cylinder of [`Case::shock`].
const SHOCK_SEED: u64 = 5;
const FILL_PA: f64 = 2e7;
const FILL_K: f64 = 288.15;

/// A drawn cylinder with its readings of [`SENSORS`].
#[derive(Clone)]
struct Case {
    truth: Trajectory,
    rows: Vec<(f64, [f64; 3])>,
}

impl Case {
    fn new(chamber: Chamber, seed: u64, sample_s: f64) -> Self {
        let request = ChamberRequest::new(chamber, seed, sample_s);
        let run = ChamberRequest { wall_cells: 3, gas_cells: 4, ..request }.run().unwrap();
        let rows = run.log.rows().map(|(t, row)| (t, [row[SHOULDER], row[VALVE], row[PRESSURE]])).collect();
        Self { truth: run.trajectory, rows }
    }

    /// The chamber from 10 to 60 °C in five hours.
    fn ramp() -> &'static Self {
        static CASE: OnceLock<Case> = OnceLock::new();
        CASE.get_or_init(|| Self::new(Chamber::SCENARIOS[2], 3, 60.0))
    }

    /// The chamber from 21 to -25 °C at once.
    fn shock() -> &'static Self {
        static CASE: OnceLock<Case> = OnceLock::new();
        CASE.get_or_init(|| Self::new(Chamber::SCENARIOS[0], SHOCK_SEED, 20.0))
    }

    /// The first hours of it.
    fn until(&self, hours: f64) -> Self {
        let mut case = self.clone();
        case.rows.retain(|(t, _)| *t <= 3600.0 * hours);
        case
    }

    fn run(&self, observer: &mut Observer) -> Vec<Estimate> {
        self.rows.iter().map(|(t, readings)| observer.step(*t, readings).unwrap()).collect()
    }

    /// Root mean square of the mean gas temperature's error, K.
    fn gas_rms_k(&self, estimates: &[Estimate]) -> f64 {
        let square = |(e, truth): (&Estimate, &f64)| (e.gas_mean_k - truth).powi(2);
        (estimates.iter().zip(&self.truth.gas_mean_k).map(square).sum::<f64>() / estimates.len() as f64)
            .sqrt()
    }
}

fn vessel() -> Vessel {
    presets::load("nitrogen-20l").unwrap()
}

fn observer_with(sensors: &[&str], settings: &ObserverSettings) -> Observer {
    let sensors: Vec<Sensor> = sensors.iter().map(|name| Sensor::typical(name).unwrap()).collect();
    Observer::new(&vessel(), &sensors, &Commissioning::filled(FILL_PA, FILL_K), settings).unwrap()
}

fn observer(engine: Engine) -> Observer {
    observer_with(&SENSORS, &ObserverSettings { engine, ..ObserverSettings::default() })
}

/// Every number is one; the leak rate may be missing, with its standard deviation.
fn is_sound(estimate: &Estimate) -> bool {
    let Estimate { gas_mean_k, gas_mean_sd_k, mass_kg, mass_sd_kg, leak_kg_s, leak_sd_kg_s, .. } = *estimate;
    let leak = leak_kg_s.is_finite() && leak_sd_kg_s >= 0.0 || leak_kg_s.is_nan() && leak_sd_kg_s.is_nan();
    [gas_mean_k, mass_kg, estimate.pressure_expected_pa, estimate.p15_pa].iter().all(|v| v.is_finite())
        && gas_mean_sd_k > 0.0
        && mass_sd_kg > 0.0
        && gas_mean_sd_k.is_finite()
        && mass_sd_kg.is_finite()
        && leak
}

//! A leak that begins at once is followed within hours, by a cylinder that has learnt nothing yet.
use super::*;
use cylwatch_estimator::sensor::Exposure;
use cylwatch_estimator::thermal::scenario;
use cylwatch_estimator::thermal::simulate::{SimulationSettings, simulate};
use rand::SeedableRng;
use rand_chacha::ChaCha12Rng;
use rand_distr::{Distribution, StandardNormal};

/// Leak of the preset, kg/s: 60 g/h from 60 minutes to the end after four hours.
const LEAK_KG_S: f64 = 60e-3 / 3600.0;

/// Estimates in the preset `leak-after-tunnel`, with its couplings and noise.
fn estimates(seed: u64) -> Vec<Estimate> {
    let scenario = scenario::presets::load("leak-after-tunnel").unwrap();
    let trajectory = simulate(&vessel(), &scenario, &SimulationSettings::default(), &mut |_| {}).unwrap();
    let sensors: Vec<Sensor> = SENSORS.iter().map(|name| Sensor::typical(name).unwrap()).collect();
    let mut observer = observer(Engine::Extended);
    let mut rng = ChaCha12Rng::seed_from_u64(seed);
    let surfaces = ["shoulder", "valve"].map(|place| trajectory.surface_k(place).unwrap());
    let mut estimates = Vec::new();
    for (k, &time_s) in trajectory.time_s.iter().enumerate() {
        let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
        let mut readings = [0.0; 3];
        for (sensor, body) in surfaces.iter().enumerate() {
            let exposure =
                Exposure { body_k: body[k], air_k: trajectory.ambient_k[k], ..Exposure::default() };
            readings[sensor] = sensors[sensor].predict(&exposure, &[0.0, 0.15]).value + 0.05 * normal();
        }
        readings[PRESSURE] = trajectory.pressure_pa[k] + 1e3 * normal();
        estimates.push(observer.step(time_s, &readings).unwrap());
    }
    estimates
}

#[test]
fn three_hours_into_a_leak_after_a_tunnel_its_rate_is_right_within_a_tenth() {
    for seed in [1, 2] {
        let last = *estimates(seed).last().unwrap();
        let rate_g_h = 3.6e6 * last.leak_kg_s;
        assert_eq!(last.time_s, 4.0 * 3600.0);
        assert!((last.leak_kg_s / LEAK_KG_S - 1.0).abs() < 0.1, "seed {seed}: {rate_g_h} g/h");
        assert!(last.leak_sd_kg_s < 0.1 * LEAK_KG_S, "seed {seed}");
    }
}

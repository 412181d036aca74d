//! No filter allocates in a step, from the first one on.
use cylwatch_allocations::allocations;
use cylwatch_estimator::filter::{ExtendedKalman, UdFactors};
use cylwatch_estimator::observer::{Commissioning, Engine, Observer, ObserverSettings};
use cylwatch_estimator::sensor::Sensor;
use cylwatch_estimator::thermal::vessel::presets;
use nalgebra::DMatrix;

use crate::copying_model::CopyingModel;

const STATES: usize = 12;
const OUTPUTS: usize = 3;

/// Eight of twelve states move, driven by ten noise sources.
fn model() -> CopyingModel {
    CopyingModel::new(STATES, 8, 10, OUTPUTS)
}

/// Complete and incomplete samples.
const SAMPLES: [[f64; OUTPUTS]; 5] = [
    [0.1, 0.2, -0.1],
    [f64::NAN, 0.3, 0.0],
    [f64::NAN, f64::NAN, f64::NAN],
    [0.0, 1e6, 0.1],
    [0.2, 0.0, f64::NAN],
];

#[test]
fn no_step_of_a_kalman_filter_allocates() {
    let prior = UdFactors::from_covariance(&DMatrix::identity(STATES, STATES)).unwrap();
    let mut filter = ExtendedKalman::try_new(model(), &[0.0; STATES], prior).unwrap();
    let counted = allocations(|| {
        for (k, z) in SAMPLES.iter().cycle().take(100).enumerate() {
            let dt_s = if k % 17 == 16 { 0.5 } else { 1.0 };
            assert!(filter.step(dt_s, z).is_ok());
        }
    });
    assert_eq!(counted, 0);
}

#[test]
fn no_step_of_the_observer_allocates_with_any_engine_but_the_moving_horizon() {
    for engine in [Engine::Extended, Engine::Unscented, Engine::Stationary] {
        let sensors = ["shoulder", "valve", "pressure"].map(|name| Sensor::typical(name).unwrap());
        let settings = ObserverSettings { engine, ..ObserverSettings::default() };
        let vessel = presets::load("nitrogen-20l").unwrap();
        let commissioning = Commissioning::filled(2e7, 288.15);
        let mut observer = Observer::new(&vessel, &sensors, &commissioning, &settings).unwrap();
        let row = |k: u32| {
            let warm = 5.0 * (f64::from(k) / 30.0).sin();
            let mut z = [288.15 + warm, 288.15 + warm, 2e7 + 0.7e5 * warm];
            match k % 13 {
                5 => z[1] = f64::NAN,
                8 => z = [f64::NAN; 3],
                11 => z[0] += 100.0,
                _ => {}
            }
            z
        };
        for k in 0..200 {
            observer.step(60.0 * f64::from(k), &row(k)).unwrap();
        }
        let begin = observer.snapshot();
        let mut sought = 0;
        for counts in [false, true] {
            observer.restore(&begin);
            for k in 200..400 {
                match k {
                    300 => observer.begin_exchange(),
                    303 => observer.end_exchange(),
                    _ => {}
                }
                let (t, z) = (60.0 * f64::from(k), row(k));
                let counted = allocations(|| assert!(observer.step(t, &z).unwrap().mass_kg > 0.0));
                sought += u32::from(counts && counted > 0);
            }
        }
        // A member seeks its stationary gain anew after an hour of complete samples at the earliest, which allocates.
        let may = if engine == Engine::Stationary { 4 * settings.bank.len() as u32 } else { 0 };
        assert!(sought <= may, "{engine:?}: {sought} steps allocate");
        assert_eq!(observer.restarts(), 0);
    }
}

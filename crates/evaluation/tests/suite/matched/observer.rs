//! The observer against a filter put together by hand from its state space.
use cylwatch_estimator::filter::{ExtendedKalman, StateSpace, UdFactors};
use cylwatch_estimator::observer::cylinder::Cylinder;
use cylwatch_estimator::observer::{Commissioning, LeakHypothesis, ModelError, Observer, ObserverSettings};
use cylwatch_estimator::sensor::Sensor;
use cylwatch_estimator::thermal::vessel::presets;
use nalgebra::{DMatrix, DVector};
use rand::SeedableRng;
use rand_chacha::ChaCha12Rng;

use cylwatch_evaluation::matched::{Draws, OwnWorld, leak_member, mass_member, settings};
use cylwatch_evaluation::world::chamber::Chamber;

/// Intervals of irregular samples, s, some of them longer than the longest step.
const INTERVALS_S: [f64; 5] = [60.0, 20.0, 45.0, 7.5, 300.0];

fn observed(member: LeakHypothesis) -> ObserverSettings {
    ObserverSettings {
        longest_step_s: 20.0,
        gate_sd: 1e6,
        air_step: None,
        model_error: ModelError {
            correlation_s: 60.0,
            surface_k: 0.15,
            ..ObserverSettings::default().model_error
        },
        ..settings(member)
    }
}

/// Rows of time, s, and readings of a drawn truth; some readings are missing.
fn rows(settings: &ObserverSettings) -> Vec<(f64, Vec<f64>)> {
    let chamber = Chamber { end_degc: 21.0, ..Chamber::SCENARIOS[0] };
    let mut world = OwnWorld::new(chamber, settings, 0.3).unwrap();
    let mut draws = Draws(ChaCha12Rng::seed_from_u64(11));
    let (mut x, mut time_s) = (draws.state(&world), 0.0);
    (0..150)
        .map(|k| {
            let mut z = draws.readings(&mut world, &x).unwrap();
            if k > 0 {
                (0..z.len()).filter(|j| (k + j) % 7 == 0).for_each(|j| z[j] = f64::NAN);
            }
            let row = (time_s, z);
            let dt_s = INTERVALS_S[k % INTERVALS_S.len()];
            draws.advance(&mut world, &mut x, dt_s).unwrap();
            time_s += dt_s;
            row
        })
        .collect()
}

#[test]
fn every_member_of_the_observer_is_an_extended_kalman_filter_on_its_state_space() {
    let vessel = presets::load("nitrogen-20l").unwrap();
    let sensors: Vec<Sensor> =
        ["shoulder", "valve", "pressure"].iter().map(|name| Sensor::typical(name).unwrap()).collect();
    for member in [mass_member(), leak_member()] {
        // One member at a time: the surface solver starts from its last solution and stops within 1 uK, so that members that
        // share a cylinder see each other at 1e-8.
        let settings = observed(member);
        let rows = rows(&settings);
        let mut observer =
            Observer::new(&vessel, &sensors, &Commissioning::filled(2e7, 288.15), &settings).unwrap();
        observer.step(rows[0].0, &rows[0].1).unwrap();
        let cylinder = Cylinder::new(&vessel, &sensors, &settings).unwrap();
        let (x, p) = observer.state(0).unwrap();
        let factors = UdFactors::from_covariance(&p).unwrap();
        let mut filter = ExtendedKalman::try_new(cylinder, x.as_slice(), factors).unwrap();
        let (mut last_s, mut heard_s) = (rows[0].0, vec![rows[0].0; sensors.len()]);
        for (time_s, z) in &rows[1..] {
            observer.step(*time_s, z).unwrap();
            filter.step(time_s - last_s, &vec![f64::NAN; sensors.len()]).unwrap();
            for sensor in 0..sensors.len() {
                // One output after the other, each linearised where the one before has led.
                filter.model_mut().set_interval_s(sensor, time_s - heard_s[sensor]);
                let mut one = vec![f64::NAN; sensors.len()];
                one[sensor] = z[sensor];
                filter.step(0.0, &one).unwrap();
                if z[sensor].is_finite() {
                    heard_s[sensor] = *time_s;
                }
            }
            last_s = *time_s;
            let (x, p) = observer.state(0).unwrap();
            let state = state_difference(filter.state(), &DVector::from_column_slice(x.as_slice()), &p);
            let covariance =
                covariance_difference(&known_as_ones(filter.factors().covariance()), &known_as_ones(p));
            assert!(state < 1e-9 && covariance < 1e-9, "{time_s} s: {state:e} {covariance:e}");
        }
        assert_eq!(filter.model().states(), x.len());
    }
}

/// Largest difference of two covariances, relative to the standard deviations of the second one.
fn covariance_difference(a: &DMatrix<f64>, b: &DMatrix<f64>) -> f64 {
    let sd = b.diagonal().map(|v| v.sqrt().max(1e-100));
    (a - b).map_with_location(|i, j, e| (e / (sd[i] * sd[j])).abs()).max()
}

/// Largest difference of two states, relative to the larger of their size and their standard deviation.
fn state_difference(a: &[f64], b: &DVector<f64>, p: &DMatrix<f64>) -> f64 {
    let scale = |i: usize| p[(i, i)].sqrt().max(b[i].abs()).max(1e-100);
    (0..b.len()).map(|i| ((a[i] - b[i]) / scale(i)).abs()).fold(0.0, f64::max)
}

/// Rows and columns of states without variance replaced by those of the identity, so that they can be compared.
fn known_as_ones(mut p: DMatrix<f64>) -> DMatrix<f64> {
    for i in 0..p.nrows() {
        if p[(i, i)] == 0.0 {
            p[(i, i)] = 1.0;
        }
    }
    p
}

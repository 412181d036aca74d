//! Cost of a sample, time and measurement update, of every engine of a bank on two plants; cost of a steady state.
//!
//! The plants are the cylinder with shoulder, valve and pressure sensors at rest, and the water tank of the example `second_plant`.
//!
//! `cargo bench -p cylwatch-benches --bench filter`
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use cylwatch_estimator::filter::horizon::{Constraint, HorizonSettings};
use cylwatch_estimator::filter::{Bank, BankEngine, Plant, Workspace, steady_state};
use cylwatch_estimator::observer::cylinder::Cylinder;
use cylwatch_estimator::observer::{Commissioning, Observer, ObserverSettings};
use cylwatch_estimator::sensor::Sensor;
use cylwatch_estimator::thermal::vessel::presets;
use nalgebra::{DMatrix, DVector};

#[allow(dead_code, reason = "the example has a main function and ensembles of its own")]
#[path = "../crates/estimator/examples/second_plant.rs"]
mod second_plant;

use second_plant::{Tank, bank, truth};

/// Samples before the clock runs: a stationary gain needs an hour and its convergence.
const BEFORE: usize = 600;
/// Interval of the samples, s.
const INTERVAL_S: f64 = 60.0;
/// Samples in a moving horizon, and its iterations as the observer has them.
const WINDOW: usize = 20;
const ITERATIONS: usize = 2;

/// One sample after the other of endless readings.
fn bench<P: Plant>(c: &mut Criterion, name: &str, plant: &P, mut bank: Bank<P>, readings: &[Vec<f64>]) {
    let (mut plant, mut work) = (plant.clone(), Workspace::new(plant));
    let mut readings = readings.iter().cycle();
    let mut sample = || {
        let z = readings.next().expect("endless");
        bank.predict(&mut plant, &mut work, INTERVAL_S).expect("a possible state");
        bank.update(&mut plant, &mut work, z).expect("a possible reading");
    };
    (0..BEFORE).for_each(|_| sample());
    c.benchmark_group("bank").sample_size(20).bench_function(name, |b| b.iter(&mut sample));
}

/// Every engine with its name; the constraint holds one state from below.
fn engines(leak: usize) -> [(&'static str, BankEngine); 4] {
    let settings =
        HorizonSettings { samples: WINDOW, iterations_max: ITERATIONS, ..HorizonSettings::default() };
    [
        ("extended", BankEngine::Extended),
        ("unscented", BankEngine::Unscented),
        ("stationary", BankEngine::Stationary),
        ("moving horizon of 20", BankEngine::MovingHorizon(settings, vec![Constraint::at_least(leak, 0.0)])),
    ]
}

fn tank(c: &mut Criterion) {
    let readings: Vec<Vec<f64>> = truth(1, 1.0).iter().map(|(_, z)| z.to_vec()).collect();
    for (name, engine) in engines(3) {
        let mut tank = Tank::default();
        let bank = bank(&mut tank, &engine);
        bench(c, &format!("tank, two members, {name}"), &tank, bank, &readings);
    }
}

fn cylinder(c: &mut Criterion) {
    let sensors =
        ["shoulder", "valve", "pressure"].map(|name| Sensor::typical(name).expect("typical sensor"));
    let vessel = presets::load("nitrogen-20l").expect("built-in vessel");
    let settings = ObserverSettings::default();
    let filled = Commissioning::filled(2e7, 288.15);
    let mut observer = Observer::new(&vessel, &sensors, &filled, &settings).expect("sound settings");
    let row = |k: u32| {
        let warm_k = 3.0 * (f64::from(k) / 100.0).sin();
        vec![288.15 + warm_k, 288.15 + warm_k, 2e7 + 0.7e5 * warm_k + f64::from(k % 7)]
    };
    let readings: Vec<Vec<f64>> = (0..1440).map(row).collect();
    observer.step(0.0, &readings[0]).expect("the first row");
    let (mean, covariance) = observer.state(0).expect("one row");
    let leak = observer.cylinder().state_map().leak;
    for (count, hypotheses) in [("one member", &settings.bank[..1]), ("four members", &settings.bank[..4])] {
        for (name, engine) in engines(leak) {
            let mut cylinder = Cylinder::new(&vessel, &sensors, &settings).expect("sound settings");
            (0..sensors.len()).for_each(|sensor| cylinder.set_interval_s(sensor, INTERVAL_S));
            let members: Vec<_> =
                hypotheses.iter().map(|hypothesis| (*hypothesis, covariance.clone())).collect();
            let bank = Bank::new(&mut cylinder, &engine, mean.as_slice(), &members).expect("a covariance");
            bench(c, &format!("cylinder, {count}, {name}"), &cylinder, bank, &readings);
        }
    }
}

fn riccati(c: &mut Criterion) {
    let mut group = c.benchmark_group("steady state");
    for n in [4, 8, 13, 20] {
        let f = DMatrix::from_fn(n, n, |i, j| if i == j { 0.99 } else { 0.05 / (1 + i + 2 * j) as f64 });
        let h = DMatrix::from_fn(3, n, |i, j| if j == i { 1.0 } else { 0.1 });
        let (q, r) = (DMatrix::identity(n, n) * 1e-3, DVector::from_element(3, 0.1));
        group.bench_function(BenchmarkId::from_parameter(n), |b| {
            b.iter(|| steady_state(&f, &h, &q, &r).map(|s| s.doublings));
        });
    }
}

criterion_group!(benches, tank, cylinder, riccati);
criterion_main!(benches);

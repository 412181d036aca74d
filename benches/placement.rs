//! Cost of the search for sensors on the 20 L cylinder.
//!
//! `cargo bench -p cylwatch-benches --bench placement`
use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, criterion_group, criterion_main};
use cylwatch_estimator::observer::ObserverSettings;
use cylwatch_estimator::placement::certificate::{CertificateSettings, certify};
use cylwatch_estimator::placement::search::{Method, SearchControl, search};
use cylwatch_estimator::placement::{
    Conditions, Constraints, GroupedProblem, InstrumentedCylinder, Objective, Quantity,
};
use cylwatch_estimator::sensor::Sensor;
use cylwatch_estimator::thermal::vessel::presets;

/// Heights of the side of the 20 L cylinder, m.
const LOW_M: f64 = 0.05;
const HIGH_M: f64 = 0.75;

/// The mean gas temperature with so many thermometers on the wall of so many nodes, and the pressure, which is the last one.
fn problem(thermometers: usize, wall_nodes: usize) -> GroupedProblem {
    let vessel = presets::load("nitrogen-20l").expect("it is built in");
    let settings = ObserverSettings { wall_nodes, ..ObserverSettings::default() };
    let height = |number: usize| LOW_M + (HIGH_M - LOW_M) * number as f64 / (thermometers - 1) as f64;
    let mut sensors: Vec<Sensor> = (0..thermometers)
        .map(|number| Sensor::typical_at_height(height(number)).expect("the cylinder reaches there"))
        .collect();
    for (number, sensor) in sensors.iter_mut().enumerate() {
        sensor.name = format!("wall_{number}");
    }
    sensors.push(Sensor::typical("pressure").expect("it is built in"));
    let member = settings.bank[0];
    InstrumentedCylinder::new(&vessel, &sensors, &settings, &member, &Conditions::default())
        .and_then(|cylinder| cylinder.problem(Quantity::GasTemperature))
        .expect("the conditions are a state of the gas")
}

/// So many thermometers beside the pressure.
fn beside_pressure(problem: &GroupedProblem, thermometers: usize) -> Constraints {
    Constraints { must: vec![problem.candidates() - 1], ..Constraints::of(thermometers + 1) }
}

fn searches(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("placement");
    group.sample_size(10).warm_up_time(Duration::from_millis(1));
    let few = problem(40, 6);
    let three = beside_pressure(&few, 3);
    group.bench_function("3 of 40, exhaustive, 9880 layouts", |bench| {
        bench.iter(|| search(black_box(&few), &three, Method::Exhaustive, 0.02, &SearchControl::default()));
    });
    let many = problem(1000, 6);
    let five = beside_pressure(&many, 5);
    group.bench_function("5 of 1000, greedy with swaps", |bench| {
        bench.iter(|| search(black_box(&many), &five, Method::Greedy, 0.02, &SearchControl::default()));
    });
    group.bench_function("5 of 1000, certificate", |bench| {
        bench.iter(|| certify(black_box(&many), &five, &CertificateSettings::default()));
    });
    group.finish();
}

criterion_group!(benches, searches);
criterion_main!(benches);

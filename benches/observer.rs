//! Cost of a step of the cylinder's observer: by engine, by size of the bank, by interval of the samples.
//!
//! A cylinder of 20 L with shoulder, valve and pressure sensors through one day under a train
//! ([`cylwatch_evaluation::world`]), again and again. One step includes the estimate.
//!
//! `cargo bench -p cylwatch-benches --bench observer`
use std::sync::OnceLock;

use criterion::{Criterion, criterion_group, criterion_main};
use cylwatch_estimator::observer::{
    Commissioning, Engine, MovingHorizonSettings, Observer, ObserverSettings, Smoother,
};
use cylwatch_estimator::sensor::Sensor;
use cylwatch_estimator::thermal::vessel::presets;
use cylwatch_evaluation::world::{Family, Request, RowPattern, Simulated};

const SENSORS: [&str; 3] = ["shoulder", "valve", "pressure"];
const INTERVAL_S: f64 = 10.0;
const FILL_K: f64 = 288.15;
const FILL_PA: f64 = 2e7;

/// Readings at a time: one day, sampled every 10 s, that repeats itself.
fn readings(time_s: f64) -> [f64; 3] {
    static DAY: OnceLock<Vec<[f64; 3]>> = OnceLock::new();
    let day = DAY.get_or_init(|| {
        let family = Family { rows: RowPattern::TenSeconds, ..Family::usual() };
        let request = Request::tight(family, 1, 86_400.0);
        let simulated = Simulated::run(&request).expect("a simulation");
        let world = simulated.world_of_even_rows(&request).expect("a world");
        world.log.rows().map(|(_, row)| [row[0], row[1], row[2]]).collect()
    });
    day[(time_s / INTERVAL_S).round() as usize % day.len()]
}

fn observer(settings: &ObserverSettings) -> Observer {
    let sensors = SENSORS.map(|name| Sensor::typical(name).expect("typical sensor"));
    let vessel = presets::load("nitrogen-20l").expect("built-in vessel");
    let commissioning = Commissioning::filled(FILL_PA, FILL_K);
    Observer::new(&vessel, &sensors, &commissioning, settings).expect("sound settings")
}

fn bench(c: &mut Criterion, name: &str, settings: &ObserverSettings, interval_s: f64, samples: usize) {
    let mut observer = observer(settings);
    let mut time_s = 0.0;
    let mut step = || {
        time_s += interval_s;
        observer.step(time_s, &readings(time_s)).expect("time runs forwards")
    };
    (0..samples).for_each(|_| {
        step();
    });
    c.benchmark_group("observer").sample_size(20).bench_function(name, |b| b.iter(&mut step));
}

fn engine(engine: Engine) -> ObserverSettings {
    ObserverSettings { engine, ..ObserverSettings::default() }
}

fn single(engine: Engine) -> ObserverSettings {
    ObserverSettings { engine, ..ObserverSettings::single() }
}

fn engines(c: &mut Criterion) {
    let horizon = Engine::MovingHorizon(MovingHorizonSettings::default());
    for interval_s in [10.0, 60.0] {
        let named = |name: &str| format!("{name}, {interval_s} s");
        bench(c, &named("default bank of four"), &engine(Engine::Extended), interval_s, 500);
        bench(c, &named("one member, extended"), &single(Engine::Extended), interval_s, 500);
        bench(c, &named("one member, unscented"), &single(Engine::Unscented), interval_s, 200);
        bench(c, &named("one member, stationary"), &single(Engine::Stationary), interval_s, 2000);
        bench(c, &named("one member, moving horizon of 20"), &single(horizon), interval_s, 50);
    }
}

/// A stationary gain at rest: no covariance moves.
fn at_rest(c: &mut Criterion) {
    for (name, longest_step_s) in [("in steps of 20 s", 20.0), ("in one step", 60.0)] {
        let settings = ObserverSettings { longest_step_s, ..single(Engine::Stationary) };
        let mut observer = observer(&settings);
        let mut time_s = 0.0;
        let mut step = || {
            time_s += 60.0;
            observer.step(time_s, &[FILL_K, FILL_K, FILL_PA + (time_s % 7.0)]).expect("time runs forwards")
        };
        (0..3000).for_each(|_| {
            step();
        });
        let name = format!("one member, stationary at rest, 60 s {name}");
        c.benchmark_group("observer").sample_size(20).bench_function(name, |b| b.iter(&mut step));
    }
}

fn around(c: &mut Criterion) {
    let mut smoother = Smoother::with_rows(observer(&engine(Engine::Extended)), 2048).expect("smoothable");
    let mut time_s = 0.0;
    c.benchmark_group("observer").sample_size(20).bench_function("smoothed, bank of four, 60 s", |b| {
        b.iter(|| {
            time_s += 60.0;
            smoother.push(time_s, &readings(time_s)).expect("time runs forwards").len()
        });
    });
}

criterion_group!(benches, engines, at_rest, around);
criterion_main!(benches);

//! What a row costs: observer and monitor together, on a railway week at one row per minute and on the same at one row per ten seconds.
use std::hint::black_box;

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use cylwatch_detector::monitor::{Monitor, MonitorSettings};
use cylwatch_estimator::observer::{Commissioning, Observer};
use cylwatch_estimator::sensor::Sensor;
use cylwatch_estimator::thermal::vessel::presets;
use cylwatch_evaluation::truth::{Course, TruthSettings, generate_with};

const SENSORS: [&str; 3] = ["shoulder", "valve", "pressure"];
type Rows = Vec<(f64, [f64; 3])>;

fn rows(days: f64, sample_time_s: f64) -> Rows {
    let settings = TruthSettings { gas_cells: 1, relative_tolerance: 1e-4, ..TruthSettings::default() };
    let truth = generate_with(&Course::RailwayWeeks { days }, 1, sample_time_s, &settings).expect("a truth");
    let columns =
        SENSORS.map(|name| truth.log.channels.iter().position(|c| c.name == name).expect("it is read"));
    truth.log.rows().map(|(t, row)| (t, columns.map(|c| row[c]))).collect()
}

fn throughput(criterion: &mut Criterion) {
    let vessel = presets::load("nitrogen-20l").expect("it is built in");
    let sensors = SENSORS.map(|name| Sensor::typical(name).expect("it is built in"));
    let filled = Commissioning { settled: false, ..Commissioning::filled(200e5, 288.15) };
    let mut group = criterion.benchmark_group("rows");
    group.sample_size(10);
    for (name, days, interval_s, step_s) in [
        ("every minute", 7.0, 60.0, 0.0),
        ("every 10 s", 2.0, 10.0, 0.0),
        ("every 10 s, in bins of a minute", 2.0, 10.0, 60.0),
    ] {
        let rows = rows(days, interval_s);
        group.throughput(Throughput::Elements(rows.len() as u64));
        let mut settings = MonitorSettings::default();
        settings.intake.step_s = step_s;
        group.bench_function(format!("observer and monitor, {name}"), |bench| {
            bench.iter_batched(
                || Monitor::new(&vessel, &sensors, &filled, &settings).expect("it can begin"),
                |mut monitor| {
                    for (time_s, readings) in &rows {
                        black_box(monitor.step(*time_s, readings).expect("a row"));
                    }
                },
                BatchSize::PerIteration,
            );
        });
        group.bench_function(format!("observer alone, {name}"), |bench| {
            bench.iter_batched(
                || Observer::new(&vessel, &sensors, &filled, &settings.observer).expect("it can begin"),
                |mut observer| {
                    for (time_s, readings) in &rows {
                        black_box(observer.step(*time_s, readings).expect("a row"));
                    }
                },
                BatchSize::PerIteration,
            );
        });
    }
    group.finish();
}

criterion_group!(benches, throughput);
criterion_main!(benches);

//! What a row costs: observer and monitor together, on a railway week at one row per minute and on the same at one row per ten seconds.
use std::hint::black_box;

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use cylwatch_detector::monitor::{Monitor, MonitorSettings};
use cylwatch_estimator::observer::{Commissioning, Observer};
use cylwatch_estimator::sensor::Sensor;
use cylwatch_estimator::thermal::vessel::presets;
use cylwatch_evaluation::world::{Family, Request, RowPattern, Simulated};

const SENSORS: [&str; 3] = ["shoulder", "valve", "pressure"];
type Rows = Vec<(f64, [f64; 3])>;

fn rows(days: f64, rows: RowPattern) -> Rows {
    let request = Request::tight(Family { rows, ..Family::usual() }, 1, 86_400.0 * days);
    let simulated = Simulated::run(&request).expect("a simulation");
    let world = simulated.world_of_even_rows(&request).expect("a world");
    world.log.rows().map(|(t, row)| (t, [row[0], row[1], row[2]])).collect()
}

fn throughput(criterion: &mut Criterion) {
    let vessel = presets::load("nitrogen-20l").expect("it is built in");
    let sensors = SENSORS.map(|name| Sensor::typical(name).expect("it is built in"));
    let filled = Commissioning { settled: false, ..Commissioning::filled(200e5, 288.15) };
    let mut group = criterion.benchmark_group("rows");
    group.sample_size(10);
    for (name, days, pattern, step_s) in [
        ("every minute", 7.0, RowPattern::Minute, 0.0),
        ("every 10 s", 2.0, RowPattern::TenSeconds, 0.0),
        ("every 10 s, in bins of a minute", 2.0, RowPattern::TenSeconds, 60.0),
    ] {
        let rows = rows(days, pattern);
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

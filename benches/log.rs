//! Time of reading a log: rows with four readings, in memory.
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use cylwatch::log::{LogOptions, LogReader};
use std::hint::black_box;

const ROWS: u32 = 100_000;

/// A log of noise-like digits; `date` writes RFC 3339 instead of seconds.
fn log(date: bool) -> String {
    let mut text = String::from(if date { "time" } else { "time_s" });
    text.push_str(",shoulder_degc,valve_degc,ambient_degc,pressure_bar\n");
    for row in 0..ROWS {
        let digits = f64::from(row.wrapping_mul(2_654_435_761) % 1_000) * 1e-3;
        let time = match date {
            true => format!(
                "2026-01-{:02}T{:02}:{:02}:{:02}Z",
                1 + row / 8640,
                row / 360 % 24,
                row / 6 % 60,
                row % 6 * 10
            ),
            false => format!("{}", row * 10),
        };
        let [shoulder, valve, ambient, pressure] = [15.0, 14.0, 12.0, 200.0].map(|value| value + digits);
        text.push_str(&format!("{time},{shoulder:.3},{valve:.3},{ambient:.3},{pressure:.3}\n"));
    }
    text
}

fn read(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("read a log row");
    group.throughput(Throughput::Elements(u64::from(ROWS)));
    for (name, date) in [("time in seconds", false), ("time as RFC 3339", true)] {
        let text: &'static str = log(date).leak();
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                let mut reader =
                    LogReader::from_text(Box::new(text.as_bytes()), "log.csv", &LogOptions::default())
                        .expect("the header is right");
                while let Some(row) = reader.next_row().expect("the rows are right") {
                    black_box(row);
                }
            });
        });
    }
    group.finish();
}

criterion_group!(benches, read);
criterion_main!(benches);

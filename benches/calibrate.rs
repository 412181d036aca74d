//! A calibration of six numbers, with contact and offsets beside them, on a day of readings every 10 s.
#![allow(clippy::unwrap_used, missing_docs)]
use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};

#[allow(dead_code)]
#[path = "../crates/estimator/tests/suite/calibrate/study.rs"]
mod study;

use study::{Case, preset};

fn bench(criterion: &mut Criterion) {
    let mut scenario = preset("tunnel-step");
    (scenario.duration_s, scenario.sample_time_s) = (86_400.0, 10.0);
    let calibration = Case::new(1).calibration(&scenario);
    let mut group = criterion.benchmark_group("calibrate");
    group.sample_size(10);
    group.bench_function("six numbers, a day at 10 s", |bencher| {
        bencher.iter(|| black_box(&calibration).run().unwrap());
    });
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);

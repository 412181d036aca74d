//! Cost of a steady state by structured doubling.
//!
//! `cargo bench -p cylwatch-benches --bench filter`
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use cylwatch_estimator::filter::steady_state;
use nalgebra::{DMatrix, DVector};

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

criterion_group!(benches, riccati);
criterion_main!(benches);

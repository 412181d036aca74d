//! Cost of one step, prediction and scalar updates, of every estimator.
//!
//! `cargo bench -p cylwatch-estimator --bench filter`
use criterion::{Criterion, criterion_group, criterion_main};
use cylwatch_estimator::filter::{Linearisation, UdFactors};
use nalgebra::{Const, DMatrix, Dyn, SMatrix};

/// A dense, stable transition of `leading` of `n` states with `k` noise sources.
fn transition(n: usize, leading: usize, k: usize) -> Linearisation {
    let mut linear = Linearisation::zeros(n, leading, k);
    linear.phi = DMatrix::from_fn(leading, n, |i, j| if i == j { 0.9 } else { 0.1 / (1 + i + 2 * j) as f64 });
    linear.g = DMatrix::from_fn(leading, k, |i, j| if i == j % leading { 1.0 } else { 0.05 });
    linear.q.fill(0.01);
    linear
}

fn gradient(n: usize, j: usize) -> Vec<f64> {
    (0..n).map(|i| if i == 2 * j { 1.0 } else { 0.2 / (1 + i + j) as f64 }).collect()
}

/// The covariance of an observer of 15 states, 9 of them moving, with 14 noise sources and 3 sensors.
fn observer_covariance(c: &mut Criterion) {
    let linear = transition(15, 9, 14);
    let h: Vec<Vec<f64>> = (0..3).map(|j| gradient(15, j)).collect();
    let mut gain = [0.0; 15];
    let mut dynamic = UdFactors::<Dyn>::from_covariance(&DMatrix::identity(15, 15)).expect("a covariance");
    let mut group = c.benchmark_group("ud, 9 of 15 states, 14 noises, 3 sensors");
    group.bench_function("dynamic", |b| {
        b.iter(|| {
            dynamic.predict(&linear);
            h.iter().map(|h| dynamic.update(h, 0.1, &mut gain)).sum::<f64>()
        });
    });
    let mut fixed = UdFactors::<Const<15>>::from_covariance(&SMatrix::identity()).expect("a covariance");
    group.bench_function("static", |b| {
        b.iter(|| {
            fixed.predict(&linear);
            h.iter().map(|h| fixed.update(h, 0.1, &mut gain)).sum::<f64>()
        });
    });
    group.bench_function("dynamic, prediction alone", |b| b.iter(|| dynamic.predict(&linear)));
}

criterion_group!(benches, observer_covariance);
criterion_main!(benches);

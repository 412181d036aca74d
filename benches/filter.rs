//! Cost of one step, prediction and update, of every estimator on a process that costs next to nothing itself.
//!
//! `cargo bench -p cylwatch-benches --bench filter`
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use cylwatch_estimator::filter::{
    CovarianceForm, ExtendedKalman, Joseph, KalmanSettings, SequentialFilter, StateSpace, Stationary,
    StationarySettings, UdFactors, Unscented, UnscentedSettings, steady_state,
};
use nalgebra::{Const, DMatrix, DVector, Dyn, SMatrix};

#[path = "../crates/estimator/tests/suite/copying_model.rs"]
mod copying_model;

use copying_model::CopyingModel;

/// States and outputs of the comparison; all states move, each driven by its own noise.
const STATES: [usize; 4] = [4, 8, 12, 20];
const OUTPUTS: [usize; 4] = [1, 2, 3, 4];

fn kalman<F: CovarianceForm>(model: CopyingModel, form: F) -> ExtendedKalman<CopyingModel, F> {
    let start = vec![0.0; model.states()];
    ExtendedKalman::try_new(model, &start, form, &KalmanSettings::default()).expect("settings fit")
}

fn bench_steps<F: SequentialFilter>(c: &mut Criterion, name: &str, build: impl Fn(CopyingModel) -> F) {
    let mut group = c.benchmark_group(name);
    group
        .sample_size(30)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_millis(600));
    for n in STATES {
        for outputs in OUTPUTS {
            let mut filter = build(CopyingModel::new(n, n, n, outputs));
            let z = vec![0.1; outputs];
            group.bench_function(
                BenchmarkId::from_parameter(format!("{n} states, {outputs} outputs")),
                |b| {
                    b.iter(|| filter.step(1.0, &z).is_ok());
                },
            );
        }
    }
}

fn identity(model: &CopyingModel) -> DMatrix<f64> {
    DMatrix::identity(model.states(), model.states())
}

fn forms(c: &mut Criterion) {
    bench_steps(c, "kalman, ud", |model| {
        let form = UdFactors::<Dyn>::from_covariance(&identity(&model)).expect("a covariance");
        kalman(model, form)
    });
    bench_steps(c, "kalman, joseph", |model| {
        let form = Joseph::<Dyn>::from_covariance(&identity(&model)).expect("a covariance");
        kalman(model, form)
    });
}

fn other_filters(c: &mut Criterion) {
    bench_steps(c, "unscented", |model| {
        let start = vec![0.0; model.states()];
        let p = identity(&model);
        Unscented::try_new(model, &start, &p, &UnscentedSettings::default()).expect("a covariance")
    });
    bench_steps(c, "stationary", |model| {
        let start = vec![0.0; model.states()];
        Stationary::try_new(model, &start, &start, &StationarySettings::new(1.0)).expect("a steady state")
    });
}

/// An observer's covariance: 15 states, 9 of them moving, 14 noise sources, 3 outputs.
fn observer(c: &mut Criterion) {
    let model = CopyingModel::new(15, 9, 14, 3);
    let mut group = c.benchmark_group("9 of 15 states, 14 noises, 3 outputs");
    let z = [0.1; 3];
    let form = UdFactors::<Dyn>::from_covariance(&identity(&model)).expect("a covariance");
    let mut filter = kalman(model.clone(), form.clone());
    group.bench_function("kalman, ud", |b| b.iter(|| filter.step(1.0, &z).is_ok()));
    let fixed = UdFactors::<Const<15>>::from_covariance(&SMatrix::identity()).expect("a covariance");
    let mut filter = kalman(model.clone(), fixed.clone());
    group.bench_function("kalman, ud of static size", |b| b.iter(|| filter.step(1.0, &z).is_ok()));
    bench_covariance(&mut group, "covariance alone, dynamic", form, model.clone());
    bench_covariance(&mut group, "covariance alone, static", fixed, model);
}

type Group<'a> = criterion::BenchmarkGroup<'a, criterion::measurement::WallTime>;

/// Prediction and three scalar updates of the covariance, without state, outputs and report.
fn bench_covariance<F: CovarianceForm>(
    group: &mut Group<'_>,
    name: &str,
    mut form: F,
    mut model: CopyingModel,
) {
    let (n, m) = (model.states(), model.leading());
    let mut linear = cylwatch_estimator::filter::Linearisation::zeros(n, m, model.noises());
    let mut h = vec![vec![0.0; n]; model.outputs()];
    let _ = model.propagate(&mut vec![0.0; n], 1.0, Some(&mut linear));
    for (j, h) in h.iter_mut().enumerate() {
        let _ = model.output(j, &vec![0.0; n], Some(h));
    }
    let mut gain = vec![0.0; n];
    group.bench_function(name, |b| {
        b.iter(|| {
            form.predict(&linear);
            h.iter().map(|h| form.update(h, 0.1, &mut gain)).sum::<f64>()
        });
    });
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

criterion_group!(benches, observer, riccati, forms, other_filters);
criterion_main!(benches);

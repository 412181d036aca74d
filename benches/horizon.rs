//! Cost of a sample of the moving-horizon estimator: problem size, window length, and what constraints and outliers add.
//!
//! A chain of thermal nodes, the gas mass and the leak rate; one output reads mass and temperature together, the
//! others read nodes. The "observer" has 15 states, 9 of which move, 7 noise sources and 3 outputs.
//!
//! `cargo bench -p cylwatch-benches --bench horizon`
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use cylwatch_estimator::filter::horizon::{Constraint, HorizonSettings, Loss, MovingHorizon};
use cylwatch_estimator::filter::{Linearisation, StateSpace};
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

#[allow(dead_code, reason = "the chain has matrices of its own")]
#[path = "../crates/estimator/tests/suite/copying_model.rs"]
mod copying_model;

use copying_model::CopyingModel;

/// Time between samples, s.
const DT_S: f64 = 60.0;

/// `leading - 2` nodes, mass, leak rate, then constants: offsets of the outputs.
fn chain(n: usize, leading: usize, noises: usize, outputs: usize) -> CopyingModel {
    let nodes = leading - 2;
    let mut linear = Linearisation::zeros(n, leading, noises);
    for i in 0..leading {
        linear.phi[(i, i)] = 1.0;
    }
    for i in 1..nodes {
        for (a, b) in [(i, i - 1), (i - 1, i)] {
            linear.phi[(a, a)] -= 0.2;
            linear.phi[(a, b)] += 0.2;
        }
    }
    linear.phi[(leading - 2, leading - 1)] = -DT_S;
    // Strong noise at the outer node, a wandering leak, weak noises on the other nodes.
    for source in 0..noises {
        let state = if source == 1 { leading - 1 } else { source.saturating_sub(1).min(nodes - 1) };
        linear.g[(state, source)] = 1.0;
        linear.q[source] = if source == 0 { 1.0 } else { 1e-4 };
    }
    linear.q[1] = 1e-8;
    let mut h = DMatrix::zeros(n, outputs);
    h[(leading - 2, 0)] = 1.0;
    h[(nodes - 1, 0)] = 0.5;
    for j in 1..outputs {
        h[((j - 1) * nodes / outputs, j)] = 1.0;
    }
    for constant in leading..n {
        h[(constant, (constant - leading) % outputs)] = 1.0;
    }
    CopyingModel::of(linear, h, 0.01)
}

/// A record with the given leak rate.
fn record(CopyingModel { linear, h, .. }: &CopyingModel, leak: f64, samples: usize) -> Vec<Vec<f64>> {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let mut normal = move || rng.sample::<f64, _>(StandardNormal);
    let (leading, n) = linear.phi.shape();
    let mut x = DVector::zeros(n);
    (0..samples)
        .map(|_| {
            let w = linear.q.map(|q| q.sqrt() * normal());
            let next = &linear.phi * &x + &linear.g * w;
            x.rows_mut(0, leading).copy_from(&next);
            x[leading - 1] = leak;
            h.tr_mul(&x).iter().map(|z| z + 0.1 * normal()).collect()
        })
        .collect()
}

/// What a case adds to the plain window.
#[derive(Clone, Copy, PartialEq)]
enum Case {
    /// Constraints that never bind.
    Slack,
    /// Leak at its bound most of the time, mass not rising.
    Active,
    /// Huber's loss with a tenth of the readings off by 20 standard deviations.
    Robust,
}

fn bench(c: &mut Criterion, group: &str, name: &str, chain: &CopyingModel, samples: usize, case: Case) {
    let (n, leading) = (chain.states(), chain.leading());
    let leak = if case == Case::Active { -3e-4 } else { 1e-2 };
    let mut record = record(chain, leak, 2000);
    if case == Case::Robust {
        let mut rng = ChaCha8Rng::seed_from_u64(2);
        record.iter_mut().flatten().filter(|_| rng.random_bool(0.1)).for_each(|z| *z += 2.0);
    }
    let constraints =
        vec![Constraint::at_least(leading - 1, 0.0), Constraint::step(&[(leading - 2, 1.0)], 0.0)];
    let loss = if case == Case::Robust { Loss::Huber { delta: 2.0 } } else { Loss::Quadratic };
    let settings = HorizonSettings { samples, loss, ..HorizonSettings::default() };
    let mut horizon = MovingHorizon::try_new(
        chain.clone(),
        &DVector::zeros(n),
        &DMatrix::identity(n, n),
        constraints,
        settings,
    )
    .expect("sound problem");
    let mut samples = record.iter().cycle();
    let mut step = || horizon.step(DT_S, samples.next().expect("endless")).expect("no edge");
    let (mut solves, mut rows) = (0, 0);
    for _ in 0..200 {
        let estimate = step();
        solves += estimate.qp_solves;
        rows += estimate.active.len();
    }
    let per_step = |count: usize| count as f64 / 200.0;
    let what = format!("{:.1} programs, {:.1} active", per_step(solves), per_step(rows));
    let id = BenchmarkId::new(name, what);
    c.benchmark_group(group).sample_size(20).bench_function(id, |b| b.iter(&mut step));
}

fn sizes(c: &mut Criterion) {
    for (n, sensors) in [(4, 1), (8, 2), (12, 3), (20, 4)] {
        let chain = chain(n, n, 3, sensors);
        for samples in [10, 20, 30] {
            for (name, case) in [("slack", Case::Slack), ("active", Case::Active)] {
                let name = format!("n = {n}, {sensors} sensors, N = {samples}, {name}");
                bench(c, "horizon", &name, &chain, samples, case);
            }
        }
    }
}

fn observer(c: &mut Criterion) {
    let chain = chain(15, 9, 7, 3);
    for (name, case) in [("slack", Case::Slack), ("active", Case::Active), ("robust", Case::Robust)] {
        bench(c, "observer", &format!("N = 20, {name}"), &chain, 20, case);
    }
}

criterion_group!(benches, observer, sizes);
criterion_main!(benches);

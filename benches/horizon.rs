//! Cost of a sample of the moving-horizon estimator: problem size, window length, and what constraints and outliers add.
//!
//! A chain of thermal nodes, the gas mass and the leak rate; one output reads mass and temperature together, the
//! others read nodes. The "observer" has 15 states, 9 of which move, 7 noise sources and 3 outputs.
//!
//! `cargo bench -p cylwatch-benches --bench horizon`
use std::convert::Infallible;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use cylwatch_estimator::filter::horizon::{Constraint, HorizonSettings, Loss, MovingHorizon};
use cylwatch_estimator::filter::{Linearisation, StateSpace};
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

/// Time between samples, s.
const DT_S: f64 = 60.0;

/// `leading - 2` nodes, mass, leak rate, then constants: offsets of the outputs.
#[derive(Clone)]
struct Chain {
    linear: Linearisation,
    h: DMatrix<f64>,
    next: DVector<f64>,
}

impl Chain {
    fn new(n: usize, leading: usize, noises: usize, outputs: usize) -> Self {
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
        let mut h = DMatrix::zeros(outputs, n);
        h[(0, leading - 2)] = 1.0;
        h[(0, nodes - 1)] = 0.5;
        for j in 1..outputs {
            h[(j, (j - 1) * nodes / outputs)] = 1.0;
        }
        for constant in leading..n {
            h[((constant - leading) % outputs, constant)] = 1.0;
        }
        Self { linear, h, next: DVector::zeros(leading) }
    }

    /// A record with the given leak rate.
    fn record(&self, leak: f64, samples: usize) -> Vec<Vec<f64>> {
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let mut normal = move || rng.sample::<f64, _>(StandardNormal);
        let (leading, n) = self.linear.phi.shape();
        let mut x = DVector::zeros(n);
        (0..samples)
            .map(|_| {
                let w = self.linear.q.map(|q| q.sqrt() * normal());
                let next = &self.linear.phi * &x + &self.linear.g * w;
                x.rows_mut(0, leading).copy_from(&next);
                x[leading - 1] = leak;
                (&self.h * &x).iter().map(|z| z + 0.1 * normal()).collect()
            })
            .collect()
    }
}

impl StateSpace for Chain {
    type Error = Infallible;

    fn states(&self) -> usize {
        self.linear.phi.ncols()
    }

    fn leading(&self) -> usize {
        self.linear.phi.nrows()
    }

    fn noises(&self) -> usize {
        self.linear.q.len()
    }

    fn outputs(&self) -> usize {
        self.h.nrows()
    }

    fn propagate(
        &mut self,
        x: &mut [f64],
        _dt_s: f64,
        linear: Option<&mut Linearisation>,
    ) -> Result<(), Infallible> {
        self.next.fill(0.0);
        for (column, x) in self.linear.phi.column_iter().zip(x.iter()) {
            self.next.axpy(*x, &column, 1.0);
        }
        x[..self.next.len()].copy_from_slice(self.next.as_slice());
        if let Some(linear) = linear {
            linear.phi.copy_from(&self.linear.phi);
            linear.g.copy_from(&self.linear.g);
            linear.q.copy_from(&self.linear.q);
        }
        Ok(())
    }

    fn output(&mut self, j: usize, x: &[f64], h: Option<&mut [f64]>) -> Result<f64, Infallible> {
        if let Some(h) = h {
            h.iter_mut().zip(self.h.row(j).iter()).for_each(|(h, a)| *h = *a);
        }
        Ok(self.h.row(j).iter().zip(x).map(|(a, x)| a * x).sum())
    }

    fn noise_variance(&self, _j: usize, _x: &[f64]) -> f64 {
        0.01
    }
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

fn bench(c: &mut Criterion, group: &str, name: &str, chain: &Chain, samples: usize, case: Case) {
    let (n, leading) = (chain.states(), chain.leading());
    let leak = if case == Case::Active { -3e-4 } else { 1e-2 };
    let mut record = chain.record(leak, 2000);
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
        let chain = Chain::new(n, n, 3, sensors);
        for samples in [10, 20, 30] {
            for (name, case) in [("slack", Case::Slack), ("active", Case::Active)] {
                let name = format!("n = {n}, {sensors} sensors, N = {samples}, {name}");
                bench(c, "horizon", &name, &chain, samples, case);
            }
        }
    }
}

fn observer(c: &mut Criterion) {
    let chain = Chain::new(15, 9, 7, 3);
    for (name, case) in [("slack", Case::Slack), ("active", Case::Active), ("robust", Case::Robust)] {
        bench(c, "observer", &format!("N = 20, {name}"), &chain, 20, case);
    }
}

criterion_group!(benches, observer, sizes);
criterion_main!(benches);

//! Random linear processes and their textbook filter in dense matrices: what the filters are compared with.
use std::convert::Infallible;

use cylwatch_estimator::filter::{Dimensions, Gate, Linearisation, Plant, StateSpace};
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// `dx = A x dt + dw`, `dw ~ N(0, Q_c dt)`, `z = H x + v`, `v ~ N(0, diag(r))`; the trailing rows of `A` and `Q_c` are zero.
#[derive(Clone, Debug)]
pub(crate) struct LinearModel {
    pub a: DMatrix<f64>,
    pub q_c: DMatrix<f64>,
    pub h: DMatrix<f64>,
    pub r: DVector<f64>,
    pub leading: usize,
}

pub(crate) fn rng(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

pub(crate) fn uniform(rng: &mut ChaCha8Rng, rows: usize, columns: usize) -> DMatrix<f64> {
    DMatrix::from_fn(rows, columns, |_, _| rng.random_range(-1.0..1.0))
}

pub(crate) fn normal(rng: &mut ChaCha8Rng, n: usize) -> DVector<f64> {
    DVector::from_fn(n, |_, _| StandardNormal.sample(rng))
}

/// Transition and noise covariance over `dt_s` of `dx = A x dt + dw`, `dw ~ N(0, Q_c dt)`: from the exponential of one block
/// matrix (Van Loan 1978) over an interval so short that nothing in it overflows, then doubled.
pub(crate) fn discretise(a: &DMatrix<f64>, q_c: &DMatrix<f64>, dt_s: f64) -> (DMatrix<f64>, DMatrix<f64>) {
    let n = a.nrows();
    let norm = a.column_iter().map(|column| column.lp_norm(1)).fold(0.0, f64::max) * dt_s;
    let doublings = norm.max(0.25).log2().ceil() as i32 + 2;
    let short_s = dt_s * 0.5_f64.powi(doublings);
    let mut block = DMatrix::zeros(2 * n, 2 * n);
    block.view_mut((0, 0), (n, n)).copy_from(&(-a * short_s));
    block.view_mut((0, n), (n, n)).copy_from(&(q_c * short_s));
    block.view_mut((n, n), (n, n)).copy_from(&(a.transpose() * short_s));
    let block = block.exp();
    let mut f = block.view((n, n), (n, n)).transpose();
    let mut q = &f * block.view((0, n), (n, n));
    for _ in 0..doublings {
        q += &f * &q * f.transpose();
        f = &f * &f;
    }
    let symmetric = (&q + q.transpose()) * 0.5;
    (f, symmetric)
}

/// A well-conditioned covariance.
pub(crate) fn covariance(rng: &mut ChaCha8Rng, n: usize) -> DMatrix<f64> {
    let a = uniform(rng, n, 2 * n);
    &a * a.transpose() + DMatrix::identity(n, n) * 0.1
}

/// A process, its start, and irregular samples of which about every fourth reading is missing.
pub(crate) struct Case {
    pub model: LinearModel,
    pub x0: DVector<f64>,
    pub p0: DMatrix<f64>,
    pub dt_s: Vec<f64>,
    pub z: Vec<Vec<f64>>,
}

impl Case {
    pub(crate) fn random(
        rng: &mut ChaCha8Rng,
        (n, leading, outputs): (usize, usize, usize),
        steps: usize,
    ) -> Self {
        let model = LinearModel::random(rng, n, leading, outputs);
        let p0 = covariance(rng, n);
        let x0 = normal(rng, n) * 3.0;
        let dt_s: Vec<f64> = (0..steps).map(|_| rng.random_range(0.05..1.5)).collect();
        let z = model.readings(rng, &x0, &dt_s, 0.25);
        Self { model, x0, p0, dt_s, z }
    }
}

impl LinearModel {
    /// A stable random process of `n` states, of which `leading` move, with `outputs` outputs.
    pub(crate) fn random(rng: &mut ChaCha8Rng, n: usize, leading: usize, outputs: usize) -> Self {
        let mut a = uniform(rng, n, n) / (n as f64).sqrt();
        (0..n).for_each(|i| a[(i, i)] -= 1.0);
        a.rows_mut(leading, n - leading).fill(0.0);
        let g = uniform(rng, leading, leading);
        let mut q_c = DMatrix::zeros(n, n);
        q_c.view_mut((0, 0), (leading, leading)).copy_from(&(&g * g.transpose()));
        let r = DVector::from_fn(outputs, |_, _| rng.random_range(0.05..0.5));
        Self { a, q_c, h: uniform(rng, outputs, n), r, leading }
    }

    /// Transition and noise covariance over `dt_s`.
    pub(crate) fn discrete(&self, dt_s: f64) -> (DMatrix<f64>, DMatrix<f64>) {
        discretise(&self.a, &self.q_c, dt_s)
    }

    /// The same as a linearisation; the noise comes in along the principal axes of its covariance.
    pub(crate) fn linearisation(&self, dt_s: f64) -> Linearisation {
        let (f, q) = self.discrete(dt_s);
        let m = self.leading;
        let axes = q.view((0, 0), (m, m)).into_owned().symmetric_eigen();
        let variances = axes.eigenvalues.map(|v| v.max(0.0));
        Linearisation { phi: f.rows(0, m).into_owned(), g: axes.eigenvectors, q: variances }
    }

    /// Simulated readings at the times `dt_s` apart; about `missing` of them are NaN.
    pub(crate) fn readings(
        &self,
        rng: &mut ChaCha8Rng,
        x0: &DVector<f64>,
        dt_s: &[f64],
        missing: f64,
    ) -> Vec<Vec<f64>> {
        let mut x = x0.clone();
        let mut rows = Vec::new();
        for &dt_s in dt_s {
            let linear = self.linearisation(dt_s);
            let w = normal(rng, self.leading).component_mul(&linear.q.map(f64::sqrt));
            let moved = &linear.phi * &x + &linear.g * w;
            x.rows_mut(0, self.leading).copy_from(&moved);
            let v = normal(rng, self.r.len()).component_mul(&self.r.map(f64::sqrt));
            let z = &self.h * &x + v;
            rows.push(
                z.iter().map(|z| if rng.random_range(0.0..1.0) < missing { f64::NAN } else { *z }).collect(),
            );
        }
        rows
    }
}

impl StateSpace for LinearModel {
    type Error = Infallible;

    fn dimensions(&self) -> Dimensions {
        Dimensions {
            states: self.a.nrows(),
            leading: self.leading,
            noises: self.leading,
            outputs: self.h.nrows(),
        }
    }

    fn propagate(
        &mut self,
        x: &mut [f64],
        dt_s: f64,
        linear: Option<&mut Linearisation>,
    ) -> Result<(), Infallible> {
        let own = self.linearisation(dt_s);
        let moved = &own.phi * DVector::from_column_slice(x);
        x[..self.leading].copy_from_slice(moved.as_slice());
        if let Some(linear) = linear {
            *linear = own;
        }
        Ok(())
    }

    fn output(&mut self, j: usize, x: &[f64], h: Option<&mut [f64]>) -> Result<f64, Infallible> {
        let row = self.h.row(j).transpose();
        if let Some(h) = h {
            h.copy_from_slice(row.as_slice());
        }
        Ok(row.dot(&DVector::from_column_slice(x)))
    }

    fn noise_variance(&self, j: usize, _x: &[f64]) -> f64 {
        self.r[j]
    }
}

/// Every reading passes.
impl Plant for LinearModel {
    type Hypothesis = ();

    fn suppose(&mut self, (): &()) {}

    fn gate(&self, (): &(), _output: usize) -> Gate {
        Gate { limit: f64::INFINITY, rejections_in_a_row: 0 }
    }
}

/// The textbook filter: vector update with the inverse of `S`, Joseph's form.
#[derive(Clone, Debug)]
pub(crate) struct DenseFilter {
    pub x: DVector<f64>,
    pub p: DMatrix<f64>,
    /// Innovations and covariance of the last update, of the outputs that were there.
    pub innovation: DVector<f64>,
    pub s: DMatrix<f64>,
}

impl DenseFilter {
    pub(crate) fn new(x: DVector<f64>, p: DMatrix<f64>) -> Self {
        Self { x, p, innovation: DVector::zeros(0), s: DMatrix::zeros(0, 0) }
    }

    pub(crate) fn predict(&mut self, model: &LinearModel, dt_s: f64) {
        let (f, q) = model.discrete(dt_s);
        self.x = &f * &self.x;
        self.p = &f * &self.p * f.transpose() + q;
    }

    pub(crate) fn update(&mut self, model: &LinearModel, z: &[f64]) {
        let there: Vec<usize> = (0..z.len()).filter(|j| z[*j].is_finite()).collect();
        let h = model.h.select_rows(&there);
        let r = DMatrix::from_diagonal(&model.r.select_rows(&there));
        let z = DVector::from_iterator(there.len(), there.iter().map(|j| z[*j]));
        self.s = &h * &self.p * h.transpose() + &r;
        self.innovation = z - &h * &self.x;
        if there.is_empty() {
            return;
        }
        let gain = &self.p * h.transpose() * self.s.clone().try_inverse().unwrap();
        self.x += &gain * &self.innovation;
        let left = DMatrix::identity(self.p.nrows(), self.p.nrows()) - &gain * h;
        let p = &left * &self.p * left.transpose() + &gain * r * gain.transpose();
        self.p = (&p + p.transpose()) * 0.5;
    }

    pub(crate) fn step(&mut self, model: &LinearModel, dt_s: f64, z: &[f64]) {
        self.predict(model, dt_s);
        self.update(model, z);
    }
}

/// Largest difference of two covariances, each element relative to the two standard deviations.
pub(crate) fn covariance_difference(a: &DMatrix<f64>, b: &DMatrix<f64>) -> f64 {
    let sd = b.diagonal().map(|v| v.sqrt().max(1e-100));
    (a - b).map_with_location(|i, j, e| (e / (sd[i] * sd[j])).abs()).max()
}

/// Largest difference of two states, relative to the larger of their size and their standard deviation.
pub(crate) fn state_difference(a: &[f64], b: &DVector<f64>, p: &DMatrix<f64>) -> f64 {
    let scale = |i: usize| p[(i, i)].sqrt().max(b[i].abs()).max(1e-100);
    (0..b.len()).map(|i| ((a[i] - b[i]) / scale(i)).abs()).fold(0.0, f64::max)
}

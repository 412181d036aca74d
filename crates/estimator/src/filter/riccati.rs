//! Steady state of a Kalman filter: the discrete algebraic Riccati equation by structured doubling.
//!
//! `P = F P F^T - F P H^T (H P H^T + R)^-1 H P F^T + Q`. Started from `A = F^T`, `G = H^T R^-1 H`, `X = Q`, the steps
//!
//! `A <- A W A`, `G <- G + A W G A^T`, `X <- X + A^T X W A`, with `W = (I + G X)^-1`,
//!
//! each do as much as all filter steps before: after `i` of them `X` is the covariance that a filter predicts which
//! knew the state exactly `2^i` steps ago. `X` only grows, and its diagonal bounds the rest.
//!
//! Source: Chu, Fan, Lin and Wang 2004 (Anderson 1978).
use crate::filter::simd::{Arch, Simd, WithSimd};
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector};

use super::dense::{factor_cholesky, factor_lu, product, solve_upper, solve_upper_transposed, symmetrise};
use super::kernel::{column, column_mut, multiply_columns, padded, subtract_columns};
use crate::EstimatorError;

/// Doublings after which a growing covariance counts as unbounded: `2^60` filter steps.
const DOUBLINGS: usize = 60;

/// Growth of a variance, relative, after which the next, of the order of its square, is below rounding.
const SETTLED: f64 = 1e-10;

/// What a filter with constant matrices settles at.
#[derive(Clone, Debug, PartialEq)]
pub struct SteadyState {
    /// Covariance before an update: (n, n).
    pub predicted: DMatrix<f64>,
    /// Covariance after an update: (n, n).
    pub updated: DMatrix<f64>,
    /// Gain `K = P H^T S^-1`: (n, outputs).
    pub gain: DMatrix<f64>,
    /// Covariance of the innovations `S = H P H^T + R`: (outputs, outputs).
    pub innovation: DMatrix<f64>,
    /// Doublings taken.
    pub doublings: usize,
}

/// Steady state for transition `f` (n, n), outputs `h` (outputs, n), process noise `q` (n, n) and noise variances `r`
/// (outputs). Constants without noise count as known: their variance goes to zero, if only as one over the time.
///
/// # Errors
/// Sizes differ, a noise variance is not positive, or the covariance grows without bound: a state that moves or is
/// driven is not seen by the outputs.
pub fn steady_state(
    f: &DMatrix<f64>,
    h: &DMatrix<f64>,
    q: &DMatrix<f64>,
    r: &DVector<f64>,
) -> Result<SteadyState, EstimatorError> {
    let n = f.nrows();
    for length in [f.ncols(), h.ncols(), q.nrows(), q.ncols()] {
        super::failure::check_length(length, n)?;
    }
    if r.len() != h.nrows() {
        return Err(EstimatorError::ReadingsLength { readings: r.len(), outputs: h.nrows() });
    }
    if let Some(&variance) = r.iter().find(|r| !(r.is_finite() && **r > 0.0)) {
        return Err(EstimatorError::NoiseNotPositive { variance });
    }
    let element = |i: usize, j: usize| (0..r.len()).map(|l| h[(l, i)] * h[(l, j)] / r[l]).sum();
    let (predicted, doublings) = settle(f, &DMatrix::from_fn(n, n, element), q)?;
    finish(predicted, h, r, doublings)
}

/// The covariance before an update, of a filter whose every sample brings the information `H^T R^-1 H` (n, n), for transition `f` (n, n)
/// and process noise `q` (n, n).
///
/// # Errors
/// As [`steady_state`].
pub fn steady_prediction(
    f: &DMatrix<f64>,
    information: &DMatrix<f64>,
    q: &DMatrix<f64>,
) -> Result<DMatrix<f64>, EstimatorError> {
    let n = f.nrows();
    for length in [f.ncols(), information.nrows(), information.ncols(), q.nrows(), q.ncols()] {
        super::failure::check_length(length, n)?;
    }
    Ok(settle(f, information, q)?.0)
}

/// The predicted covariance and the doublings that it took.
fn settle(
    f: &DMatrix<f64>,
    information: &DMatrix<f64>,
    q: &DMatrix<f64>,
) -> Result<(DMatrix<f64>, usize), EstimatorError> {
    let mut doubling = Doubling::new(f, information, q);
    let arch = Arch::new();
    for doublings in 1..=DOUBLINGS {
        match arch.dispatch(&mut doubling) {
            Growth::Settled => return Ok((doubling.solution(), doublings)),
            Growth::Grows => {}
            Growth::Unbounded => break,
        }
    }
    Err(EstimatorError::NoSteadyState)
}

/// Gain and updated covariance (Joseph's form) of the predicted one.
fn finish(
    predicted: DMatrix<f64>,
    h: &DMatrix<f64>,
    r: &DVector<f64>,
    doublings: usize,
) -> Result<SteadyState, EstimatorError> {
    let (n, outputs) = (predicted.nrows(), r.len());
    let cross = product(h, &predicted);
    let mut innovation = product(&cross, &h.transpose());
    (0..outputs).for_each(|j| innovation[(j, j)] += r[j]);
    symmetrise(innovation.as_mut_slice(), outputs);
    let mut root = innovation.clone();
    if !factor_cholesky(root.as_mut_slice(), outputs) {
        return Err(EstimatorError::NoSteadyState);
    }
    let mut transposed = cross;
    for column in transposed.as_mut_slice().chunks_exact_mut(outputs.max(1)) {
        solve_upper_transposed(root.as_slice(), outputs, column);
        solve_upper(root.as_slice(), outputs, column);
    }
    let gain = transposed.transpose();
    let left = DMatrix::identity(n, n) - product(&gain, h);
    let noise = DMatrix::from_fn(n, outputs, |i, j| gain[(i, j)] * r[j]);
    let moved = product(&product(&left, &predicted), &left.transpose());
    let mut updated = moved + product(&noise, &transposed);
    symmetrise(updated.as_mut_slice(), n);
    Ok(SteadyState { predicted, updated, gain, innovation, doublings })
}

/// What a doubling did to the covariance.
enum Growth {
    Settled,
    Grows,
    Unbounded,
}

/// The iterates `A`, `G`, `X` and memory. All matrices have `high` rows, `n` padded to a multiple of four.
struct Doubling {
    n: usize,
    high: usize,
    a: Vec<f64>,
    a_transposed: Vec<f64>,
    g: Vec<f64>,
    x: Vec<f64>,
    /// `I + G X`, then its factors: (n, n).
    w: Vec<f64>,
    exchanges: Vec<usize>,
    /// `[A; X] W`: (2 high, n).
    stack: Vec<f64>,
    /// Upper and lower half of `stack`: (high, n).
    half: Vec<f64>,
    product: Vec<f64>,
    product_2: Vec<f64>,
}

impl WithSimd for &mut Doubling {
    type Output = Growth;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Growth {
        self.step()
    }
}

impl Doubling {
    fn new(f: &DMatrix<f64>, information: &DMatrix<f64>, q: &DMatrix<f64>) -> Self {
        let n = f.nrows();
        let high = padded(n);
        let load = |element: &dyn Fn(usize, usize) -> f64| {
            let mut a = vec![0.0; high * n];
            for (j, column) in a.chunks_exact_mut(high.max(1)).enumerate() {
                (0..n).for_each(|i| column[i] = element(i, j));
            }
            a
        };
        let zeros = || vec![0.0; high * n];
        Self {
            n,
            high,
            a: load(&|i, j| f[(j, i)]),
            a_transposed: load(&|i, j| f[(i, j)]),
            g: load(&|i, j| information[(i, j)]),
            x: load(&|i, j| 0.5 * (q[(i, j)] + q[(j, i)])),
            w: vec![0.0; n * n],
            exchanges: vec![0; n],
            stack: vec![0.0; 2 * high * n],
            half: zeros(),
            product: zeros(),
            product_2: zeros(),
        }
    }

    fn solution(&self) -> DMatrix<f64> {
        DMatrix::from_fn(self.n, self.n, |i, j| self.x[j * self.high + i])
    }

    /// One doubling.
    #[inline(always)]
    fn step(&mut self) -> Growth {
        let (n, high) = (self.n, self.high);
        if n == 0 {
            return Growth::Settled;
        }
        multiply_columns(&self.g, &self.x, high, n, &mut self.product);
        for (j, (w, product)) in self.w.chunks_exact_mut(n).zip(self.product.chunks_exact(high)).enumerate() {
            w.copy_from_slice(&product[..n]);
            w[j] += 1.0;
        }
        if !factor_lu(&mut self.w, n, &mut self.exchanges) {
            return Growth::Unbounded;
        }
        self.divide_by_w();
        let growth = self.grow_covariance();
        if matches!(growth, Growth::Grows) {
            self.double_dynamics();
        }
        growth
    }

    /// `stack = [A; X] (I + G X)^-1`, column by column, all rows at once.
    #[inline(always)]
    fn divide_by_w(&mut self) {
        let (n, high) = (self.n, self.high);
        let tall = 2 * high;
        for (j, to) in self.stack.chunks_exact_mut(tall).enumerate() {
            to[..high].copy_from_slice(column(&self.a, high, j));
            to[high..].copy_from_slice(column(&self.x, high, j));
        }
        for j in 0..n {
            let (before, rest) = self.stack.split_at_mut(j * tall);
            let (target, u) = (&mut rest[..tall], column(&self.w, n, j));
            subtract_columns(target, before, u);
            let inverse = 1.0 / u[j];
            target.iter_mut().for_each(|t| *t *= inverse);
        }
        for j in (0..n).rev() {
            let (rest, after) = self.stack.split_at_mut((j + 1) * tall);
            let (target, l) = (&mut rest[j * tall..], &column(&self.w, n, j)[j + 1..]);
            subtract_columns(target, after, l);
        }
        for (j, &other) in self.exchanges.iter().enumerate().rev() {
            if other != j {
                let (left, right) = self.stack.split_at_mut(other * tall);
                column_mut(left, tall, j).swap_with_slice(&mut right[..tall]);
            }
        }
    }

    /// `X <- X + A^T (X W) A`; its growth is positive semi-definite.
    #[inline(always)]
    fn grow_covariance(&mut self) -> Growth {
        let (n, high) = (self.n, self.high);
        for (to, from) in self.half.chunks_exact_mut(high).zip(self.stack.chunks_exact(2 * high)) {
            to.copy_from_slice(&from[high..]);
        }
        multiply_columns(&self.half, &self.a, high, n, &mut self.product);
        multiply_columns(&self.a_transposed, &self.product, high, n, &mut self.product_2);
        let mut growth = Growth::Settled;
        for i in 0..n {
            let (added, x) = (self.product_2[i * high + i], self.x[i * high + i]);
            if !(x + added).is_finite() {
                return Growth::Unbounded;
            }
            if added > SETTLED * x {
                growth = Growth::Grows;
            }
        }
        add_symmetric(&mut self.x, &self.product_2, high, n);
        growth
    }

    /// `G <- G + (A W) G A^T` and `A <- (A W) A`.
    #[inline(always)]
    fn double_dynamics(&mut self) {
        let (n, high) = (self.n, self.high);
        for (to, from) in self.half.chunks_exact_mut(high).zip(self.stack.chunks_exact(2 * high)) {
            to.copy_from_slice(&from[..high]);
        }
        multiply_columns(&self.half, &self.g, high, n, &mut self.product);
        multiply_columns(&self.product, &self.a_transposed, high, n, &mut self.product_2);
        add_symmetric(&mut self.g, &self.product_2, high, n);
        multiply_columns(&self.half, &self.a, high, n, &mut self.product);
        core::mem::swap(&mut self.a, &mut self.product);
        for j in 0..n {
            for i in 0..n {
                self.a_transposed[i * high + j] = self.a[j * high + i];
            }
        }
    }
}

/// `A <- A + (B + B^T)/2` of matrices (n, n) with `high` rows.
#[inline(always)]
fn add_symmetric(a: &mut [f64], b: &[f64], high: usize, n: usize) {
    for j in 0..n {
        for i in 0..=j {
            let sum = a[j * high + i] + 0.5 * (b[j * high + i] + b[i * high + j]);
            a[j * high + i] = sum;
            a[i * high + j] = sum;
        }
    }
}

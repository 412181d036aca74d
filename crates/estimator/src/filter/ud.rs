//! Covariance as `P = U diag(d) U^T` with unit upper triangular `U`: the form of Bierman and Thornton.
//!
//! No step subtracts covariances, so `P` stays symmetric and positive semi-definite whatever the rounding, at about
//! the cost of the plain formulas and without square roots. Zero variances (`d_j = 0`) are allowed everywhere.
//!
//! * measurement: Bierman's rank-one update, one scalar at a time;
//! * time: Thornton's modified weighted Gram-Schmidt on `[Phi U, G]` with weights `[d, q]`. Trailing states are
//!   constants: with `U = [U_x U_xy; 0 U_y]` their `U_y, d_y` stay, `U_xy <- Phi_xx U_xy + Phi_xy U_y`, and only
//!   `[Phi_xx U_x, G]` is orthogonalised;
//! * added variance: Agee and Turner's rank-one update.
//!
//! Source: Bierman 1977 (chapters III, V, VI), Thornton 1976.
use nalgebra::{DMatrix, DVector};

use super::factor::{factor_udu, mirror};
use super::kernel::{axpy, column, column_mut, dot};
use super::state_space::Linearisation;
use crate::EstimatorError;
use thornton::TimeUpdate;

mod thornton;

/// Factors of a covariance of `n` states, with the memory that its updates work in.
///
/// # Shapes
/// `U`: (n, n) unit upper triangular; `d`: (n), not negative.
#[derive(Clone, Debug)]
pub struct UdFactors {
    u: DMatrix<f64>,
    d: DVector<f64>,
    /// `U^T h` in an update, `v` in a rank-one update.
    f: DVector<f64>,
    work: TimeUpdate,
}

impl UdFactors {
    /// Factors of the covariance `p`, which may be singular and may hold zero variances.
    ///
    /// A variance that the later states explain up to rounding (`n` epsilon of itself) counts as explained in full.
    ///
    /// # Errors
    /// `p` is not finite, not symmetric, or not positive semi-definite.
    pub fn from_covariance(p: &DMatrix<f64>) -> Result<Self, EstimatorError> {
        let mut factors = Self::zeros(p.nrows());
        factors.factorise(|u| u.copy_from(p))?;
        Ok(factors)
    }

    /// Memory for factors of `n` states.
    pub(crate) fn zeros(n: usize) -> Self {
        let d = DVector::zeros(n);
        Self { u: DMatrix::zeros(n, n), f: d.clone(), d, work: TimeUpdate::default() }
    }

    /// Become the factors of the covariance that `write` makes; of a regular one without allocating.
    ///
    /// # Errors
    /// As [`from_covariance`](Self::from_covariance).
    pub(crate) fn factorise(&mut self, write: impl FnOnce(&mut DMatrix<f64>)) -> Result<(), EstimatorError> {
        write(&mut self.u);
        factor_udu(self.u.as_mut_slice(), self.d.as_mut_slice())
    }

    /// Make room for a process with `leading` moving states and `noises` noise sources, so that not even the first
    /// [`predict`](Self::predict) allocates.
    pub(crate) fn reserve(&mut self, leading: usize, noises: usize) {
        self.work.reserve(self.states(), leading, noises);
    }

    /// Number of states `n`.
    pub(crate) fn states(&self) -> usize {
        self.d.len()
    }

    /// The factor `U`: (n, n).
    pub(crate) fn unit_upper(&self) -> &DMatrix<f64> {
        &self.u
    }

    /// The factor `d`: (n).
    pub fn diagonal(&self) -> &DVector<f64> {
        &self.d
    }

    /// Take over the covariance of `other`, of the same size, without allocating.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        self.u.copy_from(&other.u);
        self.d.copy_from(&other.d);
    }

    /// The covariance `P`: (n, n).
    pub fn covariance(&self) -> DMatrix<f64> {
        let mut p = self.u.clone();
        self.covariance_into(&mut p);
        p
    }

    /// Write the covariance `P` into `p`: (n, n).
    pub(crate) fn covariance_into(&self, p: &mut DMatrix<f64>) {
        self.write_covariance(p.as_mut_slice());
    }

    /// Write the covariance `P` into a column-major slice of length n^2.
    pub(crate) fn write_covariance(&self, p: &mut [f64]) {
        let n = self.states();
        p.fill(0.0);
        for (l, &d) in self.d.as_slice().iter().enumerate() {
            let u = &column(self.u.as_slice(), n, l)[..=l];
            for j in 0..=l {
                axpy(d * u[j], &u[..=j], &mut column_mut(p, n, j)[..=j]);
            }
        }
        mirror(p, n);
    }

    /// Variance of state `i`.
    pub fn variance(&self, i: usize) -> f64 {
        let (n, u) = (self.states(), self.u.as_slice());
        (i..n).map(|j| self.d[j] * u[j * n + i] * u[j * n + i]).sum()
    }

    /// Write the covariance of state `i` with all states: (n).
    pub(crate) fn write_column(&self, i: usize, y: &mut [f64]) {
        let (n, u) = (self.states(), self.u.as_slice());
        y.fill(0.0);
        for (j, d) in self.d.as_slice().iter().enumerate().skip(i) {
            let u = &column(u, n, j)[..=j];
            axpy(d * u[i], u, y);
        }
    }

    /// Variance `h^T P h` of a linear function of the state; `h`: (n).
    pub fn quadratic(&self, h: &[f64]) -> f64 {
        let (n, u) = (self.states(), self.u.as_slice());
        (0..n)
            .map(|j| {
                let f = dot(&column(u, n, j)[..=j], h);
                f * f * self.d[j]
            })
            .sum()
    }

    /// Time update `P <- F P F^T + G diag(q) G^T` (Thornton).
    ///
    /// # Panics
    /// The sizes of `linear` are not those of this covariance.
    pub fn predict(&mut self, linear: &Linearisation) {
        let n = self.states();
        assert_eq!(linear.phi.ncols(), n, "the transition has as many columns as there are states");
        self.work.run(linear, self.u.as_mut_slice(), self.d.as_mut_slice());
    }

    /// Variance `h^T P h` of a linear function of the state, kept for `update_projected`; `h`: (n).
    pub(crate) fn project(&mut self, h: &[f64]) -> f64 {
        let n = self.states();
        let (u, f) = (self.u.as_slice(), self.f.as_mut_slice());
        f.fill(0.0);
        // A gradient has few elements: row by row.
        for (i, &h) in h.iter().enumerate().filter(|(_, h)| **h != 0.0) {
            f.iter_mut().enumerate().skip(i).for_each(|(j, f)| *f += h * u[j * n + i]);
        }
        f.iter().zip(self.d.as_slice()).map(|(f, d)| f * f * d).sum()
    }

    /// Update by a scalar measurement `z = h^T x + v`, `v ~ N(0, r)` (Bierman); `h`: (n), `r >= 0`.
    ///
    /// Writes the gain `K = P h / S` into `gain` (n) and returns `S = h^T P h + r`. If `S = 0`, nothing was left to
    /// learn: the gain is zero.
    pub fn update(&mut self, h: &[f64], r: f64, gain: &mut [f64]) -> f64 {
        self.project(h);
        self.update_projected(r, gain)
    }

    /// As [`update`](Self::update), with the `h` of the last [`project`](Self::project); nothing may have changed the
    /// covariance since.
    pub(crate) fn update_projected(&mut self, r: f64, gain: &mut [f64]) -> f64 {
        let (u, d, f) = (self.u.as_mut_slice(), self.d.as_mut_slice(), self.f.as_slice());
        bierman(u, d, f, r, gain)
    }

    /// `P <- P + c v v^T` with `c >= 0` (Agee and Turner); `v`: (n).
    pub fn add_rank_one(&mut self, c: f64, v: &[f64]) {
        self.f.as_mut_slice().copy_from_slice(v);
        self.add_leading(c, v.len());
    }

    /// Rank-one update of the leading block of `size` states by `c v v^T` with `v = f[..size]`.
    fn add_leading(&mut self, mut c: f64, size: usize) {
        let n = self.states();
        let v = &mut self.f.as_mut_slice()[..size];
        for j in (0..size).rev() {
            let s = v[j];
            let old = self.d[j];
            let new = old + c * s * s;
            if s == 0.0 || new == 0.0 {
                continue;
            }
            let b = c * s / new;
            for (u, v) in column_mut(self.u.as_mut_slice(), n, j)[..j].iter_mut().zip(v.iter_mut()) {
                *v -= s * *u;
                *u += b * *v;
            }
            self.d[j] = new;
            c *= old / new;
        }
    }

    /// Add `variance` to state `i`, its covariances unchanged.
    pub(crate) fn inflate(&mut self, i: usize, variance: f64) {
        self.f.fill(0.0);
        self.f[i] = 1.0;
        self.add_leading(variance, i + 1);
    }

    /// Multiply state `i` by a positive factor: its variance by the square, its covariances by the factor.
    pub fn scale(&mut self, i: usize, factor: f64) {
        let n = self.states();
        let u = self.u.as_mut_slice();
        for j in i + 1..n {
            u[j * n + i] *= factor;
        }
        for above in &mut column_mut(u, n, i)[..i] {
            *above /= factor;
        }
        self.d[i] *= factor * factor;
    }

    /// Make state `i` independent of all others, with the given variance: an event has reset it.
    pub(crate) fn decorrelate_and_set(&mut self, i: usize, variance: f64) {
        let n = self.states();
        let u = self.u.as_mut_slice();
        for j in i + 1..n {
            u[j * n + i] = 0.0;
        }
        // What state i explained in the states before it remains theirs.
        let explained = &mut column_mut(u, n, i)[..i];
        self.f.as_mut_slice()[..i].copy_from_slice(explained);
        explained.fill(0.0);
        let d = core::mem::replace(&mut self.d[i], variance);
        self.add_leading(d, i);
    }
}

/// Bierman's update with `f = U^T h`; writes the gain and returns the innovation's variance.
fn bierman(u: &mut [f64], d: &mut [f64], f: &[f64], r: f64, gain: &mut [f64]) -> f64 {
    let n = d.len();
    gain.fill(0.0);
    let mut s = r;
    for (((j, u), d), &f) in u.chunks_exact_mut(n.max(1)).enumerate().zip(d).zip(f) {
        let v = f * *d;
        let before = s;
        s += f * v;
        if v == 0.0 || s == 0.0 {
            continue;
        }
        *d *= before / s;
        // Where no noise and no variance came before, the gain collected so far is zero.
        let p = if before > 0.0 { -f / before } else { 0.0 };
        // The diagonal of U is 1 and what is below it 0, and so is the gain from here on: whole groups of four may take part.
        let height = (j / 4 * 4 + 4).min(n);
        learn(&mut u[..height], &mut gain[..height], p, v);
    }
    if s > 0.0 {
        let inverse = 1.0 / s;
        gain.iter_mut().for_each(|b| *b *= inverse);
    }
    s
}

/// Update a column of `U` by the gain so far, and the gain by the column.
#[inline]
fn learn(u: &mut [f64], gain: &mut [f64], p: f64, v: f64) {
    for (u, b) in u.iter_mut().zip(gain) {
        let old = *u;
        *u += *b * p;
        *b += old * v;
    }
}

#[cfg(test)]
mod tests;

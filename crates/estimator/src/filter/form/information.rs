//! Inverse covariance as `P^-1 = R^T R` with upper triangular `R`: the square-root information form.
//!
//! * measurement: `Theta [R; h^T / sqrt r] = [R'; 0]` by Givens rotations;
//! * time: with `A = R F^-1`, `Theta [I, 0; -A G diag(sqrt q), A] = [., .; 0, R']` by Householder reflections. With
//!   `R = [R_x R_xy; 0 R_y]` the trailing constants keep their `R_y`.
//!
//! It needs a covariance and a transition of full rank and noise on every measurement. Source: Dyer and McReynolds
//! 1969; Bierman 1977, chapters V and VI.
use nalgebra::allocator::Allocator;
use nalgebra::{DefaultAllocator, Dim, OMatrix, OVector, U1};

use super::CovarianceForm;
use crate::EstimatorError;
use crate::filter::dense::{
    factor_lu, householder, reflect, set_identity, solve_lu_transposed, solve_upper, solve_upper_transposed,
};
use crate::filter::factor::{factor_root, square_root};
use crate::filter::kernel::{axpy, column, column_mut, dot};
use crate::filter::state_space::Linearisation;

/// Square root of an inverse covariance of `n` states. `R`: (n, n) upper triangular.
#[derive(Clone, Debug)]
pub struct Information<D: Dim>
where
    DefaultAllocator: Allocator<D, D> + Allocator<D>,
{
    r: OMatrix<f64, D, D>,
    work: OVector<f64, D>,
    array: Array,
}

/// Memory of the time update.
#[derive(Clone, Debug, Default)]
struct Array {
    /// `[I, 0; -A G diag(sqrt q), A]`: (k + m, k + n).
    array: Vec<f64>,
    /// Factors of `Phi_xx`: (m, m).
    lu: Vec<f64>,
    exchanges: Vec<usize>,
    /// One row of `R_x` or of `A`: (m).
    row: Vec<f64>,
}

impl<D: Dim> Information<D>
where
    DefaultAllocator: Allocator<D, D> + Allocator<D>,
{
    /// From the covariance `p`.
    ///
    /// # Errors
    /// `p` is not finite, not symmetric, or not positive definite.
    pub fn from_covariance(p: &OMatrix<f64, D, D>) -> Result<Self, EstimatorError> {
        let mut s = p.clone();
        let mut work = OVector::zeros_generic(p.shape_generic().0, U1);
        factor_root(s.as_mut_slice(), work.as_mut_slice())?;
        if let Some(state) = work.iter().position(|d| *d == 0.0) {
            return Err(EstimatorError::CovarianceSingular { state });
        }
        let mut r = p.clone();
        invert_upper(s.as_slice(), r.as_mut_slice(), p.nrows());
        Ok(Self { r, work, array: Array::default() })
    }

    /// The factor `R`: (n, n).
    pub fn root(&self) -> &OMatrix<f64, D, D> {
        &self.r
    }

    /// Write `A = R F^-1` behind the columns of the noise, and `-A G diag(sqrt q)` and the identity into these.
    ///
    /// # Errors
    /// The transition has no inverse.
    fn load(&mut self, linear: &Linearisation) -> Result<(), EstimatorError> {
        let (m, n, k) = (linear.phi.nrows(), self.states(), linear.q.len());
        let Array { array, lu, exchanges, row } = &mut self.array;
        lu.copy_from_slice(&linear.phi.as_slice()[..m * m]);
        if !factor_lu(lu, m, exchanges) {
            return Err(EstimatorError::TransitionSingular);
        }
        let high = k + m;
        array.fill(0.0);
        for i in 0..m {
            (0..m).for_each(|j| row[j] = if j >= i { self.r[(i, j)] } else { 0.0 });
            solve_lu_transposed(lu, m, exchanges, row);
            for l in 0..k {
                array[l * high + k + i] = -linear.q[l].sqrt() * dot(row, column(linear.g.as_slice(), m, l));
            }
            for j in 0..n {
                let moved = dot(row, column(linear.phi.as_slice(), m, j));
                array[(k + j) * high + k + i] = if j < m { row[j] } else { self.r[(i, j)] - moved };
            }
        }
        (0..k).for_each(|l| array[l * high + l] = 1.0);
        Ok(())
    }

    /// Triangularise the first `k + m` columns of the array and take the rows of the state from it.
    fn triangularise(&mut self, m: usize, k: usize) {
        let (n, high) = (self.states(), k + m);
        let array = &mut self.array.array;
        for j in 0..k + m {
            let (before, after) = array.split_at_mut((j + 1) * high);
            let v = &mut before[j * high + j..];
            let (diagonal, beta) = householder(v, 0);
            for other in after.chunks_exact_mut(high) {
                reflect(beta, v, &mut other[j..]);
            }
            v.fill(0.0);
            v[0] = diagonal;
        }
        for j in 0..n {
            let rows = m.min(j + 1);
            column_mut(self.r.as_mut_slice(), n, j)[..rows]
                .copy_from_slice(&column(array, high, k + j)[k..k + rows]);
        }
    }

    /// `x <- R^-T h`.
    fn whiten(&self, h: &[f64], x: &mut [f64]) {
        x.copy_from_slice(h);
        solve_upper_transposed(self.r.as_slice(), self.states(), x);
    }
}

/// `R = S^-1` of upper triangular matrices (n, n).
fn invert_upper(s: &[f64], r: &mut [f64], n: usize) {
    set_identity(r, n);
    for r in r.chunks_exact_mut(n) {
        solve_upper(s, n, r);
    }
}

impl<D: Dim> CovarianceForm for Information<D>
where
    DefaultAllocator: Allocator<D, D> + Allocator<D>,
{
    fn states(&self) -> usize {
        self.r.nrows()
    }

    fn reserve(&mut self, leading: usize, noises: usize) {
        let Array { array, lu, exchanges, row } = &mut self.array;
        array.resize((noises + leading) * (noises + self.r.nrows()), 0.0);
        lu.resize(leading * leading, 0.0);
        exchanges.resize(leading, 0);
        row.resize(leading, 0.0);
    }

    fn copy_from(&mut self, other: &Self) {
        self.r.copy_from(&other.r);
    }

    fn predict(&mut self, linear: &Linearisation) -> Result<(), EstimatorError> {
        let (m, k) = (linear.phi.nrows(), linear.q.len());
        if m > 0 {
            self.reserve(m, k);
            self.load(linear)?;
            self.triangularise(m, k);
        }
        Ok(())
    }

    fn update(&mut self, h: &[f64], r: f64, gain: &mut [f64]) -> Result<f64, EstimatorError> {
        if r.is_nan() || r <= 0.0 {
            return Err(EstimatorError::NoiseNotPositive { variance: r });
        }
        let n = self.states();
        self.whiten(h, gain);
        let s = r + dot(gain, gain);
        let row = self.work.as_mut_slice();
        for (row, h) in row.iter_mut().zip(h) {
            *row = h / r.sqrt();
        }
        for i in 0..n {
            let longer = self.r[(i, i)].hypot(row[i]);
            let (cosine, sine) = (self.r[(i, i)] / longer, row[i] / longer);
            for (r, row) in self.r.as_mut_slice()[i * n + i..].iter_mut().step_by(n).zip(&mut row[i..]) {
                let old = *r;
                *r = cosine * old + sine * *row;
                *row = cosine * *row - sine * old;
            }
        }
        self.covariance_with(h, gain);
        gain.iter_mut().for_each(|k| *k /= r);
        Ok(s)
    }

    fn add_rank_one(&mut self, c: f64, v: &[f64]) {
        let n = self.states();
        self.reserve(n, 1);
        let array = &mut self.array.array;
        array.fill(0.0);
        array[0] = 1.0;
        for (j, v) in v.iter().enumerate() {
            let r = &column(self.r.as_slice(), n, j)[..=j];
            axpy(-c.sqrt() * v, r, &mut array[1..=n]);
            column_mut(array, n + 1, j + 1)[1..j + 2].copy_from_slice(r);
        }
        self.triangularise(n, 1);
    }

    fn covariance_with(&self, h: &[f64], y: &mut [f64]) {
        self.whiten(h, y);
        solve_upper(self.r.as_slice(), self.states(), y);
    }

    fn variance(&self, i: usize) -> f64 {
        let mut x = vec![0.0; self.states()];
        x[i] = 1.0;
        solve_upper_transposed(self.r.as_slice(), x.len(), &mut x);
        dot(&x, &x)
    }

    fn write_covariance(&self, p: &mut [f64]) {
        let n = self.states();
        let mut s = self.r.clone();
        invert_upper(self.r.as_slice(), s.as_mut_slice(), n);
        square_root(s.as_slice(), n, p);
    }
}

//! Covariance as `P = S S^T` with upper triangular `S`, moved by orthogonal transformations of arrays.
//!
//! * time: `[G diag(sqrt q), Phi_xx S_x] Theta = [0, S_x']` by Householder reflections, last row first. Trailing
//!   states are constants, whose columns move alone, as in [`UdFactors`](crate::filter::UdFactors);
//! * measurement: `[sqrt r, h^T S; 0, S] Theta = [sqrt(S_e), 0; K sqrt(S_e), S']` by Givens rotations, one per column.
//!
//! Source: Carlson 1973; Kailath, Sayed and Hassibi 2000, chapter 12.
use nalgebra::allocator::Allocator;
use nalgebra::{DefaultAllocator, Dim, OMatrix, OVector, U1};

use super::CovarianceForm;
use crate::EstimatorError;
use crate::filter::dense::{householder, reflect};
use crate::filter::factor::{factor_root, square_root};
use crate::filter::kernel::{axpy, column, column_mut, dot};
use crate::filter::state_space::Linearisation;

/// Square root of a covariance of `n` states. `S`: (n, n) upper triangular.
#[derive(Clone, Debug)]
pub struct SquareRoot<D: Dim>
where
    DefaultAllocator: Allocator<D, D> + Allocator<D>,
{
    s: OMatrix<f64, D, D>,
    work: OVector<f64, D>,
    /// Rows of `[G diag(sqrt q), Phi_xx S_x]` as columns: (k + m, m).
    rows: Vec<f64>,
}

impl<D: Dim> SquareRoot<D>
where
    DefaultAllocator: Allocator<D, D> + Allocator<D>,
{
    /// Square root of the covariance `p`, which may be singular.
    ///
    /// # Errors
    /// `p` is not finite, not symmetric, or not positive semi-definite.
    pub fn from_covariance(p: &OMatrix<f64, D, D>) -> Result<Self, EstimatorError> {
        let mut s = p.clone();
        let mut work = OVector::zeros_generic(p.shape_generic().0, U1);
        factor_root(s.as_mut_slice(), work.as_mut_slice())?;
        Ok(Self { s, work, rows: Vec::new() })
    }

    /// The factor `S`: (n, n).
    pub fn root(&self) -> &OMatrix<f64, D, D> {
        &self.s
    }

    /// `F S`: columns of moving states become rows to triangularise, those of constants are final.
    fn transform(&mut self, linear: &Linearisation) {
        let (m, n) = linear.phi.shape();
        let k = linear.q.len();
        let moved = &mut self.work.as_mut_slice()[..m];
        for j in 0..n {
            let s = column_mut(self.s.as_mut_slice(), n, j);
            moved.fill(0.0);
            for (phi, s) in linear.phi.as_slice().chunks_exact(m).zip(&s[..=j]) {
                axpy(*s, phi, moved);
            }
            if j < m {
                for (to, from) in self.rows[k + j..].iter_mut().step_by(k + m).zip(moved.iter()) {
                    *to = *from;
                }
            } else {
                s[..m].copy_from_slice(moved);
            }
        }
        for (l, &q) in linear.q.iter().enumerate() {
            let root = q.sqrt();
            for i in 0..m {
                self.rows[i * (k + m) + l] = root * linear.g[(i, l)];
            }
        }
    }

    /// Reflect the rows, last one first, until only the triangle at their end is left.
    fn triangularise(&mut self, m: usize, k: usize) {
        let (n, width) = (self.states(), k + m);
        for j in (0..m).rev() {
            let (before, row) = self.rows[..(j + 1) * width].split_at_mut(j * width);
            let active = k + j + 1;
            let (diagonal, beta) = householder(&mut row[..active], k + j);
            let s = column_mut(self.s.as_mut_slice(), n, j);
            // Either sign of a column gives the same covariance: the diagonal is kept positive.
            let sign = 1.0_f64.copysign(diagonal);
            for (other, s) in before.chunks_exact_mut(width).zip(s.iter_mut()) {
                reflect(beta, &row[..active], &mut other[..active]);
                *s = sign * other[k + j];
            }
            s[j] = diagonal.abs();
        }
    }
}

impl<D: Dim> CovarianceForm for SquareRoot<D>
where
    DefaultAllocator: Allocator<D, D> + Allocator<D>,
{
    fn states(&self) -> usize {
        self.s.nrows()
    }

    fn reserve(&mut self, leading: usize, noises: usize) {
        self.rows.resize((leading + noises) * leading, 0.0);
    }

    fn copy_from(&mut self, other: &Self) {
        self.s.copy_from(&other.s);
    }

    fn predict(&mut self, linear: &Linearisation) -> Result<(), EstimatorError> {
        let (m, k) = (linear.phi.nrows(), linear.q.len());
        if m > 0 {
            self.reserve(m, k);
            self.transform(linear);
            self.triangularise(m, k);
        }
        Ok(())
    }

    fn update(&mut self, h: &[f64], r: f64, gain: &mut [f64]) -> Result<f64, EstimatorError> {
        let n = self.states();
        gain.fill(0.0);
        let mut root = r.sqrt();
        for j in 0..n {
            let s = &mut column_mut(self.s.as_mut_slice(), n, j)[..=j];
            let f = dot(s, h);
            let longer = root.hypot(f);
            if longer == 0.0 {
                continue;
            }
            let (cosine, sine) = (root / longer, f / longer);
            root = longer;
            for (s, b) in s.iter_mut().zip(gain.iter_mut()) {
                let old = *s;
                *s = cosine * old - sine * *b;
                *b = cosine * *b + sine * old;
            }
        }
        if root > 0.0 {
            gain.iter_mut().for_each(|b| *b /= root);
        }
        Ok(root * root)
    }

    fn add_rank_one(&mut self, c: f64, v: &[f64]) {
        let n = self.states();
        let w = self.work.as_mut_slice();
        for (w, v) in w.iter_mut().zip(v) {
            *w = c.sqrt() * v;
        }
        for j in (0..n).rev() {
            let s = &mut column_mut(self.s.as_mut_slice(), n, j)[..=j];
            let longer = s[j].hypot(w[j]);
            if longer == 0.0 {
                continue;
            }
            let (cosine, sine) = (s[j] / longer, w[j] / longer);
            for (s, w) in s.iter_mut().zip(w.iter_mut()) {
                let old = *s;
                *s = cosine * old + sine * *w;
                *w = cosine * *w - sine * old;
            }
        }
    }

    fn covariance_with(&self, h: &[f64], y: &mut [f64]) {
        let n = self.states();
        y.fill(0.0);
        for j in 0..n {
            let s = &column(self.s.as_slice(), n, j)[..=j];
            axpy(dot(s, h), s, y);
        }
    }

    fn variance(&self, i: usize) -> f64 {
        (i..self.states()).map(|j| self.s[(i, j)].powi(2)).sum()
    }

    fn write_covariance(&self, p: &mut [f64]) {
        square_root(self.s.as_slice(), self.states(), p);
    }
}

//! How a covariance is carried: two forms with the same steps, equal up to rounding.
//!
//! | form | carries | accuracy | costs |
//! |---|---|---|---|
//! | [`UdFactors`] | `P = U diag(d) U^T` | never indefinite, singular `P` allowed | least |
//! | [`Joseph`] | `P` itself | loses small eigenvalues of ill-conditioned problems | dense products: the reference |
use nalgebra::allocator::Allocator;
use nalgebra::{DMatrix, DefaultAllocator, Dim};

use super::kernel::dot;
use super::state_space::Linearisation;
use super::ud::UdFactors;

mod joseph;

pub use joseph::Joseph;

/// A covariance `P` of `n` states that can be moved in time and updated by scalar measurements.
///
/// No step allocates once [`reserve`](Self::reserve) has seen the sizes of the process.
pub trait CovarianceForm: Clone {
    /// Number of states `n`.
    fn states(&self) -> usize;

    /// Make room for a process with `leading` moving states and `noises` noise sources.
    fn reserve(&mut self, leading: usize, noises: usize);

    /// Take over the covariance of `other`, of the same size, without allocating.
    fn copy_from(&mut self, other: &Self);

    /// Time update `P <- F P F^T + G diag(q) G^T`.
    fn predict(&mut self, linear: &Linearisation);

    /// Update by a scalar measurement `z = h^T x + v`, `v ~ N(0, r)`; writes the gain `K = P h / S` (n), returns
    /// `S = h^T P h + r`. If `S = 0`, the gain is zero.
    fn update(&mut self, h: &[f64], r: f64, gain: &mut [f64]) -> f64;

    /// `P <- P + c v v^T` with `c >= 0`; `v`: (n).
    fn add_rank_one(&mut self, c: f64, v: &[f64]);

    /// Covariance `y = P h` of every state with a linear function of the state; `h` and `y`: (n).
    fn covariance_with(&self, h: &[f64], y: &mut [f64]);

    /// Variance `S = h^T P h + r` of an innovation; `h`: (n), `work`: (n), of no meaning afterwards.
    fn innovation_variance(&self, h: &[f64], r: f64, work: &mut [f64]) -> f64 {
        self.covariance_with(h, work);
        dot(h, work) + r
    }

    /// Variance of state `i`.
    fn variance(&self, i: usize) -> f64;

    /// Write `P` into a column-major slice of length n^2.
    fn write_covariance(&self, p: &mut [f64]);

    /// The covariance `P`: (n, n).
    fn to_dense(&self) -> DMatrix<f64> {
        let mut p = DMatrix::zeros(self.states(), self.states());
        self.write_covariance(p.as_mut_slice());
        p
    }
}

impl<D: Dim> CovarianceForm for UdFactors<D>
where
    DefaultAllocator: Allocator<D, D> + Allocator<D>,
{
    fn states(&self) -> usize {
        self.states()
    }

    fn reserve(&mut self, leading: usize, noises: usize) {
        self.reserve(leading, noises);
    }

    fn copy_from(&mut self, other: &Self) {
        self.copy_from(other);
    }

    fn predict(&mut self, linear: &Linearisation) {
        self.predict(linear);
    }

    fn update(&mut self, h: &[f64], r: f64, gain: &mut [f64]) -> f64 {
        self.update(h, r, gain)
    }

    fn add_rank_one(&mut self, c: f64, v: &[f64]) {
        self.add_rank_one(c, v);
    }

    fn covariance_with(&self, h: &[f64], y: &mut [f64]) {
        self.covariance_with(h, y);
    }

    fn innovation_variance(&self, h: &[f64], r: f64, _work: &mut [f64]) -> f64 {
        self.quadratic(h) + r
    }

    fn variance(&self, i: usize) -> f64 {
        self.variance(i)
    }

    fn write_covariance(&self, p: &mut [f64]) {
        self.write_covariance(p);
    }
}

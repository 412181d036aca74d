//! The covariance itself, updated in Joseph's form `(I - K h^T) P (I - K h^T)^T + K r K^T`.
use nalgebra::allocator::Allocator;
use nalgebra::{DefaultAllocator, Dim, OMatrix};

use super::CovarianceForm;
use crate::EstimatorError;
use crate::filter::dense::{add_product, add_product_transposed, set_identity, symmetrise};
use crate::filter::factor::factor_udu;
use crate::filter::kernel::{axpy, dot};
use crate::filter::state_space::Linearisation;

/// A dense covariance: the reference against which the factors are compared.
///
/// Source: Bucy and Joseph 1968.
#[derive(Clone, Debug)]
pub struct Joseph<D: Dim>
where
    DefaultAllocator: Allocator<D, D>,
{
    p: OMatrix<f64, D, D>,
    left: OMatrix<f64, D, D>,
    product: OMatrix<f64, D, D>,
}

impl<D: Dim> Joseph<D>
where
    DefaultAllocator: Allocator<D, D>,
{
    /// The covariance `p`, which may be singular.
    ///
    /// # Errors
    /// `p` is not finite, not symmetric, or not positive semi-definite.
    pub fn from_covariance(p: &OMatrix<f64, D, D>) -> Result<Self, EstimatorError> {
        let mut left = p.clone();
        factor_udu(left.as_mut_slice(), &mut vec![0.0; p.nrows()])?;
        let mut own = p.clone();
        symmetrise(own.as_mut_slice(), p.nrows());
        Ok(Self { product: own.clone(), p: own, left })
    }

    /// The covariance `P`: (n, n).
    pub fn covariance(&self) -> &OMatrix<f64, D, D> {
        &self.p
    }
}

impl<D: Dim> CovarianceForm for Joseph<D>
where
    DefaultAllocator: Allocator<D, D>,
{
    fn states(&self) -> usize {
        self.p.nrows()
    }

    fn reserve(&mut self, _leading: usize, _noises: usize) {}

    fn copy_from(&mut self, other: &Self) {
        self.p.copy_from(&other.p);
    }

    fn predict(&mut self, linear: &Linearisation) {
        let (m, n) = linear.phi.shape();
        let (p, product) = (self.p.as_mut_slice(), &mut self.product.as_mut_slice()[..m * n]);
        product.fill(0.0);
        add_product(product, 1.0, linear.phi.as_slice(), p, m);
        let moved = &mut self.left.as_mut_slice()[..m * m];
        moved.fill(0.0);
        add_product_transposed(moved, product, |_| 1.0, linear.phi.as_slice(), m, m);
        let g = linear.g.as_slice();
        add_product_transposed(moved, g, |l| linear.q[l], g, m, m);
        for j in 0..n {
            for i in 0..m {
                let value = if j < m { moved[j * m + i] } else { product[j * m + i] };
                p[j * n + i] = value;
                if j >= m {
                    p[i * n + j] = value;
                }
            }
        }
        symmetrise(p, n);
    }

    fn update(&mut self, h: &[f64], r: f64, gain: &mut [f64]) -> f64 {
        let n = self.states();
        self.covariance_with(h, gain);
        let s = dot(gain, h) + r;
        if s <= 0.0 {
            gain.fill(0.0);
            return 0.0;
        }
        gain.iter_mut().for_each(|k| *k /= s);
        let left = self.left.as_mut_slice();
        set_identity(left, n);
        for (left, h) in left.chunks_exact_mut(n).zip(h) {
            axpy(-h, gain, left);
        }
        let (p, product) = (self.p.as_mut_slice(), self.product.as_mut_slice());
        product.fill(0.0);
        add_product(product, 1.0, left, p, n);
        p.fill(0.0);
        add_product_transposed(p, product, |_| 1.0, left, n, n);
        add_product_transposed(p, gain, |_| r, gain, n, n);
        symmetrise(p, n);
        s
    }

    fn add_rank_one(&mut self, c: f64, v: &[f64]) {
        let n = self.states();
        add_product_transposed(self.p.as_mut_slice(), v, |_| c, v, n, n);
    }

    fn covariance_with(&self, h: &[f64], y: &mut [f64]) {
        y.fill(0.0);
        add_product(y, 1.0, self.p.as_slice(), h, h.len());
    }

    fn variance(&self, i: usize) -> f64 {
        self.p[(i, i)]
    }

    fn write_covariance(&self, p: &mut [f64]) {
        p.copy_from_slice(self.p.as_slice());
    }
}

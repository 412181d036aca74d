//! Noise of a transition: gathered over the parts of a divided interval, and factored for the filter.
use nalgebra::DMatrix;

use crate::filter::Linearisation;
use crate::filter::kernel::axpy;

/// Transition and noise of the parts of an interval so far.
#[derive(Clone, Debug)]
pub(super) struct Parts {
    /// Transition: (leading, n).
    pub phi: DMatrix<f64>,
    /// Noise covariance, upper triangle: (leading, leading).
    pub noise: DMatrix<f64>,
    moved: DMatrix<f64>,
}

impl Parts {
    pub fn new(n: usize, leading: usize) -> Self {
        Self {
            phi: DMatrix::zeros(leading, n),
            noise: DMatrix::zeros(leading, leading),
            moved: DMatrix::zeros(leading, n),
        }
    }

    /// No parts.
    pub fn clear(&mut self) {
        self.phi.fill_with_identity();
        self.noise.fill(0.0);
    }

    /// One more part with the transition `phi` and the noise `q`, an upper triangle.
    pub fn append(&mut self, phi: &DMatrix<f64>, q: &DMatrix<f64>) {
        let m = phi.nrows();
        let (moving, constant) = phi.as_slice().split_at(m * m);
        self.moved.fill(0.0);
        self.moved.as_mut_slice()[m * m..].copy_from_slice(constant);
        add_product(moving, self.phi.as_slice(), self.moved.as_mut_slice(), m);
        std::mem::swap(&mut self.phi, &mut self.moved);
        // Phi (N Phi^T), then the upper triangle alone.
        for j in 0..m {
            (0..j).for_each(|i| self.noise[(j, i)] = self.noise[(i, j)]);
        }
        let (half, rest) = self.moved.as_mut_slice().split_at_mut(m * m);
        half.fill(0.0);
        add_product(moving, self.noise.as_slice(), half, m);
        rest.fill(0.0);
        self.noise.copy_from(q);
        let noise = self.noise.as_mut_slice();
        for (left, right) in half.chunks_exact(m).zip(moving.chunks_exact(m)) {
            for (j, to) in noise.chunks_exact_mut(m).enumerate() {
                axpy(right[j], &left[..=j], &mut to[..=j]);
            }
        }
    }
}

/// `C <- C + A B` for column-major matrices whose columns have length `m`.
fn add_product(a: &[f64], b: &[f64], c: &mut [f64], m: usize) {
    for (c, b) in c.chunks_exact_mut(m).zip(b.chunks_exact(m)) {
        for (a, &factor) in a.chunks_exact(m).zip(b) {
            if factor != 0.0 {
                axpy(factor, a, c);
            }
        }
    }
}

/// Write the upper triangle `noise` as `G diag(q) G^T`, with the column of the last state first; `noise` is used up.
///
/// A variance that the later states explain up to rounding counts as explained in full: its column stays zero.
pub(super) fn factor(noise: &mut DMatrix<f64>, linear: &mut Linearisation) {
    let m = noise.nrows();
    linear.g.fill(0.0);
    linear.q.fill(0.0);
    let (noise, g) = (noise.as_mut_slice(), linear.g.as_mut_slice());
    let rounding = m as f64 * f64::EPSILON;
    for (index, g) in g.chunks_exact_mut(m.max(1)).enumerate() {
        let j = m - 1 - index;
        let (before, column) = noise.split_at_mut(j * m);
        let left = column[j];
        if left <= f64::MIN_POSITIVE {
            continue;
        }
        linear.q[index] = left;
        g[j] = 1.0;
        let inverse = 1.0 / left;
        for ((g, &value), i) in g[..j].iter_mut().zip(&column[..j]).zip(0..) {
            if value == 0.0 {
                continue;
            }
            *g = value * inverse;
            let diagonal = before[i * m + i];
            axpy(-*g, &column[..=i], &mut before[i * m..=i * m + i]);
            if before[i * m + i] <= rounding * diagonal {
                before[i * m..=i * m + i].fill(0.0);
            }
        }
    }
}

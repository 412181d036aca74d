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
    pub(super) fn new(n: usize, leading: usize) -> Self {
        Self {
            phi: DMatrix::zeros(leading, n),
            noise: DMatrix::zeros(leading, leading),
            moved: DMatrix::zeros(leading, n),
        }
    }

    /// No parts.
    pub(super) fn clear(&mut self) {
        self.phi.fill_with_identity();
        self.noise.fill(0.0);
    }

    /// One more part with the transition `phi` and the noise `q`, an upper triangle.
    pub(super) fn append(&mut self, phi: &DMatrix<f64>, q: &DMatrix<f64>) {
        let m = phi.nrows();
        let (moving, constant) = phi.as_slice().split_at(m * m);
        self.moved.fill(0.0);
        self.moved.as_mut_slice()[m * m..].copy_from_slice(constant);
        add_product(moving, self.phi.as_slice(), self.moved.as_mut_slice(), m);
        core::mem::swap(&mut self.phi, &mut self.moved);
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
    let (m, noise) = (noise.nrows(), noise.as_mut_slice());
    let (g, q) = (linear.g.as_mut_slice(), linear.q.as_mut_slice());
    g.fill(0.0);
    q.fill(0.0);
    let rounding = m as f64 * f64::EPSILON;
    for (index, g) in g.chunks_exact_mut(m.max(1)).enumerate() {
        let j = m - 1 - index;
        let (before, column) = noise.split_at_mut(j * m);
        let left = column[j];
        if left <= f64::MIN_POSITIVE {
            continue;
        }
        q[index] = left;
        g[j] = 1.0;
        let inverse = 1.0 / left;
        for (i, (target, &value)) in before.chunks_exact_mut(m).zip(column.iter()).enumerate() {
            if value == 0.0 {
                continue;
            }
            g[i] = value * inverse;
            let diagonal = target[i];
            axpy(-g[i], &column[..=i], &mut target[..=i]);
            if target[i] <= rounding * diagonal {
                target[..=i].fill(0.0);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DVector;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn a_factored_noise_is_the_noise_singular_or_not() {
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        for (m, rank) in [(9, 9), (9, 4), (12, 12), (5, 1), (1, 1), (4, 0)] {
            let root =
                DMatrix::from_fn(m, rank, |i, _| 10_f64.powi(i as i32 % 4) * rng.random_range(-1.0..1.0));
            let expected = &root * root.transpose();
            let mut linear = Linearisation::zeros(m, m, m);
            factor(&mut expected.upper_triangle(), &mut linear);
            let found = &linear.g * DMatrix::from_diagonal(&linear.q) * linear.g.transpose();
            let sd = expected.diagonal().map(|d| d.sqrt().max(1e-100));
            let worst = (&found - &expected).map_with_location(|i, j, e| (e / (sd[i] * sd[j])).abs());
            assert!(worst.iter().all(|e| *e < 1e-12), "{m} states, rank {rank}: {worst}");
            assert!(linear.q.iter().all(|q| *q >= 0.0));
        }
    }

    #[test]
    fn parts_of_an_interval_follow_each_other() {
        let mut rng = ChaCha8Rng::seed_from_u64(4);
        let (n, m) = (7, 4);
        let mut parts = Parts::new(n, m);
        parts.clear();
        let (mut f, mut q) = (DMatrix::identity(n, n), DMatrix::zeros(n, n));
        for _ in 0..3 {
            let phi = DMatrix::from_fn(m, n, |_, _| rng.random_range(-1.0..1.0));
            let noise = DMatrix::from_diagonal(&DVector::from_fn(m, |_, _| rng.random_range(0.1..1.0)));
            parts.append(&phi, &noise);
            let (mut step, mut added) = (DMatrix::identity(n, n), DMatrix::zeros(n, n));
            step.rows_mut(0, m).copy_from(&phi);
            added.view_mut((0, 0), (m, m)).copy_from(&noise);
            q = &step * q * step.transpose() + added;
            f = step * f;
        }
        assert!((&parts.phi - f.rows(0, m)).abs().max() < 1e-12);
        let moving = q.view((0, 0), (m, m)).into_owned();
        assert!((parts.noise.upper_triangle() - moving.upper_triangle()).abs().max() < 1e-12);
    }
}

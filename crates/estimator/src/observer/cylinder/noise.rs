//! Noise of a transition, factored for the filter.
use nalgebra::DMatrix;

use crate::filter::Linearisation;
use crate::filter::kernel::axpy;

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
}

//! Draws with matched second moments.
use nalgebra::DMatrix;
use rand_chacha::ChaCha12Rng;
use rand_distr::{Distribution, StandardNormal};

/// Standard normal numbers (seeds, dimensions), moved and turned so that the mean over the seeds is 0 and their covariance is the identity.
///
/// An error that is linear in them has then its true second moment over the seeds, whatever their number; what is left of the Monte Carlo
/// error is that of the noise. With too few seeds for that each dimension has mean 0 and variance 1 by itself.
pub(super) fn matched_draws(seeds: usize, dimensions: usize, rng: &mut ChaCha12Rng) -> DMatrix<f64> {
    let mut z = DMatrix::zeros(seeds, dimensions);
    // Seed by seed.
    for row in 0..seeds {
        (0..dimensions).for_each(|column| z[(row, column)] = StandardNormal.sample(rng));
    }
    if seeds < 2 {
        return z;
    }
    for mut column in z.column_iter_mut() {
        let mean = column.mean();
        column.add_scalar_mut(-mean);
        let sd = (column.norm_squared() / seeds as f64).sqrt();
        column.unscale_mut(sd);
    }
    if seeds <= dimensions {
        return z;
    }
    let covariance = z.transpose() * &z / seeds as f64;
    // Z L^-T with the covariance L L^T.
    match covariance.cholesky().and_then(|root| root.l().solve_lower_triangular(&z.transpose())) {
        Some(turned) => turned.transpose(),
        None => z,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn the_draws_have_the_moments_of_their_law_exactly() {
        let of = |seeds| matched_draws(seeds, 12, &mut ChaCha12Rng::seed_from_u64(3));
        let z = of(30);
        assert!(z.row_mean().amax() < 1e-12);
        let covariance = z.transpose() * &z / 30.0;
        assert!((covariance - DMatrix::identity(12, 12)).amax() < 1e-12);
        // Too few for a covariance: means and variances alone.
        let few = of(8);
        assert!(few.row_mean().amax() < 1e-12);
        assert!(few.column_iter().all(|column| (column.norm_squared() / 8.0 - 1.0).abs() < 1e-12));
        assert!(of(1).amax() > 0.1);
    }
}

//! The posterior Cramer-Rao bound of linear processes: the Kalman filter's covariance.
use cylwatch_estimator::bound::{Expectation, path_bound, posterior_bound};
use cylwatch_estimator::filter::{Linearisation, StateSpace, UdFactors};
use nalgebra::DVector;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::linear_model::{DenseFilter, LinearModel, covariance, covariance_difference};

#[test]
fn the_bound_of_a_linear_process_is_the_kalman_covariance() {
    for (seed, n, leading, outputs) in [(1, 4, 4, 2), (2, 6, 3, 2), (3, 8, 5, 3)] {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut model = LinearModel::random(&mut rng, n, leading, outputs);
        let prior = covariance(&mut rng, n);
        let intervals: Vec<f64> =
            (0..30).map(|k| if k == 0 { 0.0 } else { rng.random_range(0.1..1.0) }).collect();
        let heard: Vec<Vec<bool>> = intervals
            .iter()
            .map(|_| (0..outputs).map(|_| rng.random_range(0.0..1.0) < 0.7).collect())
            .collect();
        // Linearisations do not depend on the path: any will do.
        let paths = vec![vec![vec![0.0; n]; intervals.len()]; 2];
        let times = (&intervals[..], &heard[..]);
        let full = posterior_bound(&mut model, &prior, &paths, times, Expectation::Full).unwrap();
        let of_mean =
            posterior_bound(&mut model, &prior, &paths, times, Expectation::MeanTransition).unwrap();
        let mut along = UdFactors::from_covariance(&prior).unwrap();
        let mut linear = Linearisation::zeros(n, leading, model.noises());
        let mut kalman = DenseFilter::new(DVector::zeros(n), prior.clone());
        for (k, &dt_s) in intervals.iter().enumerate() {
            if dt_s > 0.0 {
                kalman.predict(&model, dt_s);
            }
            let z: Vec<f64> = heard[k].iter().map(|heard| if *heard { 0.0 } else { f64::NAN }).collect();
            kalman.update(&model, &z);
            let rest = &paths[0][0];
            path_bound(&mut model, &mut along, (rest, dt_s, rest), &heard[k], &mut linear).unwrap();
            for bound in [&full[k], &of_mean[k], &along.covariance()] {
                let difference = covariance_difference(bound, &kalman.p);
                assert!(difference < 1e-10, "seed {seed}, sample {k}: {difference:e}");
            }
        }
    }
}

//! Identity: without constraints a linear problem gives the Kalman filter, whatever the window.
use cylwatch_estimator::filter::horizon::{HorizonSettings, HorizonStatus, Loss, MovingHorizon};
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::problems::{Linear, covariance, normal};
use super::reference::{Kalman, difference};

/// Largest relative differences of state and covariance over `steps` samples, irregular, a third of them missing.
fn worst_difference(
    problem: &Linear,
    (mean, prior): (&DVector<f64>, &DMatrix<f64>),
    settings: HorizonSettings,
    steps: usize,
    seed: u64,
) -> (f64, f64) {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut truth = mean + prior * normal(&mut rng, mean.len());
    let mut filter = Kalman { x: mean.clone(), p: prior.clone() };
    let mut horizon =
        MovingHorizon::try_new(problem.clone(), mean, prior, Vec::new(), settings).expect("sound problem");
    let mut worst = (0.0_f64, 0.0_f64);
    for step in 0..steps {
        // Every seventh sample comes at the same time as the one before.
        let dt_s = if step % 7 == 0 { 0.0 } else { rng.random_range(0.01..1.0) };
        let z = problem.sample(&mut rng, &mut truth, dt_s, 0.33);
        filter.step(problem, dt_s, &z);
        let estimate = horizon.step(dt_s, z.as_slice()).expect("linear problems have no edge");
        assert_eq!(estimate.status, HorizonStatus::Unconstrained);
        assert!(estimate.converged && estimate.iterations == 1, "a linear problem needs one iteration");
        let x = DMatrix::from_column_slice(mean.len(), 1, estimate.x.as_slice());
        let reference = DMatrix::from_column_slice(mean.len(), 1, filter.x.as_slice());
        worst.0 = worst.0.max(difference(&x, &reference));
        worst.1 = worst.1.max(difference(&estimate.covariance, &filter.p));
    }
    worst
}

#[test]
fn a_window_of_any_length_gives_the_kalman_filter() {
    for (case, samples) in (1..=20).enumerate() {
        let mut rng = ChaCha8Rng::seed_from_u64(100 + case as u64);
        let (n, constants) = (rng.random_range(2..7), rng.random_range(0..3));
        let (k, outputs) = (rng.random_range(1..n + 1), rng.random_range(1..4));
        let problem = Linear::random(&mut rng, n + constants, n, k, outputs);
        let size = n + constants;
        let prior = (normal(&mut rng, size), covariance(&mut rng, size, size));
        let settings = HorizonSettings { samples, ..HorizonSettings::default() };
        let worst = worst_difference(&problem, (&prior.0, &prior.1), settings, 80, 1 + case as u64);
        assert!(worst.0 < 1e-8 && worst.1 < 1e-8, "{samples} samples: {worst:?}");
    }
}

#[test]
fn singular_priors_and_silent_processes_give_the_kalman_filter_too() {
    for (seed, rank, k) in [(1, 0, 2), (2, 2, 1), (3, 5, 1), (4, 3, 4)] {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut problem = Linear::random(&mut rng, 7, 5, k, 2);
        if k == 1 {
            problem.q[0] = 0.0;
        }
        let prior = (normal(&mut rng, 7), covariance(&mut rng, 7, rank));
        let settings = HorizonSettings { samples: 6, ..HorizonSettings::default() };
        let worst = worst_difference(&problem, (&prior.0, &prior.1), settings, 60, 50 + seed);
        assert!(worst.0 < 1e-8 && worst.1 < 1e-8, "rank {rank}: {worst:?}");
    }
}

#[test]
fn a_problem_of_the_observers_size_gives_the_kalman_filter_over_a_long_record() {
    let mut rng = ChaCha8Rng::seed_from_u64(9);
    let problem = Linear::random(&mut rng, 15, 9, 7, 3);
    let prior = (normal(&mut rng, 15), covariance(&mut rng, 15, 15));
    let worst = worst_difference(&problem, (&prior.0, &prior.1), HorizonSettings::default(), 300, 77);
    assert!(worst.0 < 1e-8 && worst.1 < 1e-8, "{worst:?}");
}

#[test]
fn a_loss_that_never_bends_is_the_quadratic_one() {
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    let problem = Linear::random(&mut rng, 5, 4, 2, 2);
    let prior = (normal(&mut rng, 5), covariance(&mut rng, 5, 5));
    let loss = Loss::Huber { delta: 1e9 };
    let settings = HorizonSettings { samples: 8, loss, ..HorizonSettings::default() };
    let worst = worst_difference(&problem, (&prior.0, &prior.1), settings, 60, 5);
    assert!(worst.0 < 1e-8 && worst.1 < 1e-8, "{worst:?}");
}

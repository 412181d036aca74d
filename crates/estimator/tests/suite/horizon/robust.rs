//! Huber's loss: the optimum against dense computation, and what it is good for.
use cylwatch_estimator::filter::horizon::{
    Constraint, HorizonEstimate, HorizonSettings, HorizonStatus, Loss, MovingHorizon,
};
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::problems::{Linear, covariance, leaking_mass, normal};
use super::reference::{Condensed, Optimum};

const DELTA: f64 = 1.5;

fn settings(samples: usize, loss: Loss) -> HorizonSettings {
    HorizonSettings { samples, loss, ..HorizonSettings::default() }
}

/// Huber's optimum by reweighting: each round minimises a quadratic that lies above the loss and touches it.
fn reweighted(condensed: &mut Condensed, c: &DMatrix<f64>, gap: &DVector<f64>) -> Optimum {
    let (rows, values) = (condensed.rows.clone(), condensed.values.clone());
    let mut weights = DVector::from_element(values.len(), 1.0);
    for _ in 0..2000 {
        let root = weights.map(f64::sqrt);
        condensed.rows = DMatrix::from_diagonal(&root) * &rows;
        condensed.values = root.component_mul(&values);
        let optimum = condensed.constrained(c, gap, c.nrows());
        let next = (&values - &rows * &optimum.y).map(|r| (DELTA / r.abs()).min(1.0));
        let change = (&next - &weights).amax();
        weights = next;
        if change < 1e-13 {
            return optimum;
        }
    }
    panic!("reweighting converges");
}

#[test]
fn the_robust_optimum_is_that_of_dense_reweighting_inside_constraints_or_not() {
    let (mut outliers, mut active) = (0, 0);
    for seed in 0..24 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let problem = Linear::random(&mut rng, 3, 2, 2, 2);
        let (mean, prior) = (normal(&mut rng, 3), covariance(&mut rng, 3, 3));
        let root = prior.clone().cholesky().expect("full rank").unpack();
        let mut truth = mean.clone();
        let samples: Vec<_> = (0..6)
            .map(|_| {
                let dt_s = rng.random_range(0.2..1.0);
                let mut z = problem.sample(&mut rng, &mut truth, dt_s, 0.1);
                let sign = if rng.random_bool(0.5) { 20.0 } else { -20.0 };
                z.iter_mut().filter(|_| rng.random_bool(0.2)).for_each(|z| *z += sign);
                (dt_s, z)
            })
            .collect();
        let mut condensed = Condensed::new(&problem, &mean, &root, &samples);
        // Every other case bounds the first state at the last two samples by way of all of them.
        let bound = if seed % 2 == 0 { truth[0] - 0.2 } else { 1e3 };
        let rows: Vec<_> = (0..=6).map(|i| condensed.maps[i].row(0).transpose()).collect();
        let gap = DVector::from_fn(7, |i, _| bound - condensed.offsets[i][0]);
        let optimum = reweighted(&mut condensed, &DMatrix::from_columns(&rows).transpose(), &gap);

        let constraints = vec![Constraint::at_most(0, bound)];
        let loss = Loss::Huber { delta: DELTA };
        let mut horizon =
            MovingHorizon::try_new(problem.clone(), &mean, &prior, constraints, settings(20, loss))
                .expect("sound problem");
        let mut estimate = None;
        for (dt_s, z) in &samples {
            estimate = Some(horizon.step(*dt_s, z.as_slice()).expect("no edge"));
        }
        let estimate = estimate.expect("six samples");
        for (i, x) in horizon.trajectory().iter().enumerate() {
            let error = (x - condensed.state(i, &optimum.y)).amax();
            assert!(error < 1e-7, "seed {seed}, state {i}: {error}");
        }
        assert_eq!(estimate.active.len(), optimum.active.len(), "seed {seed}");
        outliers += estimate.outliers.len();
        active += estimate.active.len();
    }
    assert!(outliers > 40 && active > 10, "the cases exercise both: {outliers} {active}");
}

#[test]
fn an_outlier_counts_with_the_variance_that_its_pull_has() {
    // A constant read five times with unit noise, once far off; prior variance 4, mean 0.
    let problem = Linear {
        a: DMatrix::zeros(1, 1),
        u: DVector::zeros(1),
        g: DMatrix::zeros(1, 1),
        q: DVector::zeros(1),
        h: DMatrix::identity(1, 1),
        r: DVector::from_element(1, 1.0),
    };
    let loss = Loss::Huber { delta: DELTA };
    let prior = DMatrix::from_element(1, 1, 4.0);
    let mut horizon =
        MovingHorizon::try_new(problem, &DVector::zeros(1), &prior, Vec::new(), settings(5, loss))
            .expect("sound problem");
    let mut estimate = None;
    for z in [0.3, 50.0, -0.2, 0.1, 0.4] {
        estimate = Some(horizon.step(1.0, &[z]).expect("no edge"));
    }
    let HorizonEstimate { x, covariance, outliers, status, .. } = estimate.expect("five samples");
    // Stationarity: x / 4 + sum over the four (x - z) = delta.
    let expected = (0.3 - 0.2 + 0.1 + 0.4 + DELTA) / 4.25;
    assert!((x[0] - expected).abs() < 1e-9, "{} {expected}", x[0]);
    let variance = 1.0 / (4.25 + DELTA / (50.0 - expected));
    assert!((covariance[(0, 0)] - variance).abs() < 1e-9, "{} {variance}", covariance[(0, 0)]);
    assert_eq!(status, HorizonStatus::Solved);
    assert_eq!(outliers.len(), 1);
    assert_eq!((outliers[0].output, outliers[0].age), (0, 3));
    assert!((outliers[0].residual - (50.0 - expected)).abs() < 1e-9);
}

/// Root mean square error of the mass over an ensemble, with a share of the readings 20 standard deviations off.
fn mass_error(loss: Loss, share: f64) -> f64 {
    let mut sum = 0.0;
    for seed in 0..20 {
        let mut rng = ChaCha8Rng::seed_from_u64(500 + seed);
        let problem = leaking_mass(0.01, 1e-6, 1.0);
        let mut truth = DVector::from_vec(vec![100.0, 0.02]);
        let prior = DMatrix::from_diagonal(&DVector::from_vec(vec![1.0, 0.01]));
        let mut horizon =
            MovingHorizon::try_new(problem.clone(), &truth, &prior, Vec::new(), settings(15, loss))
                .expect("sound problem");
        for _ in 0..60 {
            let mut z = problem.sample(&mut rng, &mut truth, 1.0, 0.0);
            if rng.random_bool(share) {
                z[0] += if rng.random_bool(0.5) { 20.0 } else { -20.0 };
            }
            let estimate = horizon.step(1.0, z.as_slice()).expect("no edge");
            sum += (estimate.x[0] - truth[0]).powi(2) / (20.0 * 60.0);
        }
    }
    sum.sqrt()
}

#[test]
fn outliers_ruin_the_quadratic_estimate_and_hardly_touch_the_robust_one() {
    let huber = Loss::Huber { delta: 1.345 };
    let (clean, robust_clean) = (mass_error(Loss::Quadratic, 0.0), mass_error(huber, 0.0));
    let (ruined, robust) = (mass_error(Loss::Quadratic, 0.2), mass_error(huber, 0.2));
    assert!(robust_clean < 1.1 * clean, "robustness costs little without outliers: {robust_clean} {clean}");
    assert!(ruined > 5.0 * clean, "a fifth of outliers ruins the quadratic loss: {ruined} {clean}");
    assert!(robust < 2.0 * clean, "the robust loss resists: {robust} {clean}");
}

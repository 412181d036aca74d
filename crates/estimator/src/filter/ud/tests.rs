use approx::assert_relative_eq;
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;

fn matrix(rng: &mut ChaCha8Rng, rows: usize, columns: usize) -> DMatrix<f64> {
    DMatrix::from_fn(rows, columns, |_, _| rng.random_range(-1.0..1.0))
}

/// Covariance of full rank with standard deviations that differ by `decades` powers of ten.
fn covariance(rng: &mut ChaCha8Rng, n: usize, decades: f64) -> DMatrix<f64> {
    let a = matrix(rng, n, n + 2);
    let scale =
        DMatrix::from_diagonal(&DVector::from_fn(n, |_, _| 10_f64.powf(rng.random_range(0.0..decades))));
    &scale * &a * a.transpose() * &scale
}

/// Largest difference of two covariances, each element relative to the two standard deviations.
fn difference(a: &DMatrix<f64>, b: &DMatrix<f64>) -> f64 {
    let sd = DVector::from_fn(b.nrows(), |i, _| b[(i, i)].sqrt().max(1e-100));
    (a - b).map_with_location(|i, j, e| (e / (sd[i] * sd[j])).abs()).max()
}

fn dense_transition(linear: &Linearisation) -> (DMatrix<f64>, DMatrix<f64>) {
    let (m, n) = linear.phi.shape();
    let mut f = DMatrix::identity(n, n);
    f.rows_mut(0, m).copy_from(&linear.phi);
    let mut q = DMatrix::zeros(n, n);
    q.view_mut((0, 0), (m, m))
        .copy_from(&(&linear.g * DMatrix::from_diagonal(&linear.q) * linear.g.transpose()));
    (f, q)
}

fn transition(rng: &mut ChaCha8Rng, n: usize, m: usize, k: usize) -> Linearisation {
    let q = DVector::from_fn(k, |_, _| rng.random_range(0.0..2.0));
    Linearisation { phi: matrix(rng, m, n), g: matrix(rng, m, k), q }
}

const SIZES: [(usize, usize, usize); 9] =
    [(1, 1, 1), (2, 1, 0), (3, 0, 0), (4, 4, 2), (5, 3, 7), (8, 8, 8), (12, 7, 9), (15, 9, 14), (20, 20, 3)];

#[test]
fn factors_give_the_covariance_back() {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    for n in [1, 2, 3, 7, 15] {
        let p = covariance(&mut rng, n, 6.0);
        let ud = UdFactors::from_covariance(&p).unwrap();
        assert!(difference(&ud.covariance(), &p) < 1e-14);
        assert!((0..n).all(|i| (ud.variance(i) / p[(i, i)] - 1.0).abs() < 1e-14));
        let h = DVector::from_fn(n, |_, _| rng.random_range(-1.0..1.0));
        assert_relative_eq!(ud.quadratic(h.as_slice()), h.dot(&(&p * &h)), max_relative = 1e-12);
    }
}

#[test]
fn singular_covariances_and_zero_variances_are_factored() {
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    for rank in 0..6 {
        let a = matrix(&mut rng, 6, rank);
        let p = &a * a.transpose();
        let ud = UdFactors::from_covariance(&p).unwrap();
        assert!(difference(&ud.covariance(), &p) < 1e-13);
        assert!(ud.diagonal().iter().all(|d| *d >= 0.0));
    }
    let diagonal = DMatrix::from_diagonal(&DVector::from_vec(vec![4.0, 0.0, 1e-30, 0.0]));
    let ud = UdFactors::from_covariance(&diagonal).unwrap();
    assert_eq!(ud.covariance(), diagonal);
}

#[test]
fn what_is_no_covariance_is_refused() {
    let refuse = |columns: [[f64; 2]; 2]| {
        UdFactors::from_covariance(&DMatrix::from_column_slice(2, 2, columns.as_flattened())).unwrap_err()
    };
    assert!(matches!(
        refuse([[1.0, 0.5], [0.4, 1.0]]),
        EstimatorError::CovarianceNotSymmetric { row: 0, column: 1, .. }
    ));
    assert!(matches!(
        refuse([[1.0, 1.001], [1.001, 1.0]]),
        EstimatorError::CovarianceIndefinite { state: 1, .. }
    ));
    assert!(matches!(
        refuse([[1.0, 0.0], [0.0, -1e-9]]),
        EstimatorError::CovarianceIndefinite { state: 1, .. }
    ));
    assert!(matches!(
        refuse([[1.0, 1e-3], [1e-3, 0.0]]),
        EstimatorError::CovarianceIndefinite { state: 1, .. }
    ));
    assert!(matches!(
        refuse([[1.0, f64::NAN], [f64::NAN, 1.0]]),
        EstimatorError::CovarianceNotFinite { row: 1, column: 0 }
    ));
}

#[test]
fn time_update_equals_the_dense_one() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    for (n, m, k) in SIZES {
        let mut ud = UdFactors::from_covariance(&covariance(&mut rng, n, 1.0)).unwrap();
        for noises in [k, k + 5, 0] {
            let linear = transition(&mut rng, n, m, noises);
            let (f, q) = dense_transition(&linear);
            let expected = &f * ud.covariance() * f.transpose() + q;
            ud.predict(&linear);
            assert!(difference(&ud.covariance(), &expected) < 1e-12, "{n} {m} {noises}");
        }
    }
}

#[test]
fn time_update_with_a_singular_transition_and_without_noise_stays_exact() {
    let mut linear = Linearisation::zeros(3, 2, 1);
    linear.phi.copy_from(&DMatrix::from_row_slice(2, 3, &[1.0, 0.5, 0.25, 2.0, 1.0, 0.5]));
    let mut ud = UdFactors::from_covariance(&DMatrix::identity(3, 3)).unwrap();
    let (f, _) = dense_transition(&linear);
    let expected = &f * f.transpose();
    ud.predict(&linear);
    assert_relative_eq!(ud.covariance(), expected, max_relative = 1e-15);
    linear.phi.fill(0.0);
    ud.predict(&linear);
    assert_eq!(ud.covariance(), DMatrix::from_diagonal(&DVector::from_vec(vec![0.0, 0.0, 1.0])));
}

#[test]
fn scalar_update_equals_the_dense_one() {
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    for (n, _, _) in SIZES {
        let p = covariance(&mut rng, n, 1.0);
        let mut ud = UdFactors::from_covariance(&p).unwrap();
        let h = DVector::from_fn(n, |i, _| if i % 3 == 1 { 0.0 } else { rng.random_range(-1.0..1.0) });
        let r = rng.random_range(0.1..1.0);
        let mut gain = DVector::zeros(n);
        let s = ud.update(h.as_slice(), r, gain.as_mut_slice());
        let expected_s = h.dot(&(&p * &h)) + r;
        let expected_gain = &p * &h / expected_s;
        assert_relative_eq!(s, expected_s, max_relative = 1e-13);
        assert_relative_eq!(gain, expected_gain, max_relative = 1e-11);
        // The Joseph form: no difference of large numbers.
        let left = DMatrix::identity(n, n) - &expected_gain * h.transpose();
        let expected = &left * p * left.transpose() + r * &expected_gain * expected_gain.transpose();
        assert!(difference(&ud.covariance(), &expected) < 1e-11);
    }
}

#[test]
fn exact_measurement_leaves_no_variance_in_its_direction() {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let mut ud = UdFactors::from_covariance(&covariance(&mut rng, 5, 1.0)).unwrap();
    let h = [0.0, 1.0, -0.5, 0.0, 2.0];
    let mut gain = [0.0; 5];
    let s = ud.update(&h, 0.0, &mut gain);
    assert_relative_eq!(dot(&h, &gain), 1.0, max_relative = 1e-14);
    assert!(ud.quadratic(&h) < 1e-28 * s);
    let again = ud.update(&[0.0; 5], 0.0, &mut gain);
    assert_eq!((again, gain), (0.0, [0.0; 5]));
}

#[test]
fn added_variance_equals_the_dense_sum() {
    let mut rng = ChaCha8Rng::seed_from_u64(6);
    for (n, _, _) in SIZES {
        let mut ud = UdFactors::from_covariance(&covariance(&mut rng, n, 2.0)).unwrap();
        let v = DVector::from_fn(n, |i, _| if i == n / 2 { 0.0 } else { rng.random_range(-9.0..9.0) });
        let expected = ud.covariance() + 0.3 * &v * v.transpose();
        ud.add_rank_one(0.3, v.as_slice());
        assert!(difference(&ud.covariance(), &expected) < 1e-13);
        let mut expected = ud.covariance();
        expected[(n / 2, n / 2)] += 7.0;
        ud.inflate(n / 2, 7.0);
        assert!(difference(&ud.covariance(), &expected) < 1e-13);
    }
    let mut nothing = UdFactors::from_covariance(&DMatrix::zeros(3, 3)).unwrap();
    nothing.add_rank_one(2.0, &[1.0, -3.0, 0.0]);
    let expected = DMatrix::from_row_slice(3, 3, &[2.0, -6.0, 0.0, -6.0, 18.0, 0.0, 0.0, 0.0, 0.0]);
    assert_relative_eq!(nothing.covariance(), expected, max_relative = 1e-15);
}

#[test]
fn a_reset_state_is_independent_and_the_others_keep_their_covariance() {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    for i in 0..6 {
        let mut ud = UdFactors::from_covariance(&covariance(&mut rng, 6, 2.0)).unwrap();
        let mut expected = ud.covariance();
        expected.row_mut(i).fill(0.0);
        expected.column_mut(i).fill(0.0);
        expected[(i, i)] = 0.25;
        ud.decorrelate_and_set(i, 0.25);
        assert!(difference(&ud.covariance(), &expected) < 1e-13);
    }
}

/// Rows that move by themselves, one that another drives, constants that nothing depends on, triangular noise.
#[test]
fn what_is_zero_in_transition_and_noise_makes_no_difference() {
    let mut rng = ChaCha8Rng::seed_from_u64(21);
    for (n, m) in [(18, 9), (13, 9), (21, 12), (7, 6), (9, 9)] {
        let mut linear = transition(&mut rng, n, m, m);
        for row in 4..m {
            linear.phi.row_mut(row).fill(0.0);
            linear.phi[(row, row)] = 0.9;
        }
        linear.phi[(4, 5)] = -3.0;
        linear.phi.columns_mut(n - (n - m) / 2, (n - m) / 2).fill(0.0);
        for (column, row) in (0..m).flat_map(|column| (m - column..m).map(move |row| (column, row))) {
            linear.g[(row, column)] = 0.0;
        }
        // Rows may also start or end anywhere.
        linear.phi[(m - 1, 0)] = if n == 13 { 0.4 } else { 0.0 };
        linear.q[2] = 0.0;
        let p = covariance(&mut rng, n, 3.0);
        let mut ud = UdFactors::from_covariance(&p).unwrap();
        let (f, q) = dense_transition(&linear);
        let expected = &f * ud.covariance() * f.transpose() + q;
        ud.predict(&linear);
        assert!(difference(&ud.covariance(), &expected) < 1e-12, "{n} states, {m} moving");
        let again = ud.clone();
        ud.predict(&linear);
        let expected = &f * again.covariance() * f.transpose() + dense_transition(&linear).1;
        assert!(difference(&ud.covariance(), &expected) < 1e-12, "{n} states, {m} moving, again");
    }
}

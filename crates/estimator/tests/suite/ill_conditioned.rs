//! Problems in which the covariance itself cannot be carried in double precision, with their closed forms.
use cylwatch_estimator::filter::{Linearisation, UdFactors};
use nalgebra::{DMatrix, DVector};

use crate::linear_model::{covariance_difference, rng, uniform};

/// Joseph's form `P <- (I - K h^T) P (I - K h^T)^T + K r K^T`, row by row.
fn update_in_josephs_form(p: &DMatrix<f64>, h: &DMatrix<f64>, r: f64) -> DMatrix<f64> {
    let mut p = p.clone();
    for row in h.row_iter() {
        let h = row.transpose();
        let gain = &p * &h / (h.dot(&(&p * &h)) + r);
        let left = DMatrix::identity(p.nrows(), p.nrows()) - &gain * h.transpose();
        p = &left * p * left.transpose() + r * &gain * gain.transpose();
        p = (&p + p.transpose()) * 0.5;
    }
    p
}

/// The plain update `P <- (I - K h^T) P`.
fn update_plainly(p: &DMatrix<f64>, h: &DMatrix<f64>, r: f64) -> DMatrix<f64> {
    let mut p = p.clone();
    for row in h.row_iter() {
        let h = row.transpose();
        let gain = &p * &h / (h.dot(&(&p * &h)) + r);
        p = (DMatrix::identity(p.nrows(), p.nrows()) - gain * h.transpose()) * &p;
    }
    p
}

fn is_positive_definite(p: &DMatrix<f64>) -> bool {
    let symmetric = (p + p.transpose()) * 0.5;
    p.diagonal().iter().all(|v| *v > 0.0) && symmetric.symmetric_eigenvalues().iter().all(|v| *v > 0.0)
}

fn assert_factors_are_right(p0: &DMatrix<f64>, h: &DMatrix<f64>, r: f64, expected: &DMatrix<f64>) {
    let mut factors = UdFactors::from_covariance(p0).unwrap();
    for row in h.row_iter() {
        factors.update(row.transpose().as_slice(), r, &mut vec![0.0; h.ncols()]);
    }
    assert!(covariance_difference(&factors.covariance(), expected) < 1e-6);
}

/// Two nearly equal, nearly exact readings: `H = [1 1 1; 1 1 1 + eps]`, `R = eps^2 I`, `P = I`.
#[test]
fn nearly_equal_exact_readings_defeat_the_plain_update_and_not_the_factors() {
    // A power of two, so that 1 + eps is exact.
    let eps = 2.0_f64.powi(-30);
    let h = DMatrix::from_row_slice(2, 3, &[1.0, 1.0, 1.0, 1.0, 1.0, 1.0 + eps]);
    // (I + H^T H / eps^2)^-1 by hand, in the coordinates (x_1 + x_2, x_1 - x_2, x_3).
    let c = 8.0 + 2.0 * eps + 2.0 * eps * eps;
    let sum = (1.0 + eps + eps * eps) / (4.0 + eps + eps * eps);
    let (own, other) = (0.5 * (sum + 1.0), 0.5 * (sum - 1.0));
    let (cross, third) = (-(2.0 + eps) / c, (4.0 + eps * eps) / c);
    let expected = [own, other, cross, other, own, cross, cross, cross, third];
    let expected = DMatrix::from_row_slice(3, 3, &expected);
    let p0 = DMatrix::identity(3, 3);
    let plain = update_plainly(&p0, &h, eps * eps);
    assert!(!is_positive_definite(&plain) && covariance_difference(&plain, &expected) > 0.1);
    let joseph = update_in_josephs_form(&p0, &h, eps * eps);
    assert!(covariance_difference(&joseph, &expected) > 1e-3, "the covariance itself cannot hold eps^2");
    assert_factors_are_right(&p0, &h, eps * eps, &expected);
}

/// As many readings as states, with a noise of 1e-20 of the prior: `P = r (H^T H + r I)^-1`.
#[test]
fn readings_of_twenty_digits_defeat_the_plain_update_and_not_the_factors() {
    let r = 1e-20;
    for (seed, n) in [(81, 2), (82, 4), (83, 7)] {
        let h = uniform(&mut rng(seed), n, n) + DMatrix::identity(n, n) * 2.0;
        let expected = (h.transpose() * &h + DMatrix::identity(n, n) * r).try_inverse().unwrap() * r;
        let p0 = DMatrix::identity(n, n);
        let plain = update_plainly(&p0, &h, r);
        assert!(covariance_difference(&plain, &expected) > 1e3, "n = {n}");
        assert!(n > 2 || !is_positive_definite(&plain));
        assert_factors_are_right(&p0, &h, r, &expected);
    }
}

/// A combination of two states known to twenty digits, which then turn: what is known must survive.
#[test]
fn a_time_update_keeps_what_the_covariance_cannot_hold() {
    let r = 1e-20;
    let h = [0.3, 0.7, 0.0];
    let mut linear = Linearisation::zeros(3, 2, 1);
    // Turns the two states by 90 degrees, and with them what is known.
    linear.phi.copy_from_slice(&[0.0, 1.0, -1.0, 0.0, 0.0, 0.0]);
    let p0 = DMatrix::from_diagonal(&DVector::from_vec(vec![1.0, 3.0, 2.0]));
    // Variance of h^T x: 0.3^2 + 3 0.7^2 before the reading.
    let expected = 1.0 / (1.0 / 1.56 + 1.0 / r);
    let mut factors = UdFactors::from_covariance(&p0).unwrap();
    factors.update(&h, r, &mut [0.0; 3]);
    factors.predict(&linear);
    assert!((factors.quadratic(&[-0.7, 0.3, 0.0]) / expected - 1.0).abs() < 1e-6);
    let joseph = update_in_josephs_form(&p0, &DMatrix::from_row_slice(1, 3, &h), r);
    let turned = &linear.phi * joseph * linear.phi.transpose();
    let along = DVector::from_vec(vec![-0.7, 0.3]);
    assert!((along.dot(&(turned * &along)) / expected - 1.0).abs() > 1.0);
}

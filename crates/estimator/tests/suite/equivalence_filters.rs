//! The extended Kalman filter against the textbook filter, on linear processes.
use cylwatch_estimator::filter::{ExtendedKalman, Innovation, Outcome, UdFactors};
use nalgebra::{DMatrix, DVector};

use crate::linear_model::{Case, DenseFilter, LinearModel, covariance_difference, rng, state_difference};

fn cases(seed: u64) -> Vec<Case> {
    let mut rng = rng(seed);
    [(1, 1, 1), (4, 4, 2), (8, 5, 3), (12, 12, 4), (15, 9, 3)]
        .map(|sizes| Case::random(&mut rng, sizes, 40))
        .into()
}

fn filter(model: &LinearModel, x0: &DVector<f64>, p0: &DMatrix<f64>) -> ExtendedKalman<LinearModel> {
    ExtendedKalman::try_new(model.clone(), x0.as_slice(), UdFactors::from_covariance(p0).unwrap()).unwrap()
}

fn nis(innovations: &[Innovation]) -> f64 {
    let read = innovations.iter().filter(|of| of.outcome != Outcome::Missing);
    read.map(|of| of.nu * of.nu / of.s).sum()
}

#[test]
fn filter_on_ud_factors_is_the_textbook_filter() {
    for Case { model, x0, p0, dt_s, z } in cases(21) {
        let mut filter = filter(&model, &x0, &p0);
        let mut textbook = DenseFilter::new(x0, p0);
        for (dt_s, z) in dt_s.iter().zip(&z) {
            let found = nis(filter.step(*dt_s, z).unwrap());
            textbook.step(&model, *dt_s, z);
            let nu = &textbook.innovation;
            let nis = nu.dot(&(textbook.s.clone().try_inverse().unwrap() * nu));
            assert!((found - nis).abs() < 1e-10 * nis.max(1.0));
            assert!(state_difference(filter.state(), &textbook.x, &textbook.p) < 1e-10);
            assert!(covariance_difference(&filter.factors().covariance(), &textbook.p) < 1e-10);
        }
    }
}

#[test]
fn order_of_the_outputs_does_not_matter() {
    for Case { model, x0, p0, dt_s, z } in cases(25) {
        let order: Vec<usize> = (0..model.h.nrows()).rev().collect();
        let mut turned = model.clone();
        turned.h = model.h.select_rows(&order);
        turned.r = model.r.select_rows(&order);
        let (mut forward, mut backward) = (filter(&model, &x0, &p0), filter(&turned, &x0, &p0));
        for (dt_s, z) in dt_s.iter().zip(&z) {
            let forward_nis = nis(forward.step(*dt_s, z).unwrap());
            let z: Vec<f64> = order.iter().map(|j| z[*j]).collect();
            let backward_nis = nis(backward.step(*dt_s, &z).unwrap());
            assert!((forward_nis - backward_nis).abs() < 1e-10 * forward_nis.max(1.0));
            assert_same(&backward, &forward);
        }
    }
}

#[test]
fn splitting_a_step_in_two_changes_nothing() {
    for Case { model, x0, p0, dt_s, z } in cases(26) {
        let mut whole = filter(&model, &x0, &p0);
        let mut split = whole.clone();
        let none = vec![f64::NAN; model.h.nrows()];
        for (dt_s, z) in dt_s.iter().zip(&z) {
            whole.step(*dt_s, z).unwrap();
            split.step(0.3 * dt_s, &none).unwrap();
            split.step(0.7 * dt_s, z).unwrap();
            assert_same(&split, &whole);
        }
    }
}

fn assert_same(found: &ExtendedKalman<LinearModel>, expected: &ExtendedKalman<LinearModel>) {
    let p = expected.factors().covariance();
    let x = DVector::from_column_slice(expected.state());
    assert!(state_difference(found.state(), &x, &p) < 1e-10);
    assert!(covariance_difference(&found.factors().covariance(), &p) < 1e-10);
}

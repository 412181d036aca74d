//! The extended Kalman filter in every form against the textbook filter, on linear processes.
use cylwatch_estimator::filter::{
    CovarianceForm, ExtendedKalman, Joseph, KalmanSettings, Outcome, UdFactors,
};
use nalgebra::{DMatrix, DVector, Dyn};

use crate::linear_model::{Case, DenseFilter, LinearModel, covariance_difference, rng, state_difference};

fn cases(seed: u64) -> Vec<Case> {
    let mut rng = rng(seed);
    [(1, 1, 1), (4, 4, 2), (8, 5, 3), (12, 12, 4), (15, 9, 3)]
        .map(|sizes| Case::random(&mut rng, sizes, 40))
        .into()
}

fn assert_follows_the_textbook<F: CovarianceForm>(make: impl Fn(&DMatrix<f64>) -> F, seed: u64) {
    for Case { model, x0, p0, dt_s, z } in cases(seed) {
        let settings = KalmanSettings::default();
        let mut filter = ExtendedKalman::try_new(model.clone(), x0.as_slice(), make(&p0), &settings).unwrap();
        let mut textbook = DenseFilter::new(x0, p0);
        for (dt_s, z) in dt_s.iter().zip(&z) {
            let report = filter.step(*dt_s, z).unwrap();
            textbook.step(&model, *dt_s, z);
            let nu = &textbook.innovation;
            let nis = nu.dot(&(textbook.s.clone().try_inverse().unwrap() * nu));
            assert!((report.nis - nis).abs() < 1e-10 * nis.max(1.0));
            assert_eq!(report.dof, nu.len());
            assert!(state_difference(filter.state(), &textbook.x, &textbook.p) < 1e-10);
            assert!(covariance_difference(&filter.form().to_dense(), &textbook.p) < 1e-10);
        }
    }
}

#[test]
fn filter_on_ud_factors_is_the_textbook_filter() {
    assert_follows_the_textbook(|p| UdFactors::<Dyn>::from_covariance(p).unwrap(), 21);
}

#[test]
fn filter_on_josephs_form_is_the_textbook_filter() {
    assert_follows_the_textbook(|p| Joseph::<Dyn>::from_covariance(p).unwrap(), 23);
}

fn ud_filter(
    model: &LinearModel,
    x0: &DVector<f64>,
    p0: &DMatrix<f64>,
    settings: &KalmanSettings,
) -> ExtendedKalman<LinearModel, UdFactors<Dyn>> {
    let form = UdFactors::from_covariance(p0).unwrap();
    ExtendedKalman::try_new(model.clone(), x0.as_slice(), form, settings).unwrap()
}

#[test]
fn order_of_the_outputs_does_not_matter() {
    for Case { model, x0, p0, dt_s, z } in cases(25) {
        let order: Vec<usize> = (0..model.h.nrows()).rev().collect();
        let mut turned = model.clone();
        turned.h = model.h.select_rows(&order);
        turned.r = model.r.select_rows(&order);
        let settings = KalmanSettings { consider: vec![model.h.ncols() - 1], ..KalmanSettings::default() };
        for settings in [KalmanSettings::default(), settings] {
            let mut forward = ud_filter(&model, &x0, &p0, &settings);
            let mut backward = ud_filter(&turned, &x0, &p0, &settings);
            for (dt_s, z) in dt_s.iter().zip(&z) {
                let nis = forward.step(*dt_s, z).unwrap().nis;
                let z: Vec<f64> = order.iter().map(|j| z[*j]).collect();
                let turned_nis = backward.step(*dt_s, &z).unwrap().nis;
                let p = forward.form().to_dense();
                let x = DVector::from_column_slice(forward.state());
                assert!((nis - turned_nis).abs() < 1e-10 * nis.max(1.0));
                assert!(state_difference(backward.state(), &x, &p) < 1e-10);
                assert!(covariance_difference(&backward.form().to_dense(), &p) < 1e-10);
            }
        }
    }
}

#[test]
fn splitting_a_step_in_two_changes_nothing() {
    for Case { model, x0, p0, dt_s, z } in cases(26) {
        let mut whole = ud_filter(&model, &x0, &p0, &KalmanSettings::default());
        let mut split = whole.clone();
        for (dt_s, z) in dt_s.iter().zip(&z) {
            whole.step(*dt_s, z).unwrap();
            split.predict(0.3 * dt_s).unwrap();
            split.step(0.7 * dt_s, z).unwrap();
            let p = whole.form().to_dense();
            let x = DVector::from_column_slice(whole.state());
            assert!(state_difference(split.state(), &x, &p) < 1e-10);
            assert!(covariance_difference(&split.form().to_dense(), &p) < 1e-10);
        }
    }
}

#[test]
fn iterating_a_linear_update_changes_nothing() {
    for Case { model, x0, p0, dt_s, z } in cases(27) {
        let settings = KalmanSettings { iterations: 5, tolerance: 1e-9, ..KalmanSettings::default() };
        let mut plain = ud_filter(&model, &x0, &p0, &KalmanSettings::default());
        let mut iterated = ud_filter(&model, &x0, &p0, &settings);
        for (dt_s, z) in dt_s.iter().zip(&z) {
            plain.step(*dt_s, z).unwrap();
            let report = iterated.step(*dt_s, z).unwrap();
            assert!(report.converged && report.iterations <= 1);
            let p = plain.form().to_dense();
            let x = DVector::from_column_slice(plain.state());
            assert!(state_difference(iterated.state(), &x, &p) < 1e-10);
            assert!(covariance_difference(&iterated.form().to_dense(), &p) < 1e-10);
        }
    }
}

/// Schmidt's filter in dense matrices: the optimal vector gain with the rows of the consider states struck out.
fn schmidt_step(filter: &mut DenseFilter, model: &LinearModel, dt_s: f64, z: &[f64], consider: &[usize]) {
    filter.predict(model, dt_s);
    let there: Vec<usize> = (0..z.len()).filter(|j| z[*j].is_finite()).collect();
    let h = model.h.select_rows(&there);
    let r = DMatrix::from_diagonal(&model.r.select_rows(&there));
    let z = DVector::from_iterator(there.len(), there.iter().map(|j| z[*j]));
    let s = &h * &filter.p * h.transpose() + &r;
    let mut gain = &filter.p * h.transpose() * s.try_inverse().unwrap();
    for i in consider {
        gain.row_mut(*i).fill(0.0);
    }
    let left = DMatrix::identity(filter.x.len(), filter.x.len()) - &gain * &h;
    filter.x += &gain * (z - &h * &filter.x);
    filter.p = &left * &filter.p * left.transpose() + &gain * r * gain.transpose();
}

#[test]
fn consider_states_follow_schmidts_dense_filter() {
    for Case { model, x0, p0, dt_s, z } in cases(28) {
        let n = x0.len();
        for consider in [vec![n - 1], (0..n).step_by(2).collect()] {
            let settings = KalmanSettings { consider: consider.clone(), ..KalmanSettings::default() };
            let mut filter = ud_filter(&model, &x0, &p0, &settings);
            let mut dense = DenseFilter::new(x0.clone(), p0.clone());
            for (dt_s, z) in dt_s.iter().zip(&z) {
                filter.step(*dt_s, z).unwrap();
                schmidt_step(&mut dense, &model, *dt_s, z, &consider);
                assert!(state_difference(filter.state(), &dense.x, &dense.p) < 1e-10);
                assert!(covariance_difference(&filter.form().to_dense(), &dense.p) < 1e-10);
            }
        }
    }
}

#[test]
fn a_step_without_readings_is_a_prediction() {
    for Case { model, x0, p0, .. } in cases(29) {
        let mut filter = ud_filter(&model, &x0, &p0, &KalmanSettings::default());
        let mut predicted = filter.clone();
        let none = vec![f64::NAN; model.h.nrows()];
        let report = filter.step(0.7, &none).unwrap();
        assert!(report.dof == 0 && report.outputs.iter().all(|o| o.outcome == Outcome::Missing));
        predicted.predict(0.7).unwrap();
        assert_eq!(filter.state(), predicted.state());
        assert_eq!(filter.form().to_dense(), predicted.form().to_dense());
    }
}

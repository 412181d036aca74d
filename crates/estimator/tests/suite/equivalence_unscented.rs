//! The unscented filter is the Kalman filter on linear processes, whatever its points.
use cylwatch_estimator::filter::{Unscented, UnscentedSettings};
use rand::RngExt;

use crate::linear_model::{
    DenseFilter, LinearModel, covariance, covariance_difference, normal, rng, state_difference,
};

fn assert_follows_the_textbook(settings: UnscentedSettings, seed: u64) {
    let mut rng = rng(seed);
    for (n, leading, outputs) in [(1, 1, 1), (4, 4, 2), (8, 5, 3), (12, 12, 4)] {
        let model = LinearModel::random(&mut rng, n, leading, outputs);
        let p0 = covariance(&mut rng, n);
        let x0 = normal(&mut rng, n) * 3.0;
        let dt_s: Vec<f64> = (0..25).map(|_| rng.random_range(0.05..1.5)).collect();
        let z = model.readings(&mut rng, &x0, &dt_s, 0.25);
        let mut filter = Unscented::try_new(model.clone(), x0.as_slice(), &p0, &settings).unwrap();
        let mut textbook = DenseFilter::new(x0, p0);
        for (dt_s, z) in dt_s.iter().zip(&z) {
            let report = filter.step(*dt_s, z).unwrap();
            textbook.step(&model, *dt_s, z);
            let nu = &textbook.innovation;
            let nis = nu.dot(&(textbook.s.clone().try_inverse().unwrap() * nu));
            assert!((report.nis - nis).abs() < 1e-10 * nis.max(1.0));
            assert!(state_difference(filter.state(), &textbook.x, &textbook.p) < 1e-10);
            assert!(covariance_difference(&filter.covariance(), &textbook.p) < 1e-10);
        }
    }
}

#[test]
fn cubature_points_follow_the_textbook() {
    assert_follows_the_textbook(UnscentedSettings::default(), 31);
}

#[test]
fn points_drawn_anew_for_each_output_follow_the_textbook() {
    assert_follows_the_textbook(UnscentedSettings { redraw: true, ..UnscentedSettings::default() }, 32);
}

#[test]
fn scaled_points_with_a_weighted_middle_follow_the_textbook() {
    let settings = UnscentedSettings { alpha: 0.7, beta: 2.0, kappa: 1.0, ..UnscentedSettings::default() };
    assert_follows_the_textbook(settings, 33);
}

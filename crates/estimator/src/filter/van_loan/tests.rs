use approx::assert_relative_eq;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;

fn one(value: f64) -> DMatrix<f64> {
    DMatrix::from_element(1, 1, value)
}

#[test]
fn an_ornstein_uhlenbeck_process_has_its_closed_form_however_stiff() {
    for (rate, interval_s) in [(0.1, 0.01), (1.0, 1.0), (2.0, 25.0), (1e3, 5.0), (1e-9, 1.0), (3.0, 0.0)] {
        let process = discretise(&one(-rate), &one(1.0), &one(0.7), interval_s).unwrap();
        let phi = f64::exp(-rate * interval_s);
        assert_relative_eq!(process.phi[(0, 0)], phi, max_relative = 1e-12, epsilon = 1e-300);
        let noise = -0.7 * f64::exp_m1(-2.0 * rate * interval_s) / (2.0 * rate);
        assert_relative_eq!(process.noise[(0, 0)], noise, max_relative = 1e-13);
    }
}

#[test]
fn chains_of_integrators_have_their_closed_forms() {
    let t: f64 = 7.0;
    let a = DMatrix::from_row_slice(2, 2, &[0.0, 1.0, 0.0, 0.0]);
    let g = DMatrix::from_column_slice(2, 1, &[0.0, 1.0]);
    let double = discretise(&a, &g, &one(0.3), t).unwrap();
    assert_relative_eq!(double.phi, DMatrix::from_row_slice(2, 2, &[1.0, t, 0.0, 1.0]), max_relative = 1e-14);
    let noise = [t.powi(3) / 3.0, t * t / 2.0, t * t / 2.0, t].map(|q| 0.3 * q);
    assert_relative_eq!(double.noise, DMatrix::from_row_slice(2, 2, &noise), max_relative = 1e-13);
    let a = DMatrix::from_row_slice(3, 3, &[0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
    let g = DMatrix::from_column_slice(3, 1, &[0.0, 0.0, 1.0]);
    let triple = discretise(&a, &g, &one(1.0), t).unwrap();
    assert_relative_eq!(triple.noise[(0, 0)], t.powi(5) / 20.0, max_relative = 1e-13);
    assert_relative_eq!(triple.noise[(0, 1)], t.powi(4) / 8.0, max_relative = 1e-13);
    assert_relative_eq!(triple.noise[(1, 2)], t.powi(2) / 2.0, max_relative = 1e-13);
}

#[test]
fn a_relaxation_driven_by_a_random_walk_has_its_closed_form() {
    // dx = (b - x)/tau dt, db = dw: x(T) = ... + int (1 - exp(-(T - s)/tau)) dw.
    let (tau, t): (f64, f64) = (40.0, 60.0);
    let a = DMatrix::from_row_slice(2, 2, &[-1.0 / tau, 1.0 / tau, 0.0, 0.0]);
    let g = DMatrix::from_column_slice(2, 1, &[0.0, 1.0]);
    let process = discretise(&a, &g, &one(1.0), t).unwrap();
    let e = f64::exp(-t / tau);
    assert_relative_eq!(process.phi[(0, 1)], 1.0 - e, max_relative = 1e-13);
    assert_relative_eq!(process.noise[(0, 1)], t - tau * (1.0 - e), max_relative = 1e-12);
    let own = t - 2.0 * tau * (1.0 - e) + 0.5 * tau * (1.0 - e * e);
    assert_relative_eq!(process.noise[(0, 0)], own, max_relative = 1e-12);
}

#[test]
fn a_random_process_is_its_block_exponential_and_splits() {
    let mut rng = ChaCha8Rng::seed_from_u64(71);
    for n in [1, 3, 6, 10] {
        let a = DMatrix::from_fn(n, n, |_, _| rng.random_range(-1.0..1.0));
        let g = DMatrix::from_fn(n, 2, |_, _| rng.random_range(-1.0..1.0));
        let q_c = DMatrix::from_row_slice(2, 2, &[1.0, 0.3, 0.3, 0.5]);
        let whole = discretise(&a, &g, &q_c, 1.3).unwrap();
        let mut block = DMatrix::zeros(2 * n, 2 * n);
        block.view_mut((0, 0), (n, n)).copy_from(&(-&a * 1.3));
        block.view_mut((0, n), (n, n)).copy_from(&(&g * &q_c * g.transpose() * 1.3));
        block.view_mut((n, n), (n, n)).copy_from(&(a.transpose() * 1.3));
        let block = block.exp();
        let phi = block.view((n, n), (n, n)).transpose();
        assert_relative_eq!(whole.phi, phi, epsilon = 1e-12 * phi.amax());
        let noise = &phi * block.view((0, n), (n, n));
        assert_relative_eq!(whole.noise, noise, epsilon = 1e-11 * noise.amax());
        let (first, second) =
            (discretise(&a, &g, &q_c, 0.4).unwrap(), discretise(&a, &g, &q_c, 0.9).unwrap());
        let noise = &second.phi * first.noise * second.phi.transpose() + &second.noise;
        assert_relative_eq!(whole.noise, noise, epsilon = 1e-13 * noise.amax());
        assert_relative_eq!(whole.phi, &second.phi * first.phi, epsilon = 1e-13 * phi.amax());
        assert_eq!(whole.noise, whole.noise.transpose());
    }
}

#[test]
fn a_linearisation_carries_the_same_noise() {
    let a = DMatrix::from_row_slice(3, 3, &[-0.5, 0.2, 0.3, 0.1, -0.7, 0.0, 0.0, 0.0, 0.0]);
    let g = DMatrix::from_row_slice(3, 2, &[1.0, 0.0, 0.5, 2.0, 0.0, 0.0]);
    let process = discretise(&a, &g, &DMatrix::identity(2, 2), 0.8).unwrap();
    let linear = process.linearisation(2).unwrap();
    assert_eq!(linear.phi, process.phi.rows(0, 2).into_owned());
    let noise = &linear.g * DMatrix::from_diagonal(&linear.q) * linear.g.transpose();
    assert_relative_eq!(noise, process.noise.view((0, 0), (2, 2)).into_owned(), max_relative = 1e-14);
    assert!(process.linearisation(4).is_err());
}

#[test]
fn unusable_processes_are_refused() {
    let refuse = |a: f64, q_c: f64, interval_s: f64| discretise(&one(a), &one(1.0), &one(q_c), interval_s);
    assert!(matches!(refuse(-1.0, 1.0, -1.0), Err(EstimatorError::IntervalNegative { .. })));
    assert!(matches!(refuse(f64::NAN, 1.0, 1.0), Err(EstimatorError::LinearisationUnusable)));
    assert!(matches!(refuse(1e3, 1.0, 1e3), Err(EstimatorError::LinearisationUnusable)));
    assert!(matches!(
        discretise(&one(1.0), &one(1.0), &DMatrix::zeros(2, 2), 1.0),
        Err(EstimatorError::StateLength { .. })
    ));
    assert!(refuse(-1.0, -1.0, 1.0).unwrap().linearisation(1).is_err());
}

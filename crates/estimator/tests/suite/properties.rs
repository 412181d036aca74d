//! What holds for any covariance, transition and reading, however they are scaled.
use cylwatch_estimator::filter::{Linearisation, UdFactors, steady_state};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

/// Sizes: states, moving states, noise sources.
fn sizes() -> impl Strategy<Value = (usize, usize, usize)> {
    (1_usize..8).prop_flat_map(|n| (Just(n), 0..=n, 0_usize..6))
}

fn elements(count: usize) -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-1.0..1.0_f64, count)
}

/// A positive semi-definite matrix of random rank, in units up to eight decades apart.
fn covariances(n: usize) -> impl Strategy<Value = DMatrix<f64>> {
    (1..=n, prop::collection::vec(-4.0..4.0_f64, n)).prop_flat_map(move |(rank, decades)| {
        elements(n * rank).prop_map(move |a| {
            let scale = DVector::from_iterator(n, decades.iter().map(|d| 10_f64.powf(*d)));
            let root = DMatrix::from_diagonal(&scale) * DMatrix::from_vec(n, rank, a);
            &root * root.transpose()
        })
    })
}

fn transitions((n, m, k): (usize, usize, usize)) -> impl Strategy<Value = Linearisation> {
    (elements(m * n), elements(m * k), prop::collection::vec(0.0..2.0_f64, k)).prop_map(move |(phi, g, q)| {
        Linearisation {
            phi: DMatrix::from_vec(m, n, phi),
            g: DMatrix::from_vec(m, k, g),
            q: DVector::from_vec(q),
        }
    })
}

#[derive(Debug, Clone)]
struct Problem {
    p: DMatrix<f64>,
    linear: Linearisation,
    h: Vec<f64>,
    r: f64,
}

fn problems() -> impl Strategy<Value = Problem> {
    sizes().prop_flat_map(|(n, m, k)| {
        (covariances(n), transitions((n, m, k)), elements(n), -20.0..6.0_f64)
            .prop_map(|(p, linear, h, decade)| Problem { p, linear, h, r: 10_f64.powf(decade) })
    })
}

/// Symmetric, and no eigenvalue of the correlation matrix below rounding.
fn assert_is_covariance(p: &DMatrix<f64>) -> Result<(), TestCaseError> {
    prop_assert_eq!(p, &p.transpose());
    let scale = p.diagonal().map(|v| if v > 0.0 { 1.0 / v.sqrt() } else { 0.0 });
    let correlation = DMatrix::from_diagonal(&scale) * p * DMatrix::from_diagonal(&scale);
    let lowest = correlation.symmetric_eigenvalues().min();
    prop_assert!(lowest > -1e-13 * p.nrows() as f64, "eigenvalue {}", lowest);
    Ok(())
}

fn assert_steps_keep_a_covariance(mut form: UdFactors, problem: &Problem) -> Result<(), TestCaseError> {
    let n = problem.h.len();
    let mut gain = vec![0.0; n];
    for _ in 0..4 {
        let before: Vec<f64> = (0..n).map(|i| form.variance(i)).collect();
        let s = form.update(&problem.h, problem.r, &mut gain);
        prop_assert!(s >= problem.r * (1.0 - 1e-14));
        for (i, before) in before.into_iter().enumerate() {
            prop_assert!(form.variance(i) <= before * (1.0 + 1e-14), "variance {} grew", i);
        }
        assert_is_covariance(&form.covariance())?;
        form.predict(&problem.linear);
        assert_is_covariance(&form.covariance())?;
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn ud_factors_stay_a_covariance_and_no_update_adds_variance(problem in problems()) {
        let form = UdFactors::from_covariance(&problem.p).unwrap();
        assert_steps_keep_a_covariance(form.clone(), &problem)?;
        prop_assert!(form.diagonal().iter().all(|d| *d >= 0.0));
    }

    #[test]
    fn factors_and_josephs_form_agree_where_the_covariance_can_be_carried(problem in problems()) {
        let problem = Problem { r: problem.r.max(1e-2), ..problem };
        let n = problem.h.len();
        let mut dense = &problem.p / problem.p.amax().max(1e-300);
        let mut ud = UdFactors::from_covariance(&dense).unwrap();
        let (mut gain, h) = (vec![0.0; n], DVector::from_column_slice(&problem.h));
        let Linearisation { phi, g, q } = &problem.linear;
        let mut f = DMatrix::identity(n, n);
        f.rows_mut(0, phi.nrows()).copy_from(phi);
        for _ in 0..4 {
            let s = ud.update(&problem.h, problem.r, &mut gain);
            let expected_s = h.dot(&(&dense * &h)) + problem.r;
            let expected = &dense * &h / expected_s;
            prop_assert!((s / expected_s - 1.0).abs() < 1e-12);
            for (k, expected) in gain.iter().zip(&expected) {
                prop_assert!((k - expected).abs() < 1e-11);
            }
            let left = DMatrix::identity(n, n) - &expected * h.transpose();
            dense = &left * dense * left.transpose() + problem.r * &expected * expected.transpose();
            ud.predict(&problem.linear);
            dense = &f * dense * f.transpose();
            let mut leading = dense.view_mut((0, 0), (phi.nrows(), phi.nrows()));
            leading += g * DMatrix::from_diagonal(q) * g.transpose();
            prop_assert!((ud.covariance() - &dense).amax() < 1e-12 * dense.amax().max(1.0));
        }
    }

    #[test]
    fn steady_states_of_driven_processes_are_fixed_points(
        n in 1_usize..7,
        a in elements(36),
        h in elements(18),
        decade in -6.0..3.0_f64,
    ) {
        let f = DMatrix::from_fn(n, n, |i, j| a[i * n + j] * 1.2);
        let h = DMatrix::from_fn(2, n, |i, j| h[i * n + j]);
        let r = DVector::from_element(2, 10_f64.powf(decade));
        let Ok(steady) = steady_state(&f, &h, &DMatrix::identity(n, n), &r) else { return Ok(()) };
        let next = &f * &steady.updated * f.transpose() + DMatrix::identity(n, n);
        let sd = next.diagonal().map(f64::sqrt);
        let difference = (&next - &steady.predicted).map_with_location(|i, j, e| (e / (sd[i] * sd[j])).abs()).max();
        prop_assert!(difference < 1e-9, "{}", difference);
        assert_is_covariance(&steady.predicted)?;
    }
}

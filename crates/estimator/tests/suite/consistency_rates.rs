//! How often the statistics call a filter wrong: a perfect one at the nominal rate, a wrong one nearly always.
//!
//! Rates are compared by the binomial distribution, with bounds that hold in 99.9 % of cases; the seeds are fixed.
use std::convert::Infallible;

use cylwatch_estimator::consistency::{
    EnsembleNees, Finding, NisAccumulator, RunConsistency, Significance, Whiteness, normalised_error_squared,
};
use cylwatch_estimator::filter::{Dimensions, ExtendedKalman, Linearisation, StateSpace, UdFactors};
use nalgebra::{DMatrix, DVector};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use statrs::distribution::{Binomial, DiscreteCDF};

const STATES: usize = 3;

/// Three bodies in a row between which heat flows slowly; the outer two are seen.
#[derive(Clone)]
struct Row {
    phi: DMatrix<f64>,
    q: f64,
    r: f64,
}

impl Row {
    fn new(q: f64, r: f64) -> Self {
        let phi =
            DMatrix::from_row_slice(STATES, STATES, &[0.93, 0.06, 0.0, 0.06, 0.87, 0.06, 0.0, 0.06, 0.92]);
        Self { phi, q, r }
    }
}

impl StateSpace for Row {
    type Error = Infallible;

    fn dimensions(&self) -> Dimensions {
        Dimensions { states: STATES, leading: STATES, noises: STATES, outputs: 2 }
    }

    fn propagate(
        &mut self,
        x: &mut [f64],
        _dt_s: f64,
        linear: Option<&mut Linearisation>,
    ) -> Result<(), Infallible> {
        let moved = &self.phi * DVector::from_column_slice(x);
        x.copy_from_slice(moved.as_slice());
        if let Some(linear) = linear {
            linear.phi.copy_from(&self.phi);
            linear.g.fill_with_identity();
            linear.q.fill(self.q);
        }
        Ok(())
    }

    fn output(&mut self, j: usize, x: &[f64], h: Option<&mut [f64]>) -> Result<f64, Infallible> {
        let state = if j == 0 { 0 } else { STATES - 1 };
        if let Some(h) = h {
            h.fill(0.0);
            h[state] = 1.0;
        }
        Ok(x[state])
    }

    fn noise_variance(&self, _j: usize, _x: &[f64]) -> f64 {
        self.r
    }
}

/// A run of `filter` on data of `truth`, from a prior of unit variance: each sample with error and covariance.
fn run(
    rng: &mut ChaCha8Rng,
    truth: &Row,
    filter: &Row,
    samples: usize,
    mut look: impl FnMut(usize, &ExtendedKalman<Row>, &[f64]),
) {
    let mut normal = || -> f64 { StandardNormal.sample(rng) };
    let mut x: Vec<f64> = (0..STATES).map(|_| normal()).collect();
    let prior = UdFactors::from_covariance(&DMatrix::identity(STATES, STATES)).unwrap();
    let mut kalman = ExtendedKalman::try_new(filter.clone(), &[0.0; STATES], prior).unwrap();
    let mut truth = truth.clone();
    for k in 0..samples {
        if k > 0 {
            truth.propagate(&mut x, 1.0, None).unwrap();
            x.iter_mut().for_each(|x| *x += truth.q.sqrt() * normal());
        }
        let z = [x[0] + truth.r.sqrt() * normal(), x[STATES - 1] + truth.r.sqrt() * normal()];
        kalman.step(if k > 0 { 1.0 } else { 0.0 }, &z).unwrap();
        let error: Vec<f64> = kalman.state().iter().zip(&x).map(|(estimate, x)| estimate - x).collect();
        look(k, &kalman, &error);
    }
}

/// Whether so many of `runs` fit a rate, with 99.9 %.
fn fits(count: usize, runs: usize, rate: f64) -> bool {
    let binomial = Binomial::new(rate, runs as u64).unwrap();
    let count = count as u64;
    binomial.cdf(count) > 0.0005 && (count == 0 || binomial.sf(count - 1) > 0.0005)
}

const MATCHED: (f64, f64) = (0.01, 0.25);
const FIVE: Significance = Significance::FIVE_PERCENT;

fn findings(
    seed: u64,
    (runs, samples): (usize, usize),
    filter: &Row,
    judge: fn(&[[f64; 4]]) -> Finding,
) -> Vec<Finding> {
    let (mut rng, truth) = (ChaCha8Rng::seed_from_u64(seed), Row::new(MATCHED.0, MATCHED.1));
    (0..runs)
        .map(|_| {
            let mut innovations = Vec::new();
            run(&mut rng, &truth, filter, samples, |_, kalman, _| {
                let [a, b] = kalman.innovations() else { panic!("two outputs") };
                innovations.push([a.nu, a.s, b.nu, b.s]);
            });
            judge(&innovations)
        })
        .collect()
}

fn nis(innovations: &[[f64; 4]]) -> Finding {
    let mut nis = NisAccumulator::default();
    for [nu_a, s_a, nu_b, s_b] in innovations {
        nis.add(*nu_a, *s_a, true);
        nis.add(*nu_b, *s_b, true);
    }
    nis.finding(FIVE)
}

fn whiteness(innovations: &[[f64; 4]]) -> Finding {
    let mut whiteness = Whiteness::new(10);
    innovations.iter().for_each(|[nu, s, ..]| whiteness.push(nu / s.sqrt()));
    whiteness.finding(FIVE)
}

fn wrong(findings: &[Finding]) -> usize {
    findings.iter().filter(|finding| !finding.is_consistent()).count()
}

#[test]
fn a_perfect_filter_fails_the_innovation_test_at_the_nominal_rate() {
    let findings = findings(1, (600, 200), &Row::new(MATCHED.0, MATCHED.1), nis);
    assert!(fits(wrong(&findings), 600, 0.05), "{} of 600", wrong(&findings));
}

#[test]
fn a_perfect_filter_fails_the_whiteness_test_at_the_nominal_rate() {
    let findings = findings(2, (600, 200), &Row::new(MATCHED.0, MATCHED.1), whiteness);
    assert!(fits(wrong(&findings), 600, 0.05), "{} of 600", wrong(&findings));
}

#[test]
fn a_filter_whose_noise_is_off_by_two_is_found_and_told_which_way() {
    for (factor, expected) in [(0.5, Finding::TooConfident), (2.0, Finding::TooCautious)] {
        let findings = findings(3, (200, 200), &Row::new(MATCHED.0, factor * MATCHED.1), nis);
        let found = findings.iter().filter(|finding| **finding == expected).count();
        assert!(found >= 198, "noise times {factor}: {found} of 200");
    }
}

#[test]
fn a_filter_that_holds_its_state_too_tightly_has_correlated_innovations() {
    let findings = findings(4, (200, 500), &Row::new(0.001 * MATCHED.0, MATCHED.1), whiteness);
    let found = findings.iter().filter(|finding| **finding == Finding::Correlated).count();
    assert!(found >= 198, "{found} of 200");
}

#[test]
fn errors_summed_over_one_run_reject_a_perfect_filter_far_more_often_than_nominal() {
    let (mut rng, row) = (ChaCha8Rng::seed_from_u64(5), Row::new(MATCHED.0, MATCHED.1));
    let runs = 400;
    let rejected = (0..runs)
        .filter(|_| {
            // The wrong way on purpose: every sample of one run counts as an independent one.
            let mut pooled = NisAccumulator::default();
            run(&mut rng, &row, &row, 200, |_, kalman, error| {
                let squared = normalised_error_squared(error, &kalman.factors().covariance()).unwrap();
                (0..STATES).for_each(|_| pooled.add((squared / STATES as f64).sqrt(), 1.0, true));
            });
            !pooled.finding(FIVE).is_consistent()
        })
        .count();
    println!("errors summed over one run reject a perfect filter in {rejected} of {runs} runs");
    assert!(rejected > runs * 3 / 10, "{rejected} of {runs}");
}

#[test]
fn a_perfect_filter_fails_the_error_test_of_an_ensemble_at_most_at_the_nominal_rate() {
    let (mut rng, row) = (ChaCha8Rng::seed_from_u64(6), Row::new(MATCHED.0, MATCHED.1));
    let times = [0.0, 4.0, 9.0, 14.0, 19.0, 24.0, 29.0, 34.0, 39.0];
    let (ensembles, runs) = (100, 50);
    let (mut together, mut single) = (0, 0);
    for _ in 0..ensembles {
        let mut nees = EnsembleNees::new(&times, STATES);
        for _ in 0..runs {
            run(&mut rng, &row, &row, 40, |k, kalman, error| {
                if let Some(index) = times.iter().position(|time| *time == k as f64) {
                    nees.add(index, error, &kalman.factors().covariance()).unwrap();
                }
            });
        }
        together += usize::from(!nees.judge(FIVE).finding.is_consistent());
        let last = nees.times(FIVE)[times.len() - 1];
        single += usize::from(!last.band.unwrap().contains(last.mean));
    }
    // One time is judged at the nominal rate, all of them together at most at that rate.
    assert!(fits(single, ensembles, 0.05), "{single} of {ensembles}");
    assert!(together == 0 || fits(together, ensembles, 0.05) || together < 5, "{together} of {ensembles}");
}

#[test]
fn an_ensemble_finds_a_filter_whose_noise_is_off_by_two() {
    let (mut rng, truth) = (ChaCha8Rng::seed_from_u64(7), Row::new(MATCHED.0, MATCHED.1));
    for (factor, expected) in [(0.5, Finding::TooConfident), (2.0, Finding::TooCautious)] {
        let mut nees = EnsembleNees::new(&[9.0, 19.0, 39.0], STATES);
        for _ in 0..200 {
            run(&mut rng, &truth, &Row::new(MATCHED.0, factor * MATCHED.1), 40, |k, kalman, error| {
                if let Some(index) = [9, 19, 39].iter().position(|time| *time == k) {
                    nees.add(index, error, &kalman.factors().covariance()).unwrap();
                }
            });
        }
        assert_eq!(nees.judge(Significance::ONE_PERCENT).finding, expected, "noise times {factor}");
    }
}

#[test]
fn the_report_of_a_perfect_run_finds_nothing() {
    let (mut rng, row) = (ChaCha8Rng::seed_from_u64(8), Row::new(MATCHED.0, MATCHED.1));
    let mut statistics = RunConsistency::new(&["left", "right"], RunConsistency::LAGS);
    run(&mut rng, &row, &row, 3000, |_, kalman, error| {
        statistics.record_innovations(kalman.innovations());
        statistics.record_error("left", error[0], kalman.factors().variance(0).sqrt());
    });
    let report = statistics.report(Significance::ONE_PERCENT);
    assert!(report.nis.finding.is_consistent() && report.normality.is_consistent(), "{report}");
    assert!(report.outputs.iter().all(|output| output.whiteness.is_consistent()), "{report}");
    assert_eq!(report.nis.readings, 6000);
    assert!((0.92..0.98).contains(&report.coverage[0].1.share()), "{report}");
}

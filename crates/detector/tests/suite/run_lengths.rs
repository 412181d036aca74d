//! Exact run lengths against published tables and against simulation.
use approx::assert_relative_eq;
use cylwatch_detector::calibrate::{
    CusumChart, EwmaChart, RunRule, ShiryaevRobertsChart, Sides, shiryaev_roberts_arl, siegmund_arl,
    sprt_bounds,
};
use cylwatch_detector::statistic::{
    Cusum, Ewma, EwmaLimits, Shewhart, ShiryaevRoberts, Side, Sprt, SprtDecision, Statistic, TwoSidedCusum,
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

use crate::monte_carlo::{Mean, run_length};

fn cusum(reference: f64, threshold: f64, head_start: f64, sides: Sides) -> CusumChart {
    CusumChart { reference, threshold, head_start, sides }
}

/// Relative tolerance of the table, or half a unit of the last printed digit where that is coarser.
fn close(found: f64, printed: f64, unit: f64) {
    let tolerance = (1e-3 * printed).max(0.5 * unit);
    assert!((found - printed).abs() <= tolerance, "found {found}, printed {printed}");
}

#[test]
fn cumulative_sums_have_the_run_lengths_of_the_published_table() {
    // k, h, ARL0 one-sided and its unit, Siegmund's, two-sided and its unit, ARL1 at twice the reference and its unit.
    let table = [
        (0.5, 4.0, (335.4, 0.1), 338.1, (167.7, 0.1), (8.38, 0.01)),
        (0.5, 5.0, (930.9, 0.1), 938.2, (465.4, 0.1), (10.38, 0.01)),
        (0.5, 8.0, (18_970.0, 10.0), 19_110.0, (9_483.0, 1.0), (16.4, 0.1)),
        (0.5, 10.0, (1.40e5, 1e3), 1.41e5, (7.0e4, 1e3), (20.4, 0.1)),
        (0.5, 12.0, (1.04e6, 1e4), 1.05e6, (5.2e5, 1e4), (24.4, 0.1)),
        (0.25, 8.0, (736.8, 0.1), 737.8, (368.0, 1.0), (28.8, 0.1)),
    ];
    for (k, h, one, siegmund, two, delay) in table {
        let (one_sided, two_sided) = (cusum(k, h, 0.0, Sides::One), cusum(k, h, 0.0, Sides::Two));
        println!(
            "k {k}, h {h}: {:.2} {:.2} {:.3}",
            one_sided.arl(0.0),
            two_sided.arl(0.0),
            one_sided.arl(2.0 * k)
        );
        close(one_sided.arl(0.0), one.0, one.1);
        close(two_sided.arl(0.0), two.0, two.1);
        close(one_sided.arl(2.0 * k), delay.0, delay.1);
        assert_relative_eq!(siegmund_arl(k, h, 0.0), siegmund, max_relative = 6e-3);
    }
}

#[test]
fn run_lengths_in_years_give_the_published_thresholds() {
    let year_min = 365.25 * 24.0 * 60.0;
    for (arl, threshold) in [
        (year_min, 11.31),
        (10.0 * year_min, 13.62),
        (100.0 * year_min, 15.92),
        (10.0 * year_min / 60.0, 9.52),
    ] {
        let chart = CusumChart::for_arl(0.5, 0.0, Sides::One, arl).unwrap();
        // The printed ones are Siegmund's, whose run length is 0.8 % too long and threshold so much lower.
        let siegmund = chart.threshold - 0.008;
        assert!((siegmund - threshold).abs() < 0.006, "{} for {threshold}", chart.threshold);
        assert_relative_eq!(siegmund_arl(0.5, siegmund, 0.0), arl, max_relative = 2e-3);
        assert_relative_eq!(chart.arl(0.0), arl, max_relative = 1e-6);
    }
}

#[test]
fn a_head_start_has_the_run_lengths_of_lucas_and_crosier() {
    // Two-sided, k = 0.5, h = 5, head start 2.5: 430 without a shift, 6.35 at one standard deviation.
    let chart = cusum(0.5, 5.0, 0.5, Sides::Two);
    assert_relative_eq!(chart.arl(0.0), 430.0, max_relative = 2e-3);
    assert_relative_eq!(chart.arl(1.0), 6.35, max_relative = 1e-3);
    let fast = CusumChart::for_arl(0.5, 0.5, Sides::Two, 430.0).unwrap();
    assert_relative_eq!(fast.threshold, 5.0, max_relative = 1e-3);
}

#[test]
fn cumulative_sums_run_as_long_as_their_integral_equation_says() {
    for (mean, runs) in [(0.0, 6000), (0.7, 6000)] {
        for head_start in [0.0, 0.5] {
            let chart = cusum(0.4, 3.5, head_start, Sides::Two);
            let one_sided = Cusum::try_new(0.4).unwrap().with_head_start(head_start * 3.5).unwrap();
            let found = run_length(|| TwoSidedCusum::new(one_sided), 3.5, (mean, 0.0), runs, 1);
            assert!(found.agrees(chart.arl(mean), 0.1), "{found:?}, expected {}", chart.arl(mean));
        }
    }
}

#[test]
fn moving_averages_have_the_run_lengths_of_lucas_and_saccucci() {
    // Two-sided, asymptotic limits: 500 samples between false alarms.
    for (weight, threshold) in [(1.0, 3.090), (0.5, 3.071), (0.25, 2.998), (0.1, 2.814), (0.05, 2.615)] {
        let chart = EwmaChart { weight, threshold, side: Side::Both, limits: EwmaLimits::Asymptotic };
        assert_relative_eq!(chart.arl(0.0), 500.0, max_relative = 4e-3);
    }
    let chart = EwmaChart { weight: 0.1, threshold: 2.814, side: Side::Both, limits: EwmaLimits::Asymptotic };
    assert_relative_eq!(chart.arl(1.0), 10.3, max_relative = 5e-3);
}

#[test]
fn moving_averages_run_as_long_as_their_integral_equation_says() {
    for limits in [EwmaLimits::Exact, EwmaLimits::Asymptotic] {
        for (side, mean) in [(Side::Both, 0.0), (Side::Above, 0.0), (Side::Below, -1.0), (Side::Both, 1.0)] {
            let chart = EwmaChart::for_arl(0.15, side, limits, 200.0).unwrap();
            assert_relative_eq!(chart.arl(0.0), 200.0, max_relative = 1e-6);
            let new = || Ewma::try_new(0.15, side, limits).unwrap();
            let found = run_length(new, chart.threshold, (mean, 0.0), 6000, 2);
            let expected = chart.arl(mean);
            assert!(found.agrees(expected, 0.1), "{side:?}, {limits:?}: {found:?}, expected {expected}");
        }
    }
}

#[test]
fn shiryaev_roberts_runs_as_long_as_its_integral_equation_says_and_never_shorter_than_its_threshold() {
    for (shift, log_threshold) in [(1.0, 100_f64.ln()), (0.5, 200_f64.ln()), (2.0, 50_f64.ln())] {
        let chart = ShiryaevRobertsChart { shift, log_threshold };
        for mean in [0.0, shift] {
            let new = || ShiryaevRoberts::try_new(shift).unwrap();
            let found = run_length(new, log_threshold, (mean, 0.0), 6000, 3);
            assert!(found.agrees(chart.arl(mean), 0.1), "{found:?}, expected {}", chart.arl(mean));
        }
        assert!(chart.arl(0.0) >= log_threshold.exp());
        let formula = shiryaev_roberts_arl(shift, log_threshold.exp());
        assert_relative_eq!(chart.arl(0.0), formula, max_relative = 0.02);
        let again = ShiryaevRobertsChart::for_arl(-shift, chart.arl(0.0)).unwrap();
        assert_relative_eq!(again.log_threshold, log_threshold, max_relative = 1e-6);
    }
}

#[test]
fn run_rules_run_as_long_as_their_chain_says() {
    for (count, of) in [(1, 1), (3, 3), (2, 3), (3, 5)] {
        for (side, mean) in [(Side::Both, 0.0), (Side::Above, 0.5)] {
            let rule = RunRule::for_arl(side, count, of, 150.0).unwrap();
            let new = || Shewhart::with_run(side, count, of).unwrap();
            let found = run_length(new, rule.threshold, (mean, 0.0), 6000, 4);
            let expected = rule.arl(mean);
            assert!(found.agrees(expected, 0.1), "{count} of {of}: {found:?}, expected {expected}");
        }
    }
    // The chain and the closed form agree where both apply: "all of n" as "n of n" without an extra sample.
    let rule = RunRule { threshold: 1.0, side: Side::Above, count: 1, of: 4 };
    assert_relative_eq!(rule.arl_of_exceedances(0.01), 100.0, max_relative = 1e-12);
}

#[test]
fn sequential_tests_keep_their_errors_and_sample_numbers() {
    let mut random = ChaCha8Rng::seed_from_u64(5);
    for (shift, alpha, beta) in [(0.5, 0.05, 0.05), (1.0, 0.01, 0.1), (-0.3, 0.02, 0.05)] {
        let bounds = sprt_bounds(shift, alpha, beta).unwrap();
        for mean in [0.0, shift, 0.5 * shift] {
            let (mut lengths, mut changes) = (Vec::new(), 0.0);
            let runs = 8000;
            for _ in 0..runs {
                let mut test = Sprt::try_new(shift, bounds.upper, bounds.lower).unwrap();
                while test.decision() == SprtDecision::Undecided {
                    test.update(mean + random.sample::<f64, _>(StandardNormal));
                }
                lengths.push(test.samples() as f64);
                changes += f64::from(u8::from(test.decision() == SprtDecision::Change));
            }
            let found = Mean::of(&lengths);
            let expected = bounds.characteristics(mean);
            assert!(found.agrees(expected.mean_samples, 0.1), "{mean}: {found:?}, expected {expected:?}");
            let p = expected.probability_of_change;
            let error = (p * (1.0 - p) / f64::from(runs)).sqrt();
            let share = changes / f64::from(runs);
            assert!((share - p).abs() < 4.0 * error, "{mean}: {share}, expected {p}");
        }
        assert_relative_eq!(bounds.characteristics(0.0).probability_of_change, alpha, max_relative = 1e-8);
        assert_relative_eq!(
            1.0 - bounds.characteristics(shift).probability_of_change,
            beta,
            max_relative = 1e-9
        );
    }
}

#[test]
fn charts_out_of_reach_or_out_of_bounds_are_refused() {
    assert!(CusumChart::for_arl(0.5, 0.0, Sides::One, 0.5).is_err());
    assert!(CusumChart::for_arl(0.0, 0.0, Sides::One, 100.0).is_err());
    assert!(CusumChart::for_arl(0.5, 1.0, Sides::One, 100.0).is_err());
    assert!(EwmaChart::for_arl(0.0, Side::Both, EwmaLimits::Exact, 100.0).is_err());
    assert!(ShiryaevRobertsChart::for_arl(0.0, 100.0).is_err());
    assert!(RunRule::for_arl(Side::Both, 3, 2, 100.0).is_err());
    assert!(RunRule::for_arl(Side::Both, 3, 20, 100.0).is_err());
    assert!(sprt_bounds(1.0, 0.6, 0.1).is_err());
    assert!(sprt_bounds(9.0, 0.1, 0.1).is_err());
}

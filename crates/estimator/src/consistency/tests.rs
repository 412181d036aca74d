use approx::assert_relative_eq;
use nalgebra::{DMatrix, dmatrix};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Exp1, StandardNormal, StandardUniform};

use super::*;

const FIVE: Significance = Significance::FIVE_PERCENT;

fn normal(rng: &mut ChaCha8Rng) -> f64 {
    StandardNormal.sample(rng)
}

#[test]
fn bands_are_those_of_chi_square_tables() {
    let band = Band::of_mean_square(100, FIVE).unwrap();
    assert_relative_eq!(band.low, 0.742_22, epsilon = 1e-5);
    assert_relative_eq!(band.high, 1.295_61, epsilon = 1e-5);
    let one = Band::of_mean_square(1, Significance::ONE_PERCENT).unwrap();
    assert_relative_eq!(one.high, 7.879_44, epsilon = 1e-5);
    assert!(Band::of_mean_square(0, FIVE).is_none());
}

#[test]
fn the_band_of_a_year_of_readings_is_that_of_the_normal_limit() {
    let dof = 9_467_280;
    let band = Band::of_mean_square(dof, FIVE).unwrap();
    let half = FIVE.normal_quantile() * (2.0 / dof as f64).sqrt();
    // The next term of the Cornish-Fisher expansion: 2 (z^2 - 1) / (3 dof).
    let skew = 2.0 * (FIVE.normal_quantile().powi(2) - 1.0) / (3.0 * dof as f64);
    assert_relative_eq!(band.high, 1.0 + half + skew, epsilon = 1e-9);
    assert_relative_eq!(band.low, 1.0 - half + skew, epsilon = 1e-9);
}

#[test]
fn a_significance_is_a_probability_and_is_shared_among_tests() {
    for probability in [0.0, 1.0, -0.1, f64::NAN] {
        assert!(Significance::try_new(probability).is_err());
    }
    assert_relative_eq!(FIVE.normal_quantile(), 1.959_963_984_540_054, max_relative = 1e-9);
    assert_relative_eq!(FIVE.shared_by(10).probability(), 0.005);
}

#[test]
fn a_squared_error_does_not_depend_on_units() {
    let covariance: DMatrix<f64> = dmatrix![4.0, 1.0; 1.0, 1.0];
    // P^-1 = [1 -1; -1 4] / 3.
    assert_relative_eq!(
        normalised_error_squared(&[2.0, 1.0], &covariance).unwrap(),
        4.0 / 3.0,
        epsilon = 1e-14
    );
    let units = DMatrix::from_diagonal(&nalgebra::dvector![1e-9, 1e7]);
    let scaled = &units * covariance * &units;
    assert_relative_eq!(normalised_error_squared(&[2e-9, 1e7], &scaled).unwrap(), 4.0 / 3.0, epsilon = 1e-12);
}

#[test]
fn what_is_known_exactly_has_no_squared_error() {
    assert!(normalised_error_squared(&[0.0, 1.0], &dmatrix![0.0, 0.0; 0.0, 1.0]).is_err());
    assert!(normalised_error_squared(&[0.0, 1.0], &dmatrix![1.0, 1.0; 1.0, 1.0]).is_err());
    assert!(normalised_error_squared(&[0.0], &dmatrix![1.0, 0.0; 0.0, 1.0]).is_err());
}

#[test]
fn an_ensemble_knows_its_times_and_lengths() {
    let mut ensemble = EnsembleNees::new(&[0.0, 60.0], 1);
    assert_eq!(ensemble.judge(FIVE).finding, Finding::TooFew);
    assert!(ensemble.add(2, &[1.0], &dmatrix![1.0]).is_err());
    assert!(ensemble.add(0, &[1.0, 1.0], &DMatrix::identity(2, 2)).is_err());
    for _ in 0..50 {
        ensemble.add(0, &[1.0], &dmatrix![1.0]).unwrap();
        ensemble.add(1, &[2.0], &dmatrix![1.0]).unwrap();
    }
    let times = ensemble.times(FIVE);
    assert_eq!((times[0].mean, times[1].mean, times[1].runs), (1.0, 4.0, 50));
    assert_eq!(ensemble.judge(FIVE).finding, Finding::TooConfident);
}

#[test]
fn autocorrelation_of_an_alternating_series_alternates() {
    let mut whiteness = Whiteness::new(3);
    (0..100).for_each(|k| whiteness.push(if k % 2 == 0 { 1.0 } else { -1.0 }));
    for (lag, expected) in [(1, -1.0), (2, 1.0), (3, -1.0)] {
        assert_relative_eq!(whiteness.autocorrelation(lag).unwrap(), expected, epsilon = 1e-14);
    }
    assert_eq!((whiteness.autocorrelation(0), whiteness.autocorrelation(4)), (None, None));
    assert_eq!(whiteness.finding(FIVE), Finding::Correlated);
}

#[test]
fn missing_samples_leave_lags_as_they_are() {
    // Every other sample is missing: lag 1 has no pair, lag 2 has them all.
    let mut whiteness = Whiteness::new(2);
    (0..100).for_each(|k| whiteness.push(if k % 2 == 0 { 1.0 } else { f64::NAN }));
    assert_eq!(whiteness.autocorrelation(1), None);
    assert_relative_eq!(whiteness.autocorrelation(2).unwrap(), 1.0, epsilon = 1e-14);
    assert_relative_eq!(whiteness.bound(2, FIVE).unwrap(), 1.959_964 / 7.0, epsilon = 1e-6);
}

#[test]
fn autocorrelations_of_a_first_order_process_are_its_powers() {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let (mut whiteness, mut x) = (Whiteness::new(4), 0.0);
    for _ in 0..200_000 {
        x = 0.6 * x + 0.8 * normal(&mut rng);
        whiteness.push(x);
    }
    for lag in 1..=4 {
        let expected = 0.6_f64.powi(lag as i32);
        assert_relative_eq!(whiteness.autocorrelation(lag).unwrap(), expected, epsilon = 0.01);
    }
}

#[test]
fn lilliefors_agrees_with_the_critical_values_of_stephens() {
    // Stephens 1974, table 1.3: D (sqrt n - 0.01 + 0.85/sqrt n) = 0.895 at 5 %, 1.035 at 1 %.
    for n in [20.0_f64, 50.0, 100.0] {
        for (modified, probability) in [(0.895, 0.05), (1.035, 0.01)] {
            let distance = modified / (n.sqrt() - 0.01 + 0.85 / n.sqrt());
            assert_relative_eq!(normality::p_value(distance, n), probability, max_relative = 0.15);
        }
    }
    assert_eq!(normality::p_value(0.0, 50.0), 0.1);
}

#[test]
fn lilliefors_rejects_normal_samples_at_the_nominal_rate() {
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    // Rejections are binomial: expected 200 +- 13.8 and 100 +- 9.7; four standard deviations, and 10 % for the formula.
    for (n, runs, range) in [(60, 4000, 125..=275), (1000, 2000, 51..=149)] {
        let rejected = (0..runs)
            .filter(|_| {
                let sample: Vec<f64> = (0..n).map(|_| 3.0 + 7.0 * normal(&mut rng)).collect();
                lilliefors(&sample).unwrap().p_value < 0.05
            })
            .count();
        assert!(range.contains(&rejected), "{rejected} of {runs} samples of {n}");
    }
}

#[test]
fn lilliefors_tells_other_distributions_from_normal_ones() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let exponential: Vec<f64> = (0..200).map(|_| Exp1.sample(&mut rng)).collect();
    let uniform: Vec<f64> = (0..400).map(|_| StandardUniform.sample(&mut rng)).collect();
    assert!(lilliefors(&exponential).unwrap().p_value < 1e-3);
    assert!(lilliefors(&uniform).unwrap().p_value < 1e-2);
    assert!(lilliefors(&[1.0; 20]).is_none());
    assert!(lilliefors(&exponential[..7]).is_none());
}

#[test]
fn thinned_values_take_a_fixed_room_and_span_the_run_evenly() {
    let mut thinned = Normality::with_capacity(64);
    (0..10_000).for_each(|k| thinned.push(f64::from(k)));
    let kept = thinned.kept;
    assert!((32..=64).contains(&kept.len()));
    let stride = kept[1] - kept[0];
    assert!(kept.windows(2).all(|pair| pair[1] - pair[0] == stride));
    assert!(kept[0] == 0.0 && 10_000.0 - kept[kept.len() - 1] <= stride);
}

#[test]
fn coverage_has_the_interval_of_newcombe() {
    // Newcombe 1998, Statistics in Medicine 17, p. 861, method 3: 81 of 263 and 15 of 148.
    for (inside, samples, low, high) in [(81, 263, 0.2553, 0.3662), (15, 148, 0.0624, 0.1605)] {
        let interval = Coverage { inside, samples }.interval(FIVE).unwrap();
        assert_relative_eq!(interval.low, low, epsilon = 5e-5);
        assert_relative_eq!(interval.high, high, epsilon = 5e-5);
    }
}

#[test]
fn a_report_says_in_words_what_is_wrong() {
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    let mut run = RunConsistency::new(&["shoulder", "pressure"], RunConsistency::LAGS);
    let mut slow = 0.0;
    for k in 0..2000 {
        slow = 0.95 * slow + 0.312 * normal(&mut rng);
        run.record(0, normal(&mut rng), 1.0, true);
        let heard = k % 3 == 0;
        run.record(1, if heard { 2.0 * slow } else { f64::NAN }, 1.0, k % 300 != 0);
        run.record_error("gas_mean_k", normal(&mut rng), 1.0);
    }
    let report = run.report(Significance::ONE_PERCENT);
    let [shoulder, pressure] = &report.outputs[..] else { panic!("two outputs") };
    assert_eq!((shoulder.nis.finding, shoulder.whiteness), (Finding::Consistent, Finding::Consistent));
    assert_eq!((pressure.nis.finding, pressure.whiteness), (Finding::TooConfident, Finding::Correlated));
    assert_eq!((pressure.nis.readings, pressure.nis.refused), (667, 7));
    assert!((report.coverage[0].1.share() - 0.95).abs() < 0.02);
    let words = report.to_string();
    for part in
        ["the filter is too confident", "7 refused by the gate", "correlated in time", "holds the truth in 9"]
    {
        assert!(words.contains(part), "`{part}` in: {words}");
    }
}

#[test]
fn a_report_without_samples_says_so() {
    let report = RunConsistency::new(&["shoulder"], 20).report(FIVE);
    assert_eq!((report.nis.finding, report.normality), (Finding::TooFew, Finding::TooFew));
    assert_eq!(report.outputs[0].whiteness, Finding::TooFew);
    assert!(report.to_string().contains("too few to tell"));
}

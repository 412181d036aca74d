//! The mean time between false alarms that was asked for, against the one that residuals of other seeds give.
use cylwatch_detector::calibrate::{
    CalibrationSettings, CusumChart, FalseAlarms, MovingBlocks, ResidualSource, Sides, SimulatedNoise, Tail,
    block_length, calibrate_threshold, count_alarms, fit_noise,
};
use cylwatch_detector::statistic::{Cusum, Noise, Residual, Shewhart, Side, Statistic, Whitener};

const INTERVAL_S: f64 = 60.0;
/// What is asked for, samples.
const WISHED: f64 = 3000.0;

fn noise(phi: f64) -> Noise {
    Noise::ar1(0.3, phi, INTERVAL_S)
}

fn simulated(phi: f64, seed: u64) -> SimulatedNoise {
    SimulatedNoise::try_new(noise(phi), INTERVAL_S, seed).unwrap()
}

fn record(phi: f64, seed: u64, n: usize) -> Vec<Residual> {
    let mut source = simulated(phi, seed);
    (0..n).map(|_| source.next_residual()).collect()
}

/// A cumulative sum of residuals as they are, in units of 0.3.
fn raw() -> impl FnMut(Residual) -> f64 {
    let mut sum = Cusum::try_new(0.5).unwrap();
    move |residual: Residual| sum.update(residual.value / 0.3)
}

/// A cumulative sum of whitened residuals.
fn whitened(noise: Noise) -> impl FnMut(Residual) -> f64 {
    let mut whitener = Whitener::try_new(noise).unwrap();
    let mut sum = Cusum::try_new(0.5).unwrap();
    move |residual| whitener.whiten(residual).map_or(0.0, |whitened| sum.update(whitened.value))
}

fn shewhart() -> impl FnMut(Residual) -> f64 {
    let mut chart = Shewhart::new(Side::Both);
    move |residual: Residual| chart.update(residual.value / 0.3)
}

/// Achieved on other seeds, within a quarter of what was asked for.
fn within_a_quarter(name: &str, phi: f64, found: FalseAlarms, wished: f64) {
    let (low, high) = found.interval(0.95);
    println!("{name}, {phi}: wished {wished:.0}, achieved {:.0} ({low:.0} to {high:.0})", found.mean());
    assert!((found.mean() / wished - 1.0).abs() < 0.25, "{name}, {phi}: {found:?}");
    assert!(found.alarms > 250, "{name}, {phi}: too few alarms to tell");
}

#[test]
fn the_integral_equation_holds_for_whitened_residuals() {
    let threshold = CusumChart::for_arl(0.5, 0.0, Sides::One, WISHED).unwrap().threshold;
    for (phi, seed) in [(0.0, 21), (0.9, 22), (0.99, 23)] {
        let found = count_alarms(&mut simulated(phi, seed), || whitened(noise(phi)), threshold, 2_000_000);
        within_a_quarter("integral equation", phi, found, WISHED);
    }
}

#[test]
fn simulation_of_fitted_noise_calibrates_a_sum_of_raw_residuals() {
    for phi in [0.0, 0.9, 0.99] {
        let fitted = fit_noise(&record(phi, 31, 60_000)).unwrap().noise;
        let mut source = SimulatedNoise::try_new(fitted, INTERVAL_S, 32).unwrap();
        let settings = CalibrationSettings::new(WISHED);
        let calibrated = calibrate_threshold(&mut source, raw, &settings).unwrap();
        let (low, high) = calibrated.achieved.unwrap().interval(0.99);
        assert!(low < 1.1 * WISHED && high > 0.9 * WISHED, "{calibrated:?}");
        let found = count_alarms(&mut simulated(phi, 33), raw, calibrated.threshold, 2_000_000);
        within_a_quarter("simulation", phi, found, WISHED);
    }
}

#[test]
fn blocks_of_recorded_residuals_calibrate_a_sum_of_raw_residuals() {
    for (phi, n) in [(0.0, 30_000), (0.9, 60_000), (0.99, 600_000)] {
        let residuals = record(phi, 41, n);
        let block = block_length(&residuals[..n.min(60_000)]).unwrap();
        let mut source = MovingBlocks::try_new(&residuals, block, 42).unwrap();
        let calibrated = calibrate_threshold(&mut source, raw, &CalibrationSettings::new(WISHED)).unwrap();
        println!("blocks of {block}");
        let found = count_alarms(&mut simulated(phi, 43), raw, calibrated.threshold, 2_000_000);
        within_a_quarter("blocks", phi, found, WISHED);
    }
}

#[test]
fn longer_mean_times_than_were_run_are_extrapolated() {
    let wished = 20_000.0;
    let settings = |tail| CalibrationSettings { longest_run: 2000, tail, runs: 1500, arl: wished };
    let noise = noise(0.9);
    let sum = calibrate_threshold(&mut simulated(0.9, 51), || whitened(noise), &settings(Tail::Exponential));
    let sum = sum.unwrap();
    assert_eq!((sum.achieved, sum.run_to), (None, 2000.0));
    let exact = CusumChart { reference: 0.5, threshold: sum.threshold, head_start: 0.0, sides: Sides::One };
    assert!((exact.arl(0.0) / wished - 1.0).abs() < 0.25, "{}", exact.arl(0.0));
    let chart = calibrate_threshold(&mut simulated(0.9, 52), shewhart, &settings(Tail::Normal)).unwrap();
    let found = count_alarms(&mut simulated(0.9, 53), shewhart, chart.threshold, 8_000_000);
    within_a_quarter("extrapolated Shewhart", 0.9, found, wished);
}

#[test]
fn a_statistic_that_never_moves_cannot_be_calibrated() {
    let settings = CalibrationSettings::new(100.0);
    assert!(calibrate_threshold(&mut simulated(0.0, 1), || |_: Residual| 1.0, &settings).is_err());
    let settings = CalibrationSettings::new(1.0);
    assert!(calibrate_threshold(&mut simulated(0.0, 1), raw, &settings).is_err());
}

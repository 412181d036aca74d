//! The mean time between false alarms that was asked for, and the one that is achieved, in white and coloured residuals;
//! and the mean delay of the likelihood ratio of a ramp against the bound.
//!
//! `cargo run --release -p cylwatch-detector --example false_alarm_rates` (half a minute; one without `--release`)
#![allow(clippy::print_stdout)]
use cylwatch_detector::DetectorError;
use cylwatch_detector::calibrate::{
    CalibrationSettings, Change, CusumChart, FalseAlarms, GlrChart, MovingBlocks, ResidualSource, Sides,
    SimulatedNoise, block_length, calibrate_threshold, count_alarms, fit_noise,
};
use cylwatch_detector::statistic::{
    Cusum, Glr, GlrSettings, Noise, Residual, Shape, Side, Statistic, Whitener,
};
use rayon::prelude::*;

const HOUR_S: f64 = 3600.0;
const SD: f64 = 0.3;
/// Mean number of samples between false alarms of the cumulative sums.
const WISHED: f64 = 3000.0;

fn main() -> Result<(), DetectorError> {
    println!(
        "Cumulative sum, k = 0.5, {WISHED} samples between false alarms asked for; achieved (95 % interval):\n"
    );
    println!("| correlation | set by | achieved |\n|---|---|---|");
    for phi in [0.0, 0.9, 0.99] {
        sums(phi)?;
    }
    println!("\nLikelihood ratio of a ramp, noise 0.3 bar, 3 h, hourly, window 720 h:\n");
    println!("| asked for, h | threshold | achieved, h |\n|---|---|---|");
    for wished_h in [1e3, 1e4, 1e5] {
        ramp_alarms(wished_h)?;
    }
    println!("\n| bar/h | bound, h | mean delay, h | efficiency |\n|---|---|---|---|");
    for rate in [0.001, 0.002, 0.005, 0.01, 0.03, 0.1, 0.3] {
        ramp_delay(rate)?;
    }
    Ok(())
}

fn noise() -> Noise {
    Noise::ornstein_uhlenbeck(SD, 3.0 * HOUR_S)
}

fn source(noise: Noise, seed: u64) -> Result<SimulatedNoise, DetectorError> {
    SimulatedNoise::try_new(noise, HOUR_S, seed)
}

fn achieved(found: &FalseAlarms) -> String {
    let (low, high) = found.interval(0.95);
    format!("{:.0} ({low:.0} to {high:.0})", found.mean())
}

/// A cumulative sum of residuals as they are.
fn raw() -> impl FnMut(Residual) -> f64 {
    let mut sum = Cusum::try_new(0.5).expect("finite reference");
    move |residual: Residual| sum.update(residual.value / SD)
}

/// A cumulative sum of whitened residuals.
fn whitened(noise: Noise) -> impl FnMut(Residual) -> f64 {
    let mut whitener = Whitener::try_new(noise).expect("valid noise");
    let mut sum = Cusum::try_new(0.5).expect("finite reference");
    move |residual| whitener.whiten(residual).map_or(0.0, |whitened| sum.update(whitened.value))
}

/// Three ways to a threshold, each from three records.
fn sums(phi: f64) -> Result<(), DetectorError> {
    let noise = Noise::ar1(SD, phi, HOUR_S);
    let samples = 10_000_000;
    let exact = CusumChart::for_arl(0.5, 0.0, Sides::One, WISHED)?.threshold;
    // Whitened samples of one seed are the same whatever the correlation: another seed for each.
    let seed = (1000.0 * phi) as u64;
    let found = count_alarms(&mut source(noise, seed)?, || whitened(noise), exact, samples);
    println!("| {phi} | integral equation, whitened | {} |", achieved(&found));
    for seed in 1..=3 {
        let mut recorded = source(noise, 100 + seed)?;
        let record: Vec<Residual> = (0..600_000).map(|_| recorded.next_residual()).collect();
        let settings = CalibrationSettings { runs: 1000, ..CalibrationSettings::new(WISHED) };
        let fitted = fit_noise(&record[..60_000])?.noise;
        let by_fit = calibrate_threshold(&mut source(fitted, 200 + seed)?, raw, &settings)?;
        let found = count_alarms(&mut source(noise, 300 + seed)?, raw, by_fit.threshold, samples);
        println!("| {phi} | simulation of the noise fitted to 60 000 samples | {} |", achieved(&found));
        let mut blocks = MovingBlocks::try_new(&record, block_length(&record[..60_000])?, 400 + seed)?;
        let by_blocks = calibrate_threshold(&mut blocks, raw, &settings)?;
        let found = count_alarms(&mut source(noise, 300 + seed)?, raw, by_blocks.threshold, samples);
        println!("| {phi} | blocks of 600 000 samples | {} |", achieved(&found));
    }
    Ok(())
}

fn ramp_chart(wished_h: f64) -> Result<GlrChart, DetectorError> {
    let (shape, side) = (Shape::Ramp, Side::Above);
    GlrChart { shape, side, noise: noise(), interval_s: HOUR_S, window: 720, threshold: 0.0 }
        .for_arl(wished_h)
}

fn ramp() -> Glr {
    let settings = GlrSettings { side: Side::Above, window: 720, ..GlrSettings::new(Shape::Ramp, noise()) };
    Glr::try_new(settings).expect("valid settings")
}

fn ramp_alarms(wished_h: f64) -> Result<(), DetectorError> {
    let threshold = ramp_chart(wished_h)?.threshold;
    let counts: Result<Vec<FalseAlarms>, DetectorError> = (0..16_u64)
        .into_par_iter()
        .map(|seed| {
            let detector = || {
                let mut glr = ramp();
                move |residual| glr.update(residual)
            };
            let samples = (20.0 * wished_h) as u64;
            Ok(count_alarms(&mut source(noise(), 500 + seed)?, detector, threshold, samples))
        })
        .collect();
    let found = counts?.iter().fold(FalseAlarms::default(), |sum, count| FalseAlarms {
        alarms: sum.alarms + count.alarms,
        samples: sum.samples + count.samples,
    });
    println!("| {wished_h:.0} | {threshold:.3} | {} |", achieved(&found));
    Ok(())
}

/// A ramp after 800 hours without one; runs that alarm before it are left out.
fn ramp_delay(rate: f64) -> Result<(), DetectorError> {
    let (wished_h, before, runs) = (1e5, 800_u32, 2000);
    let threshold = ramp_chart(wished_h)?.threshold;
    let mut source = source(noise(), 600)?;
    let mut delays = Vec::new();
    for run in 0..runs {
        source.begin(run);
        let mut glr = ramp();
        let mut alarms = |n: u32| {
            let residual = source.next_residual();
            let value = residual.value + rate * f64::from(n.saturating_sub(before));
            glr.update(Residual { value, ..residual }) >= threshold
        };
        delays.extend((0..).find(|n| alarms(*n)).filter(|n| *n > before).map(|n| f64::from(n - before)));
    }
    let n = delays.len() as f64;
    let mean = delays.iter().sum::<f64>() / n;
    let sd = (delays.iter().map(|delay| (delay - mean).powi(2)).sum::<f64>() / n).sqrt();
    let bound_h = Change::Ramp(rate / HOUR_S).delay_bound(noise(), HOUR_S, wished_h * HOUR_S) / HOUR_S;
    let error = sd / n.sqrt();
    println!("| {rate} | {bound_h:.1} | {mean:.1} +- {error:.1} | {:.3} |", bound_h / mean);
    Ok(())
}

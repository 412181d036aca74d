//! Delay of the likelihood ratio of a ramp against the bound that no detector can go below.
use cylwatch_detector::calibrate::{Change, GlrChart, ResidualSource, SimulatedNoise};
use cylwatch_detector::statistic::{Glr, GlrSettings, Noise, Residual, Shape, Side, Statistic};

use crate::monte_carlo::Mean;

const HOUR_S: f64 = 3600.0;
/// Hours without a change before it.
const BEFORE: u32 = 800;
/// Mean time between false alarms, h.
const BETWEEN_ALARMS_H: f64 = 1e5;

/// Mean delay, h, of a change (a ramp per hour) over runs that do not alarm before it.
fn mean_delay_h(change: Change, chart: &GlrChart, runs: u64) -> Mean {
    let GlrChart { noise, threshold, shape, side, window, .. } = *chart;
    let mut source = SimulatedNoise::try_new(noise, HOUR_S, 71).unwrap();
    let settings = GlrSettings { side, window, ..GlrSettings::new(shape, noise) };
    let delays: Vec<f64> = (0..runs)
        .filter_map(|run| {
            source.begin(run);
            let mut glr = Glr::try_new(settings).unwrap();
            let mut update = |n: u32| {
                let residual = source.next_residual();
                let since = f64::from(n.saturating_sub(BEFORE));
                let added = match change {
                    Change::Ramp(rate) => rate * since,
                    Change::Step(size) => size * since.min(1.0),
                };
                glr.update(Residual { value: residual.value + added, ..residual }) >= threshold
            };
            let first = (0..).find(|n| update(*n))?;
            (first > BEFORE).then(|| f64::from(first - BEFORE))
        })
        .collect();
    assert!(delays.len() as f64 > 0.95 * runs as f64, "alarms before the change");
    Mean::of(&delays)
}

#[test]
fn ramps_in_coloured_residuals_are_found_within_the_bound_over_0_85() {
    let noise = Noise::ornstein_uhlenbeck(0.3, 3.0 * HOUR_S);
    let chart = GlrChart {
        shape: Shape::Ramp,
        side: Side::Above,
        noise,
        interval_s: HOUR_S,
        window: 720,
        threshold: 0.0,
    };
    let chart = chart.for_arl(BETWEEN_ALARMS_H).unwrap();
    println!("threshold {:.2}", chart.threshold);
    // Rate, bar/h; mean delay published, h.
    for (rate, published) in
        [(0.001, 302.0), (0.002, 191.0), (0.005, 103.0), (0.01, 64.0), (0.03, 30.0), (0.1, 12.2), (0.3, 4.8)]
    {
        let bound_h =
            Change::Ramp(rate / HOUR_S).delay_bound(noise, HOUR_S, BETWEEN_ALARMS_H * HOUR_S) / HOUR_S;
        let found = mean_delay_h(Change::Ramp(rate), &chart, 300);
        let efficiency = bound_h / found.mean;
        println!(
            "{rate} bar/h: bound {bound_h:.1} h, delay {:.1} +- {:.1} h (published {published}), efficiency {efficiency:.3}",
            found.mean, found.error
        );
        assert!(efficiency >= 0.85, "{rate}: {efficiency}");
        assert!((found.mean / published - 1.0).abs() < 0.06, "{rate}: {found:?}");
        let expected_h = chart.delay_s(Change::Ramp(rate / HOUR_S)) / HOUR_S;
        assert!((expected_h / found.mean - 1.0).abs() < 0.06, "{rate}: {found:?}, expected {expected_h}");
    }
}

#[test]
fn steps_in_white_residuals_are_found_after_the_delay_that_the_chart_says() {
    let chart = GlrChart {
        shape: Shape::Step,
        side: Side::Both,
        noise: Noise::white(1.0),
        interval_s: HOUR_S,
        window: 720,
        threshold: 0.0,
    };
    let chart = chart.for_arl(5e4).unwrap();
    for size in [0.3, 0.4, 0.7, 1.2] {
        let found = mean_delay_h(Change::Step(size), &chart, 600);
        let expected_h = chart.delay_s(Change::Step(size)) / HOUR_S;
        println!("step {size}: {:.1} +- {:.1} h, expected {expected_h:.1} h", found.mean, found.error);
        assert!((expected_h / found.mean - 1.0).abs() < 0.06, "{size}: {found:?}, expected {expected_h}");
    }
}

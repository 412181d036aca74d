//! Mean time between false alarms of the likelihood ratio, as its formula says.
use cylwatch_detector::calibrate::{
    CalibrationSettings, FalseAlarms, GlrChart, SimulatedNoise, calibrate_threshold, count_alarms,
    siegmund_venkatraman_arl,
};
use cylwatch_detector::statistic::{Glr, GlrSettings, Noise, Residual, Shape, Side, Statistic};

fn detector(settings: GlrSettings) -> impl FnMut(Residual) -> f64 {
    let mut glr = Glr::try_new(settings).unwrap();
    move |residual| glr.update(residual)
}

fn achieved(chart: &GlrChart, samples: u64, seed: u64) -> FalseAlarms {
    let GlrChart { shape, side, noise, window, .. } = *chart;
    let settings = GlrSettings { shape, side, noise, window, per_octave: 8 };
    let mut source = SimulatedNoise::try_new(noise, chart.interval_s, seed).unwrap();
    count_alarms(&mut source, || detector(settings), chart.threshold, samples)
}

fn chart(shape: Shape, side: Side, noise: Noise, arl: f64) -> GlrChart {
    GlrChart { shape, side, noise, interval_s: 1.0, window: 720, threshold: 0.0 }.for_arl(arl).unwrap()
}

#[test]
fn the_formula_gives_the_requested_mean_time_within_a_quarter() {
    let wished = 2500.0;
    let ramp = (Shape::Ramp, Side::Above);
    for (noise, (shape, side)) in [
        (Noise::white(0.3), ramp),
        (Noise::ar1(0.3, 0.9, 1.0), ramp),
        (Noise::ar1(0.3, 0.99, 1.0), ramp),
        (Noise::white(0.3), (Shape::Step, Side::Both)),
        (Noise::ar1(0.3, 0.1, 1.0), (Shape::Step, Side::Both)),
    ] {
        let found = achieved(&chart(shape, side, noise, wished), 800_000, 61);
        let (low, high) = found.interval(0.95);
        println!("{shape:?}, {noise:?}: {:.0} ({low:.0} to {high:.0}) of {wished}", found.mean());
        assert!((found.mean() / wished - 1.0).abs() < 0.25, "{shape:?}, {noise:?}: {found:?}");
    }
}

#[test]
fn steps_in_coloured_noise_are_calibrated_by_simulation() {
    let wished = 1500.0;
    for phi in [0.9, 0.99] {
        let noise = Noise::ar1(0.3, phi, 1.0);
        let refused = GlrChart {
            shape: Shape::Step,
            side: Side::Both,
            noise,
            interval_s: 1.0,
            window: 720,
            threshold: 0.0,
        };
        assert!(refused.for_arl(wished).is_err());
        let settings = GlrSettings { window: 720, ..GlrSettings::new(Shape::Step, noise) };
        let mut source = SimulatedNoise::try_new(noise, 1.0, 64).unwrap();
        let calibration = CalibrationSettings::new(wished);
        let calibrated = calibrate_threshold(&mut source, || detector(settings), &calibration).unwrap();
        let found = achieved(&GlrChart { threshold: calibrated.threshold, ..refused }, 600_000, 65);
        println!("step, {phi}: {:.0} of {wished}", found.mean());
        assert!((found.mean() / wished - 1.0).abs() < 0.25, "{phi}: {found:?}");
    }
}

#[test]
fn ramps_in_coloured_noise_have_the_published_mean_times() {
    // Correlation time 3 h, hourly, window 720 h: log-likelihood ratio and mean time simulated elsewhere, h.
    for (threshold, published) in
        [(6.0, 1078.0), (7.0, 2812.0), (8.0, 7034.0), (10.0, 50_820.0), (10.8, 99_579.0)]
    {
        let noise = Noise::ornstein_uhlenbeck(0.3, 3.0);
        let chart = GlrChart { threshold, ..chart(Shape::Ramp, Side::Above, noise, 1000.0) };
        println!("{threshold}: formula {:.0}, published {published}", chart.arl());
        assert!((chart.arl() / published - 1.0).abs() < 0.1, "{threshold}: {}", chart.arl());
    }
}

#[test]
fn steps_in_white_noise_have_the_published_mean_times() {
    // Two-sided, simulated elsewhere.
    for (b, published) in [(3.5_f64, 527.0), (4.0, 2672.0), (4.5, 18_792.0)] {
        let threshold = 0.5 * b * b;
        let chart = GlrChart { threshold, ..chart(Shape::Step, Side::Both, Noise::white(1.0), 1000.0) };
        assert!((chart.arl() / published - 1.0).abs() < 0.2, "{b}: {}", chart.arl());
        assert!((chart.arl() / siegmund_venkatraman_arl(threshold) - 1.0).abs() < 0.1);
        if b < 4.1 {
            let found = achieved(&chart, 500_000, 62);
            assert!((found.mean() / published - 1.0).abs() < 0.15, "{b}: {found:?}");
        }
    }
}

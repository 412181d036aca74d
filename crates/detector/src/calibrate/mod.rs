//! From a mean time between false alarms to a threshold, and how short a delay can be at that price.
//!
//! * Independent residuals, exactly: [`CusumChart`], [`EwmaChart`], [`ShiryaevRobertsChart`] solve the integral
//!   equation of the run length, [`SprtBounds`] that of its test; [`RunRule`] solves its Markov chain. Mean run length without a change is the mean
//!   time between false alarms, with a change it is the mean delay. Every chart has `for_arl`, the inverse.
//! * In closed form, approximately: [`siegmund_arl`], [`shiryaev_roberts_arl`], [`siegmund_venkatraman_arl`],
//!   and [`GlrChart`] for steps and ramps in white or coloured noise on a window.
//! * From residuals as they are, coloured and heavy-tailed: [`calibrate_threshold`] feeds a detector from
//!   [`SimulatedNoise`] fitted by [`fit_noise`], or from [`MovingBlocks`] of leak-free data, and states the
//!   mean time that the threshold achieves on other draws, with a confidence interval ([`FalseAlarms`]).
//! * [`Change::delay_bound`] is the delay that no detector can go below.
//!
//! All run lengths are numbers of samples; times in seconds are named so.
//!
//! A leak of 0.05 bar/h in hourly residuals that wander by 0.3 bar over 3 h, one false alarm in ten years:
//!
//! ```
//! use cylwatch_detector::calibrate::{Change, GlrChart};
//! use cylwatch_detector::statistic::{Glr, GlrSettings, Noise, Residual, Shape, Side, Statistic};
//!
//! let hour_s = 3600.0;
//! let noise = Noise::ornstein_uhlenbeck(0.3, 3.0 * hour_s);
//! let (shape, side, window) = (Shape::Ramp, Side::Below, 720);
//! let chart = GlrChart { shape, side, noise, interval_s: hour_s, window, threshold: 0.0 };
//! let chart = chart.for_arl(10.0 * 8766.0)?;
//!
//! let leak = Change::Ramp(-0.05 / hour_s);
//! let shortest_h = leak.delay_bound(noise, hour_s, 10.0 * 8766.0 * hour_s) / hour_s;
//! assert!(shortest_h < 21.0 && chart.delay_s(leak) / hour_s < 22.0);
//!
//! let mut glr = Glr::try_new(GlrSettings { side, window, ..GlrSettings::new(shape, noise) })?;
//! let alarm = (0..100).map(f64::from).find(|hour| {
//!     let lost_bar = 0.05 * (hour - 50.0).max(0.0);
//!     glr.update(Residual { time_s: hour * hour_s, value: -lost_bar }) >= chart.threshold
//! });
//! assert!(alarm.is_some());
//! let leak = glr.finding().and_then(|finding| finding.refined).expect("a ramp was found");
//! assert!((leak.size * hour_s + 0.05).abs() < 1e-6 && (leak.onset_s / hour_s - 50.0).abs() < 1e-3);
//! # Ok::<(), cylwatch_detector::DetectorError>(())
//! ```
mod approximation;
mod blocks;
mod bound;
mod cusum;
mod ewma;
mod false_alarms;
mod fit;
mod glr;
mod quadrature;
mod run_rule;
mod shiryaev_roberts;
mod signature;
mod solve;
mod source;
mod sprt;
mod threshold;

pub use approximation::{
    MEAN_OVERSHOOT, shiryaev_roberts_arl, siegmund_arl, siegmund_venkatraman_arl,
    siegmund_venkatraman_threshold,
};
pub use blocks::{MovingBlocks, autocorrelation_time, block_length};
pub use bound::Change;
pub use cusum::{CusumChart, Sides};
pub use ewma::EwmaChart;
pub use false_alarms::{FalseAlarms, count_alarms};
pub use fit::{NoiseFit, fit_noise};
pub use glr::GlrChart;
pub use run_rule::RunRule;
pub use shiryaev_roberts::ShiryaevRobertsChart;
pub use signature::signature_threshold_sd;
pub use source::{ResidualSource, SimulatedNoise};
pub use sprt::{SprtBounds, SprtCharacteristics, sprt_bounds};
pub use threshold::{Calibrated, CalibrationSettings, Tail, calibrate_threshold};

/// Density of the standard normal distribution.
pub(crate) fn normal_density(x: f64) -> f64 {
    (-0.5 * x * x).exp() / std::f64::consts::TAU.sqrt()
}

/// Distribution function of the standard normal distribution.
pub(crate) fn normal_probability(x: f64) -> f64 {
    0.5 * statrs::function::erf::erfc(-x / std::f64::consts::SQRT_2)
}

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

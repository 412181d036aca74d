//! How good a leak detector is, from runs whose truth is known: pure functions, each result with an interval.
//!
//! The words are those of the American Petroleum Institute's practice for pipelines: reliability is how seldom a detector alarms without a
//! leak (`alarm_level` sets thresholds for it), sensitivity how small a leak it finds how soon (`Detection`, [`SmallestLeak`],
//! [`Delay`]). An alarm before the onset of a leak is a false one; such a run says nothing about the leak.
//!
//! Source: API RP 1130, Computational Pipeline Monitoring for Liquids; API RP 1149.
mod class;
mod delay;
mod detection;
mod level;
mod run;
mod smallest;
mod survival;
mod trace;

pub use class::Class;
pub use delay::Delay;
pub(crate) use detection::{Detection, Horizon, Proportion};
pub use level::AlarmLevel;
pub(crate) use level::alarm_level;
pub use run::Run;
pub(crate) use run::by_rate;
pub use smallest::{Reached, SmallestLeak};
pub(crate) use survival::{Observed, Survival};
pub use trace::Trace;

/// Confidence of every interval that is not asked for at another one.
pub(crate) const CONFIDENCE: f64 = 0.95;

/// Quantile of the standard normal distribution that leaves half of `1 - level` above it.
fn normal_quantile(level: f64) -> f64 {
    use statrs::distribution::{ContinuousCDF, Normal};
    let level = level.clamp(0.0, 1.0 - 1e-12);
    Normal::standard().inverse_cdf(0.5 + 0.5 * level)
}

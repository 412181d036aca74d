//! How good a leak detector is, from records of runs whose truth is known.
//!
//! The words are those of the American Petroleum Institute's practice for pipelines, which ask of every leak detector:
//!
//! | word | question | measure |
//! |---|---|---|
//! | reliability | how often does it alarm without a leak? | [`AlarmRate`]: alarms per cylinder-year |
//! | sensitivity | how small a leak does it find, how soon? | [`Detection`], [`SmallestLeak`], [`Delay`] against the delay that no detector can go below |
//! | accuracy | how well does it say how much and since when? | [`Accuracy`] of rate and onset, coverage of their intervals; [`Confusion`] of classes |
//!
//! Every measure is a pure function of [`Run`]s and comes with an interval, since a number of runs is all that stands
//! behind it. An alarm before the onset of a leak is a false one: it ends the time at risk, and such a run says nothing
//! about the leak.
//!
//! ```
//! use cylwatch_evaluation::performance::{Performance, Run, TrueLeak, Horizon};
//!
//! let (hour_s, day_s) = (3600.0, 86_400.0);
//! let watched = |seed, alarm_s| Run { seed, leak: None, from_s: 0.0, until_s: 30.0 * day_s, alarm_s, found: None };
//! let tight: Vec<Run> = (0..100).map(|seed| watched(seed, None)).collect();
//! let leak = Some(TrueLeak { rate_pa_s: 0.1e5 / hour_s, onset_s: day_s });
//! let leaking = (0..40).map(|seed| Run { leak, ..watched(seed, Some(day_s + 3.0 * hour_s)) });
//! let runs: Vec<Run> = tight.into_iter().chain(leaking).collect();
//!
//! let performance = Performance::of("monitor", &runs, |_| None);
//! // 100 times 30 days and 40 days before the leaks without an alarm: fewer than one in 2.3 years.
//! assert!((performance.reliability.cylinder_years() - 8.32).abs() < 0.01);
//! assert!((performance.reliability.per_year_interval(0.95).1 - 0.443).abs() < 0.001);
//! let found = performance.sensitivity[0].within(Horizon::Day).wilson(0.95);
//! assert!(found.0 > 0.91);
//! ```
//!
//! [`mod@bench`] makes such runs: detectors side by side on the same simulated cylinders. [`fault`](crate::fault) puts faults into good rows.
//!
//! Source: API RP 1130, Computational Pipeline Monitoring for Liquids; API RP 1149.
mod accuracy;
mod alarm_rate;
pub mod bench;
mod confusion;
mod delay;
mod detection;
mod proportion;
mod run;
mod smallest;
mod summary;
mod survival;

pub use accuracy::{Accuracy, Errors};
pub use alarm_rate::AlarmRate;
pub use confusion::{Class, Confusion};
pub use delay::Delay;
pub use detection::{Detection, Horizon};
pub use proportion::Proportion;
pub use run::{Estimated, Found, Run, TrueLeak, by_rate};
pub use smallest::{Reached, SmallestLeak};
pub use summary::{Performance, Row, Sensitivity};
pub use survival::{Observed, Survival};

/// Confidence of every interval that is not asked for at another one.
pub const CONFIDENCE: f64 = 0.95;

/// Quantile of the standard normal distribution that leaves half of `1 - level` above it.
fn normal_quantile(level: f64) -> f64 {
    use statrs::distribution::{ContinuousCDF, Normal};
    let level = level.clamp(0.0, 1.0 - 1e-12);
    Normal::standard().inverse_cdf(0.5 + 0.5 * level)
}

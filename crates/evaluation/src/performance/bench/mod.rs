//! All detectors on the same readings: from seeds to the measures of each.
//!
//! A [`Plan`] says which cylinders are simulated ([`crate::truth`]): courses, leak rates, seeds. Each simulated cylinder is
//! read once by imperfect sensors, and every [`Candidate`] sees the same rows. What a candidate's statistic reaches for the first time is
//! kept ([`Trace`]), so that one pass serves every threshold. The thresholds are set on tight cylinders of the training
//! seeds for one mean time between false alarms ([`AlarmLevel`]); cylinders of other seeds, tight and leaking, then judge all candidates
//! at them ([`bench()`]).
//!
//! A leak is a constant mass flow from a random time of the day after learning on. Watching ends when it has taken 40 % of
//! the gas: who has not noticed by then counts as having missed it at any horizon.
//!
//! # What stands behind the numbers
//! Some cylinder-years of training reach a mean time between false alarms of as many years, beyond that the tail is extrapolated ([`AlarmLevel::factor`]
//! says how far); the tests bound the false-alarm rate by about four per total length ([`super::AlarmRate`]). The simulation knows
//! its own weather alone.
mod baselines;
mod candidate;
mod case;
mod level;
mod monitored;
mod plan;
mod result;
mod trace;

pub use baselines::baselines;
pub use candidate::{Candidate, Contender, Readings};
pub use level::{AlarmLevel, alarm_level};
pub use monitored::monitor;
pub use plan::Plan;
pub use result::{Judged, Outcome, Progress, bench};
pub use trace::{Highest, Trace};

#[cfg(test)]
mod tests;

//! The monitor: rows of a log in, a verdict and events out.
pub mod alarm;
mod event;
mod output;
mod verdict;

pub use event::{Event, EventKind};
pub use output::{Health, Interval, LeakFinding, Outlook, Output};
pub use verdict::{Reason, Verdict};

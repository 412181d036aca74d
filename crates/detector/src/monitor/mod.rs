//! The monitor: rows of a log in, a verdict and events out.
mod event;
pub mod intake;
mod output;
mod verdict;

pub use event::{Event, EventKind};
pub use output::{Health, Interval, LeakFinding, Outlook, Output};
pub use verdict::{Reason, Verdict};

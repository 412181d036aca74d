//! The monitor: rows of a log in, a verdict and events out.
mod event;
pub mod health;
pub mod intake;
pub mod jump;
pub mod onset;
mod output;
pub mod trace;
mod verdict;

pub use event::{Event, EventKind};
pub use output::{Health, Interval, LeakFinding, Outlook, Output};
pub use verdict::{Reason, Verdict};

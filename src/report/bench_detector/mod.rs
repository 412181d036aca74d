//! Detectors side by side: the judge's table for all worlds that judge, as a summary and as a figure.
mod figure;
mod summary;

use crate::evaluation::judge::table::{CandidateReport, Leaks};

pub use figure::figure;
pub use summary::summary;

/// What the figure shows.
pub(crate) const CAPTION: &str = "Median delay against the leak rate of each detector with its interval, and the shortest delay that is possible.";

/// What a candidate finds of leaks; `None`: it watched none.
fn leaks(candidate: &CandidateReport) -> Option<&Leaks> {
    candidate.judged()?.leaks.as_ref()
}

#[cfg(test)]
mod tests;

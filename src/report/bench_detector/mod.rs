//! Detectors side by side as words, as a figure, as CSV and JSON.
mod document;
mod figure;
mod summary;

pub use document::{document, table};
pub use figure::figure;
pub use summary::summary;

/// What the figure shows.
pub const CAPTION: &str = "Median delay against the leak rate of each detector with its interval, and the shortest delay that is possible.";

#[cfg(test)]
mod tests;

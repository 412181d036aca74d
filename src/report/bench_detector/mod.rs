//! Detectors side by side as words, as a figure, as CSV and JSON.
mod document;
mod figure;
mod summary;

pub use document::{csv, document};
pub use figure::figure;
pub use summary::story;

/// What the figure shows.
pub const CAPTION: &str = "Median delay against the leak rate of each detector with its interval, and the shortest delay that is possible.";

const PASCAL_PER_BAR: f64 = 1e5;
const HOUR_S: f64 = 3600.0;

/// A rate of loss, Pa/s, in bar/h.
fn bar_h(rate_pa_s: f64) -> f64 {
    rate_pa_s / PASCAL_PER_BAR * HOUR_S
}

#[cfg(test)]
mod tests;

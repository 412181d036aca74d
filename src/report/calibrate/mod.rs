//! A calibration as words, as a figure and as JSON.
mod caution;
mod document;
mod figure;
mod study;
mod summary;

pub use caution::cautions;
pub use document::document;
pub use figure::figure;
pub use study::{Line, Study, shown_unit};
pub use summary::summary;

/// What the figure shows.
pub const CAPTION: &str =
    "Readings and model of every channel, residuals, and their autocorrelation within bounds of 99 %.";

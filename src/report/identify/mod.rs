//! An identified transfer function as words, as a figure, as CSV and JSON, beside the one that the paper publishes.
mod caution;
mod figure;
mod series;
mod study;
mod summary;

pub use caution::cautions;
pub use figure::figure;
pub use series::{document, table};
pub use study::{Judged, Part, Signal, Start, Study};
pub use summary::summary;

/// What the figure shows.
pub const CAPTION: &str = "Input, output, identified and published model; their errors; autocorrelation of the errors and their correlation with the \
                           input within bounds of 99 %.";

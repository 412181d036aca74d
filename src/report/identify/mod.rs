//! An identified transfer function as words, as a figure, as CSV and JSON, beside the one that the paper publishes.
mod caution;
mod figure;
mod series;
mod study;
mod summary;

pub(crate) use caution::cautions;
pub(crate) use figure::figure;
pub(crate) use series::{document, table};
pub(crate) use study::{Part, Signal, Study};
pub(crate) use summary::summary;

/// What the figure shows.
pub(crate) const CAPTION: &str = "Input, output, identified and published model; their errors; autocorrelation of the errors and their correlation with the \
                           input within bounds of 99 %.";

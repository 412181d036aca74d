//! A calibration as words, as a figure, as rows and as JSON.
mod caution;
mod document;
mod figure;
mod study;
mod summary;
mod table;

pub(crate) use caution::{cautions, remedy};
pub(crate) use document::document;
pub(crate) use figure::figure;
pub(crate) use study::{Line, Study, shown_unit};
pub(crate) use summary::summary;
pub(crate) use table::table;

/// What the figure shows.
pub(crate) const CAPTION: &str =
    "Readings and model of every channel, residuals, and their autocorrelation within bounds of 99 %.";

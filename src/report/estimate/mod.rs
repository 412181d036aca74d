//! Estimates as rows of a file, as a figure, as a score, as a few lines for the terminal.
//!
//! Everything here takes one estimate after the other and keeps what fits in bounded memory, whatever the length of
//! the log: rows leave at once, curves are kept as extremes of time buckets (`decimation`), statistics as sums
//! ([`Score`], [`Innovations`]).
mod decimation;
mod figure;
mod innovation;
mod row;
mod score;
mod summary;

pub(crate) use decimation::DecimatedCurves;
pub(crate) use figure::{FigureData, figure};
pub(crate) use innovation::Innovations;
pub(crate) use row::{DOCUMENTATION, EstimateRow, fields};
pub(crate) use score::Score;
pub(crate) use summary::{Summary, document, doubts, summary};
pub(in crate::report) use summary::{duration, log as sampling_text};

/// What the figure of a run shows.
pub(crate) const CAPTION: &str = "Gas temperature, mass and leak rate with bands of two standard deviations, truth where the log has it, and the \
                           innovations: readings less what was expected of them.";

//! Everything that can be wrong with the input of this crate, and what its numerics can refuse.
use crate::document::Problem;

/// Errors of the thermal crate. Messages are fragments that name value, bound and remedy.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ThermalError {
    /// Times and values of a series differ in number, or there are none.
    #[error("a series needs as many times as values and at least one, not {times} times and {values} values")]
    SeriesLengths {
        /// Number of times.
        times: usize,
        /// Number of values.
        values: usize,
    },
    /// A series holds NaN or an infinity.
    #[error("row {row} of the series is not a finite number: write a number or leave the row out")]
    SeriesNotFinite {
        /// Row, from 1.
        row: usize,
    },
    /// A series goes back in time.
    #[error("row {row} of the series goes back in time, from {previous_s} s to {time_s} s: sort the rows by time")]
    SeriesGoesBack {
        /// Row, from 1.
        row: usize,
        /// Time of this row, s.
        time_s: f64,
        /// Time of the row before, s.
        previous_s: f64,
    },
    /// Three knots at one time.
    #[error("row {row} of the series is the third at {time_s} s: a jump takes two rows, before and after")]
    SeriesTripleTime {
        /// Row, from 1.
        row: usize,
        /// Time, s.
        time_s: f64,
    },
    /// A value of a specification cannot be used.
    #[error("{problem}")]
    Specification {
        /// Path of the value by field names, e.g. `layer[1].thickness_m`.
        path: String,
        /// What is wrong with it.
        problem: Problem,
    },
    /// A line of a document cannot be used.
    #[error("{file}:{line}: {problem}")]
    Document {
        /// File as the caller named it.
        file: String,
        /// Line, from 1.
        line: usize,
        /// What is wrong there.
        problem: Problem,
    },
    /// A name that is no built-in vessel or scenario.
    #[error("no built-in {kind} {name}{nearest}; there are {known}")]
    UnknownPreset {
        /// `vessel` or `scenario`.
        kind: &'static str,
        /// Name as given.
        name: String,
        /// Suggestion, empty or `, did you mean ...?`.
        nearest: String,
        /// The built-in names.
        known: String,
    },
}

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
pub use summary::text;

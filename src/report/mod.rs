//! Results as text and bytes: CSV, JSON, SVG, PNG, tables for a terminal, pages for a browser. Pure functions; nothing here reads
//! or writes.
//!
//! The text of a result is a [`Report`]: a terminal and a page show the same one.
use crate::thermal::units::HOUR_S;

pub mod bench_detector;
pub(crate) mod calibrate;
mod clock;
pub(crate) mod commission;
mod content;
pub(crate) mod estimate;
pub mod figure;
pub(crate) mod fleet;
pub(crate) mod identify;
pub(crate) mod inspect;
pub(crate) mod inspection;
pub(crate) mod monitor;
mod page;
pub mod place;
mod provenance;
mod readings;
pub mod simulation;
mod table;

pub(crate) use clock::{Clock, Shown};
pub use content::{Block, Report};
pub(crate) use page::Page;
pub(crate) use provenance::{Fingerprint, digest, quoted};
pub use provenance::{Input, Provenance};
pub use readings::Readings;
pub use table::{Cell, Column, Digits, Table, Values, aligned, number};
pub(crate) use table::{Field, RowFormat, Rows, rounded};

/// g in a kg.
pub(crate) const GRAM: f64 = 1e3;
/// g/h in a kg/s.
pub(crate) const GRAM_PER_HOUR: f64 = 3.6e6;
/// bar/h in a Pa/s.
pub(crate) const BAR_PER_HOUR: f64 = HOUR_S / crate::thermal::units::BAR_PA;

/// What can go wrong while results become text or pictures.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// The embedded font is damaged.
    #[error("the embedded font cannot be read: the program is damaged, install it again")]
    Font,
    /// The library for Parquet failed.
    #[error("the table cannot be written as Parquet: {reason}; write CSV or JSON")]
    Parquet {
        /// What the library says.
        reason: String,
    },
    /// The drawing library failed.
    #[error("the figure cannot be drawn: {reason}")]
    Drawing {
        /// What the library says.
        reason: String,
    },
}

//! Results as text and bytes: CSV, JSON, SVG, PNG, tables for a terminal, pages for a browser. Pure functions; nothing here reads
//! or writes.
//!
//! What a result says is a [`Story`]: a terminal and a page show the same one.
pub mod bench_detector;
pub mod calibrate;
pub mod commission;
pub mod estimate;
pub mod figure;
pub mod identify;
pub mod inspect;
pub mod monitor;
mod page;
#[cfg(feature = "parquet")]
mod parquet;
pub mod place;
mod provenance;
mod readings;
pub mod simulation;
mod story;
mod table;
mod terminal;

pub use page::Page;
pub use provenance::{Fingerprint, Input, Provenance, digest, quoted};
pub use readings::Readings;
pub use story::{Block, Story};
pub use table::{Column, Table, aligned, number, rounded};

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

//! Logs as files: recorded readings, row by row, checked while they are read.
//!
//! A [`LogReader`] streams: whatever the length of the log, it holds two rows, one buffer and a few counters. Names of
//! columns say what they are and in which unit (`columns`); everything becomes SI as it enters.
//!
//! **Missing values** (empty, `NaN`, `NA`, `null`, `-`) are NaN in a [`Row`] and no fault. A reading that cannot be one
//! (text, infinite, outside of the [range](LogOptions)) is taken as missing and counted in a [`Caution`], so that a
//! glitch does not end a live run.
//!
//! **Order**: a filter cannot go back. A row whose time lies before the one above is refused with both times, unless
//! [any order](LogOptions::any_order) is wanted. Rows of
//! one time are one row: repeated ones are counted, ones that fill each other's gaps are joined, ones that contradict
//! each other are refused. For this a row is held back until the next one has been read, or a pipe has nothing more at once.
//!
//! **Structure** is not guessed: a missing unit, a unit of another quantity, one quantity twice, a row with more or
//! fewer cells than the header are refused with file, line, value and remedy ([`LogError`]).
mod caution;
mod cell;
pub(crate) mod columns;
mod csv;
pub(crate) mod cylinders;
mod date;
mod error;
mod header;
pub mod inspect;
mod label;
mod mapping;
mod memory;
#[cfg(feature = "parquet")]
mod parquet;
mod reader;
mod record;
mod row;
mod sampling;
mod source;
mod spool;
mod stuck;
mod time;
mod unit_check;
mod unpack;
mod zone;

pub use caution::{Caution, Kind};
pub use error::LogError;
pub use mapping::Mapping;
pub use memory::{Cells, MemoryLog};
pub use reader::LogReader;
pub(crate) use reader::is_parquet;
pub(crate) use row::RowScreen;
pub use row::{Row, Truth};
pub use sampling::Sampling;
pub use unpack::Packing;
pub use zone::Zone;

use crate::estimator::log::Quantity;
use jiff::Timestamp;

/// How a log is read.
#[derive(Clone, Debug)]
pub struct LogOptions {
    /// Columns with foreign names.
    pub mappings: Vec<Mapping>,
    /// Names of sensors beyond the known ones; their columns are readings, too.
    pub sensors: Vec<String>,
    /// Lowest and highest temperature that a sensor can read, K. What lies outside is taken as missing.
    pub temperature_range_k: (f64, f64),
    /// Lowest and highest absolute pressure that a sensor can read, Pa. What lies outside is taken as missing.
    pub pressure_range_pa: (f64, f64),
    /// Zone of dates that do not say theirs. `None`: they are taken as UTC, with a caution.
    pub zone: Option<Zone>,
    /// Date of second 0 of a log with dates, for one that goes on from another. `None`: the first date of the log.
    pub origin: Option<Timestamp>,
    /// Whether rows whose time runs backwards are handed out as they come, for whoever can sort late ones in, and rows of
    /// one time that contradict each other cost a caution; else they are refused.
    pub any_order: bool,
    /// Hands out the rows alone whose column `cylinder` says this. `None`: all rows.
    pub cylinder: Option<String>,
}

impl Default for LogOptions {
    /// -100 to 200 degC, which leaves out the error codes of usual loggers (-127, 850, 999); 0 to 1500 bar.
    fn default() -> Self {
        Self {
            mappings: Vec::new(),
            sensors: Vec::new(),
            temperature_range_k: (173.15, 473.15),
            pressure_range_pa: (0.0, 1.5e8),
            zone: None,
            origin: None,
            any_order: false,
            cylinder: None,
        }
    }
}

impl LogOptions {
    fn range(&self, quantity: Quantity) -> (f64, f64) {
        match quantity {
            Quantity::Temperature => self.temperature_range_k,
            Quantity::Pressure => self.pressure_range_pa,
        }
    }
}

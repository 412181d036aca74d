//! What comes out of steps.
use crate::cli::monitor::course::Told;
use crate::report::monitor::{MonitorRow, fields};
use crate::report::{RowFormat, Rows, Table};

/// Which rows are handed out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowsWanted {
    /// Every row that has become final.
    Every,
    /// The last one that has come out so far: much cheaper, where events are what is wanted.
    Last,
}

/// What comes out of steps.
pub(super) struct Out {
    pub wanted: RowsWanted,
    pub rows: Rows<MonitorRow>,
    pub table: Table,
    pub told: Vec<Told>,
}

impl Out {
    pub(super) fn new(has_dates: bool, wanted: RowsWanted) -> Self {
        let rows = Rows::new(fields(has_dates), RowFormat::Csv);
        Self { wanted, table: rows.empty_table(), rows, told: Vec::new() }
    }
}

//! What is known before the first row: form, meaning of the columns, the likely time; and the tap that counts all cells.
use super::clock::Clock;
use super::column::Column;
use super::proposal;
use crate::log::caution::Cautions;
use crate::log::columns::{self, Columns, TimeForm};
use crate::log::header::Header;
use crate::log::record::Records;
use crate::log::{LogError, LogOptions, Mapping, Packing};

/// What the header says.
#[derive(Debug)]
pub(in crate::log) struct Survey {
    pub names: Vec<String>,
    pub separator: u8,
    pub is_windows_1252: bool,
    pub packing: Packing,
    pub header_line: u64,
    pub lines_above: usize,
    /// Why a run would refuse the columns.
    pub refusal: Option<LogError>,
    /// The mapping that was supposed, since the log has no time otherwise.
    pub time: Option<Mapping>,
}

impl Survey {
    /// Finds out what the columns mean; `first` is the first row.
    pub(crate) fn new(
        header: &Header,
        first: &[String],
        packing: Packing,
        options: &LogOptions,
        cautions: &mut Cautions,
    ) -> Result<(Columns, Self), LogError> {
        let before = cautions.clone();
        let (mut columns, refusal) = columns::survey(&header.names, &header.at, options, cautions)?;
        let mut time = None;
        if columns.time.form == TimeForm::Rows
            && let Some(mapping) = proposal::time(&header.names, first)
        {
            let mut supposed = options.clone();
            supposed.mappings.push(mapping.clone());
            let mut again = before;
            if let Ok((found, _)) = columns::survey(&header.names, &header.at, &supposed, &mut again)
                && found.time.form != TimeForm::Rows
            {
                (columns, *cautions, time) = (found, again, Some(mapping));
            }
        }
        let survey = Self {
            names: header.names.clone(),
            separator: header.separator,
            is_windows_1252: header.is_windows_1252,
            packing,
            header_line: header.line,
            lines_above: header.passed,
            refusal,
            time,
        };
        Ok((columns, survey))
    }
}

/// Counts the cells of all columns, and the times.
#[derive(Debug)]
pub(in crate::log) struct Tap {
    pub(super) columns: Vec<Column>,
    pub(super) clock: Clock,
}

impl Tap {
    /// For so many columns.
    pub(crate) fn new(columns: usize) -> Self {
        Self { columns: vec![Column::default(); columns], clock: Clock::default() }
    }

    /// Takes in a row.
    pub(crate) fn push(&mut self, records: &Records, decimal_comma: bool, time_s: f64) {
        self.clock.push(time_s, records.line());
        for (column, cell) in self.columns.iter_mut().zip(records.iter()) {
            column.push(cell, decimal_comma, records.line(), time_s);
        }
    }
}

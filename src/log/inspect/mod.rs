//! What a log holds, for a person who does not know it: form, times, columns, oddities, and which command can use it.
//!
//! The log is read once, by the reader that every command uses, so that what is said here is what a command would do. A
//! `Tap` counts the cells of all columns on the way, also of those that nobody reads. Where a command would refuse the log,
//! the inspection goes on and tells. Memory does not grow with the log: quantiles are those of a systematic sample of 4096
//! values (`sketch`), gaps and jumps those of the largest few.
mod clock;
mod column;
mod findings;
mod proposal;
mod resolution;
mod sketch;
mod survey;
mod uses;

pub use clock::Interval;
pub use column::{Jump, Run};
pub use proposal::Proposal;
pub use uses::Use;

pub(super) use survey::{Survey, Tap};

use super::{Caution, LogError, LogOptions, LogReader, Mapping, Packing, Zone};
use std::io::Read;

/// How the file is written.
#[derive(Clone, Debug, PartialEq)]
pub struct Form {
    /// Separator of cells.
    pub separator: char,
    /// Whether numbers have a decimal comma.
    pub decimal_comma: bool,
    /// Encoding of the header.
    pub encoding: &'static str,
    /// Packing.
    pub packing: Packing,
    /// Whether the file is Parquet; then the rest is that of its text.
    pub is_parquet: bool,
    /// Line of the header, from 1.
    pub header_line: u64,
    /// Lines above it that are no comments.
    pub lines_above: usize,
}

/// The times of the rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Times {
    /// Column, or columns as `Datum+Zeit`; `None`: there is none, and rows are counted.
    pub column: Option<String>,
    /// The mapping that makes it the time, where nobody has given it.
    pub supposed: Option<Mapping>,
    /// Date of second 0, if the rows have dates.
    pub origin: Option<jiff::Timestamp>,
    /// Zone: in the file, given, or supposed to be UTC; `None` where there are no dates.
    pub zone: Option<String>,
    /// The zone that times are shown in; `None`: UTC.
    pub shown_zone: Option<Zone>,
    /// A zone whose clock goes back where this one does, where nobody has said one.
    pub supposed_zone: Option<Zone>,
    /// Rows with a time.
    pub rows: u64,
    /// First and last time, s.
    pub span_s: (f64, f64),
    /// Median interval, s; NaN below two rows.
    pub interval_s: f64,
    /// What 90 of 100 intervals differ by at most, s.
    pub jitter_s: f64,
    /// Gaps: intervals of more than five usual ones, the longest twenty.
    pub gaps: Vec<Interval>,
    /// Steps back of the clock, and the first of them.
    pub steps_back: (u64, Option<Interval>),
}

/// What a column is taken for.
#[derive(Clone, Debug, PartialEq)]
pub enum Role {
    /// Time, or a part of it.
    Time,
    /// A reading of this name, in this unit.
    Reading(String, &'static str),
    /// Something true of this name, in this unit.
    Truth(&'static str, &'static str),
    /// What is true in a simulated log, which has the reading of it in another column: not read.
    Simulated,
    /// Nothing: set aside.
    Aside,
}

/// A column.
#[derive(Clone, Debug, PartialEq)]
pub struct ColumnReport {
    /// Name as written.
    pub header: String,
    /// What it is taken for.
    pub role: Role,
    /// Unit as the header says it.
    pub unit: Option<String>,
    /// Cells with numbers, without anything, with something else.
    pub cells: (u64, u64, u64),
    /// First cell with something else.
    pub text: Option<String>,
    /// Lowest, median and highest value in the unit of the file; NaN without numbers.
    pub range: [f64; 3],
    /// Smallest change, in the unit of the file; infinite without one.
    pub step: f64,
    /// Longest run of one value.
    pub longest: Run,
    /// Changes that are far larger than usual.
    pub jumps: Vec<Jump>,
    /// What it may be.
    pub proposal: Option<Proposal>,
}

impl ColumnReport {
    /// Whether there are numbers.
    pub(crate) fn has_numbers(&self) -> bool {
        self.cells.0 > 0
    }
}

/// Something that a command refuses.
#[derive(Clone, Debug, PartialEq)]
pub struct Refusal {
    /// First message.
    pub message: String,
    /// How often.
    pub count: u64,
    /// Whether `monitor` takes it.
    pub monitor_takes_it: bool,
}

/// What a log holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Inspection {
    /// What messages call the log.
    pub name: String,
    /// How it is written.
    pub form: Form,
    /// Its times.
    pub times: Times,
    /// Its columns from left to right.
    pub columns: Vec<ColumnReport>,
    /// Why commands refuse it.
    pub refusals: Vec<Refusal>,
    /// What the reader cautions about.
    pub cautions: Vec<Caution>,
    /// What looks odd beside that.
    pub oddities: Vec<String>,
    /// What the commands can do with it.
    pub uses: Vec<Use>,
}

/// Reads a log and counts.
pub struct Inspector {
    name: String,
    reader: LogReader,
    survey: Survey,
    options: LogOptions,
    refusals: Vec<Refusal>,
    is_parquet: bool,
}

impl Inspector {
    /// Begins with a text; `name` is what messages and commands call it.
    ///
    /// # Errors
    /// The log cannot be read, has no header, or a mapping cannot be.
    pub fn new(input: Box<dyn Read>, name: &str, options: &LogOptions) -> Result<Self, LogError> {
        let (reader, survey) = LogReader::inspect(input, name, options)?;
        let mut inspector = Self {
            name: name.to_owned(),
            reader,
            survey,
            options: options.clone(),
            refusals: Vec::new(),
            is_parquet: false,
        };
        if let Some(refusal) = inspector.survey.refusal.take() {
            inspector.refuse(&refusal);
        }
        Ok(inspector)
    }

    /// Begins with a Parquet file.
    ///
    /// # Errors
    /// As of [`Inspector::new`]; this build cannot read any.
    pub(crate) fn of_parquet(
        input: std::fs::File,
        name: &str,
        options: &LogOptions,
    ) -> Result<Self, LogError> {
        #[cfg(feature = "parquet")]
        {
            let text = super::parquet::text(input, name)?;
            Ok(Self { is_parquet: true, ..Self::new(Box::new(text), name, options)? })
        }
        #[cfg(not(feature = "parquet"))]
        {
            let _ = (input, options);
            Err(LogError::WithoutParquet { file: name.to_owned() })
        }
    }

    /// Reads a row; `false` at the end.
    ///
    /// # Errors
    /// The log cannot be read on.
    pub fn step(&mut self) -> Result<bool, LogError> {
        match self.reader.next_row() {
            Ok(row) => Ok(row.is_some()),
            Err(error @ LogError::NoRows { .. }) => {
                // Without a column of readings that was said before.
                if !self.reader.channels().is_empty() {
                    self.refuse(&error);
                }
                Ok(false)
            }
            Err(error @ (LogError::Cells { .. } | LogError::Time { .. })) => {
                self.refuse(&error);
                Ok(true)
            }
            Err(error) => Err(error),
        }
    }

    /// Counts what a command would refuse, once for each kind.
    fn refuse(&mut self, error: &LogError) {
        let is_same = |refusal: &&mut Refusal| {
            let kind = |message: &str| message.contains("the number of cells");
            kind(&refusal.message) == kind(&error.to_string()) && !matches!(error, LogError::NoRows { .. })
        };
        let is_of_rows = matches!(error, LogError::Cells { .. } | LogError::Time { .. });
        match self.refusals.iter_mut().skip(usize::from(!is_of_rows)).find(is_same) {
            Some(refusal) if is_of_rows => refusal.count += 1,
            _ => {
                self.refusals.push(Refusal { message: error.to_string(), count: 1, monitor_takes_it: false })
            }
        }
    }
}

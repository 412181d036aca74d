//! Why a log is refused.
use crate::thermal::document::Problem;

/// What is wrong with a log: where, which value, which bound, what to do. `at` is `file:line`, or `file row N` where
/// a file has no lines.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LogError {
    /// The file or stream failed.
    #[error("{file} cannot be read")]
    Io {
        /// File.
        file: String,
        /// What the system says.
        #[source]
        source: std::io::Error,
    },
    /// There is no header.
    #[error("{file} has no header: the first line names the columns, as time_s,shoulder_degc,pressure_bar")]
    Empty {
        /// File.
        file: String,
    },
    /// There are no rows, or none has a reading.
    #[error("{file} has no row with a reading of {columns}: {remedy}")]
    NoRows {
        /// File.
        file: String,
        /// Columns of readings.
        columns: String,
        /// What to do.
        remedy: String,
    },
    /// The readings of a column are in another unit than its name says.
    #[error("{at}: {column} reads {readings}: add {remedy}")]
    Unit {
        /// Place of the last of them.
        at: String,
        /// Column as written.
        column: String,
        /// Lowest and highest value, in its unit and in the one that fits.
        readings: String,
        /// What to write.
        remedy: String,
    },
    /// The bytes are no text.
    #[error("{at}: {what}: save the log as UTF-8 with line feeds")]
    NotUtf8 {
        /// Place.
        at: String,
        /// What was found.
        what: String,
    },
    /// The first bytes are those of something else.
    #[error("{file} is {what}: {remedy}")]
    NoText {
        /// File.
        file: String,
        /// What it is.
        what: &'static str,
        /// What to do.
        remedy: &'static str,
    },
    /// A packed stream that cannot be unpacked to its end.
    #[error(
        "{at}: the gzip stream {what}: copy the file again; `gzip -cd` saves what stands before this line"
    )]
    Gzip {
        /// Place, in the unpacked text.
        at: String,
        /// Whether it is cut off or damaged.
        what: &'static str,
        /// What the unpacking says.
        #[source]
        source: std::io::Error,
    },
    /// A zone that is none.
    #[error(
        "{text:?} is no zone: write an offset from UTC, as +01:00, or a name of the IANA database, as Europe/Berlin"
    )]
    Zone {
        /// Zone as written.
        text: String,
    },
    /// A line that is too long to be a row.
    #[error("{at}: the row is longer than {limit} bytes: look for a quotation mark that is not closed")]
    Overlong {
        /// Place where the row begins.
        at: String,
        /// Longest row, bytes.
        limit: usize,
    },
    /// A column has no unit, a wrong one, or is there twice.
    #[error("{at}: column {problem}")]
    Column {
        /// Place of the header.
        at: String,
        /// Problem of the column.
        problem: Box<Problem>,
    },
    /// There is no time.
    #[error(
        "{at}: there is no column of time: name it time_s, time_min, time_h, or time for dates, \
             or give --map time_s=NAME or --map time=DATE+TIME; `cylwatch inspect` proposes one; the columns are {columns}"
    )]
    NoTime {
        /// Place of the header.
        at: String,
        /// Columns that are there.
        columns: String,
    },
    /// There is no reading.
    #[error(
        "{at}: there is no column to estimate from: name one of {known} with its unit, or give \
             --map shoulder_degc=NAME; `cylwatch inspect` proposes some; the columns are {columns}"
    )]
    NoReadings {
        /// Place of the header.
        at: String,
        /// Names of readings.
        known: &'static str,
        /// Columns that are there.
        columns: String,
    },
    /// A mapping that cannot be.
    #[error("--map {mapping}: {reason}")]
    Mapping {
        /// Mapping as written.
        mapping: String,
        /// Reason and remedy.
        reason: String,
    },
    /// A row with too many or too few cells.
    #[error(
        "{at}: the number of cells is {found} and the header's {expected}: complete the row, and quote cells that \
         contain the separator{hint}"
    )]
    Cells {
        /// Place.
        at: String,
        /// Cells of the row.
        found: usize,
        /// Cells of the header.
        expected: usize,
        /// A likely cause, or nothing.
        hint: &'static str,
    },
    /// A column of a log in memory that holds something else than is read from it.
    #[error("{at}: column {column} has {found} and must have {expected}")]
    Cell {
        /// Log.
        at: String,
        /// Column.
        column: String,
        /// What it has.
        found: String,
        /// What it must have.
        expected: &'static str,
    },
    /// The caller wanted the run to end.
    #[error("{at}: stopped")]
    Stopped {
        /// Place of the next row.
        at: String,
    },
    /// A time that is none.
    #[error("{at}: {column} = {text} must be {expected}")]
    Time {
        /// Place.
        at: String,
        /// Column.
        column: String,
        /// Cell.
        text: String,
        /// What it has to be.
        expected: &'static str,
    },
    /// Time runs backwards.
    #[error(
        "{at}: time {text} is {back_s} s before the row above ({before}): sort the rows by time, and look for \
             a clock that was set back{hint}"
    )]
    Backwards {
        /// Place.
        at: String,
        /// Time as written.
        text: String,
        /// Place of the row above.
        before: String,
        /// How far back, s.
        back_s: f64,
        /// What may be so.
        hint: &'static str,
    },
    /// Two rows of one time say different things.
    #[error(
        "{at}: {column} = {value} where {before} says {first} for the same time: keep one of the rows, or give \
             the time with more digits"
    )]
    Contradiction {
        /// Place of the second row.
        at: String,
        /// Place of the first row.
        before: String,
        /// Column.
        column: String,
        /// Second value in the column's unit.
        value: f64,
        /// First value in the column's unit.
        first: f64,
    },
    /// A Parquet file where this build cannot read any.
    #[error(
        "{file} is a Parquet file and this program was built without: build it with `cargo build --release \
             --features parquet`, or save the log as CSV"
    )]
    WithoutParquet {
        /// File.
        file: String,
    },
    /// A Parquet file that cannot be read.
    #[error("{file}: {reason}")]
    Parquet {
        /// File.
        file: String,
        /// What is wrong and what to do.
        reason: String,
    },
}

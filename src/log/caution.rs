//! What a log was taken to say where it is not clean: one caution per kind and column, counted.
use std::fmt;

/// Kind of a caution.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// A reading that is no number: taken as missing.
    Unreadable,
    /// An infinite reading: taken as missing.
    Infinite,
    /// A reading that the sensor cannot show: taken as missing.
    OutOfRange,
    /// A reading that stood still while others moved: taken as it is.
    Stuck,
    /// A column without a usable reading.
    Silent,
    /// A column whose unit is in doubt: another one fits.
    Unit,
    /// A row that repeats the one above: left out.
    Repeated,
    /// A row that fills gaps of the one above at the same time: both were joined.
    Joined,
    /// A row that contradicts the one above at the same time: left out.
    Contradicted,
    /// A row without a time: left out.
    WithoutTime,
    /// The header once more: left out.
    HeaderAgain,
    /// A line of words among the rows: left out.
    Remark,
    /// A last row that was cut off: left out.
    CutOff,
    /// Times without a zone: taken as UTC.
    WithoutZone,
    /// Numbers with a decimal comma: taken as decimal point.
    DecimalComma,
    /// A simulated value without a sensor's reading beside it: taken as the reading.
    Perfect,
    /// Unrecognised columns: ignored.
    SetAside,
    /// Lines above the header: passed over.
    Preamble,
    /// Names of columns that are no UTF-8: read as Windows-1252.
    Windows1252,
}

/// Something that a log has and should not have, or that was left out of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Caution {
    /// What.
    pub kind: Kind,
    /// Column or columns; empty where a whole row or file is meant.
    pub column: String,
    /// How often.
    pub count: u64,
    /// Place of the first.
    pub first: String,
    /// First value as written, or another detail.
    pub detail: String,
}

impl fmt::Display for Caution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { column, count, first, detail, .. } = self;
        let values = if *count == 1 { "1 value".to_owned() } else { format!("{count} values") };
        let rows = if *count == 1 { "1 row".to_owned() } else { format!("{count} rows") };
        match self.kind {
            Kind::Unreadable => {
                write!(f, "{first}: {column} = {detail} is no number; {values} taken as missing")
            }
            Kind::Infinite => {
                write!(f, "{first}: {column} = {detail} is infinite; {values} taken as missing")
            }
            Kind::OutOfRange => write!(f, "{first}: {column} = {detail}; {values} taken as missing"),
            Kind::Stuck => write!(
                f,
                "{first}: {column} stands still at {detail} while others move; {values} used as they are: \
                 look at the sensor"
            ),
            Kind::Silent => write!(f, "{column} has no usable reading: look at the sensor and at the unit"),
            Kind::Unit => write!(f, "{first}: {column} {detail}"),
            Kind::Repeated => write!(f, "{first}: the row repeats the one above; {rows} left out"),
            Kind::Joined => {
                write!(f, "{first}: the row has the time of the one above; {rows} joined with it")
            }
            Kind::Contradicted => write!(
                f,
                "{first}: the row has the time of the one above and says something else; {rows} left out"
            ),
            Kind::WithoutTime => write!(f, "{first}: the row has no time; {rows} left out"),
            Kind::HeaderAgain => write!(f, "{first}: the header stands here again; {rows} left out"),
            Kind::Remark => {
                let lines = if *count == 1 { "1 line".to_owned() } else { format!("{count} lines") };
                write!(f, "{first}: {detail} is no row; {lines} of words left out")
            }
            Kind::CutOff => write!(f, "{first}: the last row is cut off and left out"),
            Kind::WithoutZone => write!(
                f,
                "{first}: {column} = {detail} has no zone and is taken as UTC: local time repeats and leaves \
                 out an hour a year; --zone Europe/Berlin or --zone +01:00 says another one"
            ),
            Kind::DecimalComma => {
                write!(
                    f,
                    "{first}: {detail} is taken as a number with a decimal comma, as are all others like it"
                )
            }
            Kind::Perfect => {
                write!(f, "{first}: {column} is simulated without a sensor and taken as a perfect reading")
            }
            Kind::Preamble => {
                let lines = if detail == "1" { "line" } else { "lines" };
                write!(f, "{first}: the header is taken to stand here; {detail} {lines} above it passed over")
            }
            Kind::Windows1252 => write!(f, "{first}: the header is no UTF-8 and read as Windows-1252"),
            Kind::SetAside => write!(f, "{first}: columns set aside: {column}{detail}"),
        }
    }
}

/// The cautions of a log in the order of their first occurrence.
#[derive(Clone, Debug, Default)]
pub(super) struct Cautions {
    list: Vec<Caution>,
}

impl Cautions {
    /// Counts an occurrence; place and detail are made for the first one only.
    pub(super) fn count(&mut self, kind: Kind, column: &str, first: impl FnOnce() -> (String, String)) {
        if let Some(known) = self.list.iter_mut().find(|c| c.kind == kind && c.column == column) {
            known.count += 1;
            return;
        }
        let (first, detail) = first();
        self.list.push(Caution { kind, column: column.to_owned(), count: 1, first, detail });
    }

    pub(super) fn list(&self) -> &[Caution] {
        &self.list
    }
}

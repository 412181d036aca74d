//! Rows that are written while a log is read (`estimate`, `monitor`): head, rows, tail.
use super::appended::Appended;
use super::format::Format;
use super::input::{Inputs, LogInput};
use super::message::Messages;
use super::output::{Stream, Target};
use crate::report::{Field, RowFormat, Rows, Table};
use serde_json::{Map, Value, json};

/// A stream of records with declared columns.
pub(super) struct RowStream<R> {
    sink: Sink,
    format: RowFormat,
    rows: Rows<R>,
}

/// Where rows go.
enum Sink {
    /// A whole result.
    Stream(Stream),
    /// A table that a later run goes on with.
    Table(Appended),
    /// Columns in memory.
    Kept(Table),
}

impl Sink {
    fn write(&mut self, text: &str) -> anyhow::Result<()> {
        match self {
            Self::Stream(stream) => stream.write(text),
            Self::Table(table) => table.write(text),
            Self::Kept(_) => Ok(()),
        }
    }
}

impl<R> RowStream<R> {
    /// Opens the output and writes what stands above the rows.
    pub(super) fn begin(
        target: &Target,
        format: Format,
        fields: Vec<Field<R>>,
        inputs: &Inputs,
        sensors: &[String],
        log: &LogInput,
    ) -> anyhow::Result<Self> {
        let format = match format {
            Format::Csv => RowFormat::Csv,
            Format::Json => RowFormat::Json,
        };
        let rows = Rows::new(fields, format);
        if matches!(target, Target::Memory) {
            return Ok(Self { sink: Sink::Kept(rows.empty_table()), format, rows });
        }
        let mut stream = Self { sink: Sink::Stream(target.open()?), format, rows };
        if format == RowFormat::Csv {
            stream.sink.write(&comments(inputs, sensors, log, true))?;
        }
        stream.sink.write(stream.rows.header())?;
        Ok(stream)
    }

    /// Opens a table in CSV; one that `goes_on` keeps its rows and has no second header.
    pub(super) fn table(
        target: &Target,
        goes_on: bool,
        fields: Vec<Field<R>>,
        inputs: &Inputs,
        sensors: &[String],
        log: &LogInput,
        messages: &Messages,
    ) -> anyhow::Result<Self> {
        let format = RowFormat::Csv;
        let mut rows = Rows::new(fields, format);
        let there = match target {
            Target::File(path) if goes_on => Appended::table(path, rows.header(), messages)?,
            _ => None,
        };
        if let Some(table) = there {
            return Ok(Self { sink: Sink::Table(table), format, rows });
        }
        let mut table = Appended::open(target, false, messages)?;
        table.write(&comments(inputs, sensors, log, false))?;
        table.write(rows.header())?;
        Ok(Self { sink: Sink::Table(table), format, rows })
    }

    /// Takes back what a table has beyond a length, bytes.
    pub(super) fn cut(&mut self, length: u64) -> anyhow::Result<()> {
        match &mut self.sink {
            Sink::Stream(_) | Sink::Kept(_) => Ok(()),
            Sink::Table(table) => table.cut(length),
        }
    }

    /// Bytes of a table, if all that was written is there.
    pub(super) fn complete_length(&self) -> Option<u64> {
        match &self.sink {
            Sink::Stream(_) | Sink::Kept(_) => Some(0),
            Sink::Table(table) => table.complete_length(),
        }
    }

    /// Writes a record.
    pub(super) fn push(&mut self, record: &R) -> anyhow::Result<()> {
        if let Sink::Kept(table) = &mut self.sink {
            self.rows.keep(record, table);
            return Ok(());
        }
        self.sink.write(self.rows.row(record))
    }

    /// Hands on what waits.
    pub(super) fn flush(&mut self) -> anyhow::Result<()> {
        match &mut self.sink {
            Sink::Stream(stream) => stream.flush(),
            Sink::Table(table) => table.flush(),
            Sink::Kept(_) => Ok(()),
        }
    }

    /// Writes what stands below the rows: in JSON these `members`, between the date of second 0 and the provenance; in CSV the hash of a
    /// log that was a pipe.
    pub(super) fn tail(
        &mut self,
        inputs: &Inputs,
        log: &LogInput,
        members: Map<String, Value>,
    ) -> anyhow::Result<()> {
        let hashed_late = inputs.record_log(log);
        let tail = match self.format {
            // A table goes on: no line is its last one.
            RowFormat::Csv if matches!(self.sink, Sink::Table(_) | Sink::Kept(_)) => return Ok(()),
            RowFormat::Csv => hashed_late.map_or(String::new(), |input| input.comment_line() + "\n"),
            RowFormat::Json => {
                let mut document = Map::from_iter([("origin".to_owned(), json!(log.reader.origin()))]);
                document.extend(members);
                document.insert("provenance".to_owned(), inputs.provenance().to_json());
                format!("\n],{}\n", &Value::Object(document).to_string()[1..])
            }
        };
        self.sink.write(&tail)
    }

    /// Ends the output: a file appears here, or the table in memory is handed out.
    pub(super) fn finish(self) -> anyhow::Result<Option<Table>> {
        match self.sink {
            Sink::Stream(stream) => stream.finish().map(|()| None),
            Sink::Table(table) => table.finish().map(|()| None),
            Sink::Kept(table) => Ok(Some(table)),
        }
    }
}

/// Comment lines above the rows of a CSV file, which may have a last line.
fn comments(inputs: &Inputs, sensors: &[String], log: &LogInput, ends: bool) -> String {
    let mut text = inputs.provenance().comment_lines();
    if ends && log.is_hashed_late() {
        text.push_str("# input: the log's SHA-256 stands in the last line\n");
    }
    text.push_str(&format!("# sensors: {}\n", sensors.join(", ")));
    if let Some(origin) = log.reader.origin() {
        text.push_str(&format!("# time_s = 0 is {origin}\n"));
    }
    text
}

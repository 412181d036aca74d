//! Rows that are written while a log is read (`estimate`, `monitor`): head, rows, tail.
use super::format::Format;
use super::input::{Inputs, LogInput};
use super::output::{Stream, Target};
use crate::report::{Field, RowFormat, Rows};
use serde_json::{Map, Value, json};

/// A stream of records with declared columns.
pub(super) struct RowStream<R> {
    stream: Stream,
    format: RowFormat,
    rows: Rows<R>,
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
        let mut stream = target.open()?;
        if format == RowFormat::Csv {
            stream.write(&comments(inputs, sensors, log))?;
        }
        let mut rows = Rows::new(fields, format);
        stream.write(rows.header())?;
        Ok(Self { stream, format, rows })
    }

    /// Writes a record.
    pub(super) fn push(&mut self, record: &R) -> anyhow::Result<()> {
        self.stream.write(self.rows.row(record))
    }

    /// Hands on what waits.
    pub(super) fn flush(&mut self) -> anyhow::Result<()> {
        self.stream.flush()
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
            RowFormat::Csv => hashed_late.map_or(String::new(), |input| input.comment_line() + "\n"),
            RowFormat::Json => {
                let mut document = Map::from_iter([("origin".to_owned(), json!(log.reader.origin()))]);
                document.extend(members);
                document.insert("provenance".to_owned(), inputs.provenance().to_json());
                format!("\n],{}\n", &Value::Object(document).to_string()[1..])
            }
        };
        self.stream.write(&tail)
    }

    /// Ends the output: a file appears here.
    pub(super) fn finish(self) -> anyhow::Result<()> {
        self.stream.finish()
    }
}

/// Comment lines above the rows of a CSV file.
fn comments(inputs: &Inputs, sensors: &[String], log: &LogInput) -> String {
    let mut text = inputs.provenance().comment_lines();
    if log.is_hashed_late() {
        text.push_str("# input: the log's SHA-256 stands in the last line\n");
    }
    text.push_str(&format!("# sensors: {}\n", sensors.join(", ")));
    if let Some(origin) = log.reader.origin() {
        text.push_str(&format!("# time_s = 0 is {origin}\n"));
    }
    text
}

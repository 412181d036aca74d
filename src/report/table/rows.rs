//! Rows that are written while a log is read.
use super::csv::Records;
use super::json::RowFormatter;
use super::{Cell, Column, Digits, Field, Source, Table, Values};
use serde::ser::{SerializeSeq, Serializer as _};
use serde_json::{Serializer, json};

/// Format of streamed rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RowFormat {
    /// Comma-separated cells.
    Csv,
    /// Arrays inside one JSON document.
    Json,
}

/// Turns records into text, one by one; memory is reused from row to row.
pub(crate) struct Rows<R> {
    fields: Vec<Field<R>>,
    /// Precision of each column; of texts it is not used.
    digits: Vec<Digits>,
    format: RowFormat,
    is_first: bool,
    csv: Records,
    text: String,
}

impl<R> Rows<R> {
    /// For records with these columns.
    pub(crate) fn new(fields: Vec<Field<R>>, format: RowFormat) -> Self {
        let digits = |field: &Field<R>| match field.source {
            Source::Number(digits, _) => digits,
            Source::Text(_) => Digits::All,
        };
        let digits = fields.iter().map(digits).collect();
        Self { fields, digits, format, is_first: true, csv: Records::new(), text: String::new() }
    }

    /// What stands above the rows: the names of the columns.
    pub(crate) fn header(&mut self) -> &str {
        let names: Vec<&str> = self.fields.iter().map(|field| field.name).collect();
        self.text = match self.format {
            RowFormat::Csv => names.join(",") + "\n",
            RowFormat::Json => format!("{{\"columns\":{},\"data\":[", json!(names)),
        };
        &self.text
    }

    /// A record with what separates it from the one before.
    pub(crate) fn row(&mut self, record: &R) -> &str {
        self.text.clear();
        match self.format {
            RowFormat::Csv => {
                self.csv.push(self.fields.iter().map(|field| field.cell(record)));
                self.csv.take(&mut self.text);
            }
            RowFormat::Json => self.json(record),
        }
        self.is_first = false;
        &self.text
    }

    /// A table with these columns and no row.
    pub(crate) fn empty_table(&self) -> Table {
        let column = |field: &Field<R>| Column {
            name: field.name.to_owned(),
            unit: "",
            values: match field.source {
                Source::Number(digits, _) => Values::Numbers(digits, Vec::new()),
                Source::Text(_) => Values::Texts(Vec::new()),
            },
        };
        Table { columns: self.fields.iter().map(column).collect() }
    }

    /// Adds a record to a table with these columns, with all digits.
    pub(crate) fn keep(&self, record: &R, table: &mut Table) {
        for (field, column) in self.fields.iter().zip(&mut table.columns) {
            match (&field.source, &mut column.values) {
                (Source::Number(_, value), Values::Numbers(_, cells)) => cells.push(value(record)),
                (Source::Text(value), Values::Texts(cells)) => cells.push(value(record).to_owned()),
                _ => {}
            }
        }
    }

    fn json(&mut self, record: &R) {
        let mut bytes = std::mem::take(&mut self.text).into_bytes();
        bytes.extend_from_slice(if self.is_first { b"\n" } else { b",\n" });
        let mut serializer = Serializer::with_formatter(&mut bytes, RowFormatter::new(&self.digits));
        // Writing to a vector does not fail, and a cell is always a JSON value.
        if let Ok(mut array) = serializer.serialize_seq(Some(self.fields.len())) {
            for field in &self.fields {
                _ = match field.cell(record) {
                    // The formatter knows its precision.
                    Cell::Number(value, _) => array.serialize_element(&value),
                    other => array.serialize_element(&other),
                };
            }
            _ = array.end();
        }
        self.text = String::from_utf8(bytes).unwrap_or_default();
    }
}

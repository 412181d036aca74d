//! A table as JSON: an object of columns, or arrays of rows while a log is read.
use super::{Cell, Digits, Table};
use serde::ser::{Serialize, Serializer};
use serde_json::ser::Formatter;
use serde_json::{Map, Value, json};
use std::io::{Result, Write};

impl Table {
    /// As the `columns` object of a JSON file: name to array.
    pub fn to_json(&self) -> Value {
        let columns: Map<String, Value> = self
            .columns
            .iter()
            .map(|column| {
                let cells = (0..column.values.len()).map(|row| json!(column.values.cell(row)));
                (column.name.clone(), cells.collect())
            })
            .collect();
        Value::Object(columns)
    }
}

impl Serialize for Cell<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        match *self {
            Self::Missing => serializer.serialize_unit(),
            Self::Number(value, digits) => serializer.serialize_f64(digits.rounded(value)),
            Self::Integer(value) => serializer.serialize_i64(value),
            Self::Boolean(value) => serializer.serialize_bool(value),
            Self::Text(text) => serializer.serialize_str(text),
        }
    }
}

/// Writes the numbers of an array with the precision of their place; by itself serde_json writes the shortest text.
pub(super) struct RowFormatter<'a> {
    /// Precision of each place.
    digits: &'a [Digits],
    place: usize,
}

impl<'a> RowFormatter<'a> {
    pub(super) fn new(digits: &'a [Digits]) -> Self {
        Self { digits, place: 0 }
    }
}

impl Formatter for RowFormatter<'_> {
    fn begin_array_value<W: ?Sized + Write>(&mut self, writer: &mut W, first: bool) -> Result<()> {
        if first {
            return Ok(());
        }
        self.place += 1;
        writer.write_all(b",")
    }

    fn write_f64<W: ?Sized + Write>(&mut self, writer: &mut W, value: f64) -> Result<()> {
        self.digits.get(self.place).copied().unwrap_or(Digits::All).write(value, writer)
    }
}

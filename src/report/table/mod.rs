//! Tables: named columns of one type each, and what they become.
//!
//! | to | by |
//! |---|---|
//! | CSV, JSON, Parquet | [`Table::to_csv`], [`Table::to_json`], `Table::to_parquet` |
//! | a terminal, a page | [`Table::to_text`], [`Table::to_html`] |
//! | CSV and JSON row by row, while a log is read | [`RowFormat`] |
//!
//! A [`Field`] declares a column once: name, precision, and how a record gives its value.
mod csv;
mod digits;
mod html;
mod json;
#[cfg(feature = "parquet")]
mod parquet;
mod rows;
mod terminal;

pub(crate) use digits::rounded;
pub use digits::{Digits, number};
pub(crate) use rows::{RowFormat, Rows};
pub use terminal::aligned;
pub(super) use terminal::{hanging, wrapped};

/// Columns of equal length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// The columns from left to right.
    pub columns: Vec<Column>,
}

/// A column: in a file its name ends in its unit (`pressure_bar`), for people the unit stands behind the name.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Name.
    pub name: String,
    /// Unit that stands behind the name for people; empty: none, or the name has it.
    pub unit: &'static str,
    /// Cells.
    pub values: Values,
}

/// Cells of one type.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Numbers; NaN is a missing one.
    Numbers(Digits, Vec<f64>),
    /// Whole numbers.
    Integers(Vec<Option<i64>>),
    /// Truth values.
    Booleans(Vec<Option<bool>>),
    /// Texts; an empty one is missing.
    Texts(Vec<String>),
}

/// A cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cell<'a> {
    /// Empty in CSV and for people, null in JSON and Parquet.
    Missing,
    /// A finite number with its precision.
    Number(f64, Digits),
    /// A whole number.
    Integer(i64),
    /// A truth value.
    Boolean(bool),
    /// A text.
    Text(&'a str),
}

impl<'a> Cell<'a> {
    fn number(value: f64, digits: Digits) -> Self {
        if value.is_finite() { Self::Number(value, digits) } else { Self::Missing }
    }

    fn text(text: &'a str) -> Self {
        if text.is_empty() { Self::Missing } else { Self::Text(text) }
    }

    /// Appends the cell as it stands in a CSV file before quoting, or before people.
    fn write(self, out: &mut Vec<u8>) {
        match self {
            Self::Missing => {}
            // Writing to a vector does not fail.
            Self::Number(value, digits) => _ = digits.write(value, out),
            Self::Integer(value) => out.extend_from_slice(value.to_string().as_bytes()),
            Self::Boolean(value) => out.extend_from_slice(if value { b"true" } else { b"false" }),
            Self::Text(text) => out.extend_from_slice(text.as_bytes()),
        }
    }

    fn to_text(self) -> String {
        let mut out = Vec::new();
        self.write(&mut out);
        String::from_utf8_lossy(&out).into_owned()
    }
}

/// How a record gives a cell of a column.
pub(crate) enum Source<R> {
    /// A number with its precision; NaN is a missing one.
    Number(Digits, fn(&R) -> f64),
    /// A text; an empty one is missing.
    Text(fn(&R) -> &str),
}

/// Declaration of a column of records `R`.
pub(crate) struct Field<R> {
    /// Name, which ends in the unit.
    pub name: &'static str,
    /// Its cells.
    pub source: Source<R>,
}

impl<R> Field<R> {
    /// A column of numbers.
    pub(crate) const fn number(name: &'static str, digits: Digits, value: fn(&R) -> f64) -> Self {
        Self { name, source: Source::Number(digits, value) }
    }

    /// A column of texts.
    pub(crate) const fn text(name: &'static str, value: fn(&R) -> &str) -> Self {
        Self { name, source: Source::Text(value) }
    }

    fn cell<'a>(&self, record: &'a R) -> Cell<'a> {
        match self.source {
            Source::Number(digits, value) => Cell::number(value(record), digits),
            Source::Text(value) => Cell::text(value(record)),
        }
    }
}

impl Table {
    /// A table without columns.
    pub(crate) fn new() -> Self {
        Self::default()
    }

    /// A table of texts; a row that is shorter than the others has empty cells at its end.
    pub(crate) fn of_texts(header: &[impl AsRef<str>], rows: Vec<Vec<String>>) -> Self {
        let count = rows.iter().map(Vec::len).max().unwrap_or(0).max(header.len());
        let mut columns: Vec<Vec<String>> = vec![Vec::with_capacity(rows.len()); count];
        for row in rows {
            let cells = row.into_iter().chain(std::iter::repeat(String::new()));
            columns.iter_mut().zip(cells).for_each(|(column, cell)| column.push(cell));
        }
        let names = header.iter().map(AsRef::as_ref).chain(std::iter::repeat(""));
        let mut table = Self::new();
        names.zip(columns).for_each(|(name, texts)| table.push_texts(name, texts));
        table
    }

    /// Adds a column of numbers on the right; NaN is a missing one.
    pub(crate) fn push(
        &mut self,
        name: impl Into<String>,
        digits: Digits,
        values: impl IntoIterator<Item = f64>,
    ) {
        self.push_quantity(name, "", digits, values);
    }

    /// The same with a unit that stands behind the name.
    pub(crate) fn push_quantity(
        &mut self,
        name: impl Into<String>,
        unit: &'static str,
        digits: Digits,
        values: impl IntoIterator<Item = f64>,
    ) {
        let values = Values::Numbers(digits, values.into_iter().collect());
        self.columns.push(Column { name: name.into(), unit, values });
    }

    /// Adds a column of whole numbers.
    pub(crate) fn push_integers(&mut self, name: impl Into<String>, values: impl IntoIterator<Item = usize>) {
        let values = values.into_iter().map(|value| i64::try_from(value).ok()).collect();
        self.push_values(name, Values::Integers(values));
    }

    /// Adds a column of texts; an empty one is missing.
    pub(crate) fn push_texts(&mut self, name: impl Into<String>, values: impl IntoIterator<Item = String>) {
        self.push_values(name, Values::Texts(values.into_iter().collect()));
    }

    fn push_values(&mut self, name: impl Into<String>, values: Values) {
        self.columns.push(Column { name: name.into(), unit: "", values });
    }

    /// Number of rows.
    pub(crate) fn rows(&self) -> usize {
        self.columns.iter().map(|column| column.values.len()).max().unwrap_or(0)
    }

    /// Whether any column has a name or a unit.
    fn has_header(&self) -> bool {
        self.columns.iter().any(|column| !column.name.is_empty())
    }
}

impl Column {
    /// The name before people: with its unit.
    fn heading(&self) -> String {
        if self.unit.is_empty() { self.name.clone() } else { format!("{} in {}", self.name, self.unit) }
    }

    /// Whether it stands to the right: numbers, and short texts that begin with a number.
    fn is_numeric(&self) -> bool {
        /// Letters of a text that is still read as a number with its unit or interval.
        const SHORT: usize = 24;
        let Values::Texts(texts) = &self.values else { return true };
        let is_number = |cell: &String| {
            let first = cell.split_whitespace().next().unwrap_or_default();
            let first = first.trim_start_matches(['<', '>', '\u{2264}', '±']).trim_end_matches(['*', ',']);
            let is_number = first.is_empty() || first.replace('\u{2212}', "-").parse::<f64>().is_ok();
            is_number && cell.chars().count() <= SHORT
        };
        texts.iter().all(is_number)
    }
}

impl Values {
    fn len(&self) -> usize {
        match self {
            Self::Numbers(_, values) => values.len(),
            Self::Integers(values) => values.len(),
            Self::Booleans(values) => values.len(),
            Self::Texts(values) => values.len(),
        }
    }

    /// A cell; beyond the end it is missing.
    fn cell(&self, row: usize) -> Cell<'_> {
        match self {
            Self::Numbers(digits, values) => {
                values.get(row).map_or(Cell::Missing, |&value| Cell::number(value, *digits))
            }
            Self::Integers(values) => values.get(row).copied().flatten().map_or(Cell::Missing, Cell::Integer),
            Self::Booleans(values) => values.get(row).copied().flatten().map_or(Cell::Missing, Cell::Boolean),
            Self::Texts(values) => values.get(row).map_or(Cell::Missing, |text| Cell::text(text)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::Provenance;
    use serde_json::json;

    fn provenance() -> Provenance {
        Provenance { command: "c".into(), inputs: vec![], seed: None }
    }

    #[test]
    fn a_missing_value_is_an_empty_cell_and_null() {
        let mut table = Table::new();
        table.push("time_s", Digits::Significant(6), [0.0, 1.0]);
        table.push("valve_degc", Digits::Significant(6), [f64::NAN, 2.5]);
        table.push_texts("verdict", ["tight, so far".into(), String::new()]);
        let csv = table.to_csv(&provenance(), &[]);
        assert!(csv.ends_with("time_s,valve_degc,verdict\n0,,\"tight, so far\"\n1,2.5,\n"), "{csv}");
        assert_eq!(table.to_json()["valve_degc"], json!([null, 2.5]));
        assert_eq!(table.to_json()["verdict"], json!(["tight, so far", null]));
    }

    #[test]
    fn a_declared_column_is_the_same_in_a_table_and_row_by_row() {
        const FIELDS: [Field<(f64, &str)>; 2] = [
            Field::number("mass_kg", Digits::Decimals(3), |record: &(f64, &str)| record.0),
            Field::text("verdict", |record| record.1),
        ];
        let records = [(4.5, "tight"), (f64::NAN, "")];
        let mut table = Table::new();
        table.push("mass_kg", Digits::Decimals(3), records.map(|record| record.0));
        table.push_texts("verdict", records.map(|record| record.1.to_owned()));
        let csv = table.to_csv(&provenance(), &[]);
        let mut rows = Rows::new(FIELDS.into(), RowFormat::Csv);
        let mut streamed = rows.header().to_owned();
        records.iter().for_each(|record| streamed.push_str(rows.row(record)));
        assert!(csv.ends_with(&streamed) && streamed.contains("4.500,tight\n,\n"), "{csv}");
        assert_eq!(table.to_text(), "mass_kg  verdict\n-------  -------\n  4.500  tight\n\n");
    }

    #[test]
    fn a_streamed_json_row_is_an_array_with_the_declared_digits() {
        let fields = vec![
            Field::number("a", Digits::Decimals(3), |record: &(f64, f64)| record.0),
            Field::number("b", Digits::All, |record| record.1),
            Field::text("c", |_| "say \"x\""),
        ];
        let mut rows = Rows::new(fields, RowFormat::Json);
        assert_eq!(rows.header(), "{\"columns\":[\"a\",\"b\",\"c\"],\"data\":[");
        assert_eq!(rows.row(&(1.0, 0.5)), "\n[1.000,0.5,\"say \\\"x\\\"\"]");
        assert_eq!(rows.row(&(f64::NAN, 7.0)), ",\n[null,7,\"say \\\"x\\\"\"]");
    }
}

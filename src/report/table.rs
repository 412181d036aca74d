//! Columns of numbers as CSV and JSON, and rows of words for a terminal.
use super::Provenance;
use serde_json::{Map, Value, json};

/// Columns of equal length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// The columns from left to right.
    pub columns: Vec<Column>,
    /// Significant digits of every number.
    pub digits: usize,
}

/// A named column; NaN stands for a missing value and becomes an empty cell (CSV) or null (JSON).
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Name with its unit as suffix.
    pub name: String,
    /// Values.
    pub values: Vec<f64>,
}

impl Table {
    /// A table without columns.
    pub fn new(digits: usize) -> Self {
        Self { columns: Vec::new(), digits }
    }

    /// Adds a column on the right.
    pub fn push(&mut self, name: impl Into<String>, values: impl IntoIterator<Item = f64>) {
        self.columns.push(Column { name: name.into(), values: values.into_iter().collect() });
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.columns.iter().map(|column| column.values.len()).max().unwrap_or(0)
    }

    /// As CSV; `remarks` are further comment lines, without their `#`.
    pub fn to_csv(&self, provenance: &Provenance, remarks: &[String]) -> String {
        let mut text = provenance.comment_lines();
        for remark in remarks {
            text.push_str(&format!("# {}\n", remark.replace(['\n', '\r'], " ")));
        }
        let names: Vec<&str> = self.columns.iter().map(|column| column.name.as_str()).collect();
        text.push_str(&names.join(","));
        text.push('\n');
        for row in 0..self.rows() {
            let cells: Vec<String> =
                self.columns.iter().map(|column| self.cell(column.values.get(row).copied())).collect();
            text.push_str(&cells.join(","));
            text.push('\n');
        }
        text
    }

    /// As the `columns` object of a JSON file: name to array.
    pub fn to_json(&self) -> Value {
        let columns: Map<String, Value> = self
            .columns
            .iter()
            .map(|column| {
                let values = column.values.iter().map(|&value| json!(rounded(value, self.digits)));
                (column.name.clone(), values.collect())
            })
            .collect();
        Value::Object(columns)
    }

    fn cell(&self, value: Option<f64>) -> String {
        value.filter(|value| value.is_finite()).map_or_else(String::new, |value| number(value, self.digits))
    }
}

/// A value with so many significant digits.
pub fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits.max(1) - 1).parse().unwrap_or(value)
}

/// A number as text with so many significant digits, without trailing zeros; an exponent where it is shorter.
pub fn number(value: f64, digits: usize) -> String {
    // Adding zero turns a negative zero into a positive one.
    let value = rounded(value, digits) + 0.0;
    if value != 0.0 && !(1e-4..1e15).contains(&value.abs()) {
        format!("{value:e}")
    } else {
        format!("{value}")
    }
}

/// Rows of words, aligned; a column whose cells all begin like numbers stands to the right.
pub fn aligned(header: &[&str], rows: &[Vec<String>]) -> String {
    let header: Vec<Vec<String>> = match header {
        [] => Vec::new(),
        names => vec![names.iter().map(|name| (*name).to_owned()).collect()],
    };
    aligned_below(&header, rows)
}

/// The same below a header of several lines.
pub(super) fn aligned_below(header: &[Vec<String>], rows: &[Vec<String>]) -> String {
    let width = |k: usize| {
        rows.iter()
            .chain(header)
            .filter_map(|row| row.get(k))
            .map(|cell| cell.chars().count())
            .max()
            .unwrap_or(0)
    };
    let numeric = |k: usize| {
        let begins = |cell: &String| cell.starts_with(|c: char| c.is_ascii_digit() || "-+".contains(c));
        rows.iter().filter_map(|row| row.get(k)).all(|cell| cell.is_empty() || begins(cell))
    };
    let count = rows.iter().chain(header).map(Vec::len).max().unwrap_or(0);
    let layout: Vec<(usize, bool)> = (0..count).map(|k| (width(k), numeric(k))).collect();
    let line = |cells: &[String]| {
        let padded = layout.iter().zip(cells).map(|(&(width, right), cell)| {
            let pad = " ".repeat(width - cell.chars().count());
            if right { format!("{pad}{cell}") } else { format!("{cell}{pad}") }
        });
        padded.collect::<Vec<_>>().join("  ").trim_end().to_owned() + "\n"
    };
    let mut text: String = header.iter().map(|names| line(names)).collect();
    if !header.is_empty() {
        text.push_str(&line(&layout.iter().map(|(width, _)| "-".repeat(*width)).collect::<Vec<_>>()));
    }
    text.extend(rows.iter().map(|row| line(row)));
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_digits_they_are_given_and_no_more() {
        assert_eq!(number(293.15 - 273.15, 10), "20");
        assert_eq!(number(1.0 / 3.0, 4), "0.3333");
        assert_eq!(number(1.786e-5, 10), "1.786e-5");
        assert_eq!(number(-0.0, 3), "0");
    }

    #[test]
    fn a_missing_value_is_an_empty_cell_and_null() {
        let mut table = Table::new(6);
        table.push("time_s", [0.0, 1.0]);
        table.push("valve_degc", [f64::NAN, 2.5]);
        let provenance = Provenance { command: "c".into(), inputs: vec![], seed: None };
        assert!(table.to_csv(&provenance, &[]).ends_with("time_s,valve_degc\n0,\n1,2.5\n"));
        assert_eq!(table.to_json()["valve_degc"], json!([null, 2.5]));
    }

    #[test]
    fn numbers_stand_to_the_right_and_words_to_the_left() {
        let text =
            aligned(&["what", "value"], &[vec!["a".into(), "10".into()], vec!["bcd".into(), "-1.5".into()]]);
        assert_eq!(text, "what  value\n----  -----\na        10\nbcd    -1.5\n");
    }
}

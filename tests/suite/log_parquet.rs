//! Logs as Parquet; built with the feature `parquet` only.
use crate::support::run;
use cylwatch::log::{Caution, Kind, LogError, LogOptions, LogReader, Row};
use parquet::basic::Compression;
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::parser::parse_message_type;
use std::path::Path;
use std::sync::Arc;
use tempfile::tempdir;

/// A column of optional values.
pub(crate) enum Cells {
    Doubles(Vec<Option<f64>>),
    Ticks(Vec<Option<i64>>),
    Texts(Vec<Option<&'static str>>),
}

/// The values of some rows, and their definition levels.
fn part<T, V: Clone>(cells: &[Option<T>], convert: impl Fn(&T) -> V) -> (Vec<V>, Vec<i16>) {
    let levels = cells.iter().map(|cell| i16::from(cell.is_some())).collect();
    (cells.iter().flatten().map(convert).collect(), levels)
}

/// Writes a file with so many rows a group.
pub(crate) fn write(path: &Path, schema: &str, columns: &[Cells], rows: usize, group: usize) {
    let schema = Arc::new(parse_message_type(schema).unwrap());
    let properties = WriterProperties::builder().set_compression(Compression::SNAPPY).build();
    let file = std::fs::File::create(path).unwrap();
    let mut writer = SerializedFileWriter::new(file, schema, Arc::new(properties)).unwrap();
    for from in (0..rows).step_by(group) {
        let rows = from..rows.min(from + group);
        let mut group = writer.next_row_group().unwrap();
        for cells in columns {
            let mut column = group.next_column().unwrap().unwrap();
            match cells {
                Cells::Doubles(cells) => {
                    let (values, levels) = part(&cells[rows.clone()], |value| *value);
                    column.typed::<DoubleType>().write_batch(&values, Some(&levels), None).unwrap();
                }
                Cells::Ticks(cells) => {
                    let (values, levels) = part(&cells[rows.clone()], |value| *value);
                    column.typed::<Int64Type>().write_batch(&values, Some(&levels), None).unwrap();
                }
                Cells::Texts(cells) => {
                    let (values, levels) = part(&cells[rows.clone()], |text| ByteArray::from(*text));
                    column.typed::<ByteArrayType>().write_batch(&values, Some(&levels), None).unwrap();
                }
            }
            column.close().unwrap();
        }
        group.close().unwrap();
    }
    writer.close().unwrap();
}

fn read(path: &Path) -> Result<(Vec<Row>, Vec<Caution>), LogError> {
    let mut reader = LogReader::open(path, &LogOptions::default())?;
    let mut rows = Vec::new();
    while let Some(row) = reader.next_row()? {
        rows.push(row.clone());
    }
    Ok((rows, reader.cautions().to_vec()))
}

fn refused(path: &Path, words: &[&str]) {
    let message = read(path).unwrap_err().to_string();
    for word in words {
        assert!(message.contains(word), "`{word}` is missing in: {message}");
    }
}

#[test]
fn rows_of_many_groups_and_batches_are_those_of_the_same_text() {
    let folder = tempdir().unwrap();
    let count = 20_011;
    let time: Vec<Option<i64>> = (0..count).map(|k| Some(10 * k)).collect();
    let shoulder: Vec<Option<f64>> =
        (0..count).map(|k| (k % 7 != 3).then_some(15.0 + (k % 100) as f64 * 0.01)).collect();
    let pressure: Vec<Option<f64>> =
        (0..count).map(|k| (!(6000..12_000).contains(&k)).then_some(200.0 + k as f64 * 1e-4)).collect();
    let mut text = String::from("time_s,shoulder_degc,pressure_bar\n");
    let cell = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
    for k in 0..count as usize {
        text.push_str(&format!("{},{},{}\n", 10 * k, cell(shoulder[k]), cell(pressure[k])));
    }
    let schema =
        "message log { optional int64 time_s; optional double shoulder_degc; optional double pressure_bar; }";
    let path = folder.path().join("log.parquet");
    let columns = [Cells::Ticks(time), Cells::Doubles(shoulder), Cells::Doubles(pressure)];
    write(&path, schema, &columns, count as usize, 9000);
    let csv = folder.path().join("log.csv");
    std::fs::write(&csv, text).unwrap();
    let (rows, expected) = (read(&path).unwrap().0, read(&csv).unwrap().0);
    assert_eq!(rows.len(), count as usize);
    let bits = |row: &Row| row.readings.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    for (row, expected) in rows.iter().zip(&expected) {
        assert_eq!((row.time_s, bits(row)), (expected.time_s, bits(expected)));
    }
}

#[test]
fn timestamps_and_dates_as_text_count_from_the_first() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("log.parquet");
    let values = || Cells::Doubles(vec![Some(15.0), Some(16.0), Some(f64::INFINITY)]);
    let ticks = || Cells::Ticks(vec![Some(1_000_000), Some(1_002_500), None]);
    for (zoned, caution) in [("true", false), ("false", true)] {
        let schema = format!(
            "message log {{ optional int64 time (TIMESTAMP(MILLIS,{zoned})); optional double shoulder_degc; }}"
        );
        write(&path, &schema, &[ticks(), values()], 3, 10);
        let (rows, cautions) = read(&path).unwrap();
        assert_eq!(rows.iter().map(|row| row.time_s).collect::<Vec<_>>(), [0.0, 2.5]);
        assert_eq!(cautions.iter().any(|c| c.kind == Kind::WithoutZone), caution);
        assert!(
            cautions.iter().any(|c| c.kind == Kind::WithoutTime && c.first.ends_with("log.parquet row 3"))
        );
    }
    let schema = "message log { optional binary time (UTF8); optional double shoulder_degc; }";
    let texts =
        vec![Some("2026-01-01T00:00:00Z"), Some("2026-01-01T01:00:00+00:30"), Some("2026-01-01T01:00:00Z")];
    write(&path, schema, &[Cells::Texts(texts), values()], 3, 2);
    let (rows, cautions) = read(&path).unwrap();
    assert_eq!(rows.iter().map(|row| row.time_s).collect::<Vec<_>>(), [0.0, 1800.0, 3600.0]);
    assert!(rows[2].readings[0].is_nan());
    assert_eq!(cautions[0].kind, Kind::Infinite);
}

#[test]
fn columns_of_another_type_and_damaged_files_are_refused() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("log.parquet");
    let seconds = || Cells::Ticks(vec![Some(0)]);
    let words = || Cells::Texts(vec![Some("15")]);
    let schema = "message log { optional int64 time_s; optional binary shoulder_degc (UTF8); }";
    write(&path, schema, &[seconds(), words()], 1, 1);
    refused(&path, &["log.parquet: column shoulder_degc must hold integers or floating-point numbers"]);
    let schema = "message log { optional binary time_s (UTF8); optional double shoulder_degc; }";
    write(&path, schema, &[words(), Cells::Doubles(vec![Some(1.0)])], 1, 1);
    refused(&path, &["log.parquet: column time_s must be a timestamp"]);
    let schema = "message log { optional int64 time_s; optional double shoulder; }";
    write(&path, schema, &[seconds(), Cells::Doubles(vec![Some(1.0)])], 1, 1);
    refused(&path, &["log.parquet: column shoulder has no unit"]);
    let whole = std::fs::read(&path).unwrap();
    std::fs::write(&path, &whole[..whole.len() - 20]).unwrap();
    refused(&path, &["log.parquet", "save the log as CSV"]);
    std::fs::write(&path, "time_s,shoulder_degc\n0,15\n").unwrap();
    refused(&path, &["log.parquet", "save the log as CSV"]);
}

#[test]
fn a_simulation_in_parquet_is_the_log_that_its_csv_is() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    for file in ["run.csv", "run.parquet"] {
        let outcome = run(folder, &["simulate", "nitrogen-20l", "shock-cold", "-o", file, "--seed", "3"]);
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    }
    let estimated = |file: &str| {
        let outcome = run(folder, &["estimate", "nitrogen-20l", file]);
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        outcome.stdout.lines().filter(|line| !line.starts_with('#')).map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(estimated("run.parquet"), estimated("run.csv"));
}

//! Logs and tables as Parquet.
use super::{TIGHT, column, fleet, log, table, with_logs};
use crate::log_parquet::{Cells, write};
use crate::support::run;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use std::collections::BTreeMap;
use std::path::Path;

const NAMES: [&str; 3] = ["A", "B", "C"];
const COLUMNS: &str = "optional double time_s; optional double shoulder_degc; optional double valve_degc; optional double pressure_bar;";

/// The rows of a log as columns; of more than one cylinder in turn.
fn columns(text: &str, cylinders: &[&'static str]) -> (Vec<Cells>, usize) {
    let lines: Vec<&str> = text.lines().skip(1).collect();
    let of_column = |k: usize| {
        let cells =
            lines.iter().flat_map(|line| vec![line.split(',').nth(k).unwrap().parse().ok(); cylinders.len()]);
        Cells::Doubles(cells.collect())
    };
    let names = lines.iter().flat_map(|_| cylinders.iter().map(|name| Some(*name))).collect();
    let columns = (0..4).map(of_column).chain([Cells::Texts(names)]).collect();
    (columns, lines.len() * cylinders.len())
}

fn write_log(path: &Path, text: &str, cylinders: &[&'static str]) {
    let (columns, rows) = columns(text, cylinders);
    let schema = format!("message log {{ {COLUMNS} optional binary cylinder (UTF8); }}");
    write(path, &schema, &columns, rows, 250);
}

/// A table in Parquet as a CSV reader would give it.
fn parquet(folder: &Path, name: &str) -> Vec<BTreeMap<String, String>> {
    let file = std::fs::File::open(folder.join("out").join(name)).unwrap();
    let reader = SerializedFileReader::new(file).unwrap();
    let text = |field: &Field| match field {
        Field::Null => String::new(),
        Field::Str(text) => text.clone(),
        Field::Double(number) => number.to_string(),
        other => other.to_string(),
    };
    let row = |row: parquet::record::Row| {
        row.get_column_iter().map(|(name, field)| (name.clone(), text(field))).collect()
    };
    reader.get_row_iter(None).unwrap().map(|found| row(found.unwrap())).collect()
}

#[test]
fn logs_and_tables_in_parquet_say_what_those_in_csv_say() {
    let (own, of_two) = (log(0..1800, 1600), log(0..300, TIGHT));
    let rows = of_two.lines().skip(1).map(|line| format!("{line},B\n{line},C\n")).collect::<String>();
    let site = format!("{},cylinder\n{rows}", super::COLUMNS.trim_end());
    let texts = with_logs(&[("A.csv", own.clone()), ("site.csv", site)], &NAMES);
    assert_eq!(fleet(texts.path(), &[]).code, Some(1));
    let packed = with_logs(&[("none.md", String::new())], &NAMES);
    let logs = packed.path().join("logs");
    std::fs::create_dir_all(logs.join("cylinder=A")).unwrap();
    write_log(&logs.join("cylinder=A/a.parquet"), &own, &["A"]);
    write_log(&logs.join("site.parquet"), &of_two, &["B", "C"]);
    let usual = ["fleet", "logs", "--vessels", "fleet.csv", "-o", "out", "-q"];
    let outcome = run(packed.path(), &usual);
    assert_eq!(outcome.code, Some(1), "{}", outcome.stderr);
    for (name, differs) in
        [("summary", &["log", "log_sha256", "cautions"][..]), ("events", &[]), ("errors", &[])]
    {
        let (mut of_csv, mut of_parquet) =
            (table(texts.path(), &format!("{name}.csv")), parquet(packed.path(), &format!("{name}.parquet")));
        for row in of_csv.iter_mut().chain(&mut of_parquet) {
            differs.iter().for_each(|column| _ = row.remove(*column));
        }
        assert_eq!(of_parquet, of_csv, "{name}");
        assert_eq!(of_csv.is_empty(), name == "errors");
    }
    for name in NAMES {
        let state = |folder: &Path| std::fs::read(folder.join(format!("out/states/{name}.state"))).unwrap();
        assert!(state(packed.path()) == state(texts.path()), "{name}");
    }
    // Another format takes the place of the tables.
    assert_eq!(fleet(packed.path(), &[]).code, Some(1));
    assert!(!packed.path().join("out/summary.parquet").exists());
    // A night later: a file after the last, and one that was written again.
    write_log(&logs.join("cylinder=A/b.parquet"), &log(1800..1900, 1600), &["A"]);
    write_log(&logs.join("site.parquet"), &log(0..400, TIGHT), &["B", "C"]);
    assert_eq!(fleet(packed.path(), &[]).code, Some(1));
    assert_eq!(column(&table(packed.path(), "summary.csv"), "rows"), ["1900", "400", "400"]);
}

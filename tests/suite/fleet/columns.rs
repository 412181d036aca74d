//! Logs with a column `cylinder`: what comes out is what a log for each cylinder would give.
use super::{COLUMNS, TIGHT, column, content, fleet, log, row, table, with_logs};
use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;

/// Two hundred cylinders, by minute in one log and each in its own, with a cell that is no number and a row that is too long; each row has the
/// line in which it stands in the log of all.
fn two_hundred() -> (Vec<String>, String, BTreeMap<String, String>) {
    let names: Vec<String> = (0..200).map(|k| format!("N{k:03}")).collect();
    let mut all = format!("cylinder,{COLUMNS}");
    let mut own: BTreeMap<String, String> = BTreeMap::new();
    for minute in 0..30 {
        for (k, name) in names.iter().enumerate() {
            let mut cells = row(minute, TIGHT);
            match (minute, k) {
                (5, 3) => cells = cells.replacen(",15.", ",bad", 1),
                (6, 9) => cells = format!("7,{cells}"),
                _ => {}
            }
            // Quotation marks, and a line feed in one of them, are cells as any other.
            let shown = if k == 12 { format!("\"{name}\"") } else { name.clone() };
            all.push_str(&format!("{shown},{cells}"));
            own.entry(name.clone()).or_insert_with(|| COLUMNS.to_owned()).push_str(&cells);
        }
    }
    (names, all, own)
}

/// A table without what says where its rows come from.
fn without_sources(folder: &Path) -> Vec<BTreeMap<String, String>> {
    let mut rows = table(folder, "summary.csv");
    for row in &mut rows {
        for column in ["log", "log_sha256", "reason"] {
            row.remove(column);
        }
    }
    rows
}

fn of_rows(folder: &Path) -> BTreeMap<String, String> {
    let content = content(&folder.join("out/rows"));
    let body = |bytes: Vec<u8>| {
        let text = String::from_utf8(bytes).unwrap();
        text.lines().filter(|line| !line.starts_with('#')).collect::<Vec<_>>().join("\n")
    };
    content.into_iter().map(|(name, bytes)| (name, body(bytes))).collect()
}

#[test]
fn two_hundred_cylinders_in_one_log_are_what_their_own_logs_say() {
    let (names, all, own) = two_hundred();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let together = with_logs(&[("site.csv", all)], &names);
    let own: Vec<(String, String)> = own.into_iter().map(|(k, text)| (format!("{k}.csv"), text)).collect();
    let own: Vec<(&str, String)> = own.iter().map(|(name, text)| (name.as_str(), text.clone())).collect();
    let apart = with_logs(&own, &names);
    for folder in [&together, &apart] {
        let outcome = fleet(folder.path(), &["--rows"]);
        assert_eq!(outcome.code, Some(3), "{}", outcome.stderr);
    }
    assert_eq!(without_sources(together.path()), without_sources(apart.path()));
    assert_eq!(table(together.path(), "events.csv"), table(apart.path(), "events.csv"));
    let rows = of_rows(together.path());
    assert!(rows.len() == 199 && rows == of_rows(apart.path()));
    // A row is wrong in its own cylinder alone, and is told by its line in the log of all.
    let errors = table(together.path(), "errors.csv");
    assert_eq!(
        (column(&errors, "cylinder"), column(&errors, "file")),
        (vec!["N009".into()], vec!["logs/site.csv".into()])
    );
    assert_eq!(column(&errors, "line"), [(2 + 6 * 200 + 9).to_string()]);
    assert_eq!(column(&table(apart.path(), "errors.csv"), "line"), ["8"]);
    let page = std::fs::read_to_string(together.path().join("out/page.html")).unwrap();
    assert!(page.contains(&format!("logs/site.csv:{}: shoulder_degc", 2 + 5 * 200 + 3)));
    // Nothing is left of the rows on their way, and what has not changed is not read again.
    assert!(!together.path().join("out/.work").exists());
    let before = content(&together.path().join("out"));
    assert_eq!(fleet(together.path(), &["--rows"]).code, Some(3));
    assert!(content(&together.path().join("out")) == before);
}

#[test]
fn rows_of_no_cylinder_are_told_and_leave_the_others_alone() {
    let mut text = format!("cylinder,{COLUMNS}");
    for minute in 0..60 {
        text.push_str(&format!("A,{}", row(minute, TIGHT)));
        if minute == 20 {
            text.push_str(&format!(",{}power on\n,,,,\ncylinder,{COLUMNS}", row(minute, TIGHT)));
        }
    }
    text.push('B');
    let folder = with_logs(&[("site.csv", text)], &["A"]);
    assert_eq!(fleet(folder.path(), &[]).code, Some(3));
    let rows = table(folder.path(), "summary.csv");
    assert_eq!((column(&rows, "cylinder"), column(&rows, "rows")), (vec!["A".into()], vec!["60".into()]));
    let errors = table(folder.path(), "errors.csv");
    assert_eq!(
        (column(&errors, "line"), column(&errors, "reason")),
        (vec!["23".into()], vec!["a row names no cylinder".into()])
    );
    let page = std::fs::read_to_string(folder.path().join("out/page.html")).unwrap();
    for words in [
        "site.csv:24: power on is no row",
        "site.csv:26: the header stands here again",
        "the last row is cut off",
    ] {
        assert!(page.contains(words), "{words}");
    }
}

#[test]
fn a_log_of_several_that_is_damaged_leaves_its_cylinders_unknown() {
    let mut text = format!("cylinder,{COLUMNS}");
    for minute in 0..3000 {
        text.push_str(&format!("A,{}B,{}", row(minute, TIGHT), row(minute, TIGHT)));
    }
    let folder = with_logs(&[("C.csv", log(0..90, TIGHT))], &["A", "B", "C"]);
    let mut packed = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    packed.write_all(text.as_bytes()).unwrap();
    let packed = packed.finish().unwrap();
    let path = folder.path().join("logs/site.csv.gz");
    std::fs::write(&path, &packed[..packed.len() / 2]).unwrap();
    assert_eq!(fleet(folder.path(), &[]).code, Some(3));
    let errors = table(folder.path(), "errors.csv");
    assert_eq!(column(&errors, "cylinder"), ["A", "B"]);
    assert!(
        errors.iter().all(|row| row["reason"].contains("ends too early") && !row["line"].is_empty()),
        "{errors:?}"
    );
    std::fs::write(&path, &packed).unwrap();
    assert_eq!(fleet(folder.path(), &[]).code, Some(3));
    assert_eq!(column(&table(folder.path(), "summary.csv"), "rows"), ["90", "3000", "3000"]);
}

//! A fleet for a program that calls it.
use super::{FORMAT, TIGHT, alike, content, log, with_logs};
use crate::support::run;
use cylwatch::report::{Table, Values};
use cylwatch::run::{self as calls, Call, RunError};
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use tempfile::TempDir;

fn call(folder: &TempDir, output: &str) -> Call {
    let path = |name: &str| folder.path().join(name);
    let vessels = path("fleet.csv").display().to_string();
    let call = Call::of_fleet(&path("logs"), &path(output));
    call.option("vessels", Some(&vessels)).option("format", Some("csv")).option("threads", Some("2"))
}

fn texts<'a>(table: &'a Table, name: &str) -> &'a [String] {
    let column = table.columns.iter().find(|column| column.name == name).unwrap();
    let Values::Texts(texts) = &column.values else { panic!("{name} has no texts") };
    texts
}

#[test]
fn a_call_writes_the_folder_of_the_command_and_hands_out_its_tables() {
    let files = [("A.csv", log(0..1800, 1600)), ("B.csv", log(0..300, TIGHT)), ("C.csv", String::new())];
    let folder = with_logs(&files, &["A", "B", "C"]);
    let outcome = calls::fleet(call(&folder, "out")).unwrap();
    assert_eq!(
        (outcome.exit_code, texts(&outcome.summary, "cylinder")),
        (1, &["A", "C", "B"].map(String::from)[..])
    );
    assert_eq!(texts(&outcome.errors, "cylinder"), ["C"]);
    assert!(texts(&outcome.events, "event").iter().any(|event| event == "leak-found"));
    assert!(outcome.page.is_file());
    // Provenance shows the command that does the same.
    let called = content(&folder.path().join("out"));
    let words: Vec<&str> = outcome.provenance.command.split(' ').skip(1).collect();
    assert!(!words.contains(&"--threads=2"), "{words:?}");
    std::fs::remove_dir_all(folder.path().join("out")).unwrap();
    let command = run(folder.path(), &[&words[..], &FORMAT[2..]].concat());
    assert_eq!(command.code, Some(1), "{}", command.stderr);
    let mut commanded = content(&folder.path().join("out"));
    for (name, bytes) in &mut commanded {
        if let Ok(text) = std::str::from_utf8(bytes) {
            *bytes = text.replace(" -q\n", "\n").replace(" -q<", "<").into_bytes();
        }
        assert!(called[name] == *bytes, "{name}");
    }
    assert_eq!(called.len(), commanded.len());
}

#[test]
fn a_call_that_is_stopped_says_so_and_the_same_call_does_the_rest() {
    let (folder, names) = alike("S", 30, 900);
    let asked = Arc::new(AtomicU32::new(0));
    let stop = {
        let asked = Arc::clone(&asked);
        move || asked.fetch_add(1, Ordering::Relaxed) > 2
    };
    let stopped = calls::fleet(call(&folder, "out").stopped_by(stop)).unwrap_err();
    assert!(stopped.is_stopped() && stopped.to_string().contains("does the rest"), "{stopped}");
    assert!(!folder.path().join("out/summary.csv").exists());
    assert_eq!(calls::fleet(call(&folder, "out")).unwrap().summary.columns[0].values, Values::Texts(names));
}

#[test]
fn what_is_wrong_with_a_call_is_refused_with_its_parts() {
    let folder = with_logs(&[("A.csv", log(0..90, TIGHT))], &["A"]);
    let refusal = |call: Call| -> RunError { calls::fleet(call).unwrap_err() };
    std::fs::write(folder.path().join("fleet.csv"), "cylinder,vessel\nA,nitrogen-20\n").unwrap();
    let error = refusal(call(&folder, "out"));
    assert!(
        error.file().is_some_and(|file| file.ends_with("fleet.csv")) && error.line() == Some(2),
        "{error}"
    );
    let vessel = |output: &str| {
        Call::of_fleet(&folder.path().join("logs"), &folder.path().join(output))
            .option("vessel", Some("nitrogen-20l"))
    };
    assert!(refusal(vessel("out").option("quiet", None)).to_string().contains("command line"));
    assert!(refusal(vessel("fleet.csv")).to_string().contains("is a file"));
    assert!(refusal(vessel("out").option("limit-bra", Some("5"))).to_string().contains("limit-bra"));
}

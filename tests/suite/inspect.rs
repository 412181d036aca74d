//! `cylwatch inspect`: what it says of good logs, odd ones, and ones that a command would refuse.
use crate::support::{files, refusal, refused, run, run_with_stdin};
use cylwatch::log::LogOptions;
use cylwatch::log::inspect::{Inspection, Inspector};
use serde_json::Value;
use std::path::Path;
use tempfile::tempdir;

fn sample(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/logs").join(name).display().to_string()
}

/// The inspection of a text.
fn inspected(text: &str, maps: &[&str]) -> Inspection {
    let mappings = maps.iter().map(|map| map.parse().unwrap()).collect();
    let options = LogOptions { mappings, ..LogOptions::default() };
    let input = Box::new(std::io::Cursor::new(text.to_owned()));
    let mut inspector = Inspector::new(input, "log.csv", &options).unwrap();
    while inspector.step().unwrap() {}
    inspector.finish()
}

/// Rows a minute with a header; `cells` writes those of a minute.
fn minutes(header: &str, rows: u32, cells: impl Fn(u32) -> String) -> String {
    let body: String = (0..rows).map(|k| format!("{},{}\n", 60 * k, cells(k))).collect();
    format!("{header}\n{body}")
}

fn document(arguments: &[&str]) -> Value {
    let folder = tempdir().unwrap();
    let outcome = run(folder.path(), &[&["inspect"], arguments, &["--format", "json"]].concat());
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    serde_json::from_str(&outcome.stdout).unwrap()
}

#[test]
fn an_export_whose_columns_are_all_foreign_gets_proposals_and_lines_that_run() {
    let folder = tempdir().unwrap();
    for (name, maps) in [
        ("handheld.csv", &["shoulder_degc=T Schulter", "valve_degc=T Ventil", "pressure_bar=Druck"][..]),
        ("almemo.csv", &["shoulder_degc=M00", "valve_degc=M01", "pressure_bar=M10"]),
        (
            "station.txt",
            &["time=Zeitstempel", "shoulder_degc=Kanal 1", "valve_degc=Kanal 2", "pressure_barg=Kanal 3"],
        ),
        (
            "english.csv",
            &["time_s=Elapsed Time [s]", "shoulder_degc=TC1", "valve_degc=TC2", "pressure_psi=PT1"],
        ),
    ] {
        std::fs::copy(sample(name), folder.path().join(name)).unwrap();
        let outcome = run(folder.path(), &["inspect", name, "--format", "json"]);
        let found: Value = serde_json::from_str(&outcome.stdout).unwrap();
        let of_columns = found["columns"].as_array().unwrap().iter().map(|column| &column["proposal"]["map"]);
        let proposed: Vec<&str> = [&found["time"]["proposed_map"]]
            .into_iter()
            .chain(of_columns)
            .filter_map(Value::as_str)
            .collect();
        assert_eq!(proposed, maps, "{name}");
        let estimate = &found["uses"][0];
        assert_eq!(
            (estimate["command"].as_str(), estimate["possible"].as_bool()),
            (Some("estimate"), Some(true))
        );
        // The line runs as it is.
        let mut words = vec!["estimate".to_owned(), "nitrogen-20l".to_owned(), name.to_owned()];
        words.extend(proposed.iter().flat_map(|map| ["--map".to_owned(), (*map).to_owned()]));
        let line = estimate["line"].as_str().unwrap();
        assert!(words.iter().all(|word| line.contains(word.as_str())), "{line}");
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        let outcome = run(folder.path(), &words);
        assert_eq!(outcome.code, Some(0), "{line}: {}", outcome.stderr);
        let again: Vec<&str> = ["inspect"].into_iter().chain(words[2..].iter().copied()).collect();
        let outcome = run(folder.path(), &again);
        assert!(
            outcome.stdout.contains("yes") && !outcome.stdout.contains("would refuse"),
            "{}",
            outcome.stdout
        );
        assert!(outcome.stdout.lines().all(|line| line.chars().count() <= 110 || line.contains("cylwatch ")));
    }
}

#[test]
fn form_times_and_columns_are_those_of_the_file() {
    let found = document(&[&sample("handheld.csv"), "--zone", "+01:00"]);
    assert_eq!(found["form"]["separator"], ";");
    assert_eq!(found["form"]["decimal_mark"], ",");
    assert_eq!(
        (&found["form"]["encoding"], &found["form"]["header_line"]),
        (&"Windows-1252".into(), &5.into())
    );
    assert_eq!(found["time"]["origin"], "2026-11-22T13:05:00Z");
    assert_eq!((&found["time"]["interval_s"], &found["time"]["rows"]), (&60.0.into(), &37.into()));
    let shoulder = &found["columns"][2];
    assert_eq!(
        (&shoulder["min"], &shoulder["max"], &shoulder["step"]),
        (&6.4.into(), &20.0.into(), &0.1.into())
    );
    assert!(found["provenance"]["inputs"][0]["sha256"].is_string());
}

#[test]
fn a_simulated_log_can_be_used_by_all_that_have_what_they_need() {
    let folder = tempdir().unwrap();
    assert_eq!(
        run(folder.path(), &["simulate", "nitrogen-20l", "shock-cold", "-o", "run.csv", "-q"]).code,
        Some(0)
    );
    let outcome = run(folder.path(), &["inspect", "run.csv"]);
    assert_eq!((outcome.code, outcome.stderr.as_str()), (Some(0), ""));
    for words in
        ["cylwatch estimate nitrogen-20l run.csv", "--input shoulder --output gas_mean", "or --scenario"]
    {
        assert!(outcome.stdout.contains(words), "{words} is missing in\n{}", outcome.stdout);
    }
}

#[test]
fn gaps_runs_spikes_and_clocks_are_told_with_their_places() {
    let text = minutes("time_s,shoulder_degc,valve_degc,pressure_bar", 900, |k| {
        let valve = if k > 400 { 3.25 } else { 15.0 - 0.02 * f64::from(k) };
        let spike = if k == 200 { 90.0 } else { 15.0 + 0.01 * f64::from(k % 5) };
        format!("{spike:.2},{valve:.2},{:.2}", 200.0 - 0.01 * f64::from(k % 3))
    });
    let text = text.replacen("\n18000,", "\n14390,", 1);
    let found = inspected(&text, &[]);
    let odd = found.oddities.join("\n");
    assert!(odd.contains("shoulder_degc: a spike from 15.04 to 90 at line 202"), "{odd}");
    assert!(odd.contains("valve_degc: stays at 3.25 for 8.3 h from line 403 on"), "{odd}");
    assert_eq!(found.times.steps_back.0, 1);
    let lacks: Vec<usize> = found.uses.iter().map(|one| one.lacks.len()).collect();
    assert_eq!(lacks, [1, 0, 2, 2], "{:?}", found.uses);
    assert!(
        found.refusals[0].message.contains("log.csv:302: the time is 3550 s before"),
        "{:?}",
        found.refusals
    );
    let gap = "time_s,shoulder_degc\n0,15\n60,15\n120,15\n7200,15\n7260,15\n7320,15\n7380,15\n";
    let [gap] = inspected(gap, &[]).times.gaps[..] else { panic!("one gap expected") };
    assert_eq!((gap.begin_s, gap.length_s, gap.line), (120.0, 7080.0, 5));
}

/// Mappings that are proposed.
fn proposed(text: &str) -> Vec<String> {
    let columns = inspected(text, &[]).columns.into_iter();
    columns.filter_map(|column| Some(column.proposal?.mapping.to_string())).collect()
}

#[test]
fn a_unit_that_the_values_contradict_is_doubted() {
    let pressures = [
        ("pressure_bar", 2900.0, "pressure_psi=pressure_bar"),
        ("pressure_mpa", 200.0, "pressure_bar=pressure_mpa"),
        ("pressure_pa", 200.0, "pressure_bar=pressure_pa"),
    ];
    for (name, value, words) in pressures {
        let text = minutes(&format!("time_s,shoulder_degc,{name}"), 60, |k| {
            format!("15,{}", value + f64::from(k % 3))
        });
        assert_eq!(proposed(&text), [words]);
    }
    let text = minutes("time_s,shoulder_degc,pressure_bar", 60, |k| format!("288.{},200", k % 3));
    assert_eq!(proposed(&text), ["shoulder_k=shoulder_degc"]);
    let text = minutes("time_s,shoulder_degc,pressure_bar", 60, |k| {
        format!("15.1,{}", if k > 50 { "0.0" } else { "199.1" })
    });
    assert_eq!(proposed(&text), ["pressure_barg=pressure_bar"]);
}

#[test]
fn what_a_command_refuses_is_told_and_the_inspection_goes_on() {
    let text = "time_s,shoulder_degc,pressure_bar\n0,15,200\n60,15\nsoon,15,200\n120,15,200\n120,16,200\n180,15,200\n";
    let found = inspected(text, &[]);
    let said: Vec<&str> = found.refusals.iter().map(|refusal| refusal.message.as_str()).collect();
    assert!(said[0].starts_with("log.csv:3: the number of cells is 2"), "{said:?}");
    assert!(said[1].starts_with("log.csv:4: time_s = soon"), "{said:?}");
    assert!(said[2].starts_with("log.csv:6: the row has the time of the one above"), "{said:?}");
    assert_eq!(found.times.rows, 3);
    let found = inspected("time_s,shoulder,T1\n0,15,16\n60,15,16\n", &[]);
    assert!(found.refusals[0].message.contains("shoulder has no unit"));
    assert_eq!(found.columns[1].proposal.as_ref().unwrap().mapping.to_string(), "shoulder_degc=shoulder");
}

#[test]
fn a_pressure_that_is_named_a_gauge_is_proposed_as_one() {
    for (name, map) in [("Druck (Ueberdruck)", "pressure_barg=Druck"), ("Druck", "pressure_bar=Druck")] {
        let found = inspected(&minutes(&format!("time_s,{name}"), 9, |k| format!("{}", 198 + k % 3)), &[]);
        assert_eq!(found.columns[1].proposal.as_ref().unwrap().mapping.to_string(), map);
    }
}

#[test]
fn a_log_without_a_time_is_counted_in_rows() {
    let found = inspected("a,b\n1,2\n3,4\n", &[]);
    assert_eq!((found.times.column.as_deref(), found.times.rows), (None, 2));
    assert!(found.uses.iter().all(|one| one.lacks.iter().any(|lack| lack == "a column of time")));
}

#[test]
fn what_cannot_be_read_at_all_is_refused_and_leaves_nothing() {
    let folder = tempdir().unwrap();
    refused(folder.path(), &["inspect", "missing.csv"], &["missing.csv", "cannot be read"]);
    std::fs::write(folder.path().join("log.csv"), "time_s,T1\n0,1\n").unwrap();
    refused(
        folder.path(),
        &["inspect", "log.csv", "--map", "shoulder_degc=T2"],
        &["no column T2", "time_s, T1"],
    );
    std::fs::write(folder.path().join("log.csv.gz"), b"\x1f\x8b\x08\0\0").unwrap();
    refused(folder.path(), &["inspect", "log.csv.gz", "-o", "i.json"], &["log.csv.gz:1", "ends too early"]);
    refusal(run_with_stdin(folder.path(), &["inspect", "-"], ""), &["stdin has no header"]);
    assert_eq!(files(folder.path()), ["log.csv", "log.csv.gz"]);
    let outcome = run_with_stdin(folder.path(), &["inspect", "-"], "time_s,shoulder_degc\n0,15\n60,16\n");
    assert!(outcome.stdout.contains("cylwatch monitor nitrogen-20l - --fill"), "{}", outcome.stdout);
}

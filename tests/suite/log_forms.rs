//! Logs in the forms that loggers give them: packed, with preambles, dates, brackets and bytes of their own.
use crate::support::{column, files, refused, rows, run};
use approx::assert_relative_eq;
use cylwatch::log::{Caution, Kind, LogError, LogOptions, LogReader, Row};
use flate2::Compression;
use flate2::write::GzEncoder;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use tempfile::tempdir;

/// A sample of the tests' data.
fn sample(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/logs").join(name)
}

fn options(maps: &[&str]) -> LogOptions {
    let mappings = maps.iter().map(|map| map.parse().unwrap()).collect();
    LogOptions { mappings, ..LogOptions::default() }
}

/// What was read of a log.
struct Taken {
    rows: Vec<Row>,
    cautions: Vec<Caution>,
    origin: Option<String>,
}

fn read(path: &Path, options: &LogOptions) -> Result<Taken, LogError> {
    let mut reader = LogReader::open(path, options)?;
    let mut rows = Vec::new();
    while let Some(row) = reader.next_row()? {
        rows.push(row.clone());
    }
    Ok(Taken { rows, cautions: reader.cautions().to_vec(), origin: reader.origin() })
}

fn packed(text: &str) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(text.as_bytes()).unwrap();
    encoder.finish().unwrap()
}

/// A log at rest, a row a minute.
fn at_rest(rows: u32) -> String {
    let mut text = String::from("time_s,shoulder_degc,valve_degc,pressure_bar\n");
    (0..rows).for_each(|k| text.push_str(&format!("{},15,15,{}\n", 60 * k, 200.0 + f64::from(k % 7) * 0.01)));
    text
}

#[test]
fn the_exports_of_four_loggers_say_the_same() {
    let maps = |maps: &[&str]| options(maps);
    for (name, options, zone) in [
        (
            "handheld.csv",
            maps(&["shoulder_degc=T Schulter", "valve=T Ventil", "pressure_bar=Druck"]),
            Some("2026-11-22T14:05:00Z"),
        ),
        (
            "almemo.csv",
            maps(&["shoulder=M00", "valve=M01: °C", "pressure=M10"]),
            Some("2026-11-22T14:05:00Z"),
        ),
        (
            "station.txt",
            maps(&["time=Zeitstempel", "shoulder=Kanal 1", "valve=Kanal 2", "pressure=Kanal 3"]),
            Some("2026-11-22T14:05:00.5Z"),
        ),
        (
            "english.csv",
            maps(&["time=Elapsed Time", "shoulder=TC1", "valve_degc=TC2", "pressure_psi=PT1"]),
            None,
        ),
    ] {
        let Taken { rows, origin, .. } = read(&sample(name), &options).unwrap();
        assert_eq!((rows.len(), origin.as_deref()), (37, zone), "{name}");
        assert_eq!((rows[0].time_s, rows[36].time_s), (0.0, 2160.0), "{name}");
        assert_relative_eq!(rows[0].readings[..], [293.15, 293.15, 200e5], max_relative = 2e-5);
        assert_relative_eq!(rows[36].readings[..], [279.511, 278.317, 189.7e5], max_relative = 1e-3);
    }
}

#[test]
fn what_was_supposed_of_an_export_is_said_once_each() {
    let maps = options(&["shoulder_degc=T Schulter", "pressure_bar=Druck"]);
    let Taken { cautions, .. } = read(&sample("handheld.csv"), &maps).unwrap();
    let kinds: Vec<Kind> = cautions.iter().map(|caution| caution.kind).collect();
    let expected = [Kind::Preamble, Kind::Windows1252, Kind::SetAside, Kind::WithoutZone, Kind::DecimalComma];
    assert_eq!(kinds, expected);
    assert!(
        cautions[0]
            .to_string()
            .ends_with("handheld.csv:5: the header is taken to stand here; 3 lines above it passed over")
    );
    assert!(
        cautions[3].to_string().contains("Datum+Zeit = 22.11.2026 14:05:00 has no zone"),
        "{}",
        cautions[3]
    );
    let comma = cautions[4].to_string();
    assert!(
        comma.contains("is taken as a number with a decimal comma, as are all others like it"),
        "{comma}"
    );
}

#[test]
fn a_zone_that_is_given_is_that_of_all_local_times() {
    let maps = options(&["shoulder_degc=T Schulter"]);
    let zoned = LogOptions { zone: Some("+01:00".parse().unwrap()), ..maps };
    let Taken { cautions, origin, .. } = read(&sample("handheld.csv"), &zoned).unwrap();
    assert_eq!(origin.as_deref(), Some("2026-11-22T13:05:00Z"));
    assert!(!cautions.iter().any(|caution| caution.kind == Kind::WithoutZone));
    let folder = tempdir().unwrap();
    let log = sample("handheld.csv").display().to_string();
    for command in ["estimate", "monitor"] {
        let maps = ["--map", "shoulder=T Schulter", "--map", "pressure=Druck", "--zone", "+01:00"];
        let outcome = run(folder.path(), &[&[command, "nitrogen-20l", &log], &maps[..]].concat());
        assert!(outcome.stdout.contains("time_s = 0 is 2026-11-22T13:05:00Z"), "{}", outcome.stderr);
    }
    let arguments = ["estimate", "nitrogen-20l", &log, "--zone", "Berlin", "-o", "e.csv"];
    refused(folder.path(), &arguments, &["--zone", "\"Berlin\"", "Europe/Berlin", "+01:00"]);
    assert!(files(folder.path()).is_empty());
}

#[test]
fn a_date_that_can_be_two_days_is_refused_with_both_ways_out() {
    let folder = tempdir().unwrap();
    std::fs::write(
        folder.path().join("log.csv"),
        "Date,Time,shoulder_degc,pressure_bar\n01/02/2026,08:00,15,200\n",
    )
    .unwrap();
    refused(
        folder.path(),
        &["estimate", "nitrogen-20l", "log.csv", "-o", "e.csv"],
        &["log.csv:2", "Date+Time = 01/02/2026 08:00", "2026-01-31 08:00:00", "31.01.2026 08:00:00"],
    );
    assert_eq!(files(folder.path()), ["log.csv"]);
}

#[test]
fn a_unit_that_the_header_contradicts_is_refused() {
    let folder = tempdir().unwrap();
    let log = sample("handheld.csv").display().to_string();
    let arguments = |map| ["estimate", "nitrogen-20l", log.as_str(), "--map", map, "-o", "e.csv"];
    let words = ["--map pressure_psi=Druck", "the header says bar", "write pressure_bar=Druck"];
    refused(folder.path(), &arguments("pressure_psi=Druck"), &words);
    let words = ["--map shoulder_k=T Schulter", "the header says °C", "shoulder_degc=T Schulter"];
    refused(folder.path(), &arguments("shoulder_k=T Schulter"), &words);
    assert!(files(folder.path()).is_empty());
}

#[test]
fn a_packed_log_gives_the_rows_of_the_plain_one_under_any_name_and_its_own_hash() {
    let folder = tempdir().unwrap();
    let text = at_rest(90);
    let half = text.find("2700,").unwrap();
    // Two streams one after the other, as after `cat a.gz b.gz`.
    let bytes = [packed(&text[..half]), packed(&text[half..])].concat();
    std::fs::write(folder.path().join("log.csv"), &text).unwrap();
    std::fs::write(folder.path().join("log.csv.gz"), &bytes).unwrap();
    std::fs::write(folder.path().join("packed.csv"), &bytes).unwrap();
    let masses = |log: &str| {
        let outcome = run(folder.path(), &["estimate", "nitrogen-20l", log]);
        assert_eq!((outcome.code, rows(&outcome.stdout).1.len()), (Some(0), 90), "{}", outcome.stderr);
        (column(&outcome.stdout, "mass_kg"), outcome.stdout)
    };
    let (plain, _) = masses("log.csv");
    let hash = cylwatch::report::Input::of("x", &bytes).sha256;
    for log in ["log.csv.gz", "packed.csv"] {
        let (unpacked, csv) = masses(log);
        assert_eq!(unpacked, plain);
        assert!(csv.contains(&format!("# input: {log} sha256 {hash}")));
    }
}

#[test]
fn a_packed_log_comes_through_a_pipe() {
    let folder = tempdir().unwrap();
    let mut command = crate::support::program(folder.path(), &["estimate", "nitrogen-20l", "-"]);
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    let bytes = packed(&at_rest(30));
    child.stdin.take().unwrap().write_all(&bytes).unwrap();
    let output = child.wait_with_output().unwrap();
    let csv = String::from_utf8(output.stdout).unwrap();
    assert_eq!((output.status.code(), rows(&csv).1.len()), (Some(0), 30));
    let hash = cylwatch::report::Input::of("-", &bytes).sha256;
    assert!(csv.trim_end().ends_with(&format!("# input: - sha256 {hash}")));
}

#[test]
fn a_packed_log_that_is_cut_off_or_damaged_is_refused_and_leaves_nothing() {
    let folder = tempdir().unwrap();
    let bytes = packed(&at_rest(5000));
    let mut damaged = bytes.clone();
    damaged[bytes.len() / 2] ^= 0xff;
    let cases = [
        (bytes[..bytes.len() / 2].to_vec(), "ends too early"),
        (bytes[..5].to_vec(), "ends too early"),
        (damaged, "is damaged"),
        ([&bytes[..], b"no gzip at all"].concat(), "is damaged"),
    ];
    for (bytes, words) in cases {
        std::fs::write(folder.path().join("log.csv.gz"), bytes).unwrap();
        refused(
            folder.path(),
            &["estimate", "nitrogen-20l", "log.csv.gz", "-o", "e.csv"],
            &["log.csv.gz:", "the gzip stream", words, "copy the file again"],
        );
        assert_eq!(files(folder.path()), ["log.csv.gz"]);
    }
}

proptest::proptest! {
    #[test]
    fn no_bytes_make_the_reader_panic(
        bytes in proptest::collection::vec(proptest::prelude::any::<u8>(), 0..400),
        begin in 0_usize..7,
    ) {
        let begins: [&[u8]; 7] = [
            b"", b"\x1f\x8b\x08", b"time_s,shoulder_degc\n0,15\n", b"Datum;Zeit;T [\xb0C]\n22.11.2026;14:05;1,5\n",
            b"time\tshoulder_degc\n22.11.26 1:1", b"\xef\xbb\xbf\"a\nb\",\"", b"x;y\n;bar\n",
        ];
        let text = [begins[begin], &bytes].concat();
        let options = options(&[]);
        if let Ok(mut reader) = LogReader::from_text(Box::new(std::io::Cursor::new(text)), "soup", &options) {
            while let Ok(Some(_)) = reader.next_row() {}
        }
    }
}

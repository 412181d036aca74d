//! The log of a logger in Germany, as it comes: `inspect`, then what it prints, at the first try.
use crate::support::{Outcome, rows, run};
use jiff::tz::TimeZone;
use jiff::{SignedDuration, Timestamp};
use std::path::Path;
use tempfile::tempdir;

/// Writes `log.csv` of a scenario that begins at an instant: local times, semicolons, decimal commas, degrees Fahrenheit, pounds per square inch above the air, a remark among the
/// rows and one below them, a thermometer that may stand still from 30 to 42 h; the text is in Windows-1252.
fn write_log(folder: &Path, scenario: &str, start: &str) {
    let simulated = run(folder, &["simulate", "nitrogen-20l", scenario, "-o", "true.csv", "-q"]);
    assert_eq!(simulated.code, Some(0), "{}", simulated.stderr);
    let text = std::fs::read_to_string(folder.join("true.csv")).unwrap();
    let (header, rows) = rows(&text);
    let columns =
        ["time_s", "measured_shoulder_degc", "measured_valve_degc", "ambient_degc", "measured_pressure_bar"]
            .map(|name| header.iter().position(|found| *found == name).unwrap());
    let start: Timestamp = start.parse().unwrap();
    let berlin = TimeZone::get("Europe/Berlin").unwrap();
    let mut log = "Messger\u{e4}t Typ 5, Nr. 00231\r\nStandort Tunnel S\u{fc}d; Halle 2\r\n\r\n\
        Datum;Uhrzeit;T Schulter [\u{b0}F];T Ventil [\u{b0}F];Luft [\u{b0}F];Druck [psi];Bemerkung\r\n"
        .to_owned();
    let mut stuck = None;
    for row in &rows {
        let [time_s, shoulder, valve, ambient, bar] = columns.map(|at| row[at].parse::<f64>().unwrap());
        if time_s % 60.0 != 0.0 || time_s > 50.0 * 3600.0 {
            continue;
        }
        let local = (start + SignedDuration::from_secs_f64(time_s)).to_zoned(berlin.clone());
        let valve =
            if (30.0..42.0).contains(&(time_s / 3600.0)) { *stuck.get_or_insert(valve) } else { valve };
        let psi = (bar - 1.01325) * 14.503_773_8;
        let [shoulder, valve, ambient] = [shoulder, valve, ambient].map(|degc| degc * 1.8 + 32.0);
        let cells = format!("{shoulder:.1};{valve:.1};{ambient:.1};{psi:.1};\r\n").replace('.', ",");
        log.push_str(&format!("{};{cells}", local.strftime("%d.%m.%Y;%H:%M:%S")));
        if time_s == 30_000.0 {
            log.push_str("--- Batteriewechsel ---\r\n");
        }
    }
    log.push_str("Ende der Messung\r\n");
    std::fs::write(folder.join("log.csv"), log.chars().map(|c| c as u8).collect::<Vec<u8>>()).unwrap();
}

fn inspect(folder: &Path, arguments: &[&str]) -> (String, serde_json::Value) {
    let text = run(folder, &[&["inspect", "log.csv"], arguments].concat());
    assert_eq!(text.code, Some(0), "{}", text.stderr);
    let json = run(folder, &[&["inspect", "log.csv", "--format", "json"], arguments].concat());
    (text.stdout, serde_json::from_str(&json.stdout).unwrap())
}

/// Runs a line as `inspect` prints it, with these words after it.
fn run_line(folder: &Path, line: &str, more: &[&str]) -> Outcome {
    let mut words = Vec::new();
    let mut quoted = false;
    for piece in line.split('\'') {
        if quoted {
            let last: &mut String = words.last_mut().unwrap();
            last.push_str(piece);
        } else {
            words.extend(piece.split(' ').filter(|word| !word.is_empty()).map(str::to_owned));
            if piece.ends_with(' ') {
                words.push(String::new());
            }
        }
        quoted = !quoted;
    }
    let words: Vec<&str> = words.iter().filter(|word| !word.is_empty()).map(String::as_str).collect();
    assert_eq!(words[0], "cylwatch");
    run(folder, &[&words[1..], more].concat())
}

#[test]
fn what_inspect_prints_works_at_the_first_try_in_every_command_that_it_proposes() {
    let folder = tempdir().unwrap();
    write_log(folder.path(), "railway-week", "2026-10-23T22:00:00Z");
    let (text, found) = inspect(folder.path(), &[]);
    for words in [
        "supposed, by where the clock goes back: --zone Europe/Berlin",
        "as _psig if it counts from the air",
        "--- Batteriewechsel --- is no row; 2 lines of words left out",
        "T Ventil [\u{b0}F]: stays at",
    ] {
        assert!(text.contains(words), "`{words}` is missing in\n{text}");
    }
    for words in ["would refuse", "a jump", "has no zone", "set aside:"] {
        assert!(!text.contains(words), "`{words}` is in\n{text}");
    }
    let uses = found["uses"].as_array().unwrap();
    let possible: Vec<&str> = uses
        .iter()
        .filter(|one| one["possible"] == true)
        .map(|one| one["command"].as_str().unwrap())
        .collect();
    assert_eq!(possible, ["estimate", "monitor", "calibrate"]);
    for one in uses.iter().filter(|one| one["possible"] == true) {
        let line = one["line"].as_str().unwrap().replace("pressure_psi=", "pressure_psig=");
        if one["command"] == "calibrate" {
            // Tunnels between two rows leave open when they began.
            assert!(one["but"][0].as_str().unwrap().contains("the air jumps by"), "{one}");
            continue;
        }
        let outcome = run_line(folder.path(), &line, &[]);
        assert_ne!(outcome.code, Some(2), "{line}\n{}", outcome.stderr);
    }
    // The hour that comes twice stands there twice, in order.
    let estimates = std::fs::read_to_string(folder.path().join("estimate.csv")).unwrap();
    let (header, estimates) = rows(&estimates);
    assert_eq!(header[..2], ["time_s", "time"]);
    let at = |time: &str| estimates.iter().find(|row| row[1] == time).unwrap()[0].parse::<f64>().unwrap();
    assert_eq!(at("2026-10-25T02:30:00+01:00") - at("2026-10-25T02:30:00+02:00"), 3600.0);
    assert!(estimates.iter().map(|row| row[0].parse::<f64>().unwrap()).is_sorted());
}

#[test]
fn what_inspect_prints_calibrates_on_a_quiet_log() {
    let folder = tempdir().unwrap();
    write_log(folder.path(), "cool-down", "2026-10-24T18:00:00Z");
    let (_, found) = inspect(folder.path(), &[]);
    let one = found["uses"].as_array().unwrap().iter().find(|one| one["command"] == "calibrate").unwrap();
    assert_eq!((&one["possible"], one["but"].as_array().unwrap().len()), (&true.into(), 0), "{one}");
    let line = one["line"].as_str().unwrap().replace("pressure_psi=", "pressure_psig=");
    // One parameter: that all are fitted is tested elsewhere.
    let outcome = run_line(folder.path(), &line, &["--fit", "outside-film", "-q"]);
    assert_eq!(outcome.code, Some(0), "{line}\n{}", outcome.stderr);
}

#[test]
fn without_the_zone_the_refusal_names_it_and_an_hour_that_no_clock_shows_is_refused() {
    let folder = tempdir().unwrap();
    let text = "time;shoulder_degc;pressure_bar\n25.10.2026 02:50;15;200\n25.10.2026 02:00;15;200\n";
    std::fs::write(folder.path().join("log.csv"), text).unwrap();
    crate::support::refused(
        folder.path(),
        &["estimate", "nitrogen-20l", "log.csv"],
        &["log.csv:3", "3000 s before", "if summer time ended there", "--zone Europe/Berlin"],
    );
    let text = "time;shoulder_degc;pressure_bar\n29.03.2026 01:50;15;200\n29.03.2026 02:10;15;200\n";
    std::fs::write(folder.path().join("log.csv"), text).unwrap();
    crate::support::refused(
        folder.path(),
        &["estimate", "nitrogen-20l", "log.csv", "--zone", "Europe/Berlin"],
        &["log.csv:3", "leaves an hour out", "--zone +01:00"],
    );
    crate::support::refused(
        folder.path(),
        &["estimate", "nitrogen-20l", "log.csv", "--zone", "Berlin"],
        &["Berlin", "Europe/Berlin"],
    );
}

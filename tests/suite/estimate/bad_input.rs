//! Bad logs: taken with one caution per kind and its count, or refused with place, value, bound and remedy.
use super::{at_rest, cautions, estimate};
use crate::support::{column, refusal, rows, run_with_stdin};
use tempfile::tempdir;

/// Estimates of a log that is taken, with its only caution.
fn taken(log: &str) -> (String, String) {
    let folder = tempdir().unwrap();
    let outcome = estimate(folder.path(), log, &[]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let [caution] = cautions(&outcome)[..] else { panic!("one caution expected: {}", outcome.stderr) };
    let caution = caution.to_owned();
    (outcome.stdout, caution)
}

/// Asserts that a log is refused, and that no file is left.
fn refused(log: &str, words: &[&str]) {
    refused_with(log, &[], words);
}

fn refused_with(log: &str, options: &[&str], words: &[&str]) {
    let folder = tempdir().unwrap();
    refusal(estimate(folder.path(), log, &[options, &["-o", "e.csv"]].concat()), words);
    assert!(!folder.path().join("e.csv").exists());
}

/// A log at rest for half an hour with further rows.
fn with(rows: &str) -> String {
    at_rest(30) + rows
}

#[test]
fn nan_is_a_missing_value_and_no_fault() {
    let folder = tempdir().unwrap();
    let outcome = estimate(folder.path(), &with("1800,nan,NaN,200\n"), &[]);
    assert_eq!(outcome.code, Some(0));
    assert!(cautions(&outcome).is_empty(), "{}", outcome.stderr);
    assert_eq!(rows(&outcome.stdout).1[30][12], "degraded");
}

#[test]
fn infinite_readings_are_missing_and_counted() {
    let (csv, caution) = taken(&with("1800,15,15,inf\n1860,15,15,-Infinity\n1920,15,15,200\n"));
    assert_eq!(caution, "stdin:32: pressure_bar = inf is infinite; 2 values taken as missing");
    let (_, rows) = rows(&csv);
    assert_eq!((rows[30][8], rows[31][8], rows[32][8]), ("", "", "200.00000"));
}

#[test]
fn readings_that_no_sensor_can_show_are_missing_and_counted_with_the_range() {
    let (_, caution) = taken(&with("1800,15,15,-5\n1860,15,15,900\n1920,15,15,200\n"));
    assert!(caution.starts_with("stdin:32: pressure_bar = -5 lies outside of"), "{caution}");
    assert!(caution.ends_with("2 values taken as missing"), "{caution}");
    let (csv, caution) = taken(&with("1800,-300,15,200\n1860,-127,15,200\n"));
    assert!(caution.contains("shoulder_degc = -300 lies outside of"), "{caution}");
    assert!(column(&csv, "gas_mean_degc").iter().all(|gas| (gas - 15.0).abs() < 0.5));
}

#[test]
fn words_in_place_of_numbers_are_missing_and_counted() {
    let (_, caution) = taken(&with("1800,OPEN,15,200\n1860,OPEN,15,200\n"));
    assert_eq!(caution, "stdin:32: shoulder_degc = OPEN is no number; 2 values taken as missing");
}

#[test]
fn a_stuck_thermometer_is_named_with_its_value_while_another_moves() {
    let mut log = String::from("time_min,shoulder_degc,valve_degc,pressure_bar\n");
    for minute in 0..180 {
        let fall = 0.1 * f64::from(minute);
        log.push_str(&format!("{minute},15.25,{:.2},{:.2}\n", 15.0 - fall, 200.0 - 0.9 * fall));
    }
    let folder = tempdir().unwrap();
    let outcome = estimate(folder.path(), &log, &[]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let said = cautions(&outcome);
    let stuck = said.iter().find(|caution| caution.contains("stands still")).unwrap();
    assert!(stuck.contains("shoulder_degc stands still at 15.25 while others move"), "{stuck}");
    assert!(stuck.contains("120 values used as they are: look at the sensor"), "{stuck}");
}

#[test]
fn a_row_years_after_the_one_before_is_refused_and_does_not_hang() {
    for far in ["1e9", "1e300"] {
        refused(
            &with(&format!("{far},20,18,200\n")),
            &["after the row before it", "more than 365 d", "check its unit"],
        );
    }
}

#[test]
fn time_that_runs_backwards_is_refused_with_both_lines() {
    refused(
        &with("1700,15,15,200\n"),
        &["stdin:32: time 1700 s is 40 s before the row above (stdin:31)", "sort the rows"],
    );
}

#[test]
fn repeated_rows_are_left_out_and_rows_that_contradict_refused() {
    let (csv, caution) = taken(&with("1800,15,15,200\n1800,15,15,200\n1800,15,15,200\n"));
    assert_eq!(caution, "stdin:33: the row repeats the one above; 2 rows left out");
    assert_eq!(rows(&csv).1.len(), 31);
    let (csv, caution) = taken(&with("1800,15,15,\n1800,,,200\n"));
    assert_eq!(caution, "stdin:33: the row has the time of the one above; 1 row joined with it");
    assert_eq!(rows(&csv).1[30][8], "200.00000");
    refused(
        &with("1800,15,15,200\n1800,15,15,201\n"),
        &["stdin:33: pressure_bar = 201 where stdin:32 says 200", "keep one of the rows"],
    );
}

#[test]
fn a_log_without_a_usable_column_is_refused_with_the_columns_it_has() {
    refused("time_s,flow_kg_s,note\n0,1,a\n", &["no column to estimate from", "flow_kg_s, note", "--map"]);
    refused("shoulder_degc,pressure_bar\n15,200\n", &["no column of time", "time_s", "shoulder_degc"]);
    refused("time_s,ambient_degc\n0,15\n", &["no column can be used", "ambient", "--sensors"]);
    refused_with(
        "time_s,shoulder_degc\n0,\n60,\n",
        &["--fill-mass-kg", "4.4"],
        &["no row with a reading of shoulder_degc"],
    );
}

#[test]
fn units_that_are_missing_unknown_or_of_another_quantity_are_refused_with_what_would_be_right() {
    refused("time_s,shoulder,pressure_bar\n0,15,200\n", &["stdin:1", "shoulder", "_degc"]);
    refused("time_s,shoulder_degcc,pressure_bar\n0,15,200\n", &["stdin:1", "shoulder_degcc", "degc"]);
    refused("time_s,shoulder_degc,pressure_bars\n0,15,200\n", &["stdin:1", "pressure_bars", "_bar"]);
    refused("time_s,shoulder_bar,pressure_bar\n0,15,200\n", &["stdin:1", "shoulder_bar", "_degc"]);
    refused("time_degc,shoulder_degc\n0,15\n", &["stdin:1", "time_degc", "_s"]);
    refused("time_s,shoulder_degc,shoulder_k\n0,15,288\n", &["stdin:1", "shoulder_k", "shoulder_degc"]);
}

#[test]
fn celsius_in_a_column_of_kelvins_is_no_reading_and_said_so() {
    refused_with(
        "time_s,shoulder_k\n0,15\n60,15\n",
        &["--fill-mass-kg", "4.4"],
        &["shoulder_k = 15 lies outside of", "--map shoulder_degc=shoulder_k"],
    );
}

#[test]
fn a_fill_that_contradicts_the_first_pressure_is_cautioned_about_and_refused_beyond_a_factor_of_three() {
    let folder = tempdir().unwrap();
    let outcome = estimate(
        folder.path(),
        &at_rest(10),
        &["--fill-pressure-bar", "120", "--fill-temperature-degc", "15"],
    );
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let caution = cautions(&outcome)[0];
    assert!(caution.starts_with("stdin:2: the fill of 2.8"), "{caution}");
    assert!(
        caution.contains("makes 120.") && caution.contains("begins with 200.0 bar: look at vessel"),
        "{caution}"
    );
    refused_with(
        &at_rest(10),
        &["--fill-mass-kg", "40"],
        &["stdin:2: the fill of 40.000 kg makes", "and the log begins with 200.0 bar", "vessel"],
    );
    // Pounds per square inch in a column of bars.
    refused(
        "time_s,shoulder_degc,pressure_bar\n0,15,2900\n60,15,2900\n",
        &["stdin: pressure_bar reads 2900 to 2900", "--map pressure_psi=pressure_bar"],
    );
    refused(
        "time_s,shoulder_degc,pressure_bar\n0,15,0\n60,15,0\n",
        &["stdin:2: pressure_bar reads nothing or less", "--map pressure_barg=pressure_bar"],
    );
}

#[test]
fn columns_that_a_file_of_sensors_forgets_are_said() {
    let folder = tempdir().unwrap();
    std::fs::write(folder.path().join("s.toml"), "[[sensor]]\nname = \"pressure\"\n").unwrap();
    let arguments = ["estimate", "nitrogen-20l", "-", "--sensors", "s.toml"];
    let outcome = run_with_stdin(folder.path(), &arguments, &at_rest(5));
    let said = "not used: shoulder, valve; a file of sensors replaces all typical ones, name there whatever is to be used";
    assert!(cautions(&outcome).contains(&said), "{}", outcome.stderr);
}

#[test]
fn a_vessel_without_the_place_of_a_column_leaves_it_out_and_refuses_it_where_it_was_asked_for() {
    let folder = tempdir().unwrap();
    let arguments = ["estimate", "closed-bottle", "-"];
    let outcome = run_with_stdin(folder.path(), &arguments, &at_rest(5));
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert_eq!(cautions(&outcome), ["not used: valve (the vessel does not have a valve)"]);
    assert!(outcome.stdout.contains("# sensors: shoulder, pressure\n"), "{}", outcome.stdout);
    std::fs::write(folder.path().join("s.toml"), "[[sensor]]\nname = \"valve\"\n").unwrap();
    let asked = [&arguments[..], &["--sensors", "s.toml", "--fill-mass-kg", "4.4", "-o", "e.csv"]].concat();
    let words = ["sensor `valve` sits where `closed bottle, 20 L, flat ends` has no place"];
    refusal(run_with_stdin(folder.path(), &asked, &at_rest(5)), &words);
    std::fs::write(folder.path().join("s.toml"), "[[sensor]]\nname = \"shoulder\"\nnoise_bar = 1\n").unwrap();
    refusal(run_with_stdin(folder.path(), &asked, &at_rest(5)), &["s.toml:3", "noise_bar"]);
    std::fs::write(folder.path().join("s.toml"), "[[sensor]]\nname = \"wall_bottom\"\n").unwrap();
    let words = ["sensor wall_bottom has no column", "shoulder, valve, pressure", "--map"];
    refusal(run_with_stdin(folder.path(), &asked, &at_rest(5)), &words);
}

#[test]
fn readings_that_no_such_cylinder_can_give_are_refused_by_the_gate_and_said_to_not_fit() {
    // Two thermometers at rest and one at 80 °C on and off: its place or unit is not what the log says.
    let mut log = String::from("time_s,shoulder_degc,wall_bottom_degc,valve_degc,pressure_bar\n");
    for row in 0..300 {
        let last = f64::from(row * 7 % 5) * 0.01;
        let valve = if row > 60 && row % 3 == 0 { 80.0 } else { 15.0 };
        log.push_str(&format!(
            "{},{:.2},{:.2},{valve},{:.3}\n",
            60 * row,
            15.0 + last,
            15.0 - last,
            200.0 + last
        ));
    }
    let folder = tempdir().unwrap();
    let outcome = estimate(folder.path(), &log, &["--settled"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let said = cautions(&outcome);
    assert_eq!(
        said,
        [
            "79 of 300 readings of valve do not fit the vessel: look at the vessel, at the sensor's place and at its unit"
        ]
    );
}

//! What a user does first, and what comes out.
use super::{LAG_S, Noise, document, identify, lagged, log, shown};
use crate::support::run;
use tempfile::tempdir;

fn simulate(folder: &std::path::Path, scenario: &str, file: &str) {
    let outcome = run(folder, &["simulate", "nitrogen-20l", scenario, "-o", file, "-q"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
}

#[test]
fn the_summary_of_a_known_lag_has_its_pole_time_constant_and_gain_inside_their_intervals() {
    let folder = tempdir().unwrap();
    let outcome = identify(folder.path(), &log(&lagged(400)), &[]);
    assert_eq!((outcome.code, outcome.stderr.as_str()), (Some(0), ""));
    let text = &outcome.stdout;
    for (name, truth, width) in
        [("pole", -1.0 / LAG_S, 1e-5), ("time constant", LAG_S, 1.0), ("steady-state gain", 1.0, 1e-3)]
    {
        let [value, low, high] = shown(text, name);
        assert!(low < truth && truth < high && low < value && value < high, "{name}: {low} {value} {high}");
        assert!(high - low < width, "{name}: {low} {high}");
    }
    let [start, ..] = shown(text, "free response at the start");
    assert!((start - 10.0).abs() < 0.05, "{start}");
    for words in [
        "shoulder → gas_top",
        "400 rows in 6.65 h",
        "output error",
        "fit / %",
        "MSE / K^2",
        "FPE",
        "AICc",
        "BIC",
    ] {
        assert!(text.contains(words), "`{words}` is missing in {text}");
    }
}

#[test]
fn a_simulated_scenario_gives_a_gain_of_one_beside_the_papers_and_a_model_that_holds_on_another() {
    let folder = tempdir().unwrap();
    simulate(folder.path(), "tunnel-winter", "run.csv");
    simulate(folder.path(), "ramp-warm", "ramp.csv");
    let arguments = [
        "identify",
        "run.csv",
        "--input",
        "shoulder_degC",
        "--output",
        "gas_mean_k",
        "--validate",
        "ramp.csv",
    ];
    let outcome = run(folder.path(), &[&arguments[..], &["-o", "m.json", "--plot", "m.svg"]].concat());
    assert_eq!((outcome.code, outcome.stdout.as_str()), (Some(0), ""), "{}", outcome.stderr);
    let [gain, ..] = shown(&outcome.stderr, "steady-state gain");
    assert!((gain - 1.0).abs() < 0.01, "{gain}");
    let text = std::fs::read_to_string(folder.path().join("m.json")).unwrap();
    let document: serde_json::Value = serde_json::from_str(&text).unwrap();
    let fit = |part: &str, model: &str, start: &str| {
        let judged = document[part]["judged"].as_array().unwrap();
        let found = judged.iter().find(|one| one["model"] == model && one["start"] == start).unwrap();
        found["comparison"]["statistics"]["fit_percent"].as_f64().unwrap()
    };
    assert!(document["identified"]["statistics"]["fit_percent"].as_f64().unwrap() > 98.0);
    assert!(fit("held_out", "identified", "fitted") > 97.0);
    // The gain of 1.033 misses 1.3 K at 40 °C and 2 K at 60 °C.
    for (part, low, high) in [("fitted", 88.0, 94.0), ("held_out", 88.0, 94.0)] {
        let published = fit(part, "published", "fitted");
        assert!((low..high).contains(&published), "{part}: {published}");
        assert!(fit(part, "published", "zero") < published);
    }
    assert_eq!(document["provenance"]["inputs"].as_array().unwrap().len(), 2);
    let figure = std::fs::read_to_string(folder.path().join("m.svg")).unwrap();
    for words in
        ["data in °C", "error in K", "held out: ramp.csv", "lag in samples", "99 % by chance", "published"]
    {
        assert!(figure.contains(words), "`{words}` is missing");
    }
}

#[test]
fn every_method_finds_the_lag_within_its_own_interval() {
    let folder = tempdir().unwrap();
    let noise = ["--input-sd-k", "0.001", "--output-sd-k", "0.02"];
    let methods: [&[&str]; 5] = [
        &["--method", "refined-instruments"],
        &["--method", "output-error", "--start", "state-variable-filter", "--errors", "coloured"],
        &["--method", "bias-compensated", noise[0], noise[1], noise[2], noise[3]],
        &["--method", "compensated-instruments", noise[0], noise[1]],
        &["--method", "maximum-likelihood", noise[0], noise[1], noise[2], noise[3]],
    ];
    for options in methods {
        let document = document(folder.path(), &log(&lagged(400)), options);
        let lag = &document["identified"]["derived"]["poles"][0]["time_constant_s"];
        let (value, sd) = (lag["value"].as_f64().unwrap(), lag["sd"].as_f64().unwrap());
        // The maximum likelihood takes the input to wander between its samples, where it is held here.
        let known = if options[1] == "maximum-likelihood" { 40.0 } else { 4.0 * sd };
        assert!((value - LAG_S).abs() < known && sd > 0.0, "{options:?}: {value} ± {sd} s");
    }
}

#[test]
fn a_second_sensor_serves_as_instrument_and_is_named() {
    let folder = tempdir().unwrap();
    let rows = lagged(400);
    let mut text = String::from("time_s,shoulder_degc,valve_degc,gas_top_degc\n");
    let mut noise = Noise(2);
    for [time_s, shoulder, gas] in &rows {
        // Both sensors of the input have noise of their own.
        let [one, other] = [0, 1].map(|_| shoulder + 0.5 * noise.next());
        text.push_str(&format!("{time_s},{one:.3},{other:.3},{gas:.4}\n"));
    }
    let document = document(folder.path(), &text, &["--method", "second-sensor", "--second", "valve"]);
    let lag = document["identified"]["derived"]["poles"][0]["time_constant_s"]["value"].as_f64().unwrap();
    assert!((lag - LAG_S).abs() < 5.0, "{lag} s");
    assert_eq!(document["options"]["method"]["second_sensor"]["input"], "valve");
}

#[test]
fn gain_offset_and_dead_time_are_held_or_found_as_asked_for() {
    let folder = tempdir().unwrap();
    let mut rows = lagged(402);
    // Two samples late, and 3 K too high.
    let late: Vec<f64> = rows.iter().map(|row| row[2] + 3.0).collect();
    let rows: Vec<[f64; 3]> =
        rows.drain(2..).zip(late).map(|([time_s, shoulder, _], gas)| [time_s, shoulder, gas]).collect();
    let options = ["--gain", "1", "--offset", "--longest-dead-time-min", "5"];
    let outcome = identify(folder.path(), &log(&rows), &options);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let [offset, low, high] = shown(&outcome.stdout, "offset");
    assert!((offset - 3.0).abs() < 0.05 && low < high, "{offset}");
    let [dead_time_s, ..] = shown(&outcome.stdout, "dead time");
    assert!((dead_time_s - 120.0).abs() < 1.0, "{dead_time_s} s");
    assert!(outcome.stdout.contains("gain held at 1"));
    let held = identify(folder.path(), &log(&rows), &["--dead-time-min", "2", "--offset"]);
    let [lag, ..] = shown(&held.stdout, "time constant");
    assert!((lag - LAG_S).abs() < 2.0 && held.stdout.contains("dead time 120 s"), "{lag} s");
}

#[test]
fn a_held_out_part_is_judged_by_the_model_of_the_rest_alone() {
    let folder = tempdir().unwrap();
    let rows = lagged(400);
    let whole = document(folder.path(), &log(&rows), &["--validate", "0.25"]);
    let before = document(folder.path(), &log(&rows[..300]), &[]);
    assert_eq!(whole["identified"], before["identified"]);
    assert_eq!(whole["held_out"]["time_s"].as_array().unwrap().len(), 100);
    assert_eq!(whole["held_out"]["time_s"][0], 18_000.0);
    let judged = whole["held_out"]["judged"].as_array().unwrap();
    assert!(judged[0]["comparison"]["statistics"]["fit_percent"].as_f64().unwrap() > 99.0);
}

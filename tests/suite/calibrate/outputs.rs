//! The vessel file, JSON, figure, streams.
use super::{calibrate, log};
use crate::support::{files, program, run, run_with_stdin};
use cylwatch::thermal::vessel;
use tempfile::tempdir;

const DATE: &str = "2026-03-01T12:00:00Z";
const QUICK: [&str; 4] = ["--fit", "outside-film", "--date", DATE];

#[test]
fn the_vessel_file_says_what_was_fitted_from_what_and_when() {
    let folder = tempdir().unwrap();
    log(folder.path());
    calibrate(folder.path(), &[&["log.csv", "-o", "new.toml"], &QUICK[..]].concat());
    let text = std::fs::read_to_string(folder.path().join("new.toml")).unwrap();
    assert!(
        text.starts_with("# cylwatch ")
            && text.contains("# command: cylwatch calibrate nitrogen-20l log.csv")
    );
    let (specification, read) = vessel::read_specification(&text, "new.toml").unwrap();
    let record = specification.calibration.unwrap();
    assert_eq!((record.date.as_str(), record.confidence), (DATE, 0.95));
    assert_eq!(record.program, format!("cylwatch {}", env!("CARGO_PKG_VERSION")));
    assert_eq!(record.vessel.name, "preset nitrogen-20l");
    assert_eq!(record.log.len(), 1);
    assert_eq!((record.log[0].name.as_str(), record.log[0].sha256.len()), ("log.csv", 64));
    let film = &record.fitted[0];
    assert_eq!((film.parameter.as_str(), film.unit.as_str(), film.prior), ("outside-film", "1", None));
    assert!(film.low < film.value && film.value < film.high);
    assert!((read.surface.film_factor - film.value).abs() < 1e-5);
    let offset = record.fitted.iter().find(|one| one.parameter == "offset:pressure").unwrap();
    assert!(offset.unit == "Pa" && offset.prior.is_some());
    // What was not fitted is as before.
    let plain = vessel::presets::load("nitrogen-20l").unwrap();
    assert_eq!(read.geometry.layers, plain.geometry.layers);
    assert_eq!(read.valve, plain.valve);
}

#[test]
fn what_was_found_of_the_sensors_is_a_file_that_others_take() {
    let folder = tempdir().unwrap();
    log(folder.path());
    let options = ["log.csv", "-o", "new.toml", "--sensors-out", "found.toml"];
    let outcome = calibrate(folder.path(), &[&options[..], &QUICK[..]].concat());
    assert!(outcome.stderr.contains("wrote found.toml"), "{}", outcome.stderr);
    let text = std::fs::read_to_string(folder.path().join("found.toml")).unwrap();
    assert!(text.starts_with("# cylwatch ") && text.contains("[[sensor]]"), "{text}");
    let (specification, suite) = cylwatch::estimator::sensor::read_sensors(&text, "found.toml").unwrap();
    let names: Vec<&str> = specification.sensor.iter().map(|sensor| sensor.name.as_str()).collect();
    assert_eq!(names, ["shoulder", "valve", "pressure", "ambient"]);
    let vessel = std::fs::read_to_string(folder.path().join("new.toml")).unwrap();
    let fitted = vessel::read_specification(&vessel, "new.toml").unwrap().0.calibration.unwrap().fitted;
    let coupling = fitted.iter().find(|one| one.parameter == "coupling:shoulder").unwrap();
    let number = &suite.sensors()[0].parameters()[1];
    assert!(
        (number.mean / coupling.value - 1.0).abs() < 1e-4 && (number.sd / coupling.sd - 1.0).abs() < 1e-4
    );
    // The air's thermometer is one of them, and all offsets are known about as well as it is.
    let air = fitted.iter().find(|one| one.parameter == "air-offset").unwrap();
    assert!((suite.sensors()[3].parameters()[0].sd / air.sd - 1.0).abs() < 1e-4 && air.sd > 0.1);
    let arguments = ["estimate", "new.toml", "log.csv", "--sensors", "found.toml", "-o", "est.csv"];
    assert_eq!(run(folder.path(), &arguments).code, Some(0));
    let same = [&["log.csv", "-o", "same.toml", "--sensors-out", "same.toml"], &QUICK[..]].concat();
    let outcome = run(folder.path(), &[&["calibrate", "nitrogen-20l"], &same[..]].concat());
    assert_eq!(outcome.code, Some(2));
    assert!(outcome.stderr.contains("-o and --sensors-out name the same place"), "{}", outcome.stderr);
}

#[test]
fn an_offset_of_the_air_that_is_certain_is_taken_off_and_not_fitted() {
    let folder = tempdir().unwrap();
    log(folder.path());
    let sensors = |ambient: &str| {
        let of = |name: &str| format!("[[sensor]]\nname = \"{name}\"\n");
        ["shoulder", "valve", "pressure", "ambient"].map(of).concat() + ambient
    };
    let found = |ambient: &str, more: &[&str]| {
        std::fs::write(folder.path().join("sensors.toml"), sensors(ambient)).unwrap();
        let options =
            [&["log.csv", "--format", "json", "--sensors", "sensors.toml"], &QUICK[..], more].concat();
        let document: serde_json::Value =
            serde_json::from_str(&calibrate(folder.path(), &options).stdout).unwrap();
        let parameters = document["parameters"].as_array().unwrap().clone();
        let value = |name: &str| {
            let one = parameters.iter().find(|one| one["parameter"] == name);
            one.map(|one| one["value"].as_f64().unwrap())
        };
        (value("air-offset"), value("offset:shoulder").unwrap())
    };
    let (none, held) = found("", &["--hold", "air-offset"]);
    let (certain, shifted) = found("offset_k = 0.3\noffset_sd_k = 0\n", &[]);
    assert_eq!((none, certain), (None, None));
    assert!((shifted - held - 0.3).abs() < 0.02, "{held} {shifted}");
    let (fitted, _) = found("", &[]);
    assert!(fitted.is_some());
}

#[test]
fn a_wall_of_few_cells_and_a_volume_off_the_contour_are_said() {
    let folder = tempdir().unwrap();
    log(folder.path());
    let plain = vessel::presets::FILES.text("nitrogen-20l").unwrap();
    let coarse = plain.replace("volume_l = 20.0", "volume_l = 22.5").replace("cells = 6", "cells = 2");
    let coarse = coarse.replace("cells = 3", "cells = 1").replace("cells = 2", "cells = 1");
    std::fs::write(folder.path().join("coarse.toml"), coarse).unwrap();
    let options = ["calibrate", "coarse.toml", "log.csv", "--format", "json", "--date", DATE];
    let outcome = run(folder.path(), &options);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("volume_l = 22.5 is 1"), "{}", outcome.stderr);
    let document: serde_json::Value = serde_json::from_str(&outcome.stdout).unwrap();
    let cautions = document["cautions"].to_string();
    assert!(
        cautions.contains("the wall has few cells") && !cautions.contains("valve-contact by"),
        "{cautions}"
    );
    let mut said = 0;
    for one in document["parameters"].as_array().unwrap() {
        let (name, shift) = (one["parameter"].as_str().unwrap(), one["mesh_shift_sd"].as_f64().unwrap());
        if cautions.contains(&format!("{name} by")) {
            assert!(shift.abs() > 1.96, "{name}: {shift}");
            said += 1;
        }
    }
    assert!(said > 0, "{cautions}");
}

#[test]
fn the_same_run_gives_the_same_bytes_and_the_environment_may_give_the_date() {
    let folder = tempdir().unwrap();
    log(folder.path());
    let arguments = ["calibrate", "nitrogen-20l", "log.csv", "-o", "-", "--fit", "outside-film", "-q"];
    let with_epoch = || {
        let output = program(folder.path(), &arguments).env("SOURCE_DATE_EPOCH", "1772366400").output();
        String::from_utf8(output.unwrap().stdout).unwrap()
    };
    let text = with_epoch();
    assert!(text.contains("date = \"2026-03-01T12:00:00Z\""), "{text}");
    assert_eq!(text, with_epoch());
    assert_eq!(files(folder.path()), ["log.csv"]);
}

#[test]
fn json_has_parameters_covariance_residuals_and_provenance() {
    let folder = tempdir().unwrap();
    log(folder.path());
    let arguments = [&["log.csv", "--format", "json", "--validate", "0.2"], &QUICK[..]].concat();
    let outcome = calibrate(folder.path(), &arguments);
    let document: serde_json::Value = serde_json::from_str(&outcome.stdout).unwrap();
    let parameters = document["parameters"].as_array().unwrap();
    assert_eq!(parameters[0]["parameter"], "outside-film");
    let covariance = document["covariance"].as_array().unwrap();
    assert_eq!(covariance.len(), parameters.len());
    let sd = parameters[0]["sd"].as_f64().unwrap();
    assert!((covariance[0][0].as_f64().unwrap().sqrt() / sd - 1.0).abs() < 1e-9);
    let channels = document["channels"].as_array().unwrap();
    assert_eq!(channels.len(), 3);
    for channel in channels {
        let count = |key: &str| channel[key].as_array().unwrap().len();
        assert!(count("residuals") == count("time_s") && count("readings") == count("time_s"));
    }
    assert_eq!(document["held_out"]["scores"].as_array().unwrap().len(), 3);
    assert_eq!(document["provenance"]["inputs"].as_array().unwrap().len(), 2);
    assert_eq!(document["date"], DATE);
    assert!(outcome.stderr.contains("outside-film"), "the table is for people");
}

#[test]
fn the_figure_shows_readings_model_residuals_and_their_correlation() {
    let folder = tempdir().unwrap();
    log(folder.path());
    calibrate(folder.path(), &[&["log.csv", "--plot", "fit.svg"], &QUICK[..]].concat());
    let figure = std::fs::read_to_string(folder.path().join("fit.svg")).unwrap();
    for words in [
        "log.csv",
        "temperature in °C",
        "pressure in bar",
        "residual in K",
        "residual in bar",
        "model",
        "99 % by chance",
        "lag in samples",
    ] {
        assert!(figure.contains(words), "`{words}` is missing");
    }
}

#[test]
fn a_log_on_stdin_gives_what_the_file_gives() {
    let folder = tempdir().unwrap();
    let text = log(folder.path()).text();
    let of_file = calibrate(folder.path(), &[&["log.csv", "-q"], &QUICK[..]].concat()).stdout;
    let arguments = [&["calibrate", "nitrogen-20l", "-", "-q"], &QUICK[..]].concat();
    let of_stdin = run_with_stdin(folder.path(), &arguments, &text);
    assert_eq!(of_stdin.code, Some(0), "{}", of_stdin.stderr);
    let line = |text: &str| text.lines().find(|line| line.starts_with("outside-film")).unwrap().to_owned();
    assert_eq!(line(&of_file), line(&of_stdin.stdout));
}

#[test]
fn a_log_with_foreign_names_dates_and_a_known_mass_needs_no_pressure() {
    let folder = tempdir().unwrap();
    let log = log(folder.path())
        .without("pressure_bar")
        .with("time_s", |number, _| format!("2026-03-01T{:02}:{:02}:00Z", 8 + number / 60, number % 60));
    let text = log.text().replacen("time_s,ambient_degc,shoulder_degc", "Stamp,Air,T1", 1);
    std::fs::write(folder.path().join("own.csv"), text).unwrap();
    let map = ["--map", "time=Stamp", "--map", "ambient_degc=Air", "--map", "shoulder_degc=T1"];
    let arguments = [&["own.csv", "--fill-mass-kg", "4.477"], &map[..], &["--fit", "outside-film"]].concat();
    let outcome = calibrate(folder.path(), &arguments);
    assert!(outcome.stderr.contains("4.477 kg of gas as given"), "{}", outcome.stderr);
    let [_, value, low, high] = super::shown(&outcome.stdout, "outside-film");
    assert!((value - super::OUTSIDE).abs() < 2.0 * (high - low), "{value} {low} {high}");
}

#[test]
fn a_vessel_without_a_valve_joins_in_what_it_has() {
    let folder = tempdir().unwrap();
    log(folder.path()).without("valve_degc").write(folder.path(), "b.csv");
    let plain = vessel::presets::FILES.text("nitrogen-20l").unwrap();
    let (before, rest) = plain.split_once("[valve]").unwrap();
    let (_, after) = rest.split_once("[surface]").unwrap();
    std::fs::write(folder.path().join("bare.toml"), format!("{before}[surface]{after}")).unwrap();
    let arguments = ["log.csv", "b.csv", "--vessel-of", "b.csv=bare.toml", "-q"];
    let outcome = calibrate(folder.path(), &arguments);
    super::shown(&outcome.stdout, "valve-contact (log.csv)");
    super::shown(&outcome.stdout, "outside-film");
}

#[test]
fn a_log_of_another_vessel_takes_the_same_factors_with_sensors_of_its_own() {
    let folder = tempdir().unwrap();
    log(folder.path()).write(folder.path(), "b.csv");
    let arguments = ["log.csv", "b.csv", "--vessel-of", "b.csv=nitrogen-20l", "--fit", "outside-film", "-q"];
    let outcome = calibrate(folder.path(), &arguments);
    // Other specimens of the sensors: numbers of their own.
    for name in ["offset:shoulder (log.csv)", "offset:shoulder (b.csv)"] {
        super::shown(&outcome.stdout, name);
    }
    assert_eq!(run(folder.path(), &["calibrate", "--help"]).code, Some(0));
}

//! Logs in units that their columns do not say, or that few loggers write.
use crate::support::{refused, run};
use std::path::Path;
use tempfile::tempdir;

/// Thirty rows about 15 °C and 200 bar under a header, each value written by its own function.
fn log(folder: &Path, header: &str, temperature: Writing, pressure: Writing) {
    let mut text = format!("{header}\n");
    for row in 0..30 {
        let degc = 15.0 + 0.1 * f64::from(row);
        let [shoulder, valve, bar] =
            [temperature(degc), temperature(degc + 0.2), pressure(200.0 + 0.1 * f64::from(row))];
        text += &format!("{},{shoulder:.2},{valve:.2},{bar:.6}\n", 60 * row);
    }
    std::fs::write(folder.join("log.csv"), text).unwrap();
}

/// How a value is written.
type Writing = fn(f64) -> f64;

const AS_IT_IS: Writing = |value| value;

/// Temperature at the end of an estimate, degC.
fn gas_degc(folder: &Path, maps: &[&str]) -> f64 {
    let maps = maps.iter().flat_map(|map| ["--map", map]);
    let arguments: Vec<&str> =
        ["estimate", "nitrogen-20l", "log.csv", "-o", "e.csv"].into_iter().chain(maps).collect();
    let outcome = run(folder, &arguments);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let line = outcome.stderr.lines().find(|line| line.starts_with("gas mean at the end")).unwrap();
    line.split_whitespace().nth(5).unwrap().parse().unwrap()
}

#[test]
fn a_unit_that_readings_cannot_be_in_is_refused_with_the_one_that_fits() {
    let folder = tempdir().unwrap();
    let named = "time_s,shoulder_degc,valve_degc,pressure_bar";
    let cases: [(&str, Writing, Writing, &str); 5] = [
        (named, |degc| degc + 273.15, AS_IT_IS, "--map shoulder_k=shoulder_degc"),
        (named, AS_IT_IS, |bar| 1e5 * bar, "--map pressure_pa=pressure_bar"),
        (named, AS_IT_IS, |bar| 1e2 * bar, "--map pressure_kpa=pressure_bar"),
        (named, AS_IT_IS, |bar| 14.5 * bar, "--map pressure_psi=pressure_bar"),
        (
            "time_s,Shoulder [°C],Valve [°C],pressure_bar",
            |degc| degc + 273.15,
            AS_IT_IS,
            "--map 'shoulder_k=Shoulder [°C]'",
        ),
    ];
    for (header, temperature, pressure, remedy) in cases {
        log(folder.path(), header, temperature, pressure);
        for command in ["estimate", "monitor"] {
            let arguments = [command, "nitrogen-20l", "log.csv", "-o", "e.csv"];
            refused(folder.path(), &arguments, &["log.csv:21: ", remedy]);
        }
        assert!(!folder.path().join("e.csv").exists());
    }
    // What it says works.
    log(folder.path(), named, |degc| degc + 273.15, AS_IT_IS);
    let degc = gas_degc(folder.path(), &["shoulder_k=shoulder_degc", "valve_k=valve_degc"]);
    assert!((degc - 17.9).abs() < 1.0, "{degc}");
    log(folder.path(), "time_s,Shoulder [°C],Valve [°C],pressure_bar", |degc| degc + 273.15, AS_IT_IS);
    let degc = gas_degc(folder.path(), &["shoulder_k=Shoulder [°C]", "valve_k=Valve [°C]"]);
    assert!((degc - 17.9).abs() < 1.0, "{degc}");
}

#[test]
fn readings_that_a_sensor_can_show_and_a_cylinder_hardly_has_cost_a_caution() {
    let folder = tempdir().unwrap();
    let named = "time_s,shoulder_degc,valve_degc,pressure_bar";
    // 100 degF, and a gauge in which nothing is left.
    log(folder.path(), named, |degc| 1.8 * (degc + 23.0) + 32.0, AS_IT_IS);
    let hot = run(folder.path(), &["estimate", "nitrogen-20l", "log.csv", "-o", "e.csv"]);
    assert!(hot.stderr.contains("--map shoulder_degf=shoulder_degc"), "{}", hot.stderr);
    log(folder.path(), named, AS_IT_IS, |bar| bar - 200.05);
    refused(
        folder.path(),
        &["monitor", "nitrogen-20l", "log.csv"],
        &["log.csv:2: ", "--map pressure_barg=pressure_bar"],
    );
    log(folder.path(), "time_s,shoulder_degc,valve_degc,Pressure [psi]", AS_IT_IS, |bar| bar - 200.05);
    refused(
        folder.path(),
        &["estimate", "nitrogen-20l", "log.csv"],
        &["log.csv:2: ", "--map 'pressure_psig=Pressure [psi]'"],
    );
    log(folder.path(), named, AS_IT_IS, |bar| 202.85 - bar);
    let empty = run(folder.path(), &["monitor", "nitrogen-20l", "log.csv", "-o", "e.csv"]);
    assert!(empty.stderr.contains("--map pressure_barg=pressure_bar"), "{}", empty.stderr);
}

#[test]
fn fahrenheit_gauges_and_megapascals_are_read_and_inspected() {
    let folder = tempdir().unwrap();
    for header in
        ["time_s,shoulder_degf,valve_degf,pressure_psig", "time_s,Shoulder [°F],Valve [°F],Pressure [psi(g)]"]
    {
        log(folder.path(), header, |degc| 1.8 * degc + 32.0, |bar| (bar - 1.01325) * 14.503_773_8);
        let degc = gas_degc(folder.path(), &[]);
        assert!((degc - 17.9).abs() < 1.0, "{header}: {degc}");
    }
    log(folder.path(), "time_s,shoulder_degc,valve_degc,pressure_mpag", AS_IT_IS, |bar| {
        0.1 * (bar - 1.01325)
    });
    let degc = gas_degc(folder.path(), &[]);
    assert!((degc - 17.9).abs() < 1.0, "{degc}");
    let inspected = run(folder.path(), &["inspect", "log.csv"]);
    assert!(inspected.stdout.contains("pressure, mpag"), "{}", inspected.stdout);
}

#[test]
fn what_inspect_proposes_for_kelvin_under_degc_works_as_it_stands() {
    let folder = tempdir().unwrap();
    log(folder.path(), "time_s,shoulder_degc,valve_degc,pressure_bar", |degc| degc + 273.15, AS_IT_IS);
    let inspected = run(folder.path(), &["inspect", "log.csv"]);
    let line = inspected.stdout.lines().find(|line| line.contains("cylwatch monitor")).unwrap();
    let words: Vec<&str> = line.split_whitespace().skip(1).collect();
    let outcome = run(folder.path(), &words);
    assert_eq!(outcome.code, Some(3), "too short to be told: {}", outcome.stderr);
}

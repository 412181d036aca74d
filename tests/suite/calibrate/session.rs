//! What a user does: one log, a calibrated vessel file, and what it is good for.
use super::{CONTACT, INSIDE, Log, OUTSIDE, calibrate, log, shown};
use crate::support::{column, run};
use tempfile::tempdir;

/// Half a 95 % interval of a normal law in standard deviations.
const QUANTILE: f64 = 1.96;

/// Asserts that an interval holds the truth, taken as one of four standard deviations.
fn assert_holds(table: &str, name: &str, truth: f64, widest: f64) {
    let [start, value, low, high] = shown(table, name);
    let sd = (high - low) / (2.0 * QUANTILE);
    assert_eq!(start, 1.0, "{name}");
    assert!((value - truth).abs() < 4.0 * sd, "{name}: {value} in {low} to {high}, true {truth}");
    assert!(low < value && value < high && high - low < widest, "{name}: {low} {high}");
}

#[test]
fn one_log_gives_a_vessel_that_is_right_and_that_other_commands_read() {
    let folder = tempdir().unwrap();
    log(folder.path());
    let outcome = calibrate(folder.path(), &["log.csv", "-o", "new.toml", "--date", "2026-03-01T12:00:00Z"]);
    let table = &outcome.stdout;
    assert_holds(table, "outside-film", OUTSIDE, 0.03);
    assert_holds(table, "inside-film", INSIDE, 0.06);
    assert_holds(table, "valve-contact", CONTACT, 0.8);
    for words in
        ["air from the column ambient", "still air", "kg of gas by the first pressure", "wrote new.toml"]
    {
        assert!(outcome.stderr.contains(words), "`{words}` is missing in {}", outcome.stderr);
    }
    // What a usual log determines is fitted by default: nothing to be cautious about.
    assert!(!outcome.stderr.contains("caution"), "{}", outcome.stderr);
    // A calibrated vessel has nothing left to calibrate.
    let again =
        run(folder.path(), &["calibrate", "new.toml", "log.csv", "--fit", "outside-film,inside-film", "-q"]);
    for name in ["outside-film", "inside-film"] {
        let [_, value, ..] = shown(&again.stdout, name);
        assert!((value - 1.0).abs() < 0.01, "{name}: {value}");
    }
    let estimate = run(folder.path(), &["estimate", "new.toml", "log.csv", "-q"]);
    assert_eq!(estimate.code, Some(0), "{}", estimate.stderr);
}

#[test]
fn the_calibrated_vessel_predicts_a_scenario_that_nobody_recorded() {
    let folder = tempdir().unwrap();
    log(folder.path());
    calibrate(folder.path(), &["log.csv", "-o", "new.toml"]);
    let plain = cylwatch::thermal::vessel::presets::FILES.text("nitrogen-20l").unwrap();
    let truth = plain
        .replace("[inside_film]", &format!("film_factor = {OUTSIDE}\n[inside_film]\nmultiplier = {INSIDE}"))
        .replace("contact_w_k = 8", &format!("contact_w_k = {}", 8.0 * CONTACT));
    std::fs::write(folder.path().join("truth.toml"), truth).unwrap();
    let gas = |vessel: &str| {
        let outcome = run(folder.path(), &["simulate", vessel, "shock-cold", "-q"]);
        column(&outcome.stdout, "gas_mean_degc")
    };
    let true_degc = gas("truth.toml");
    let rms = |vessel: &str| {
        let squares = gas(vessel).iter().zip(&true_degc).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
        (squares / true_degc.len() as f64).sqrt()
    };
    let (before, after) = (rms("nitrogen-20l"), rms("new.toml"));
    assert!(before > 1.0 && after < before / 10.0, "{before} K before, {after} K after");
}

#[test]
fn two_fillings_share_the_vessel_and_a_third_log_is_predicted() {
    let folder = tempdir().unwrap();
    for (name, fill_bar, end_degc, seed) in
        [("a.csv", 200, 25, 1), ("b.csv", 90, 30, 2), ("c.csv", 150, 0, 3)]
    {
        Log::recorded(folder.path(), fill_bar, end_degc, seed).write(folder.path(), name);
    }
    let arguments = ["a.csv", "b.csv", "--validate", "c.csv", "-o", "new.toml"];
    let outcome = calibrate(folder.path(), &arguments);
    let table = &outcome.stdout;
    assert_holds(table, "outside-film", OUTSIDE, 0.02);
    assert_holds(table, "inside-film", INSIDE, 0.05);
    for name in [
        "fill-mass (a.csv)",
        "fill-mass (b.csv)",
        "initial-temperature (a.csv)",
        "initial-temperature (b.csv)",
    ] {
        shown(table, name);
    }
    assert!(!table.contains("fill-mass (c.csv)"), "{table}");
    let after_header = table.split("rms before").nth(1).unwrap();
    for channel in ["shoulder", "valve", "pressure"] {
        let line = after_header.lines().find(|line| line.starts_with(channel)).unwrap();
        let cells: Vec<&str> = line.split_whitespace().collect();
        let [before, after, noise] = [1, 2, 3].map(|k| cells[k].parse::<f64>().unwrap());
        assert!(after < before / 2.0 && after < 20.0 * noise, "{line}");
    }
    let text = std::fs::read_to_string(folder.path().join("new.toml")).unwrap();
    assert!(
        text.contains("held out: c.csv")
            && text.contains("name = \"b.csv\"")
            && !text.contains("name = \"c.csv\"")
    );
}

#[test]
fn the_last_part_of_a_log_is_predicted_and_a_profile_agrees_with_the_interval() {
    let folder = tempdir().unwrap();
    log(folder.path());
    let outcome = calibrate(folder.path(), &["log.csv", "--validate", "0.3", "--profile", "outside-film"]);
    let table = &outcome.stdout;
    assert!(table.contains("held out: last 30 % of log.csv"), "{table}");
    let [_, _, low, high] = shown(table, "outside-film");
    let profile = table.split("profile likelihood of").nth(1).unwrap();
    let line = profile.lines().find(|line| line.starts_with("outside-film")).unwrap();
    let ends: Vec<f64> = line.split_whitespace().skip(1).take(2).map(|end| end.parse().unwrap()).collect();
    let width = high - low;
    assert!((ends[0] - low).abs() < 0.2 * width && (ends[1] - high).abs() < 0.2 * width, "{table}");
}

#[test]
fn priors_starts_bounds_and_held_numbers_are_respected() {
    let folder = tempdir().unwrap();
    log(folder.path());
    let options = [
        "log.csv",
        "--fit",
        "outside-film,inside-film,wall-capacity,lag:shoulder",
        "--prior",
        "wall-capacity=1,0.001",
        "--prior",
        "offset:pressure=0.1,0.001",
        "--start",
        "outside-film=1.2",
        "--bounds",
        "outside-film=1.1,2",
        "--hold",
        "offset:valve,coupling:valve",
        "--prior",
        "lag:shoulder=5,2",
    ];
    let outcome = calibrate(folder.path(), &options);
    let table = &outcome.stdout;
    let [_, wall, low, high] = shown(table, "wall-capacity");
    assert!((wall - 1.0).abs() < 0.004 && high - low < 0.005, "{table}");
    let [start, offset, ..] = shown(table, "offset:pressure");
    assert!(start == 0.1 && (offset - 0.1).abs() < 0.005, "{table}");
    assert_eq!(shown(table, "outside-film")[0], 1.2);
    shown(table, "lag:shoulder");
    assert!(!table.contains("offset:valve") && !table.contains("coupling:valve"), "{table}");
}

#[test]
fn a_scenario_says_what_the_log_does_not() {
    let folder = tempdir().unwrap();
    let simulated = run(folder.path(), &["simulate", "nitrogen-20l", "tunnel-step", "-o", "run.csv", "-q"]);
    assert_eq!(simulated.code, Some(0), "{}", simulated.stderr);
    let arguments = ["run.csv", "--scenario", "tunnel-step", "--fit", "outside-film"];
    let outcome = calibrate(folder.path(), &arguments);
    let [_, value, low, high] = shown(&outcome.stdout, "outside-film");
    assert!((value - 1.0).abs() < 2.0 * (high - low), "{value} {low} {high}");
    assert!(outcome.stderr.contains("scenario `"), "{}", outcome.stderr);
}

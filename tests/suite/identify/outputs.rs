//! Formats, missing values, places.
use super::{document, identify, lagged, log};
use crate::support::{column, files, refused, rows};
use tempfile::tempdir;

#[test]
fn csv_has_data_model_and_errors_of_which_the_summary_is_the_score() {
    let folder = tempdir().unwrap();
    let text = log(&lagged(400));
    let csv = identify(folder.path(), &text, &["--format", "csv", "--validate", "0.25", "-q"]).stdout;
    assert_eq!(
        rows(&csv).0.join(","),
        "time_s,shoulder_degc,gas_top_degc,model_degc,error_k,published_degc,held_out"
    );
    let named = |name: &str| column(&csv, name);
    let (gas, model, errors, held_out) =
        (named("gas_top_degc"), named("model_degc"), named("error_k"), named("held_out"));
    for k in 0..400 {
        assert!((gas[k] - model[k] - errors[k]).abs() < 1e-6);
        assert_eq!(held_out[k], if k < 300 { 0.0 } else { 1.0 });
    }
    assert_eq!(named("time_s")[0], 0.0);
    let document = document(folder.path(), &text, &["--validate", "0.25"]);
    let mse = document["identified"]["statistics"]["mse"].as_f64().unwrap();
    let squares = errors[..300].iter().map(|error| error * error).sum::<f64>() / 300.0;
    assert!((squares / mse - 1.0).abs() < 1e-6, "{squares} {mse}");
    assert!(csv.lines().any(|line| line.starts_with("# steady-state gain")));
}

#[test]
fn missing_values_are_left_out_with_a_caution_and_change_nothing_else() {
    let folder = tempdir().unwrap();
    let mut lines = lagged(400);
    for row in [50, 51, 200] {
        lines[row][2] = f64::NAN;
    }
    // Held over the next sample, which has the same level.
    lines[130][1] = f64::NAN;
    let outcome = identify(folder.path(), &log(&lines), &["--format", "csv"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("caution: 3 rows have no gas_top"), "{}", outcome.stderr);
    let times = outcome.stdout.lines().filter(|line| !line.starts_with('#')).skip(1);
    let times: Vec<f64> = times.map(|line| line.split(',').next().unwrap().parse().unwrap()).collect();
    assert_eq!(times.len(), 397);
    assert!(!times.contains(&3000.0) && times.contains(&7800.0));
    let gap = outcome.stdout.lines().find(|line| line.starts_with("7800,")).unwrap();
    assert_eq!(gap.split(',').nth(1), Some(""));
}

#[test]
fn a_logger_with_dates_foreign_names_and_kelvins_gives_the_model_of_ours() {
    let folder = tempdir().unwrap();
    let ours = lagged(300);
    let line = |[time_s, shoulder, gas]: &[f64; 3]| {
        let (hours, minutes) = ((time_s / 3600.0) as u32, (time_s / 60.0) as u32 % 60);
        format!("2026-01-05T{hours:02}:{minutes:02}:00Z,{:.4},{:.4}\n", shoulder + 273.15, gas + 273.15)
    };
    let theirs = String::from("Timestamp,T1,T2\n") + &ours.iter().map(line).collect::<String>();
    let maps = ["--map", "time=Timestamp", "--map", "shoulder_k=T1", "--map", "gas_top_k=T2"];
    let [ours, theirs] = [document(folder.path(), &log(&ours), &[]), document(folder.path(), &theirs, &maps)]
        .map(|document| document["identified"]["model"]["den"][1].as_f64().unwrap());
    assert!((ours / theirs - 1.0).abs() < 1e-6, "{ours} {theirs}");
}

#[test]
fn a_column_that_is_a_pressure_has_its_own_units_and_no_published_model() {
    let folder = tempdir().unwrap();
    let text: String = lagged(400)
        .iter()
        .map(|[time_s, shoulder, gas]| format!("{time_s},{shoulder},{:.4}\n", 190.0 + 0.8 * gas))
        .collect();
    let text = format!("time_s,shoulder_degc,pressure_bar\n{text}");
    let arguments =
        ["identify", "-", "--input", "shoulder", "--output", "pressure", "--hold", "zero", "--offset"];
    let outcome = crate::support::run_with_stdin(
        folder.path(),
        &[&arguments[..], &["--plot", "p.png"]].concat(),
        &text,
    );
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let [gain, ..] = super::shown(&outcome.stdout, "steady-state gain");
    let [offset, ..] = super::shown(&outcome.stdout, "offset");
    assert!((gain - 0.8).abs() < 1e-3 && (offset - 190.0).abs() < 0.05, "{gain} {offset}");
    assert!(outcome.stdout.contains("bar/K") && !outcome.stdout.contains("published"));
    assert_eq!(files(folder.path()), ["p.png"]);
}

#[test]
fn places_and_options_that_contradict_each_other_are_found_before_the_run() {
    let folder = tempdir().unwrap();
    std::fs::write(folder.path().join("log.csv"), "").unwrap();
    let with = |options: &[&str], words: &[&str]| {
        let arguments = ["identify", "log.csv", "--input", "shoulder", "--output", "gas_top"];
        refused(folder.path(), &[&arguments[..], options].concat(), words);
    };
    with(&["-o", "log.csv"], &["log.csv is an input"]);
    with(&["-o", "missing/m.json"], &["no folder"]);
    with(&["--plot", "m.pdf"], &[".svg or .png"]);
    with(&["-o", "m.svg", "--plot", "m.svg"], &["same file"]);
    with(&["--validate", "1.5"], &["--validate 1.5", "between 0 and 1"]);
    with(&["--method", "second-sensor"], &["give --second"]);
    with(&["--second", "valve"], &["--method second-sensor"]);
    with(&["--method", "second-sensor", "--second", "shoulder"], &["--second shoulder"]);
    with(&["--input-sd-k", "0.1"], &["--input-sd", "choose one by --method"]);
    with(&["--dead-time-s", "10", "--longest-dead-time-s", "20"], &["keep one"]);
    with(&["--dead-time-s", "-10"], &["--dead-time-s = -10", "above 0"]);
    with(&["--initial", "warm"], &["--initial", "estimated, zero, settled, or numbers"]);
    with(&["--gain", "one"], &["--gain", "free, or a number"]);
    refused(folder.path(), &["identify", "-", "--input", "a", "--output", "A_k"], &["same column a"]);
    let both = ["identify", "-", "--input", "a", "--output", "b", "--validate", "-"];
    refused(folder.path(), &both, &["stdin", "not both"]);
    assert_eq!(files(folder.path()), ["log.csv"]);
}

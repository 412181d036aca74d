//! `--filter` and `--smooth`.
use super::{at_rest, estimate, simulate};
use crate::support::{column, refused, run};
use tempfile::tempdir;

#[test]
fn every_filter_finds_temperature_and_mass_of_a_cylinder_at_rest() {
    let folder = tempdir().unwrap();
    for filter in ["ekf", "ukf", "stationary", "mhe"] {
        let outcome = estimate(folder.path(), &at_rest(40), &["--filter", filter, "--settled"]);
        assert_eq!(outcome.code, Some(0), "{filter}: {}", outcome.stderr);
        let last = |name: &str| *column(&outcome.stdout, name).last().unwrap();
        assert!((last("gas_mean_degc") - 15.0).abs() < 0.2, "{filter}");
        // 20 L at 200 bar and 15 °C hold 4.477 kg (CoolProp 8.0: 223.8 kg/m3).
        assert!((last("mass_kg") - 4.477).abs() < 0.01, "{filter}");
    }
    let unknown = estimate(folder.path(), &at_rest(3), &["--filter", "kalman"]);
    assert_eq!(unknown.code, Some(2));
    assert!(unknown.stderr.contains("ekf, ukf, stationary, mhe"), "{}", unknown.stderr);
}

#[test]
fn smoothed_estimates_have_the_rows_of_the_log_and_are_nearer_to_the_truth() {
    let folder = tempdir().unwrap();
    simulate(folder.path(), "tunnel-winter", "run.csv");
    let truth = std::fs::read_to_string(folder.path().join("run.csv")).unwrap();
    let rms = |options: &[&str]| {
        let csv = run(folder.path(), &[&["estimate", "nitrogen-20l", "run.csv"], options].concat()).stdout;
        assert_eq!(column(&csv, "time_s"), column(&truth, "time_s"));
        let errors = column(&csv, "gas_mean_degc").into_iter().zip(column(&truth, "gas_mean_degc"));
        errors.map(|(estimate, gas)| (estimate - gas).powi(2)).sum::<f64>().sqrt()
    };
    let (filtered, smoothed) = (rms(&[]), rms(&["--smooth", "--plot", "e.svg"]));
    assert!(smoothed < 0.5 * filtered, "{smoothed} {filtered}");
}

#[test]
fn a_log_longer_than_the_smoothers_memory_comes_out_whole_and_in_order() {
    let folder = tempdir().unwrap();
    let rows = 9000;
    let outcome = estimate(folder.path(), &at_rest(rows), &["--smooth"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let times = column(&outcome.stdout, "time_s");
    assert_eq!(times, (0..rows).map(|row| 60.0 * f64::from(row)).collect::<Vec<_>>());
    assert!(outcome.stderr.contains("9000 rows"), "{}", outcome.stderr);
}

#[test]
fn filters_that_cannot_be_smoothed_are_refused_with_those_that_can() {
    let folder = tempdir().unwrap();
    std::fs::write(folder.path().join("log.csv"), at_rest(3)).unwrap();
    for filter in ["stationary", "mhe"] {
        let arguments =
            ["estimate", "nitrogen-20l", "log.csv", "--smooth", "--filter", filter, "-o", "e.csv"];
        refused(folder.path(), &arguments, &["only ekf and ukf can be smoothed"]);
    }
    assert!(!folder.path().join("e.csv").exists());
}

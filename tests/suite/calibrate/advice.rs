//! What a calibration says where the log does not fit: noise, a leak, parameters that it cannot tell apart.
use super::{Log, calibrate, log};
use crate::support::run;
use tempfile::tempdir;

/// What the cautions say of a log that was changed.
fn said(change: impl Fn(Log) -> Log) -> String {
    let folder = tempdir().unwrap();
    change(log(folder.path())).write(folder.path(), "log.csv");
    let outcome = calibrate(folder.path(), &["log.csv", "--fit", "outside-film"]);
    outcome.stderr.lines().filter(|line| line.starts_with("caution")).collect::<Vec<_>>().join("\n")
}

/// Something between -1 and 1 without a pattern.
fn noise(row: usize) -> f64 {
    let residue = (row * row * 7919 + row * 104_729) % 1009;
    residue as f64 / 504.0 - 1.0
}

#[test]
fn residuals_without_a_pattern_are_noise_and_are_named_with_its_size() {
    let cautions = said(|log| {
        log.with("shoulder_degc", |row, cell| {
            format!("{:.4}", cell.parse::<f64>().unwrap() + 0.5 * noise(row))
        })
    });
    assert!(
        cautions.contains("shoulder of log.csv scatters") && cautions.contains("the model fits"),
        "{cautions}"
    );
    // Anything within half a kelvin is 0.29 K.
    assert!(
        cautions.contains("its noise is rather 0.29 K") || cautions.contains("its noise is rather 0.3 K"),
        "{cautions}"
    );
    assert!(!cautions.contains("something is not in the model"), "{cautions}");
}

#[test]
fn a_pressure_that_falls_as_in_a_leak_is_asked_about() {
    let cautions = said(|log| {
        log.with("pressure_bar", |row, cell| {
            format!("{:.4}", cell.parse::<f64>().unwrap() - 0.02 * row as f64)
        })
    });
    let (_, rate) =
        cautions.split_once("looks like a leak of about ").unwrap_or_else(|| panic!("{cautions}"));
    // 1.2 bar of some 190 in an hour, of 4.48 kg.
    let rate_g_h: f64 = rate.split(' ').next().unwrap().parse().unwrap();
    assert!((rate_g_h / 28.0 - 1.0).abs() < 0.3, "{cautions}");
    assert!(!said(|log| log).contains("leak"));
}

#[test]
fn parameters_that_cannot_be_told_apart_come_with_the_option_that_parts_them() {
    let folder = tempdir().unwrap();
    log(folder.path());
    let fit = [
        "calibrate",
        "nitrogen-20l",
        "log.csv",
        "--fit",
        "outside-film,wall-capacity,valve-capacity,volume,inside-film",
    ];
    let outcome = run(folder.path(), &fit);
    println!("{}", outcome.stderr);
    assert!(outcome.stderr.contains("add --prior "), "{}", outcome.stderr);
    let option = outcome.stderr.split("add ").nth(1).unwrap().split_whitespace().take(2).collect::<Vec<_>>();
    let option: Vec<&str> = option.iter().map(|word| word.trim_end_matches([',', '.', ';'])).collect();
    let again = run(folder.path(), &[&fit[..], &option[..]].concat());
    assert_ne!(again.stderr, outcome.stderr);
    assert!(!again.stderr.contains(&option.join(" ")), "{}", again.stderr);
}

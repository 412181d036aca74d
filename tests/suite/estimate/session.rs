//! What a user does first, and what comes out.
use super::{at_rest, cautions, estimate, simulate};
use crate::support::{column, rows, run, run_with_stdin};
use sha2::{Digest, Sha256};
use tempfile::tempdir;

const COLUMNS: &str = "time_s,gas_mean_degc,gas_mean_sd_k,mass_kg,mass_sd_g,leak_g_h,leak_sd_g_h,leak_bar_h,pressure_bar,\
                       pressure_expected_bar,p15_bar,verdict,quality";

#[test]
fn the_session_of_the_readme_estimates_temperature_and_mass_within_what_it_states() {
    let folder = tempdir().unwrap();
    simulate(folder.path(), "tunnel-winter", "run.csv");
    let outcome =
        run(folder.path(), &["estimate", "nitrogen-20l", "run.csv", "-o", "est.csv", "--plot", "est.svg"]);
    assert_eq!((outcome.code, outcome.stdout.as_str()), (Some(0), ""), "{}", outcome.stderr);
    assert!(cautions(&outcome).is_empty(), "{}", outcome.stderr);
    let [run, est] =
        ["run.csv", "est.csv"].map(|name| std::fs::read_to_string(folder.path().join(name)).unwrap());
    assert_eq!(rows(&est).0.join(","), COLUMNS);
    assert_eq!(column(&est, "time_s"), column(&run, "time_s"));
    let [gas, mass] = ["gas_mean_degc", "mass_kg"].map(|name| (column(&est, name), column(&run, name)));
    let last = gas.0.len() - 1;
    assert!((gas.0[last] - gas.1[last]).abs() < 2.0 * column(&est, "gas_mean_sd_k")[last]);
    assert!((mass.0[last] - mass.1[last]).abs() < 2e-3 * column(&est, "mass_sd_g")[last]);
    // The cylinder jumps from -25 into 40 °C at the first row, so that its first readings say -15 °C.
    assert!((gas.0[0] - gas.1[0]).abs() > 5.0 && (gas.0[last] - gas.1[last]).abs() < 0.3);
    for words in ["gas mean against truth", "3.45 h", "NIS", "autocorrelation", "kg"] {
        assert!(outcome.stderr.contains(words), "`{words}` is missing in {}", outcome.stderr);
    }
    let figure = std::fs::read_to_string(folder.path().join("est.svg")).unwrap();
    for words in
        ["gas temperature in °C", "gas mass in kg", "innovation in sd", "time in h", "± 2 sd", "truth"]
    {
        assert!(figure.contains(words), "`{words}` is missing");
    }
}

#[test]
fn a_pipe_gives_the_numbers_of_the_file_and_the_hash_of_the_log_in_its_last_line() {
    let folder = tempdir().unwrap();
    simulate(folder.path(), "shock-cold", "run.csv");
    let of_file = run(folder.path(), &["estimate", "nitrogen-20l", "run.csv"]);
    let log = std::fs::read_to_string(folder.path().join("run.csv")).unwrap();
    let of_pipe = run_with_stdin(folder.path(), &["estimate", "nitrogen-20l", "-"], &log);
    assert_eq!(rows(&of_file.stdout), rows(&of_pipe.stdout));
    let hash: String = Sha256::digest(&log).iter().map(|byte| format!("{byte:02x}")).collect();
    assert!(of_file.stdout.lines().take(5).any(|line| line == format!("# input: run.csv sha256 {hash}")));
    assert_eq!(of_pipe.stdout.lines().last(), Some(format!("# input: - sha256 {hash}").as_str()));
    for lines in
        ["# cylwatch ", "# command: cylwatch estimate nitrogen-20l -", "# input: preset nitrogen-20l sha256"]
    {
        assert!(of_pipe.stdout.lines().any(|line| line.starts_with(lines)), "{lines}");
    }
}

#[test]
fn a_logger_with_dates_and_foreign_names_is_mapped_and_gives_the_same_as_seconds() {
    let folder = tempdir().unwrap();
    let ours = "time_s,shoulder_degc,pressure_bar\n0,15,200\n60,15.1,200.1\n150,15.2,200.2\n";
    let theirs = "Timestamp,T1,P1,Operator\n2026-10-25T02:59:00+02:00,15,200,A\n\
                  2026-10-25T02:00:00+01:00,15.1,200.1,A\n2026-10-25T01:01:30Z,15.2,200.2,B\n";
    let maps = ["--map", "time=Timestamp", "--map", "shoulder_degc=T1", "--map", "pressure_bar=P1"];
    let (ours, theirs) = (estimate(folder.path(), ours, &[]), estimate(folder.path(), theirs, &maps));
    assert_eq!(theirs.code, Some(0), "{}", theirs.stderr);
    // Dates stand beside the times.
    let (header, dated) = rows(&theirs.stdout);
    let dates: Vec<jiff::Timestamp> = dated.iter().map(|row| row[1].parse().unwrap()).collect();
    assert_eq!(header[1], "time");
    let written = ["2026-10-25T02:59:00+02:00", "2026-10-25T02:00:00+01:00", "2026-10-25T01:01:30Z"];
    assert_eq!(dates, written.map(|date| date.parse().unwrap()));
    let without: Vec<Vec<&str>> = dated.iter().map(|row| [&row[..1], &row[2..]].concat()).collect();
    assert_eq!(rows(&ours.stdout).1, without);
    assert!(theirs.stdout.contains("# time_s = 0 is 2026-10-25T00:59:00Z"), "{}", theirs.stdout);
    assert!(cautions(&theirs)[0].contains("columns set aside: Operator"), "{}", theirs.stderr);
    let unknown = estimate(folder.path(), "time_s,shoulder_degc\n0,15\n", &["--map", "shoulder_degc=T9"]);
    assert_eq!(unknown.code, Some(2));
    assert!(unknown.stderr.contains("--map shoulder_degc=T9"), "{}", unknown.stderr);
}

#[test]
fn the_cells_of_missing_readings_are_empty_and_the_estimate_goes_on() {
    let folder = tempdir().unwrap();
    let mut log = at_rest(30);
    log.push_str("1800,,NaN,\n1860,15,,NA\n1920,15,15,200\n");
    let outcome = estimate(folder.path(), &log, &[]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let (_, rows) = rows(&outcome.stdout);
    let of = |row: usize| (rows[row][8], rows[row][12]);
    assert_eq!(
        (of(29).1, of(30), of(31), of(32)),
        ("good", ("", "predicted"), ("", "degraded"), ("200.00000", "good"))
    );
    assert!(rows[30..].iter().all(|row| (row[1].parse::<f64>().unwrap() - 15.0).abs() < 0.3));
    // Nobody looks, so less is known of what may have left.
    let sd = |row: usize| rows[row][4].parse::<f64>().unwrap();
    assert!(sd(30) > sd(29) && sd(32) < sd(30));
    let counts = outcome.stderr.lines().find(|line| line.starts_with("pressure  ")).unwrap();
    assert_eq!(counts.split_whitespace().collect::<Vec<_>>()[1..4], ["31", "0", "2"]);
}

#[test]
fn a_log_without_pressure_needs_the_fill_and_then_has_a_pressure_to_expect() {
    let folder = tempdir().unwrap();
    let log = "time_s,shoulder_degc\n0,15\n60,15\n120,15\n";
    let refused = estimate(folder.path(), log, &[]);
    assert_eq!((refused.code, refused.stdout.as_str()), (Some(2), ""));
    assert!(refused.stderr.contains("no pressure") && refused.stderr.contains("--fill-mass-kg"));
    let fill = ["--fill-pressure-bar", "200", "--fill-temperature-degc", "15", "--settled"];
    let outcome = estimate(folder.path(), log, &fill);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    for expected in column(&outcome.stdout, "pressure_expected_bar") {
        // 0.97 bar/K and 1 K at the most: see scenario 4.
        assert!((expected - 200.0).abs() < 1.0, "{expected}");
    }
    // 20 L at 200 bar and 15 °C hold 4.47 kg (CoolProp 8.0: 223.8 kg/m3).
    assert!(column(&outcome.stdout, "mass_kg").iter().all(|mass| (mass - 4.477).abs() < 0.01));
}

#[test]
fn a_fill_is_read_in_the_unit_of_its_option_and_contradictions_are_refused() {
    let folder = tempdir().unwrap();
    let log = at_rest(3);
    let masses = |options: &[&str]| column(&estimate(folder.path(), &log, options).stdout, "mass_kg");
    let bar = masses(&["--fill-pressure-bar", "200", "--fill-temperature-degc", "15"]);
    assert_eq!(bar, masses(&["--fill-pressure-mpa", "20", "--fill-temperature-k", "288.15"]));
    for (options, words) in [
        (&["--fill-mass-kg", "4.4", "--fill-pressure-bar", "200"][..], "--fill-mass fixes the mass"),
        (&["--fill-temperature-degc", "15"], "needs the pressure"),
        (&["--fill-pressure-bar", "200", "--fill-pressure-mpa", "20"], "keep one"),
        (&["--fill-sd-percent", "0"], "above 0 and at most 100"),
    ] {
        let outcome = estimate(folder.path(), &log, options);
        assert_eq!((outcome.code, outcome.stdout.as_str()), (Some(2), ""), "{options:?}");
        assert!(outcome.stderr.contains(words), "{}", outcome.stderr);
    }
}

#[test]
fn what_was_learnt_makes_the_next_start_surer_and_is_refused_for_another_vessel() {
    let folder = tempdir().unwrap();
    simulate(folder.path(), "tunnel-winter", "run.csv");
    let first = ["estimate", "nitrogen-20l", "run.csv", "-o", "a.csv", "--learned-out", "cylinder.json"];
    let outcome = run(folder.path(), &first);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let text = std::fs::read_to_string(folder.path().join("cylinder.json")).unwrap();
    let document: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(document["provenance"]["program"], "cylwatch");
    assert!(document["learned"]["names"].as_array().unwrap().len() > 4);
    let second = ["estimate", "nitrogen-20l", "run.csv", "-o", "b.csv", "--learned-in", "cylinder.json"];
    assert_eq!(run(folder.path(), &second).code, Some(0));
    // Two hours on: in the first one how far the gas was from the thermometers, in the middle of a tunnel, is most of it.
    let sd = |name: &str| {
        let text = std::fs::read_to_string(folder.path().join(name)).unwrap();
        column(&text, "gas_mean_sd_k")[120]
    };
    assert!(sd("b.csv") < 0.9 * sd("a.csv"), "{} and {}", sd("b.csv"), sd("a.csv"));
    let other = ["estimate", "closed-bottle", "run.csv", "--learned-in", "cylinder.json"];
    crate::support::refused(folder.path(), &other, &["cylinder.json: this was learnt on", "closed bottle"]);
    for (bad, words) in [("{}", "no file of --learned-out"), ("[", "no JSON")] {
        std::fs::write(folder.path().join("cylinder.json"), bad).unwrap();
        crate::support::refused(folder.path(), &second, &[words]);
    }
}

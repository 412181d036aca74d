//! `cylwatch properties`.
use crate::support::{column, files, refusal, refused, rows, run, run_with_stdin};
use tempfile::tempdir;

/// Columns of the reference table of nitrogen.
const COLUMNS: &str = "temperature_k,pressure_pa,density_kg_m3,compressibility,internal_energy_j_kg,enthalpy_j_kg,\
entropy_j_kg_k,cv_j_kg_k,cp_j_kg_k,sound_speed_m_s,dp_dt_at_density_pa_k,dp_drho_at_temperature_pa_m3_kg,\
viscosity_pa_s,conductivity_w_m_k";

#[test]
fn one_state_is_printed_with_units() {
    let folder = tempdir().unwrap();
    let arguments = ["properties", "nitrogen", "--temperature-degc", "15", "--pressure-bar", "200"];
    let outcome = run(folder.path(), &arguments);
    assert_eq!((outcome.code, outcome.stderr.as_str()), (Some(0), ""));
    assert_eq!(outcome.stdout.lines().count(), 15);
    // CoolProp 8.0: 223.187 kg/m³, Z 1.04779.
    for words in [
        "223.187",
        "kg/m³",
        "1.0477",
        "0.0042639",
        "1/K",
        "J/(kg K)",
        "m/s",
        "Pa s",
        "W/(m K)",
        "(200 bar)",
        "(15 °C)",
    ] {
        assert!(outcome.stdout.contains(words), "{words} is missing in\n{}", outcome.stdout);
    }
}

#[test]
fn any_two_quantities_in_any_unit_fix_the_same_state() {
    let folder = tempdir().unwrap();
    let density = |arguments: &[&str]| {
        let all = [&["properties", "nitrogen", "--format", "csv"], arguments].concat();
        let outcome = run(folder.path(), &all);
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        (column(&outcome.stdout, "density_kg_m3")[0], column(&outcome.stdout, "temperature_k")[0])
    };
    let (rho, t) = density(&["--temperature-degc", "-25", "--pressure-barg", "198.98675"]);
    assert!((t - 248.15).abs() < 1e-9);
    let text = rho.to_string();
    for other in [
        density(&["--temperature-k", "248.15", "--density-kg-m3", &text]),
        density(&["--pressure-mpa", "20", "--density-kg-m3", &text]),
        density(&["--pressure-kpa", "20000", "--temperature-degc=-25"]),
    ] {
        assert!((other.0 / rho - 1.0).abs() < 1e-9 && (other.1 / t - 1.0).abs() < 1e-9, "{other:?}");
    }
}

#[test]
fn a_file_of_states_becomes_the_columns_of_the_reference_table() {
    let folder = tempdir().unwrap();
    std::fs::write(
        folder.path().join("states.csv"),
        "# three ways to say it\ntemperature_degc,pressure_bar,density_kg_m3,remark\n15,200,,a\n15,,223.187,b\n,200,223.187,c\n",
    )
    .unwrap();
    let outcome = run(folder.path(), &["properties", "nitrogen", "--states", "states.csv", "-o", "out.csv"]);
    assert_eq!((outcome.code, outcome.stdout.as_str()), (Some(0), ""));
    assert!(outcome.stderr.contains("ignored columns remark"));
    let csv = std::fs::read_to_string(folder.path().join("out.csv")).unwrap();
    let (header, rows) = rows(&csv);
    assert_eq!((header.join(",").as_str(), rows.len()), (COLUMNS, 3));
    for t in column(&csv, "temperature_k") {
        assert!((t - 288.15).abs() < 1e-3);
    }
    assert!(csv.contains("# input: states.csv sha256"));
}

#[test]
fn states_come_from_stdin_and_leave_as_json() {
    let folder = tempdir().unwrap();
    let arguments = ["properties", "nitrogen", "--states", "-", "--format", "json"];
    let outcome =
        run_with_stdin(folder.path(), &arguments, "\u{feff}temperature_k,pressure_pa\r\n300,1e5\r\n");
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let document: serde_json::Value = serde_json::from_str(&outcome.stdout).unwrap();
    assert_eq!(document["columns"]["temperature_k"][0], 300.0);
    assert_eq!(document["provenance"]["inputs"][0]["name"], "-");
}

#[test]
fn a_fault_in_a_states_file_names_file_line_value_and_remedy() {
    let folder = tempdir().unwrap();
    let faults = [
        (
            "temperature_degc,pressure_bar\n15,200\n-300,200\n",
            vec!["stdin:3", "temperature_degc = -300", "above -273.15"],
        ),
        ("temperature_degc,pressure_bar\n15,0\n", vec!["stdin:2", "pressure_bar = 0", "above 0"]),
        ("temperature_degc,pressure_bar\n15,\"2,0\"\n", vec!["stdin:2", "2,0", "must be a number"]),
        ("temperature_degc,pressure_bar\n15,nan\n", vec!["stdin:2", "finite"]),
        ("temperature_degc,pressure_bar\n15\n", vec!["stdin:2", "1 cells", "2"]),
        ("temperature_degc,pressure_bar\n15,\n", vec!["stdin:2", "complete the row"]),
        ("temperature,pressure_bar\n15,1\n", vec!["stdin:1", "temperature has no unit", "_degc"]),
        ("temperature_degc,temperature_k\n15,1\n", vec!["stdin:1", "temperature_k", "temperature_degc"]),
        ("temperature_degc,p\n15,1\n", vec!["stdin:1", "two of"]),
        ("temperature_degc,pressure_bar\n", vec!["no state below the header"]),
        ("", vec!["stdin"]),
    ];
    for (text, words) in faults {
        let outcome = run_with_stdin(
            folder.path(),
            &["properties", "nitrogen", "--states", "-", "-o", "out.csv"],
            text,
        );
        refusal(outcome, &words);
        assert!(files(folder.path()).is_empty());
    }
}

#[test]
fn a_state_takes_two_quantities_of_its_three() {
    let folder = tempdir().unwrap();
    let given = |arguments: &[&str], words: &[&str]| {
        refused(folder.path(), &[&["properties", "nitrogen"], arguments].concat(), words);
    };
    given(&[], &["none was given", "--temperature-degc 15"]);
    given(&["--pressure-bar", "200"], &["--pressure-bar"]);
    given(&["--pressure-bar", "200", "--pressure-pa", "1"], &["--pressure-bar", "--pressure-pa"]);
    given(&["--pressure-bar", "-3", "--temperature-k", "300"], &["--pressure-bar = -3", "above 0"]);
    given(&["--pressure-bar", "200", "--density-kg-m3", "1e-6"], &["no temperature"]);
    given(&["--pressure-bar", "2", "--states", "-"], &["cannot be used with"]);
    given(&["--states", "missing.csv"], &["missing.csv", "cannot be read"]);
}

#[test]
fn a_state_that_the_gas_does_not_have_leaves_an_empty_row_and_a_caution() {
    let folder = tempdir().unwrap();
    let text = "temperature_k,pressure_bar\n300,1\n100,6\n97,6\n";
    let outcome = run_with_stdin(folder.path(), &["properties", "air", "--states", "-"], text);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert_eq!(outcome.stderr.lines().count(), 1, "{}", outcome.stderr);
    for words in ["stdin:3", "air at 600000 Pa and 100 K", "dew line", "stay empty"] {
        assert!(outcome.stderr.contains(words), "{words} is missing in {}", outcome.stderr);
    }
    let (_, rows) = rows(&outcome.stdout);
    assert_eq!(rows.len(), 3);
    assert_eq!(rows[1][..4].join(","), "100,600000,,");
    assert!(rows[0].iter().chain(&rows[2]).all(|cell| !cell.is_empty()));
    // Where there is no state at all there is no table either.
    let all_bad = run_with_stdin(
        folder.path(),
        &["properties", "air", "--states", "-", "-o", "out.csv"],
        "temperature_degc,pressure_bar\n-173.15,6\n-173.15,6.1\n",
    );
    refusal(all_bad, &["stdin:2", "air at 600000 Pa and 100 K"]);
    assert!(files(folder.path()).is_empty());
}

#[test]
fn numbers_of_messages_are_those_that_were_typed() {
    let folder = tempdir().unwrap();
    let arguments = ["properties", "nitrogen", "--temperature-degc=-146.958", "--pressure-bar", "99999.1"];
    let outcome = run(folder.path(), &arguments);
    assert!(outcome.stderr.contains("9999910000 Pa"), "{}", outcome.stderr);
    let arguments = ["properties", "nitrogen", "--temperature-degc=-246.958", "--pressure-bar", "1"];
    let outcome = run(folder.path(), &arguments);
    assert!(outcome.stderr.contains("temperature 26.192 K"), "{}", outcome.stderr);
}

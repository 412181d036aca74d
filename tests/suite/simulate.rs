//! `cylwatch simulate`.
use crate::support::{column, files, program, refusal, refused, rows, run, run_with_stdin};
use sha2::{Digest, Sha256};
use std::io::Read;
use std::process::Stdio;
use tempfile::tempdir;

const SHORT: &str = "\
name = \"short\"
duration_min = 2
sample_time_s = 30
[initial]
fill_pressure_bar = 200
temperature_degc = 15
[ambient]
air_degc = 20
film_w_m2_k = 8
[[leak]]
flow_g_h = 360
start_s = 60
[[sensor]]
name = \"shoulder\"
air_coupling = 0.2
";

#[test]
fn data_goes_to_stdout_and_words_to_stderr() {
    let folder = tempdir().unwrap();
    let outcome = run(folder.path(), &["simulate", "nitrogen-20l", "shock-cold"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let (header, rows) = rows(&outcome.stdout);
    assert_eq!((header[0], rows.len()), ("time_s", 181));
    assert!(outcome.stderr.contains("pressure, start and end"));
    assert!(!outcome.stderr.contains('\u{1b}'), "colour without a terminal");
    assert!(files(folder.path()).is_empty());
    let quiet = run(folder.path(), &["--quiet", "simulate", "nitrogen-20l", "shock-cold"]);
    assert_eq!(quiet.stderr, "");
}

#[test]
fn the_columns_are_those_of_the_contract() {
    let folder = tempdir().unwrap();
    let csv = run(folder.path(), &["simulate", "nitrogen-20l", "shock-cold"]).stdout;
    let (header, _) = rows(&csv);
    assert_eq!(
        header.join(","),
        "time_s,ambient_degc,gas_mean_degc,gas_1_degc,wall_bottom_degc,wall_middle_degc,wall_neck_degc,shoulder_degc,\
         valve_degc,wall_inner_mean_degc,wall_inner_bottom_degc,wall_inner_middle_degc,wall_inner_shoulder_degc,\
         wall_inner_neck_degc,pressure_bar,mass_kg,outflow_g_h,heat_to_gas_w,measured_shoulder_degc,measured_valve_degc,\
         measured_pressure_bar"
    );
}

#[test]
fn a_sensor_reads_between_its_surface_and_the_air() {
    let folder = tempdir().unwrap();
    std::fs::write(folder.path().join("s.toml"), SHORT).unwrap();
    let csv = run(folder.path(), &["simulate", "nitrogen-20l", "s.toml"]).stdout;
    let (surface, air) = (column(&csv, "shoulder_degc"), column(&csv, "ambient_degc"));
    for (k, reading) in column(&csv, "measured_shoulder_degc").into_iter().enumerate() {
        assert!((reading - (0.8 * surface[k] + 0.2 * air[k])).abs() < 1e-6);
    }
}

/// [`SHORT`] for an hour, with sensors of every kind that have errors.
fn with_noisy_sensors() -> String {
    let sensors = "noise_k = 0.05\n[[sensor]]\nname = \"pressure\"\ngauge = true\noffset_sd_bar = 0.4\nnoise_mbar = 10\n\
                   dropout = 0.5\n[[sensor]]\nname = \"ambient\"\nlag_s = 20\n[[sensor]]\nname = \"gas_1\"\nresolution_k = 0.5\n";
    format!("{SHORT}{sensors}").replace("duration_min = 2", "duration_min = 60")
}

#[test]
fn a_seed_draws_the_sensors_and_stands_in_every_output() {
    let folder = tempdir().unwrap();
    std::fs::write(folder.path().join("s.toml"), with_noisy_sensors()).unwrap();
    let csv = |seed: &[&str]| {
        let outcome = run(folder.path(), &[&["simulate", "nitrogen-20l", "s.toml"], seed].concat());
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        outcome.stdout
    };
    let readings = |csv: &str| rows(csv).1.concat().join(",");
    let (none, zero, one) = (csv(&[]), csv(&["--seed", "0"]), csv(&["--seed", "1"]));
    assert!(none.lines().any(|line| line == "# seed: 0") && one.lines().any(|line| line == "# seed: 1"));
    assert_eq!(readings(&none), readings(&zero));
    assert_eq!(column(&zero, "shoulder_degc"), column(&one, "shoulder_degc"));
    let differ = |name: &str| column(&zero, name).iter().zip(column(&one, name)).all(|(a, b)| *a != b);
    assert!(differ("measured_shoulder_degc"));
    let arguments =
        ["simulate", "nitrogen-20l", "s.toml", "-o", "run.json", "--plot", "run.svg", "--seed", "5"];
    assert_eq!(run(folder.path(), &arguments).code, Some(0));
    let text = std::fs::read_to_string(folder.path().join("run.json")).unwrap();
    let document: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(document["provenance"]["seed"], 5);
    assert!(std::fs::read_to_string(folder.path().join("run.svg")).unwrap().contains("seed: 5"));
    refused(folder.path(), &["simulate", "nitrogen-20l", "s.toml", "--seed", "-1"], &["-1"]);
}

#[test]
fn sensors_of_every_kind_get_a_column_in_their_unit() {
    let folder = tempdir().unwrap();
    std::fs::write(folder.path().join("s.toml"), with_noisy_sensors()).unwrap();
    let csv = run(folder.path(), &["simulate", "nitrogen-20l", "s.toml"]).stdout;
    let (header, rows) = rows(&csv);
    let measured: Vec<&str> = header.iter().copied().filter(|name| name.starts_with("measured_")).collect();
    let expected = ["shoulder_degc", "pressure_barg", "ambient_degc", "gas_1_degc"]
        .map(|name| format!("measured_{name}"));
    assert_eq!(measured, expected);
    // The air does not change, so a lag does not either.
    assert_eq!(column(&csv, "measured_ambient_degc"), column(&csv, "ambient_degc"));
    for gas_degc in column(&csv, "measured_gas_1_degc") {
        let steps = (gas_degc + 273.15) / 0.5;
        assert!((steps - steps.round()).abs() < 1e-6, "{gas_degc}");
    }
    let at = header.iter().position(|name| *name == "measured_pressure_barg").unwrap();
    let truth = column(&csv, "pressure_bar");
    let errors: Vec<f64> =
        (0..rows.len()).filter_map(|k| Some(rows[k][at].parse::<f64>().ok()? + 1.01325 - truth[k])).collect();
    // Half of the 121 readings are lost (binomial, within five standard deviations); the others are off by one
    // offset, of 0.4 bar within five standard deviations, and 10 mbar of noise.
    assert!((33..88).contains(&errors.len()), "{}", errors.len());
    assert!(errors.iter().all(|error| (error - errors[0]).abs() < 0.1 && error.abs() < 2.0), "{errors:?}");
}

#[test]
fn noise_of_the_presets_is_50_millikelvin_and_10_millibar() {
    let folder = tempdir().unwrap();
    let csv = run(folder.path(), &["simulate", "nitrogen-20l", "ramp-warm", "--seed", "3"]).stdout;
    let (surface, air) = (column(&csv, "shoulder_degc"), column(&csv, "ambient_degc"));
    let shoulder = column(&csv, "measured_shoulder_degc");
    let temperature = (0..air.len()).map(|k| shoulder[k] - (0.85 * surface[k] + 0.15 * air[k]));
    let truth = column(&csv, "pressure_bar");
    let pressure = column(&csv, "measured_pressure_bar").into_iter().zip(truth).map(|(read, p)| read - p);
    let sd = |errors: Vec<f64>| (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt();
    // 301 samples give a standard deviation to 4 %; five of those.
    assert!((sd(temperature.collect()) / 0.05 - 1.0).abs() < 0.2);
    assert!((sd(pressure.collect()) / 0.01 - 1.0).abs() < 0.2);
}

#[test]
fn a_sensor_that_the_vessel_has_no_place_for_is_left_out_with_a_caution() {
    let folder = tempdir().unwrap();
    let outcome = run(folder.path(), &["simulate", "closed-bottle", "shock-cold"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let (header, _) = rows(&outcome.stdout);
    assert!(header.contains(&"measured_shoulder_degc") && !header.contains(&"measured_valve_degc"));
    let cautions: Vec<&str> = outcome.stderr.lines().filter(|line| line.contains("caution")).collect();
    assert_eq!(cautions.len(), 1, "{}", outcome.stderr);
    assert!(
        cautions[0].contains("sensor valve is left out") && cautions[0].contains("does not have a valve")
    );
}

#[test]
fn a_refill_of_stratified_gas_is_refused_with_the_model_to_take() {
    let folder = tempdir().unwrap();
    let text = include_str!("../../crates/thermal/presets/vessels/nitrogen-20l.toml");
    std::fs::write(folder.path().join("v.toml"), text.replace("\"well-mixed\"", "\"stratified\"\ncells = 3"))
        .unwrap();
    let words =
        ["refill: a refill of stratified gas is not simulated", "take model = \"well-mixed\" under [gas]"];
    refused(folder.path(), &["simulate", "v.toml", "refill-from-bank"], &words);
}

#[test]
fn layers_of_a_lying_vessel_cost_a_caution() {
    let folder = tempdir().unwrap();
    std::fs::write(folder.path().join("s.toml"), SHORT).unwrap();
    let standing = include_str!("../../crates/thermal/presets/vessels/nitrogen-20l.toml")
        .replace("\"well-mixed\"", "\"stratified\"\ncells = 3");
    std::fs::write(folder.path().join("lying.toml"), standing.replace("\"vertical\"", "\"horizontal\""))
        .unwrap();
    std::fs::write(folder.path().join("standing.toml"), standing).unwrap();
    let cautioned = |vessel: &str| {
        let outcome = run(folder.path(), &["simulate", vessel, "s.toml"]);
        outcome.stderr.contains("caution: gas in layers in a lying vessel")
    };
    assert!(cautioned("lying.toml") && !cautioned("standing.toml"));
}

#[test]
fn a_leak_is_taken_from_the_mass_at_its_rate() {
    let folder = tempdir().unwrap();
    std::fs::write(folder.path().join("s.toml"), SHORT).unwrap();
    let csv = run(folder.path(), &["simulate", "nitrogen-20l", "s.toml"]).stdout;
    let mass = column(&csv, "mass_kg");
    // 360 g/h for the last of two minutes.
    assert!((mass[0] - mass[4] - 6e-3).abs() < 1e-8);
    assert!(csv.contains("# event at 60 s: leak opens"));
}

#[test]
fn every_output_states_version_command_and_the_hashes_of_its_inputs() {
    let folder = tempdir().unwrap();
    std::fs::write(folder.path().join("it's short.toml"), SHORT).unwrap();
    let hash: String = Sha256::digest(SHORT).iter().map(|byte| format!("{byte:02x}")).collect();
    let arguments = ["simulate", "nitrogen-20l", "it's short.toml", "-o", "run.json", "--plot", "run.svg"];
    assert_eq!(run(folder.path(), &arguments).code, Some(0));
    let text = std::fs::read_to_string(folder.path().join("run.json")).unwrap();
    let document: serde_json::Value = serde_json::from_str(&text).unwrap();
    let provenance = &document["provenance"];
    assert_eq!(provenance["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(
        provenance["command"],
        r"cylwatch simulate nitrogen-20l 'it'\''s short.toml' -o run.json --plot run.svg"
    );
    assert_eq!(provenance["inputs"][1]["sha256"], hash.as_str());
    assert_eq!(document["columns"]["time_s"].as_array().unwrap().len(), 5);
    let csv = run(folder.path(), &["simulate", "nitrogen-20l", "it's short.toml"]).stdout;
    assert!(csv.lines().any(|line| line == format!("# input: it's short.toml sha256 {hash}")));
    assert!(std::fs::read_to_string(folder.path().join("run.svg")).unwrap().contains(&hash));
}

#[test]
fn plots_are_well_formed() {
    let folder = tempdir().unwrap();
    for name in ["run.svg", "run.png"] {
        let arguments = ["simulate", "nitrogen-20l", "shock-cold", "--plot", name, "-o", "run.csv"];
        assert_eq!(run(folder.path(), &arguments).code, Some(0));
    }
    let svg = std::fs::read_to_string(folder.path().join("run.svg")).unwrap();
    for words in ["temperature in °C", "pressure in bar", "time in min", "gas, mean", "limit 160 bar"] {
        assert!(svg.contains(words), "{words} is missing");
    }
    let picture = std::fs::File::open(folder.path().join("run.png")).unwrap();
    let mut reader = png::Decoder::new(std::io::BufReader::new(picture)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    assert!(pixels.iter().any(|&value| value < 50), "the picture is empty");
}

#[test]
fn the_vessel_or_the_scenario_comes_from_stdin_but_not_both() {
    let folder = tempdir().unwrap();
    let outcome = run_with_stdin(folder.path(), &["simulate", "nitrogen-20l", "-"], SHORT);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert!(outcome.stdout.contains("# input: - sha256"));
    refused(folder.path(), &["simulate", "-", "-"], &["stdin", "not both"]);
}

#[test]
fn a_name_that_is_neither_file_nor_preset_is_told_both_possibilities_and_the_nearest() {
    let folder = tempdir().unwrap();
    let words =
        ["nitrogen-20: no such file", "no built-in vessel is called so", "nearest is nitrogen-20l", "--list"];
    refused(folder.path(), &["simulate", "nitrogen-20", "shock-cold"], &words);
    refused(
        folder.path(),
        &["simulate", "nitrogen-20l", "shock-kold"],
        &["scenario", "nearest is shock-cold"],
    );
    let list = run(folder.path(), &["simulate", "--list"]);
    assert!(list.stdout.contains("nitrogen-20l") && list.stdout.contains("shock-cold"));
}

#[test]
fn a_fault_in_a_file_names_file_line_value_and_remedy() {
    let folder = tempdir().unwrap();
    let faults = [
        ("fill_pressure_bar = 200", "fill_pressure_bar = -200", ["s.toml:5", "-200"]),
        ("air_degc = 20", "air_bar = 20", ["s.toml:8", "air_bar"]),
        ("duration_min = 2", "duration = 2", ["s.toml:2", "duration"]),
        ("[ambient]", "[ambient", ["s.toml:7", "unclosed"]),
    ];
    for (good, bad, words) in faults {
        std::fs::write(folder.path().join("s.toml"), SHORT.replace(good, bad)).unwrap();
        refused(folder.path(), &["simulate", "nitrogen-20l", "s.toml"], &words);
    }
}

#[test]
fn a_refused_run_leaves_the_older_output_as_it_was_and_nothing_beside_it() {
    let folder = tempdir().unwrap();
    std::fs::write(folder.path().join("run.csv"), "older").unwrap();
    std::fs::write(folder.path().join("s.toml"), SHORT.replace("film_w_m2_k", "film_bar")).unwrap();
    let arguments = ["simulate", "nitrogen-20l", "s.toml", "-o", "run.csv", "--plot", "run.svg"];
    refused(folder.path(), &arguments, &["film_bar"]);
    assert_eq!(std::fs::read_to_string(folder.path().join("run.csv")).unwrap(), "older");
    assert_eq!(files(folder.path()), ["run.csv", "s.toml"]);
}

#[test]
fn outputs_that_cannot_be_written_are_found_before_the_run() {
    let folder = tempdir().unwrap();
    std::fs::write(folder.path().join("file"), "").unwrap();
    std::fs::create_dir(folder.path().join("folder")).unwrap();
    std::fs::write(folder.path().join("s.toml"), SHORT).unwrap();
    // The scenario does not exist: a complaint about the output shows that it was checked first.
    let with = |option: &str, output: &str, words: &[&str]| {
        refused(folder.path(), &["simulate", "nitrogen-20l", "none.toml", option, output], words);
    };
    with("-o", "missing/run.csv", &["missing/run.csv", "no folder", "make it first"]);
    with("-o", "file/run.csv", &["file/run.csv"]);
    with("-o", "folder", &["folder", "name a file in it"]);
    with("-o", "", &["--output"]);
    with("--plot", "run.pdf", &["run.pdf", ".svg or .png"]);
    with("--plot", "missing/run.svg", &["missing/run.svg", "no folder"]);
    refused(folder.path(), &["simulate", "nitrogen-20l", "s.toml", "-o", "./s.toml"], &["is an input"]);
    assert_eq!(std::fs::read_to_string(folder.path().join("s.toml")).unwrap(), SHORT);
}

#[test]
fn a_tolerance_out_of_range_is_refused_with_its_bounds() {
    let folder = tempdir().unwrap();
    for bad in ["0", "-1", "1", "nan", "inf"] {
        let argument = format!("--relative-tolerance={bad}");
        refused(
            folder.path(),
            &["simulate", "nitrogen-20l", "shock-cold", &argument],
            &["tolerance", "of at least 1e-13 and at most 0.01"],
        );
    }
    refused(
        folder.path(),
        &["simulate", "nitrogen-20l", "shock-cold", "--relative-tolerance", "fine"],
        &["fine"],
    );
}

#[test]
fn a_file_that_is_no_text_is_refused() {
    let folder = tempdir().unwrap();
    std::fs::write(folder.path().join("s.toml"), [0xff, 0xfe, 0x00]).unwrap();
    refused(folder.path(), &["simulate", "nitrogen-20l", "s.toml"], &["s.toml", "UTF-8"]);
    refusal(run_with_stdin(folder.path(), &["simulate", "nitrogen-20l", "-"], ""), &["stdin"]);
}

#[test]
fn a_reader_that_has_seen_enough_is_no_error() {
    let folder = tempdir().unwrap();
    let mut command = program(folder.path(), &["simulate", "nitrogen-20l", "cool-down", "--format", "csv"]);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    let mut words = String::new();
    child.stderr.take().unwrap().read_to_string(&mut words).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(0), "{words}");
    assert!(!words.contains("error"), "{words}");
}

#[cfg(unix)]
#[test]
fn a_device_is_written_and_not_replaced() {
    let folder = tempdir().unwrap();
    let outcome = run(folder.path(), &["simulate", "nitrogen-20l", "shock-cold", "-o", "/dev/null"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    use std::os::unix::fs::FileTypeExt;
    assert!(std::fs::metadata("/dev/null").unwrap().file_type().is_char_device());
}

#[cfg(not(feature = "parquet"))]
#[test]
fn parquet_is_refused_where_the_program_was_built_without_it() {
    let folder = tempdir().unwrap();
    let words = ["without Parquet", "--features parquet"];
    refused(folder.path(), &["simulate", "nitrogen-20l", "shock-cold", "-o", "run.parquet"], &words);
    assert!(files(folder.path()).is_empty());
}

#[test]
fn an_ideal_gas_coefficient_is_converted_and_told() {
    let folder = tempdir().unwrap();
    let text = include_str!("../../crates/thermal/presets/scenarios/haque-i1.toml");
    let text = text.replace("discharge_coefficient =", "discharge_coefficient_ideal_gas =");
    std::fs::write(folder.path().join("s.toml"), text).unwrap();
    let outcome = run(folder.path(), &["simulate", "haque-i1", "s.toml", "-o", "run.csv"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let told = "orifice: discharge coefficient 0.8 with an ideal gas is 0.7592 with the real one, at 150 bar and 14.85 °C";
    assert!(outcome.stderr.contains(told), "{}", outcome.stderr);
}

#[test]
fn a_source_vessel_and_a_liner_have_columns() {
    let folder = tempdir().unwrap();
    let scenario = include_str!("../../crates/thermal/presets/scenarios/refill-from-bank.toml")
        .replace("[[refill]]", "[[refill]]\nname = \"Bank, left\"");
    std::fs::write(folder.path().join("s.toml"), scenario).unwrap();
    let steel = "[[layer]]\nmaterial = ";
    let vessel = include_str!("../../crates/thermal/presets/vessels/nitrogen-20l.toml");
    assert_eq!(vessel.matches(steel).count(), 1);
    let lined = format!("[[layer]]\nmaterial = \"hdpe\"\nthickness_mm = 4\n\n{steel}");
    std::fs::write(folder.path().join("v.toml"), vessel.replace(steel, &lined)).unwrap();
    let outcome = run(folder.path(), &["simulate", "v.toml", "s.toml"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let (header, _) = rows(&outcome.stdout);
    assert!(header.contains(&"bank__left_source_bar"), "{header:?}");
    let last = |name: &str| *column(&outcome.stdout, name).last().unwrap();
    assert!((last("bank__left_source_bar") - last("pressure_bar")).abs() < 0.1);
    assert!(last("bank__left_source_degc") < 0.0);
    // A liner lies between the gas and the wall, and so does its temperature while they differ.
    let at = |name: &str, k: usize| column(&outcome.stdout, name)[k];
    let (gas, liner, outer) =
        (at("gas_mean_degc", 20), at("liner_mean_degc", 20), at("wall_middle_degc", 20));
    let inner = at("wall_inner_mean_degc", 20);
    assert!(gas > inner && inner > liner && liner > outer, "{gas} {inner} {liner} {outer}");
}

#[test]
fn a_refill_that_cannot_be_is_refused_with_its_line_or_its_time() {
    let folder = tempdir().unwrap();
    let scenario = |refill: &str| {
        let text =
            SHORT.replace("[[leak]]\nflow_g_h = 360\nstart_s = 60\n", &format!("[[refill]]\n{refill}\n"));
        std::fs::write(folder.path().join("s.toml"), text).unwrap();
        run(folder.path(), &["simulate", "nitrogen-20l", "s.toml", "-o", "run.csv"])
    };
    refusal(scenario("diameter_mm = 1"), &["s.toml:10", "source_temperature_degc is missing"]);
    refusal(
        scenario(
            "kv_m3_h = 1\ndischarge_coefficient = 0.8\nsource_pressure_bar = 300\nsource_temperature_degc = 15",
        ),
        &["s.toml:12", "discharge_coefficient cannot stand beside kv"],
    );
    let cold = "diameter_mm = 1\nsource_pressure_bar = 20\nsource_temperature_degc = -170";
    refusal(scenario(cold), &["the source of refill", "nitrogen"]);
    assert_eq!(files(folder.path()), ["s.toml"]);
}

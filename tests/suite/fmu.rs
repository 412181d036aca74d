//! `cylwatch fmu`: what it writes, and that its units say what the program says.
use crate::support::{refused, run};
use cylwatch::log::{Cells, MemoryLog};
use cylwatch::report::{Table, Values};
use cylwatch::run::{self as calls, Call};
use cylwatch_cosimulation::variable::Type;
use cylwatch_cosimulation::{Access, Instance};
use std::fmt::Write;
use std::io::{Cursor, Read};
use std::path::Path;
use tempfile::{TempDir, tempdir};
use zip::ZipArchive;

const FILL: [&str; 4] = ["--fill-pressure-bar", "200", "--fill-temperature-degc", "15"];
const STEP_S: f64 = 60.0;
const STEPS: usize = 180;

/// A folder with something in place of the library: these tests load none.
fn folder() -> TempDir {
    let folder = tempdir().unwrap();
    std::fs::write(folder.path().join("library.so"), b"a library").unwrap();
    folder
}

fn fmu<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&["fmu", "nitrogen-20l", "--library", "library.so"], &FILL[..], more].concat()
}

fn file_of(archive: &[u8], name: &str) -> Vec<u8> {
    let mut bytes = Vec::new();
    ZipArchive::new(Cursor::new(archive)).unwrap().by_name(name).unwrap().read_to_end(&mut bytes).unwrap();
    bytes
}

/// Writes an archive and reads it.
fn written(folder: &Path, name: &str, more: &[&str]) -> Vec<u8> {
    let outcome = run(folder, &[&fmu(more)[..], &["-o", name]].concat());
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    std::fs::read(folder.join(name)).unwrap()
}

fn unit(folder: &Path, more: &[&str]) -> Instance {
    Instance::new(&file_of(&written(folder, "unit.fmu", more), "resources/cylinder.bin")).unwrap()
}

fn reference(unit: &Instance, name: &str) -> u32 {
    u32::try_from(unit.variables().iter().position(|of| of.name == name).unwrap_or_else(|| panic!("{name}")))
        .unwrap()
}

fn access(unit: &Instance, reference: u32) -> Access {
    match unit.variables()[reference as usize].kind {
        Type::Real(_) => Access::Real,
        _ => Access::IntegerOrEnumeration,
    }
}

fn get(unit: &mut Instance, name: &str) -> f64 {
    let reference = reference(unit, name);
    let access = access(unit, reference);
    unit.get(reference, access).unwrap()
}

fn set(unit: &mut Instance, name: &str, value: f64) {
    let reference = reference(unit, name);
    unit.set(reference, Access::Real, value).unwrap();
}

fn begun(mut unit: Instance, parameters: &[(&str, f64)]) -> Instance {
    unit.enter_initialization().unwrap();
    parameters.iter().for_each(|&(name, value)| set(&mut unit, name, value));
    unit.exit_initialization().unwrap();
    unit
}

/// What a master sets for a step.
type Inputs = fn(usize) -> [(&'static str, f64); 4];

/// Surroundings that stay.
fn still(_step: usize) -> [(&'static str, f64); 4] {
    restless(0)
}

/// Air, K, wind, m/s, sun, W/m², and leak, kg/s, that jump with each step.
fn restless(step: usize) -> [(&'static str, f64); 4] {
    let wave = |period: f64| (step as f64 / period).sin();
    [
        ("air_k", 280.0 + 10.0 * wave(17.0)),
        ("wind_m_s", 2.0 + 1.5 * wave(7.0)),
        ("irradiance_w_m2", 150.0 + 100.0 * wave(23.0)),
        ("leak_kg_s", 2e-5 + 1e-5 * wave(29.0)),
    ]
}

const SENSORS: &str = "
[[sensor]]
name = \"shoulder\"
air_coupling = 0.15

[[sensor]]
name = \"wall_middle\"
air_coupling = 0.1
lag_s = 40

[[sensor]]
name = \"valve\"
air_coupling = 0.15

[[sensor]]
name = \"pressure\"
";

/// The same as a scenario: each value holds for a step.
fn scenario(inputs: Inputs) -> String {
    let mut text = format!(
        "name = \"steps\"\nduration_s = {}\nsample_time_s = {STEP_S}\n[initial]\nfill_pressure_bar = 200\n\
         fill_temperature_degc = 15\ntemperature_k = 275\n[sun]\n[ambient]\n",
        STEPS as f64 * STEP_S
    );
    let table = |column: usize, name: &str| {
        let mut times = String::new();
        let mut values = String::new();
        for step in 0..STEPS {
            let value = inputs(step)[column].1;
            let (from_s, to_s) = (STEP_S * step as f64, STEP_S * (step + 1) as f64);
            write!(times, "{from_s}, {to_s}, ").unwrap();
            write!(values, "{value}, {value}, ").unwrap();
        }
        format!("{{ time_s = [{times}], {name} = [{values}] }}")
    };
    writeln!(text, "air_table = {}", table(0, "air_k")).unwrap();
    writeln!(text, "wind_table = {}", table(1, "wind_m_s")).unwrap();
    writeln!(text, "irradiance_table = {}", table(2, "irradiance_w_m2")).unwrap();
    writeln!(text, "[[leak]]\nname = \"leak\"\nflow_table = {}", table(3, "flow_kg_s")).unwrap();
    text + SENSORS
}

fn numbers(table: &Table, name: &str) -> Vec<f64> {
    match &table.columns.iter().find(|column| column.name == name).unwrap_or_else(|| panic!("{name}")).values
    {
        Values::Numbers(_, numbers) => numbers.clone(),
        other => panic!("{name}: {other:?}"),
    }
}

/// Columns of `simulate` in SI, beside the variables of the plant.
fn simulated(inputs: Inputs, relative_tolerance: &str) -> Vec<(&'static str, Vec<f64>)> {
    let call = Call::new("nitrogen-20l").scenario_of_text(scenario(inputs));
    let table = calls::simulate(call.option("relative-tolerance", Some(relative_tolerance))).unwrap().rows;
    let of = |name: &str, factor: f64, zero: f64| {
        numbers(&table, name).iter().map(|value| value * factor + zero).collect::<Vec<f64>>()
    };
    vec![
        ("gas_mean_k", of("gas_mean_degc", 1.0, 273.15)),
        ("pressure_pa", of("pressure_bar", 1e5, 0.0)),
        ("mass_kg", of("mass_kg", 1.0, 0.0)),
        ("shoulder_k", of("shoulder_degc", 1.0, 273.15)),
        ("valve_k", of("valve_degc", 1.0, 273.15)),
        ("wall_bottom_k", of("wall_bottom_degc", 1.0, 273.15)),
        ("wall_inner_mean_k", of("wall_inner_mean_degc", 1.0, 273.15)),
        ("measured_shoulder_k", of("measured_shoulder_degc", 1.0, 273.15)),
        ("measured_wall_middle_k", of("measured_wall_middle_degc", 1.0, 273.15)),
        ("measured_valve_k", of("measured_valve_degc", 1.0, 273.15)),
        ("measured_pressure_pa", of("measured_pressure_bar", 1e5, 0.0)),
    ]
}

/// The plant's outputs at the beginning of every step, with the inputs of that step.
fn stepped(folder: &Path, inputs: Inputs, relative_tolerance: f64, names: &[&str]) -> Vec<Vec<f64>> {
    std::fs::write(folder.join("sensors.toml"), SENSORS).unwrap();
    let unit = unit(folder, &["--kind", "plant", "--sensors", "sensors.toml"]);
    let first = inputs(0);
    let parameters = [("start_temperature_k", 275.0), ("relative_tolerance", relative_tolerance)];
    let mut plant = begun(unit, &[&parameters[..], &first[..]].concat());
    let mut columns = vec![Vec::new(); names.len()];
    for step in 0..STEPS {
        inputs(step).iter().for_each(|&(name, value)| set(&mut plant, name, value));
        for (column, name) in columns.iter_mut().zip(names) {
            column.push(get(&mut plant, name));
        }
        plant.step(STEP_S * step as f64, STEP_S).unwrap();
    }
    columns
}

fn worst(ours: &[f64], theirs: &[f64]) -> f64 {
    let difference = |(ours, theirs): (&f64, &f64)| match (ours.is_nan(), theirs.is_nan()) {
        (true, true) => 0.0,
        (false, false) if ours == theirs => 0.0,
        (false, false) => (ours / theirs - 1.0).abs(),
        _ => f64::INFINITY,
    };
    ours.iter().zip(theirs).map(difference).fold(0.0, f64::max)
}

/// The worst of all outputs and of the reading behind a lag, relative.
fn apart(folder: &Path, inputs: Inputs, relative_tolerance: f64) -> [f64; 2] {
    let theirs = simulated(inputs, &format!("{relative_tolerance:e}"));
    let names: Vec<&str> = theirs.iter().map(|(name, _)| *name).collect();
    let ours = stepped(folder, inputs, relative_tolerance, &names);
    let mut most = [0.0_f64; 2];
    for ((name, theirs), ours) in theirs.iter().zip(&ours) {
        let of = &mut most[usize::from(*name == "measured_wall_middle_k")];
        *of = of.max(worst(ours, theirs));
    }
    println!(
        "plant and simulate at {relative_tolerance:e}, relative: {:.1e}, behind a lag {:.1e}",
        most[0], most[1]
    );
    most
}

#[test]
fn the_plant_goes_as_simulate_with_the_same_edges() {
    let folder = folder();
    assert!(apart(folder.path(), restless, 1e-12)[0] < 1e-9);
    assert!(apart(folder.path(), still, 1e-12).iter().all(|&off| off < 1e-9));
}

#[test]
fn where_the_tolerance_is_loose_or_the_air_jumps_before_a_lag_they_are_a_millikelvin_apart() {
    // The solver decides what is left between the two. A surface jumps with the air: simulate draws a line to the value behind the jump, a
    // step ends with the value before it.
    let folder = folder();
    for relative_tolerance in [1e-12, 1e-6] {
        let [all, lagged] = apart(folder.path(), restless, relative_tolerance);
        assert!(all < 3e-6 && lagged < 3e-6);
    }
}

/// What the program's monitor says of readings.
fn monitored(readings: [Vec<f64>; 3]) -> Table {
    let time_s = (0..readings[0].len()).map(|row| STEP_S * row as f64).collect();
    let [shoulder, valve, pressure] = readings;
    let names = ["time_s", "shoulder_k", "valve_k", "pressure_pa"].map(str::to_owned);
    let columns = names.into_iter().zip([time_s, shoulder, valve, pressure].map(Cells::Numbers)).collect();
    let call = Call::new("nitrogen-20l").log(MemoryLog { name: "rows".to_owned(), columns });
    let call = call.option("fill-pressure-bar", Some("200")).option("fill-temperature-degc", Some("15"));
    calls::monitor(call).unwrap().rows
}

const SAID: [(&str, &str, f64); 6] = [
    ("gas_mean_k", "gas_mean_degc", 273.15),
    ("gas_mean_sd_k", "gas_mean_sd_k", 0.0),
    ("mass_kg", "mass_kg", 0.0),
    ("leak_probability", "leak_probability", 0.0),
    ("pressure_15_degc_pa", "p15_bar", 0.0),
    ("cold_pressure_pa", "cold_pressure_bar", 0.0),
];

/// What a unit says: places of the rows that it is of, and a column for each of [`SAID`].
fn watched(folder: &Path, readings: &[Vec<f64>; 3]) -> (Vec<usize>, Vec<Vec<f64>>) {
    let mut monitor = begun(unit(folder, &["--kind", "monitor"]), &[]);
    let (mut rows, mut columns) = (Vec::new(), vec![Vec::new(); SAID.len()]);
    let mut take = |monitor: &mut Instance| {
        let row_s = get(monitor, "row_time_s");
        // Nothing is said of the first row before the second one is there.
        if row_s.is_finite() && rows.last() != Some(&((row_s / STEP_S) as usize)) {
            rows.push((row_s / STEP_S) as usize);
            columns.iter_mut().zip(SAID).for_each(|(column, (name, ..))| column.push(get(monitor, name)));
        }
    };
    for row in 0..readings[0].len() {
        for (name, values) in ["shoulder_k", "valve_k", "pressure_pa"].iter().zip(readings) {
            set(&mut monitor, name, values[row]);
        }
        monitor.step(STEP_S * row as f64, STEP_S).unwrap();
        take(&mut monitor);
    }
    monitor.terminate().unwrap();
    take(&mut monitor);
    assert_eq!(get(&mut monitor, "rows"), readings[0].len() as f64);
    assert!(rows.len() >= readings[0].len() - 1, "{rows:?}");
    (rows, columns)
}

#[test]
fn the_monitor_says_what_the_command_says_bit_for_bit() {
    let folder = folder();
    let names = ["measured_shoulder_k", "measured_valve_k", "measured_pressure_pa"];
    let of_plant: [Vec<f64>; 3] = stepped(folder.path(), restless, 1e-12, &names).try_into().unwrap();
    let (rows, said) = watched(folder.path(), &of_plant);
    let picked = |column: Vec<f64>| rows.iter().map(|&row| column[row]).collect::<Vec<f64>>();
    let table = monitored(of_plant);
    for (&column, ours) in SAID.iter().zip(&said) {
        let theirs = picked(numbers(&table, column.1));
        if column.0 == column.1 {
            let bits = |of: &[f64]| of.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(ours), bits(&theirs), "{}", column.0);
        }
    }
}

#[test]
fn plant_and_monitor_wired_together_say_what_simulate_and_monitor_say() {
    let folder = folder();
    let names = ["measured_shoulder_k", "measured_valve_k", "measured_pressure_pa"];
    let of_plant: [Vec<f64>; 3] = stepped(folder.path(), restless, 1e-12, &names).try_into().unwrap();
    let of_simulate = simulated(restless, "1e-12");
    let of_simulate = names.map(|name| {
        let (_, values) = of_simulate.iter().find(|(of, _)| *of == name).unwrap();
        values[..STEPS].to_vec()
    });
    // As a bus rounds: to 0.1 mK and 1 Pa.
    let rounded = |readings: &[Vec<f64>; 3]| {
        let [shoulder, valve, pressure] = readings;
        let on = |steps: f64, values: &[f64]| values.iter().map(|of| (of * steps).round() / steps).collect();
        [on(1e4, shoulder), on(1e4, valve), on(1.0, pressure)]
    };
    for (name, ours, theirs, bound) in [
        ("rounded as by a bus", rounded(&of_plant), rounded(&of_simulate), 1e-14),
        // The monitor keeps covariances in single precision, which a difference of 1e-12 may tip.
        ("as they are", of_plant, of_simulate, 1e-5),
    ] {
        let (rows, said) = watched(folder.path(), &ours);
        let table = monitored(theirs);
        let mut most = 0.0_f64;
        for ((said, column, zero), ours) in SAID.iter().zip(&said) {
            let factor = if column.ends_with("_bar") { 1e5 } else { 1.0 };
            let theirs = numbers(&table, column);
            let theirs: Vec<f64> = rows.iter().map(|&row| theirs[row] * factor + zero).collect();
            let off = worst(ours, &theirs);
            println!("{said} of readings {name}, relative: {off:.1e}");
            most = most.max(off);
        }
        assert!(most < bound, "{name}: {most:.2e}");
    }
}

#[test]
fn an_archive_has_the_same_bytes_again_and_what_each_version_asks_for() {
    let folder = folder();
    for (kind, fmi, library, words) in [
        ("plant", "2", "binaries/linux64/cylwatch.so", "fmiVersion=\"2.0\""),
        ("plant", "3", "binaries/x86_64-linux/cylwatch.so", "fmiVersion=\"3.0\""),
        ("monitor", "2", "binaries/linux64/cylwatch.so", "name=\"sensor_fault\""),
        ("monitor", "3", "binaries/x86_64-linux/cylwatch.so", "EnumerationType"),
    ] {
        let more = ["--kind", kind, "--fmi", fmi];
        let archive = written(folder.path(), "one.fmu", &more);
        assert!(archive == written(folder.path(), "one.fmu", &more), "{kind} {fmi} differs");
        let description = String::from_utf8(file_of(&archive, "modelDescription.xml")).unwrap();
        let unit = Instance::new(&file_of(&archive, "resources/cylinder.bin")).unwrap();
        for part in [words, &unit.token(), "displayUnit=\"bar\""] {
            assert!(description.contains(part), "{part} is missing in {description}");
        }
        if std::env::consts::OS == "linux" && std::env::consts::ARCH == "x86_64" {
            assert_eq!(file_of(&archive, library), b"a library");
        }
        let provenance = String::from_utf8(file_of(&archive, "resources/provenance.txt")).unwrap();
        assert!(
            provenance.contains("cylwatch fmu nitrogen-20l") && provenance.contains("sha256"),
            "{provenance}"
        );
    }
}

#[test]
fn what_makes_no_unit_is_refused() {
    let folder = folder();
    let place = folder.path();
    refused(place, &["fmu", "nitrogen-20l", "-o", "x.fmu"], &["--kind"]);
    let none = ["fmu", "nitrogen-20l", "--kind", "plant", "-o", "x.fmu", "--library", "none.so"];
    refused(place, &none, &["none.so", "cargo build --release -p cylwatch-fmi"]);
    let unfilled = ["fmu", "nitrogen-20l", "--kind", "plant", "-o", "x.fmu", "--library", "library.so"];
    refused(place, &unfilled, &["give --fill-pressure-bar and --fill-temperature-degc"]);
    refused(place, &fmu(&["--kind", "monitor", "--film", "wind", "-o", "x.fmu"]), &["leave it out"]);
    refused(place, &fmu(&["--kind", "plant", "-o", "library.so"]), &["would be overwritten"]);
    refused(place, &fmu(&["--kind", "plant", "-o", "no/folder/x.fmu"]), &["there is no folder"]);
    assert!(!place.join("x.fmu").exists());
}

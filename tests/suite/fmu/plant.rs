//! The plant against `simulate`.
#![allow(clippy::print_stdout)]
use super::{STEP_S, begun, file_of, folder, get, numbers, set, unit, worst};
use crate::support::run;
use cylwatch::cosimulation::Instance;
use cylwatch::run::{self as calls, Call};
use std::fmt::Write;
use std::path::Path;

/// Steps of a run.
pub(super) const STEPS: usize = 180;

/// What a master sets for a step.
pub(super) type Inputs = fn(usize) -> [(&'static str, f64); 4];

/// Surroundings that stay.
fn still(_step: usize) -> [(&'static str, f64); 4] {
    restless(0)
}

/// Air, K, wind, m/s, sun, W/m², and leak, kg/s, that jump with each step.
pub(super) fn restless(step: usize) -> [(&'static str, f64); 4] {
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

/// Columns of `simulate` in SI, beside the variables of the plant.
pub(super) fn simulated(inputs: Inputs, relative_tolerance: &str) -> Vec<(&'static str, Vec<f64>)> {
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
pub(super) fn stepped(
    folder: &Path,
    inputs: Inputs,
    relative_tolerance: f64,
    names: &[&str],
) -> Vec<Vec<f64>> {
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

#[test]
fn each_input_does_what_its_key_in_a_scenario_does() {
    let folder = folder();
    let settled = "fill_pressure_bar = 200\nfill_temperature_degc = 15";
    let wind = &["--kind", "plant", "--fill-pressure-bar", "200", "--fill-temperature-degc", "15"][..];
    let coefficient = &[wind, &["--film", "coefficient"]].concat()[..];
    let mass = &["--kind", "plant", "--fill-mass-kg", "3"][..];
    let refill = [("refill_kg_s", 1e-3), ("refill_source_k", 300.0), ("refill_source_pa", 250e5)];
    for (options, inputs, fill, ambient, flows) in [
        (wind, &[("wind_m_s", 4.0)][..], settled, "wind_m_s = 4", ""),
        (wind, &[("radiation_difference_k", -30.0)], settled, "radiation_k = 250", ""),
        (coefficient, &[("film_w_m2_k", 25.0)], settled, "film_w_m2_k = 25", ""),
        (wind, &[("irradiance_w_m2", 700.0)], settled, "irradiance_w_m2 = 700", ""),
        (wind, &[("leak_kg_s", 1e-4)], settled, "", "[[leak]]\nflow_kg_s = 1e-4"),
        (wind, &[("leak_bore_m", 2e-4)], settled, "", "[[leak]]\ndiameter_m = 2e-4"),
        (
            wind,
            &refill,
            settled,
            "",
            "[[refill]]\nflow_kg_s = 1e-3\nsource_temperature_k = 300\nsource_pressure_bar = 250",
        ),
        (mass, &[], "mass_kg = 3", "", ""),
    ] {
        let scenario = format!(
            "name = \"one\"\nduration_s = 600\n[initial]\n{fill}\ntemperature_k = 270\n[ambient]\nair_k = 280\n{ambient}\n{flows}\n"
        );
        let call = Call::new("nitrogen-20l").scenario_of_text(scenario);
        let table = calls::simulate(call.option("relative-tolerance", Some("1e-12"))).unwrap().rows;
        let arguments =
            [&["fmu", "nitrogen-20l", "--library", "library.so", "-o", "unit.fmu"], options].concat();
        let outcome = run(folder.path(), &arguments);
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        let archive = std::fs::read(folder.path().join("unit.fmu")).unwrap();
        let unit = Instance::new(&file_of(&archive, "resources/cylinder.bin")).unwrap();
        let of_all = [("start_temperature_k", 270.0), ("relative_tolerance", 1e-12), ("air_k", 280.0)];
        let mut plant = begun(unit, &[&of_all, inputs].concat());
        (0..10).for_each(|step| plant.step(STEP_S * f64::from(step), STEP_S).unwrap());
        for (name, column, factor, zero) in [
            ("gas_mean_k", "gas_mean_degc", 1.0, 273.15),
            ("pressure_pa", "pressure_bar", 1e5, 0.0),
            ("mass_kg", "mass_kg", 1.0, 0.0),
            ("outflow_kg_s", "outflow_g_h", 1.0 / 3.6e6, 0.0),
        ] {
            let theirs = numbers(&table, column).last().unwrap() * factor + zero;
            let off = worst(&[get(&mut plant, name)], &[theirs]);
            assert!(off < 1e-9, "{name} with {inputs:?}: {off:.1e}");
        }
    }
}

//! The monitor against `monitor`, alone and behind the plant.
#![allow(clippy::print_stdout)]
use super::plant::{STEPS, restless, simulated, stepped};
use super::{STEP_S, begun, folder, get, numbers, set, unit, worst};
use cylwatch::cosimulation::Instance;
use cylwatch::log::{Cells, MemoryLog};
use cylwatch::report::Table;
use cylwatch::run::{self as calls, Call};
use std::path::Path;

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

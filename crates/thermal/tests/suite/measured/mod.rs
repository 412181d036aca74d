//! Measured fills and discharges: `data/<case>` has the digitised curves, the vessel, and a scenario for each run, with a page on
//! where they come from and which numbers are choices.
//!
//! Bars are 4 K of gas and 2.5 bar at 140 bar, root mean square at the digitised points. A run that misses them is held to what it
//! reaches, and its test says why. Discharge coefficients are fitted to the pressure alone, and nothing to a temperature unless the
//! test says so.
use std::path::{Path, PathBuf};

use cylwatch_thermal::flow::{FlowKind, Opening};
use cylwatch_thermal::scenario::{Scenario, read_scenario};
use cylwatch_thermal::simulate::{SimulationSettings, simulate};
use cylwatch_thermal::trajectory::Trajectory;
use cylwatch_thermal::vessel::{Vessel, read_vessel};

mod discharges;
mod fills;
mod layers;
mod thermometer;

/// Points of a measured curve, (time s, value).
pub(crate) type Curve = Vec<(f64, f64)>;

/// Pressures that a source states against the air.
const ATMOSPHERE_BAR: f64 = 1.013;

fn folder(case: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data").join(case)
}

/// A measured curve, `data/<case>/<name>.csv`.
pub(crate) fn curve(case: &str, name: &str) -> Curve {
    let text = std::fs::read_to_string(folder(case).join(format!("{name}.csv"))).unwrap();
    let number = |field: &str| field.trim().parse::<f64>();
    text.lines()
        .filter_map(|line| line.split_once(','))
        .filter_map(|(t, v)| Some((number(t).ok()?, number(v).ok()?)))
        .collect()
}

/// Middle of two thermometers, at the times of the second that the first covers.
fn middle(one: &Curve, other: &Curve) -> Curve {
    let (times, values): (Vec<f64>, Vec<f64>) = one.iter().copied().unzip();
    other
        .iter()
        .filter(|(t, _)| (times[0]..=times[times.len() - 1]).contains(t))
        .map(|&(t, v)| (t, 0.5 * (v + at(&times, &values, t))))
        .collect()
}

/// Linear interpolation.
fn at(times_s: &[f64], values: &[f64], t: f64) -> f64 {
    let k = times_s.partition_point(|&x| x <= t).clamp(1, times_s.len() - 1);
    let weight = (t - times_s[k - 1]) / (times_s[k] - times_s[k - 1]);
    values[k - 1] + weight * (values[k] - values[k - 1])
}

/// (bias, root mean square) of a model curve against measured points.
pub(crate) fn score(times_s: &[f64], model: &[f64], points: &Curve) -> (f64, f64) {
    let errors: Vec<f64> = points.iter().map(|&(t, measured)| at(times_s, model, t) - measured).collect();
    let n = errors.len() as f64;
    (errors.iter().sum::<f64>() / n, (errors.iter().map(|e| e * e).sum::<f64>() / n).sqrt())
}

/// Warmest or coldest cell of each sample.
pub(crate) fn extreme(cells: &[Vec<f64>], pick: fn(f64, f64) -> f64) -> Vec<f64> {
    cells.iter().map(|sample| sample.iter().copied().reduce(pick).unwrap()).collect()
}

fn case(case: &str, run: &str) -> (Vessel, Scenario) {
    let text = |file: &str| std::fs::read_to_string(folder(case).join(file));
    let vessel = read_vessel(&text("vessel.toml").unwrap(), "vessel.toml").unwrap();
    let name = format!("{run}.toml");
    let scenario = read_scenario(&text(&name).unwrap(), &name, &text).unwrap();
    (vessel, scenario)
}

fn run(vessel: &Vessel, scenario: &Scenario) -> Trajectory {
    let run = simulate(vessel, scenario, &SimulationSettings::default(), &mut |_| {}).unwrap();
    assert!(run.ledger.energy_residual().abs() < 1e-6 && run.ledger.mass_residual().abs() < 1e-6);
    run
}

fn pressure_bar(run: &Trajectory) -> Vec<f64> {
    run.pressure_pa.iter().map(|p| p / 1e5).collect()
}

fn coefficient(scenario: &mut Scenario) -> &mut f64 {
    let found = scenario.flows.iter_mut().find_map(|flow| match &mut flow.kind {
        FlowKind::Orifice { discharge_coefficient, .. }
        | FlowKind::Supply { opening: Opening::Orifice { discharge_coefficient, .. }, .. } => {
            Some(discharge_coefficient)
        }
        _ => None,
    });
    found.expect("the run has an orifice")
}

/// A run at the discharge coefficient that fits its pressure best.
struct Fitted {
    coefficient: f64,
    run: Trajectory,
    /// (bias, root mean square) of the pressure, bar.
    pressure: (f64, f64),
}

/// Golden-section search to 0.001.
fn fit(vessel: &Vessel, scenario: &Scenario, pressure: &Curve) -> Fitted {
    let evaluate = |value: f64| {
        let mut scenario = scenario.clone();
        *coefficient(&mut scenario) = value;
        let run = run(vessel, &scenario);
        let pressure = score(&run.time_s, &pressure_bar(&run), pressure);
        Fitted { coefficient: value, run, pressure }
    };
    let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut low, mut high) = (0.5, 1.0);
    let (mut left, mut right) = (evaluate(high - ratio * (high - low)), evaluate(low + ratio * (high - low)));
    while high - low > 1e-3 {
        if left.pressure.1 < right.pressure.1 {
            (high, right) = (right.coefficient, left);
            left = evaluate(high - ratio * (high - low));
        } else {
            (low, left) = (left.coefficient, right);
            right = evaluate(low + ratio * (high - low));
        }
    }
    if left.pressure.1 < right.pressure.1 { left } else { right }
}

/// The run of a file, whose discharge coefficient is the one that fits the pressure.
fn fitted(name: &str, run: &str, pressure: &Curve) -> (Vessel, Fitted) {
    let (vessel, mut scenario) = case(name, run);
    let best = fit(&vessel, &scenario, pressure);
    println!(
        "{name} {run}: Cd {:.3}, pressure {:+.2}/{:.2} bar",
        best.coefficient, best.pressure.0, best.pressure.1
    );
    let stated = *coefficient(&mut scenario);
    assert!((best.coefficient - stated).abs() < 0.006, "{name} {run} states {stated}");
    (vessel, best)
}

/// Prints and returns the root mean square of a model curve.
fn rms(what: &str, times_s: &[f64], model: &[f64], points: &Curve) -> f64 {
    let (bias, rms) = score(times_s, model, points);
    println!("  {what} {bias:+.2}/{rms:.2} K");
    rms
}

/// Pressures against the air made absolute.
fn absolute(gauge: &Curve) -> Curve {
    gauge.iter().map(|&(t, bar)| (t, bar + ATMOSPHERE_BAR)).collect()
}

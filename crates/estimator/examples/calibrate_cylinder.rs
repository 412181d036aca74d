//! How good is a vessel file after one calibration?
//!
//! `cargo run --release -p cylwatch-estimator --example calibrate_cylinder`
//!
//! A cylinder differs from its file by 30 % in five properties and in the mounting of its shoulder's thermometer. It is recorded
//! once, in a step of the air by 65 K, by Pt100 of class B on shoulder and valve and a transmitter of 0.25 %, each drawn
//! with its offset. Six numbers are fitted to this log; then the next scenario is predicted with the file and with
//! what was fitted.
#![allow(clippy::print_stdout)]
use std::error::Error;

use cylwatch_estimator::calibrate::{
    Calibrated, Calibration, CalibrationSettings, Experiment, ParameterKind, ParameterSpec,
};
use cylwatch_estimator::log::Log;
use cylwatch_estimator::sensor::{Sensor, SensorSuite, sample};
use cylwatch_estimator::thermal::scenario::{self, Scenario};
use cylwatch_estimator::thermal::simulate::{SimulationSettings, simulate};
use cylwatch_estimator::thermal::vessel::{self, InsideFilm, Vessel};

/// Built-in vessel whose file is not quite right.
const VESSEL: &str = "nitrogen-20l";
/// What is recorded, and what is then predicted.
const RECORDED: &str = "tunnel-step";
const NEXT: &str = "shock-cold";
/// Interval of the log, s.
const INTERVAL_S: f64 = 30.0;
/// Seed of the sensors' specimens and noise.
const SEED: u64 = 1;
/// Share of the way to the air that a typical thermometer reads.
const COUPLING: f64 = 0.1;

/// A number that the file has wrong.
pub(crate) struct Wrong {
    /// What it is.
    pub kind: ParameterKind,
    /// Where the search begins: what the file or the data sheet says.
    pub stated: f64,
    /// What it really is.
    pub truth: f64,
}

/// Five factors of the vessel, and the shoulder's coupling.
pub(crate) fn wrong() -> [Wrong; 6] {
    let coupling = ParameterKind::SensorCoupling { sensor: "shoulder".into() };
    let of = |kind, stated: f64, factor: f64| Wrong { kind, stated, truth: stated * factor };
    [
        of(ParameterKind::OutsideFilm, 1.0, 1.3),
        of(ParameterKind::InsideFilm, 1.0, 1.0 / 1.3),
        of(ParameterKind::WallCapacity, 1.0, 1.0 / 1.3),
        of(ParameterKind::ValveCapacity, 1.0, 1.3),
        of(ParameterKind::ValveContact, 1.0, 1.0 / 1.3),
        of(coupling, COUPLING, 1.3),
    ]
}

/// The cylinder as it is.
pub(crate) fn cylinder() -> Result<Vessel, Box<dyn Error>> {
    let mut vessel = vessel::presets::load(VESSEL)?;
    let [outside, inside, wall, valve_capacity, contact, _] = wrong().map(|one| one.truth);
    vessel.surface.film_factor *= outside;
    if let InsideFilm::Rayleigh { multiplier, .. } = &mut vessel.inside_film {
        *multiplier *= inside;
    }
    for layer in &mut vessel.geometry.layers {
        layer.material.heat_capacity_j_kg_k *= wall;
    }
    let valve = vessel.valve.as_mut().ok_or("the vessel has a valve")?;
    valve.material.heat_capacity_j_kg_k *= valve_capacity;
    valve.contact_w_k *= contact;
    Ok(vessel)
}

/// What a scenario's logger writes.
fn log(scenario: &Scenario, sensors: &[Sensor]) -> Result<Log, Box<dyn Error>> {
    let run = simulate(&cylinder()?, scenario, &SimulationSettings::default(), &mut |_| ())?;
    let mut specimens = SensorSuite::try_new(sensors.to_vec())?.draw(SEED);
    let shoulder = specimens.find_mut("shoulder").ok_or("the shoulder has a sensor")?;
    let place = shoulder
        .sensor
        .parameters()
        .iter()
        .position(|known| known.kind == cylwatch_estimator::sensor::ParameterKind::Coupling);
    shoulder.truth.parameters[place.ok_or("a surface sensor has a coupling")?] = wrong()[5].truth;
    Ok(sample(&run, &specimens, SEED)?)
}

/// Fits the six numbers, and beside them what the data sheets leave open.
pub(crate) fn calibrated() -> Result<Calibrated, Box<dyn Error>> {
    let mut scenario = scenario::presets::load(RECORDED)?;
    scenario.sample_time_s = INTERVAL_S;
    let sensors: Vec<Sensor> =
        ["shoulder", "valve", "pressure"].into_iter().map(Sensor::typical).collect::<Result<_, _>>()?;
    let sought: Vec<ParameterSpec> =
        wrong().into_iter().map(|one| ParameterSpec::new(one.kind, one.stated)).collect();
    let is_sought = |spec: &ParameterSpec| sought.iter().any(|other| other.kind == spec.kind);
    let beside = sensors.iter().flat_map(ParameterSpec::of_sensor).filter(|spec| !is_sought(spec));
    let calibration = Calibration {
        vessel: vessel::presets::load(VESSEL)?,
        parameters: sought.iter().cloned().chain(beside).collect(),
        experiments: vec![Experiment {
            source: RECORDED.into(),
            vessel: None,
            log: log(&scenario, &sensors)?,
            scenario,
            channels: sensors,
        }],
        settings: CalibrationSettings::default(),
    };
    Ok(calibration.run()?)
}

/// Root mean square errors of the mean gas temperature in the next scenario, K: with the file, and with what was fitted.
pub(crate) fn prediction(calibrated: &Calibrated) -> Result<[f64; 2], Box<dyn Error>> {
    let next = scenario::presets::load(NEXT)?;
    let gas_k = |vessel: &Vessel| -> Result<Vec<f64>, Box<dyn Error>> {
        Ok(simulate(vessel, &next, &SimulationSettings::default(), &mut |_| ())?.gas_mean_k)
    };
    let truth = gas_k(&cylinder()?)?;
    let rms = |gas_k: &[f64]| {
        let squares = gas_k.iter().zip(&truth).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
        (squares / truth.len() as f64).sqrt()
    };
    let file = vessel::presets::load(VESSEL)?;
    let fitted = calibrated.applied(0, &file);
    Ok([rms(&gas_k(&file)?), rms(&gas_k(&fitted)?)])
}

#[allow(dead_code)]
fn main() -> Result<(), Box<dyn Error>> {
    let calibrated = calibrated()?;
    println!("{:24} {:>8} {:>8} {:>9} {:>20}", "parameter", "file", "true", "estimate", "95 % interval");
    for one in wrong() {
        let found = calibrated.estimate(&one.kind).ok_or("what is sought is found")?;
        let (low, high) = found.interval;
        println!(
            "{:24} {:8.3} {:8.3} {:9.3} {:>20}",
            one.kind.name(),
            one.stated,
            one.truth,
            found.value,
            format!("{low:.3} to {high:.3}")
        );
    }
    for channel in &calibrated.channels {
        println!("{}: residuals {:.2} times the noise", channel.channel, channel.rms_over_noise);
    }
    let [before, after] = prediction(&calibrated)?;
    println!("mean gas temperature in {NEXT}: {before:.2} K rms off before, {after:.3} K after");
    Ok(())
}

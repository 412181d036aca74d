//! Run I1 of Haque et al. (1992): the discharge coefficient from the pressure record alone, the gas temperature predicted.
//! Source and accuracy of the points: `data/haque_i1/README.md` at the repository root.
use cylwatch_estimator::calibrate::{
    Calibration, CalibrationSettings, Experiment, ParameterKind, ParameterSpec,
};
use cylwatch_estimator::log::{Channel, Log, Quantity};
use cylwatch_thermal::vessel;

use super::study::{known, preset, run};

type Curve = Vec<(f64, f64)>;

fn curve(text: &str) -> Curve {
    let number = |field: &str| field.trim().parse::<f64>();
    text.lines()
        .filter_map(|line| line.split_once(','))
        .filter_map(|(t, v)| Some((number(t).ok()?, number(v).ok()?)))
        .collect()
}

macro_rules! measured {
    ($name:literal) => {
        curve(include_str!(concat!("../../../../../data/haque_i1/", $name, ".csv")))
    };
}

/// Accuracy of the digitised pressure, Pa.
const PRESSURE_SD_PA: f64 = 0.5e5;

fn calibration() -> Calibration {
    let points = measured!("pressure");
    let mut scenario = preset("haque-i1");
    // The last digitised point lies at 100.11 s.
    scenario.duration_s = 101.0;
    scenario.sample_time_s = 0.1;
    let log = Log {
        channels: vec![Channel { name: "pressure".into(), quantity: Quantity::Pressure }],
        time_s: points.iter().map(|point| point.0).collect(),
        values: points.iter().map(|point| point.1 * 1e5).collect(),
    };
    let sensor = known("pressure", PRESSURE_SD_PA);
    let coefficient = ParameterKind::DischargeCoefficient { flow: "orifice".into() };
    Calibration {
        vessel: vessel::presets::load("haque-i1").unwrap(),
        experiments: vec![Experiment {
            source: "haque_i1/pressure.csv".into(),
            vessel: None,
            scenario,
            log,
            channels: vec![sensor],
        }],
        parameters: vec![ParameterSpec::new(coefficient, 0.85)],
        settings: CalibrationSettings::default(),
    }
}

#[test]
fn discharge_coefficient_of_run_i1_follows_from_the_pressure_and_predicts_the_gas() {
    let calibration = calibration();
    let calibrated = calibration.run().unwrap();
    let found = &calibrated.estimates[0];
    let scenario = calibrated.applied_to_scenario(0, &calibration.experiments[0].scenario).unwrap();
    let course = run(&calibration.vessel, &scenario);
    let errors: Vec<f64> = measured!("gas_high")
        .iter()
        .zip(&measured!("gas_low"))
        .map(|(high, low)| {
            let t = 0.5 * (high.0 + low.0);
            let nearest = (t / scenario.sample_time_s).round() as usize;
            course.gas_mean_k[nearest] - 0.5 * (high.1 + low.1)
        })
        .collect();
    let rms = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt();
    println!(
        "Cd {:.4} [{:.4}, {:.4}], pressure {:.2} bar, gas {rms:.2} K",
        found.value,
        found.interval.0,
        found.interval.1,
        calibrated.channels[0].rms / 1e5
    );
    assert!((0.70..=0.76).contains(&found.value), "{found:?}");
    assert!(rms <= 3.0, "{rms} K");
}

/// The model does not follow the record to its accuracy: the interval must be wider than the points' scatter says.
#[test]
fn model_error_of_run_i1_widens_the_interval() {
    let calibrated = calibration().run().unwrap();
    let channel = &calibrated.channels[0];
    assert!(channel.rms_over_noise > 2.0 && channel.variance_factor > channel.rms_over_noise.powi(2));
    let profile = calibrated.profile(0).unwrap();
    let (low, high) = calibrated.estimates[0].interval;
    println!("profile {profile:?} against {low} {high}");
    assert!(profile.closed.0 && profile.closed.1);
    // One parameter, nearly linear: both intervals agree to a fifth of their width.
    let width = high - low;
    assert!(
        (profile.interval.0 - low).abs() < 0.2 * width && (profile.interval.1 - high).abs() < 0.2 * width
    );
}

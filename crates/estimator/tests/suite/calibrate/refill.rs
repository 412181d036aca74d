//! A fast refill through an orifice: its coefficient from the pressure, and lag and stem of a thermometer in the gas.
use cylwatch_estimator::calibrate::{
    Calibration, CalibrationSettings, Experiment, ParameterKind, ParameterSpec,
};
use cylwatch_estimator::sensor::{SensorSuite, read_sensors, sample};
use cylwatch_thermal::flow::FlowKind;
use cylwatch_thermal::vessel::{self, Vessel};

use super::study::{known, preset, run};

/// True coefficient, lag in s and coupling.
const TRUTH: [f64; 3] = [0.72, 6.0, 0.12];

#[test]
fn coefficient_lag_and_stem_follow_from_a_refill_through_an_orifice() {
    let text = "[[sensor]]\nname = \"tank\"\nkind = \"immersion\"\ncell = 1\nnoise_k = 0.1\nlag_s = 3\nstem_coupling = 0.08\n\
                stem_coupling_sd = 0.06\noffset_sd_k = 0.05\n[[sensor]]\nname = \"pressure\"\nnoise_mbar = 10\noffset_sd_mbar = 1\n";
    let (_, suite) = read_sensors(text, "sensors.toml").unwrap();
    let vessel = vessel::presets::load("nitrogen-20l").unwrap();
    let mut scenario = preset("refill-from-bank");
    (scenario.duration_s, scenario.sample_time_s) = (900.0, 1.0);
    let mut true_scenario = scenario.clone();
    let coefficient = true_scenario.flows[0].kind.discharge_coefficient_mut().unwrap();
    *coefficient = TRUTH[0];
    assert!(matches!(true_scenario.flows[0].kind, FlowKind::Supply { .. }));
    let mut specimens = suite.draw(1);
    let tank = specimens.find_mut("tank").unwrap();
    tank.sensor.lag_s = TRUTH[1];
    tank.truth.parameters[1] = TRUTH[2];
    let log = sample(&run(&vessel, &true_scenario), &specimens, 1).unwrap();
    let kinds = [
        ParameterKind::DischargeCoefficient { flow: "refill".into() },
        ParameterKind::SensorLag { sensor: "tank".into() },
        ParameterKind::SensorCoupling { sensor: "tank".into() },
    ];
    let starts = [0.8, 3.0, 0.08];
    let calibration = Calibration {
        vessel,
        experiments: vec![Experiment {
            source: "refill".into(),
            vessel: None,
            scenario,
            log,
            channels: suite.sensors().to_vec(),
        }],
        parameters: kinds
            .into_iter()
            .zip(starts)
            .map(|(kind, start)| ParameterSpec::new(kind, start))
            .collect(),
        settings: CalibrationSettings::default(),
    };
    let calibrated = calibration.run().unwrap();
    for ((found, truth), within) in calibrated.estimates.iter().zip(TRUTH).zip([0.002, 0.1, 0.01]) {
        println!("{:.4} [{:.4}, {:.4}] of {truth}", found.value, found.interval.0, found.interval.1);
        assert!((found.value - truth).abs() < within, "{found:?}");
    }
}

/// A jet that gives 1.5 times the film of the law, in the preset whose refill has an inlet; without one there is nothing to fit.
#[test]
fn the_film_of_a_jet_is_found_from_pressure_and_gas() {
    let scenario = preset("refill-from-bank");
    let vessel = vessel::presets::load("nitrogen-20l").unwrap();
    let truth = Vessel { jet_film_factor: 1.5, ..vessel.clone() };
    let channels = vec![known("shoulder", 0.05), known("pressure", 1e3)];
    let suite = SensorSuite::try_new(channels.clone()).unwrap();
    let log = sample(&run(&truth, &scenario), &suite.nominal(), 3).unwrap();
    let experiment = Experiment { source: "fill".into(), vessel: None, scenario, log, channels };
    let mut calibration = Calibration {
        vessel,
        experiments: vec![experiment],
        parameters: vec![ParameterSpec::new(ParameterKind::JetFilm, 1.0).with_prior(1.0, 0.5)],
        settings: CalibrationSettings::default(),
    };
    let found = calibration.run().unwrap().estimates[0].clone();
    assert!((found.value - 1.5).abs() < 4.0 * found.sd && found.sd < 0.1, "{found:?}");
    calibration.experiments[0].scenario.flows.clear();
    assert!(calibration.run().unwrap_err().to_string().contains("a refill with an inlet"));
}

//! Logs and parameters that cannot be used are refused by a typed error that says what to do.
use cylwatch_estimator::calibrate::{CalibrateError, Calibration, HoldOut, ParameterKind, ParameterSpec};

use super::study::{Case, known, preset};

/// Twenty minutes of a cold shock, one sample a minute, two sensors, outside film and wall unknown.
fn short() -> Calibration {
    let mut scenario = preset("shock-cold");
    scenario.duration_s = 1200.0;
    let case = Case::new(5);
    let mut calibration = case.calibration(&scenario);
    calibration.parameters = vec![
        ParameterSpec::new(ParameterKind::OutsideFilm, 1.0),
        ParameterSpec::new(ParameterKind::WallCapacity, 1.0),
    ];
    calibration
}

fn refused(calibration: &Calibration) -> CalibrateError {
    calibration.run().expect_err("it cannot be calibrated")
}

fn column(calibration: &mut Calibration, name: &str, value: impl Fn(usize, f64) -> f64) {
    let log = &mut calibration.experiments[0].log;
    let index = log.channels.iter().position(|channel| channel.name == name).unwrap();
    let width = log.channels.len();
    for row in 0..log.time_s.len() {
        let old = log.values[row * width + index];
        log.values[row * width + index] = value(row, old);
    }
}

#[test]
fn the_log_of_these_tests_is_good_as_it_is() {
    assert!(short().run().is_ok());
}

#[test]
fn channel_without_change_is_a_stuck_sensor() {
    let mut calibration = short();
    column(&mut calibration, "valve", |_, _| 280.0);
    assert!(
        matches!(refused(&calibration), CalibrateError::ConstantChannel { channel, .. } if channel == "valve")
    );
}

#[test]
fn log_at_rest_has_no_excitation() {
    let mut calibration = short();
    for name in ["shoulder", "valve"] {
        column(&mut calibration, name, |row, _| 294.15 + 0.05 * (row as f64).sin());
    }
    column(&mut calibration, "pressure", |row, _| 204e5 + 1e3 * (row as f64).cos());
    assert!(matches!(refused(&calibration), CalibrateError::NoExcitation { .. }));
}

#[test]
fn fewer_readings_than_parameters_are_refused() {
    let mut calibration = short();
    let experiment = &mut calibration.experiments[0];
    experiment.channels.truncate(1);
    experiment.log.time_s.truncate(1);
    experiment.log.values.truncate(3);
    assert!(matches!(refused(&calibration), CalibrateError::TooFewSamples { samples: 1, parameters: 2 }));
}

#[test]
fn parameter_that_runs_to_its_bound_is_named() {
    let mut calibration = short();
    calibration.parameters[0].bounds = Some((0.95, 1.05));
    let error = refused(&calibration);
    assert!(
        matches!(&error, CalibrateError::AtBound { parameter, .. } if parameter == "outside film"),
        "{error}"
    );
}

/// A bar of pressure per kelvin in the wrong direction: the readings of a warming cylinder on one that cools.
#[test]
fn log_of_another_cylinder_does_not_fit() {
    let mut calibration = short();
    let first = calibration.experiments[0].log.values[2];
    column(&mut calibration, "pressure", |_, old| 2.0 * first - old);
    let error = refused(&calibration);
    assert!(matches!(error, CalibrateError::Misfit { .. }), "{error}");
}

#[test]
fn parameter_that_changes_no_reading_is_refused() {
    let mut calibration = short();
    let mut scenario = calibration.experiments[0].scenario.clone();
    let mut blowdown = preset("haque-i1").flows.remove(0);
    (blowdown.start_s, blowdown.name) = (1e6, "late".into());
    scenario.flows.push(blowdown);
    calibration.experiments[0].scenario = scenario;
    let kind = ParameterKind::DischargeCoefficient { flow: "late".into() };
    calibration.parameters.push(ParameterSpec::new(kind, 0.8));
    assert!(matches!(refused(&calibration), CalibrateError::NoInfluence { .. }));
}

/// A pressure sensor at rest in temperature cannot tell its offset from the gas mass, both cannot be free.
#[test]
fn combination_that_no_reading_separates_is_named() {
    let mut calibration = short();
    calibration.experiments[0].channels = vec![known("shoulder", 0.05)];
    calibration.parameters = vec![
        ParameterSpec::new(ParameterKind::OutsideFilm, 1.0),
        ParameterSpec::new(ParameterKind::FillMass, 1.0),
        ParameterSpec::new(ParameterKind::Volume, 1.0),
    ];
    let error = refused(&calibration);
    println!("{error}");
    let CalibrateError::Undetermined { combination, .. } = error else { panic!("{error}") };
    assert!(combination.contains("fill mass") && combination.contains("volume"), "{combination}");
}

#[test]
fn names_that_are_not_there_are_refused() {
    let spec = |kind| ParameterSpec::new(kind, 0.5);
    let kinds = [
        ParameterKind::DischargeCoefficient { flow: "relief".into() },
        ParameterKind::SensorOffset { sensor: "wall_middle".into() },
        ParameterKind::SensorCoupling { sensor: "pressure".into() },
    ];
    for kind in kinds {
        let mut calibration = short();
        calibration.parameters.push(spec(kind));
        assert!(matches!(refused(&calibration), CalibrateError::ParameterMisfit { .. }));
    }
    let mut calibration = short();
    calibration.experiments[0].channels.push(known("wall_middle", 0.05));
    assert!(matches!(refused(&calibration), CalibrateError::ChannelUnknown { .. }));
}

#[test]
fn starts_and_priors_must_lie_within_their_bounds() {
    for (start, prior, bounds) in [
        (-1.0, None, None),
        (1.0, Some((1.0, 0.0)), None),
        (1.0, Some((30.0, 1.0)), None),
        (1.0, None, Some((2.0, 3.0))),
        (1.0, None, Some((-2.0, 3.0))),
    ] {
        let mut calibration = short();
        let mut spec = ParameterSpec::new(ParameterKind::InsideFilm, start);
        if let Some((mean, sd)) = prior {
            spec = spec.with_prior(mean, sd);
        }
        spec.bounds = bounds;
        calibration.parameters.push(spec);
        assert!(matches!(refused(&calibration), CalibrateError::ParameterValue { .. }));
    }
}

#[test]
fn twice_the_same_parameter_is_refused() {
    let mut calibration = short();
    calibration.parameters.push(ParameterSpec::new(ParameterKind::OutsideFilm, 1.0).only(vec![0]));
    assert!(matches!(refused(&calibration), CalibrateError::ParameterTwice { .. }));
}

#[test]
fn times_beyond_the_scenario_are_refused() {
    let mut calibration = short();
    calibration.experiments[0].scenario.duration_s = 600.0;
    assert!(matches!(refused(&calibration), CalibrateError::Time { row: 11, .. }));
}

#[test]
fn holding_out_everything_leaves_nothing_to_fit() {
    let error = short().validate(&HoldOut::Experiments(vec![0])).expect_err("nothing is left");
    assert!(matches!(error, CalibrateError::HoldOut { purpose: "fit", .. }));
    let error = short().validate(&HoldOut::After { time_s: 1e6 }).expect_err("nothing is left");
    assert!(matches!(error, CalibrateError::HoldOut { purpose: "score", .. }));
}

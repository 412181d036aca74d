//! Several logs, filling pressures and vessels at once, held-out readings, profiles.
use cylwatch_estimator::calibrate::{
    CalibrateError, Calibration, CalibrationSettings, Experiment, HoldOut, ParameterKind, ParameterSpec,
};
use cylwatch_estimator::sensor::{SensorSuite, sample};
use cylwatch_thermal::scenario::{OutsideFilm, Scenario};
use cylwatch_thermal::vessel::Fill;
use cylwatch_thermal::vessel::{self, Vessel};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::study::{Case, known, preset, run};

fn filled(scenario: &Scenario, pressure_pa: f64) -> Scenario {
    let mut scenario = scenario.clone();
    scenario.initial.fill = Fill::Settled { pressure_pa, temperature_k: 288.15 };
    scenario.duration_s = 3600.0;
    scenario
}

/// An experiment on a vessel whose wall capacity is `wall` and whose film is `film` times what is stated.
fn experiment(
    source: &str,
    vessel: &Vessel,
    scenario: &Scenario,
    wall: f64,
    film: f64,
    seed: u64,
) -> Experiment {
    let (mut true_vessel, mut exposed) = (vessel.clone(), scenario.clone());
    true_vessel.geometry.layers[0].material.heat_capacity_j_kg_k *= wall;
    if let OutsideFilm::Coefficient { film_w_m2_k } = &mut exposed.surroundings.film {
        *film_w_m2_k = film_w_m2_k.scaled(film).unwrap();
    }
    let channels = vec![known("shoulder", 0.05), known("pressure", 1e3)];
    let suite = SensorSuite::try_new(channels.clone()).unwrap();
    Experiment {
        source: source.into(),
        vessel: Some(vessel.clone()),
        scenario: scenario.clone(),
        log: sample(&run(&true_vessel, &exposed), &suite.nominal(), seed).unwrap(),
        channels,
    }
}

/// A smaller cylinder of the same steel, and two fillings: one wall capacity for all, a film for each chamber.
fn two_vessels() -> Calibration {
    let large = vessel::presets::load("nitrogen-20l").unwrap();
    let mut small = large.clone();
    (small.name, small.geometry.cylinder_length_m) = ("10 L".into(), 0.25);
    small.volume.volume_m3 = 0.01;
    let shock = preset("shock-cold");
    Calibration {
        experiments: vec![
            experiment("large, 200 bar", &large, &filled(&shock, 200e5), 1.2, 0.8, 1),
            experiment("small, 120 bar", &small, &filled(&shock, 120e5), 1.2, 1.25, 2),
        ],
        vessel: large,
        parameters: vec![
            ParameterSpec::new(ParameterKind::WallCapacity, 1.0),
            ParameterSpec::new(ParameterKind::OutsideFilm, 1.0).only(vec![0]),
            ParameterSpec::new(ParameterKind::OutsideFilm, 1.0).only(vec![1]),
        ],
        settings: CalibrationSettings::default(),
    }
}

#[test]
fn vessels_share_what_is_declared_shared_and_nothing_else() {
    let both = two_vessels().run().unwrap();
    for (estimate, truth) in both.estimates.iter().zip([1.2, 0.8, 1.25]) {
        assert!((estimate.value - truth).abs() < 4.0 * estimate.sd, "{estimate:?}");
        assert!(estimate.sd < 0.02, "{estimate:?}");
    }
    // The second log adds what it knows of the shared parameter.
    let mut alone = two_vessels();
    alone.experiments.truncate(1);
    alone.parameters.truncate(2);
    assert!(both.estimates[0].sd < alone.run().unwrap().estimates[0].sd);
}

#[test]
fn held_out_log_is_predicted_to_its_noise() {
    let mut calibration = two_vessels();
    calibration.experiments[1] =
        experiment("large, 120 bar", &calibration.vessel, &filled(&preset("shock-cold"), 120e5), 1.2, 0.8, 3);
    calibration.parameters.truncate(1);
    calibration.parameters.push(ParameterSpec::new(ParameterKind::OutsideFilm, 1.0));
    let validation = calibration.validate(&HoldOut::Experiments(vec![1])).unwrap();
    assert_eq!(validation.scores.len(), 2);
    for score in &validation.scores {
        assert!(score.rms_before > 10.0 * score.noise_sd, "{score:?}");
        assert!(score.rms_after < 1.5 * score.noise_sd, "{score:?}");
    }
}

#[test]
fn readings_after_the_fit_are_predicted_to_their_noise() {
    let mut calibration = two_vessels();
    calibration.experiments.truncate(1);
    calibration.parameters.truncate(2);
    let validation = calibration.validate(&HoldOut::After { time_s: 1800.0 }).unwrap();
    for score in &validation.scores {
        assert!(score.rms_after < 1.5 * score.noise_sd && score.rms_before > score.rms_after, "{score:?}");
    }
}

#[test]
fn profile_and_covariance_give_the_same_interval_where_the_model_is_nearly_linear() {
    let mut calibration = two_vessels();
    calibration.experiments.truncate(1);
    calibration.parameters.truncate(2);
    let calibrated = calibration.run().unwrap();
    let profile = calibrated.profile(0).unwrap();
    let (low, high) = calibrated.estimates[0].interval;
    assert!((profile.interval.0 - low).abs() < 0.1 * (high - low), "{profile:?} against {low} {high}");
    assert!((profile.interval.1 - high).abs() < 0.1 * (high - low), "{profile:?} against {low} {high}");
    assert!(profile.points.windows(2).all(|pair| pair[0].0 < pair[1].0));
}

#[test]
fn factors_found_on_one_vessel_hold_for_another() {
    let calibration = two_vessels();
    let calibrated = calibration.run().unwrap();
    let small = calibration.experiments[1].vessel.as_ref().unwrap();
    let changed = calibrated.applied(1, small);
    let [found, file] =
        [&changed, small].map(|vessel| vessel.geometry.layers[0].material.heat_capacity_j_kg_k);
    assert!((found / file - calibrated.estimates[0].value).abs() < 1e-12);
    let film = changed.surface.film_factor / small.surface.film_factor;
    assert!((film - calibrated.estimates[2].value).abs() < 1e-12, "of its own chamber");
    assert_eq!(changed.geometry.cylinder_length_m, 0.25);
}

#[test]
fn residuals_of_the_true_model_are_white_and_of_the_noise() {
    let case = Case::new(21);
    let calibrated = case.calibration(&preset("shock-cold")).run().unwrap();
    for channel in &calibrated.channels {
        assert!(
            (0.85..1.15).contains(&channel.rms_over_noise),
            "{} {}",
            channel.channel,
            channel.rms_over_noise
        );
        assert!(
            channel.whiteness_p_value.unwrap() > 1e-3,
            "{} {:?}",
            channel.channel,
            channel.whiteness_p_value
        );
    }
}

#[test]
fn a_watched_search_tells_its_steps_down_to_the_minimum() {
    let mut calibration = two_vessels();
    calibration.experiments.truncate(1);
    calibration.parameters.truncate(2);
    let mut steps = Vec::new();
    let calibrated = calibration.run_watched(&mut |step| steps.push(step), &Arc::default()).unwrap();
    assert_eq!(steps.len(), calibrated.iterations);
    assert!(steps.iter().enumerate().all(|(k, step)| step.number == k + 1));
    assert!(steps[0].distance_sd > 1.0 && steps.last().unwrap().distance_sd < 0.3, "{steps:?}");
}

#[test]
fn a_search_that_is_stopped_ends_at_once_and_so_does_what_is_computed_of_its_result() {
    let mut calibration = two_vessels();
    calibration.experiments.truncate(1);
    calibration.parameters.truncate(2);
    let stop = Arc::new(AtomicBool::new(false));
    let mut steps = 0;
    let mut watch = |_| {
        steps += 1;
        stop.store(true, Ordering::Relaxed);
    };
    let stopped = calibration.run_watched(&mut watch, &stop).unwrap_err();
    assert!(matches!(stopped, CalibrateError::Stopped) && steps == 1, "{stopped}, {steps} steps");
    let later = Arc::default();
    let calibrated = calibration.run_watched(&mut |_| (), &later).unwrap();
    assert!(calibrated.mesh_shift_sd().is_some());
    later.store(true, Ordering::Relaxed);
    assert!(matches!(calibrated.profile(0), Err(CalibrateError::Stopped)));
    assert_eq!(calibrated.mesh_shift_sd(), None);
}

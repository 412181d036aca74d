//! Every engine runs through the same observer, and they agree as far as they can.
use super::*;
use cylwatch_estimator::observer::{MovingHorizonSettings, Quality};

const ENGINES: [&str; 4] = ["ekf", "ukf", "stationary", "mhe"];

/// An observer of one member; the horizon's window is short to keep the tests fast.
fn single(engine: &str) -> Observer {
    let mut engine: Engine = engine.parse().unwrap();
    if let Engine::MovingHorizon(window) = &mut engine {
        window.samples = 8;
    }
    observer_with(&SENSORS, &ObserverSettings { engine, ..ObserverSettings::single() })
}

/// Largest differences of temperature, K, and mass, kg, from the second hour on.
fn differences(a: &[Estimate], b: &[Estimate]) -> (f64, f64) {
    let late = a.iter().zip(b).filter(|(a, _)| a.time_s >= 3600.0);
    late.fold((0.0, 0.0), |(gas, mass): (f64, f64), (a, b)| {
        (gas.max((a.gas_mean_k - b.gas_mean_k).abs()), mass.max((a.mass_kg - b.mass_kg).abs()))
    })
}

fn assert_engine_near_extended(engine: &str, gas_k: f64, mass_kg: f64) {
    let case = Case::ramp().until(4.0);
    let reference = case.run(&mut single("ekf"));
    let estimates = case.run(&mut single(engine));
    assert!(estimates.iter().all(is_sound));
    let (gas, mass) = differences(&estimates, &reference);
    assert!(gas <= gas_k, "{engine}: gas {gas} K");
    assert!(mass <= mass_kg, "{engine}: mass {mass} kg");
}

#[test]
fn unscented_agrees_with_extended_on_a_ramp() {
    assert_engine_near_extended("ukf", 0.1, 1e-3);
}

#[test]
fn moving_horizon_agrees_with_extended_on_a_ramp() {
    // It linearises again when more is known, and its constraints are rarely active here.
    assert_engine_near_extended("mhe", 0.15, 3e-3);
}

#[test]
fn moving_horizon_keeps_the_leak_rate_from_being_negative() {
    let mut settings = ObserverSettings { engine: "mhe".parse().unwrap(), ..ObserverSettings::default() };
    settings.bank.truncate(2);
    if let Engine::MovingHorizon(window) = &mut settings.engine {
        window.samples = 5;
    }
    let mut observer = observer_with(&SENSORS, &settings);
    let mut free = observer_with(&SENSORS, &ObserverSettings { engine: Engine::Extended, ..settings });
    let mut negative = 0;
    for (t, readings) in &rising_pressure(3.0) {
        // The first sample is the filter's; the window begins behind it.
        let leak = observer.step(*t, readings).unwrap().leak_kg_s;
        assert!(*t == 0.0 || leak >= 0.0, "leak {leak} at {t} s");
        negative += usize::from(free.step(*t, readings).unwrap().leak_kg_s < 0.0);
    }
    assert!(negative > 20, "the filter has no reason for a negative leak rate: {negative} samples");
}

/// The ramp with a pressure that creeps up by half a bar an hour, as if gas came in.
fn rising_pressure(hours: f64) -> Vec<(f64, [f64; 3])> {
    let mut rows = Case::ramp().until(hours).rows;
    rows.iter_mut().for_each(|(t, readings)| readings[PRESSURE] += 0.5e5 * *t / 3600.0);
    rows
}

#[test]
fn every_engine_is_nearer_to_the_truth_than_its_stated_uncertainty_allows() {
    let case = Case::shock().until(3.0);
    for engine in ["ekf", "ukf", "stationary"] {
        let estimates = case.run(&mut single(engine));
        let within = |(e, truth): (&Estimate, &f64)| (e.gas_mean_k - truth).abs() <= 2.0 * e.gas_mean_sd_k;
        let gas = estimates.iter().zip(&case.truth.gas_mean_k).filter(|pair| within(*pair)).count();
        let within = |(e, truth): (&Estimate, &f64)| (e.mass_kg - truth).abs() <= 2.0 * e.mass_sd_kg;
        let mass = estimates.iter().zip(&case.truth.mass_kg).filter(|pair| within(*pair)).count();
        let count = estimates.len() as f64;
        assert!(gas as f64 / count > 0.9 && mass as f64 / count > 0.9, "{engine}: {gas} {mass} of {count}");
        assert!(case.gas_rms_k(&estimates) < 0.6, "{engine}: rms {} K", case.gas_rms_k(&estimates));
    }
}

/// The chamber jumps by 46 K: what a constant gain does not know of the films and of the transmitter costs it, and it says so.
#[test]
fn stationary_engine_states_more_uncertainty_than_one_that_learns() {
    let case = Case::shock();
    let last = |engine: &str| *case.run(&mut single(engine)).last().unwrap();
    let (stationary, extended) = (last("stationary"), last("ekf"));
    assert!(stationary.mass_sd_kg > 1.25 * extended.mass_sd_kg);
}

#[test]
fn stationary_engine_with_learnt_constants_comes_near_the_extended_one() {
    let case = Case::shock();
    let mut teacher = observer(Engine::Extended);
    case.run(&mut teacher);
    let rms = |engine: &str| {
        let mut pupil = single(engine).with_learned(teacher.learned().unwrap()).unwrap();
        case.gas_rms_k(&case.run(&mut pupil))
    };
    let (stationary, extended) = (rms("stationary"), rms("ekf"));
    assert!(stationary < 1.5 * extended + 0.05, "{stationary} K against {extended} K");
}

#[test]
fn every_engine_takes_missing_readings_and_irregular_steps() {
    let case = Case::ramp().until(2.0);
    for engine in ENGINES {
        let mut observer = single(engine);
        for (i, (t, readings)) in case.rows.iter().enumerate() {
            if i % 11 == 5 {
                continue;
            }
            let mut readings = *readings;
            if i % 7 == 3 {
                readings[i % 3] = f64::NAN;
            }
            let jitter = if i % 5 == 0 { 7.0 } else { 0.0 };
            let estimate = observer.step(t + jitter, &readings).unwrap();
            assert!(is_sound(&estimate), "{engine} at {t} s");
            assert_ne!(estimate.quality, Quality::Restarted);
        }
        let last = case.rows.len() - 1;
        let error = observer.state(0).map(|(x, _)| x[observer.cylinder().state_map().gas]).unwrap()
            - case.truth.gas_mean_k[last];
        assert!(error.abs() < 1.0, "{engine}: {error} K");
    }
}

#[test]
fn engines_have_the_words_of_the_command_line_and_of_files() {
    for (word, engine) in [
        ("ekf", Engine::Extended),
        ("extended", Engine::Extended),
        ("ukf", Engine::Unscented),
        ("stationary", Engine::Stationary),
        ("mhe", Engine::MovingHorizon(MovingHorizonSettings::default())),
    ] {
        assert_eq!(word.parse::<Engine>().unwrap(), engine);
    }
    assert!("kalman".parse::<Engine>().unwrap_err().to_string().contains("mhe"));
    let text = r#"{"moving-horizon": {"samples": 30}}"#;
    let Engine::MovingHorizon(window) = serde_json::from_str(text).unwrap() else { panic!("another engine") };
    assert_eq!((window.samples, window.mass_not_rising), (30, true));
}

#[test]
fn a_window_without_samples_is_refused() {
    let engine = Engine::MovingHorizon(MovingHorizonSettings { samples: 0, ..Default::default() });
    let settings = ObserverSettings { engine, ..ObserverSettings::default() };
    let sensors = [Sensor::typical("pressure").unwrap()];
    let refused = Observer::new(&vessel(), &sensors, &Commissioning::filled(FILL_PA, FILL_K), &settings);
    assert!(refused.unwrap_err().to_string().contains("samples"));
}

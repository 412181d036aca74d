//! Exchange of gas, what is learnt, what cannot be known.
use super::*;
use cylwatch_estimator::observer::{Learned, Quality};

/// Readings of a cylinder at rest at 15 °C, at a pressure.
fn rest(pressure_pa: f64) -> [f64; 3] {
    [FILL_K, FILL_K, pressure_pa]
}

/// A cylinder at rest, whose pressure goes from 200 bar to `end_pa` in ten minutes after two days; with `told`, the observer
/// knows of it. The estimate twelve hours later.
fn exchange(engine: Engine, end_pa: f64, told: bool) -> (Observer, Estimate) {
    let mut observer = observer_with(&SENSORS, &ObserverSettings { engine, ..ObserverSettings::default() });
    let begin_s = 2.0 * 86_400.0_f64;
    let (mut t, mut last) = (0.0_f64, None);
    while t <= begin_s + 600.0 + 12.0 * 3600.0 {
        let part = ((t - begin_s) / 600.0).clamp(0.0, 1.0);
        if told && t == begin_s {
            observer.begin_exchange();
        }
        if told && t == begin_s + 600.0 {
            observer.end_exchange();
        }
        let estimate = observer.step(t, &rest(FILL_PA + part * (end_pa - FILL_PA))).unwrap();
        if told && (begin_s..begin_s + 600.0).contains(&t) {
            assert_eq!(estimate.quality, Quality::Open, "at {t} s");
        }
        last = Some(estimate);
        t += 120.0;
    }
    (observer, last.unwrap())
}

/// Mass that the cylinder holds at 15 °C and a pressure, kg: by the equation of state, without the observer.
fn mass_kg(pressure_pa: f64) -> f64 {
    let vessel = vessel();
    vessel.fluid.density_from_pressure_temperature(pressure_pa, FILL_K).unwrap()
        * vessel.volume.volume_m3(FILL_K, pressure_pa)
}

#[test]
fn after_a_told_discharge_or_refill_the_mass_is_known_again_and_the_constants_are_kept() {
    for end_pa in [1.6e7, 2.3e7] {
        let before = exchange(Engine::Extended, FILL_PA, false).0.learned().unwrap();
        let (observer, last) = exchange(Engine::Extended, end_pa, true);
        // 0.5 bar of the transmitter and 0.3 K of the sensors are 11 g; readings are free of both here.
        assert!(
            (last.mass_kg - mass_kg(end_pa)).abs() < 8e-3,
            "{} kg for {} kg",
            last.mass_kg,
            mass_kg(end_pa)
        );
        assert!(last.mass_sd_kg < 0.03, "sd {}", last.mass_sd_kg);
        // The reference is the gas that is there now, not that of the exchange's first row.
        let expected_pa = last.pressure_expected_pa;
        assert!((expected_pa - end_pa).abs() < 5e4, "{expected_pa} Pa for {end_pa} Pa");
        assert_eq!(last.quality, Quality::Good);
        let after = observer.learned().unwrap();
        let k = after.names.len();
        for i in 0..k {
            let sd = before.covariance[i * k + i].sqrt();
            assert!((after.mean[i] - before.mean[i]).abs() < sd, "{}", after.names[i]);
        }
    }
}

#[test]
fn every_engine_finds_the_mass_after_an_exchange() {
    for engine in [Engine::Unscented, Engine::Stationary] {
        let mut observer =
            observer_with(&SENSORS, &ObserverSettings { engine, ..ObserverSettings::single() });
        let end_pa = 1.5e7;
        let mut last = None;
        for k in 0..400_u32 {
            match k {
                200 => observer.begin_exchange(),
                205 => observer.end_exchange(),
                _ => {}
            }
            let part = ((f64::from(k) - 200.0) / 5.0).clamp(0.0, 1.0);
            let z = rest(FILL_PA + part * (end_pa - FILL_PA));
            last = Some(observer.step(60.0 * f64::from(k), &z).unwrap());
        }
        let last = last.unwrap();
        assert!((last.mass_kg - mass_kg(end_pa)).abs() < 0.02, "{engine:?}: {} kg", last.mass_kg);
    }
}

#[test]
fn an_exchange_that_nobody_told_is_followed_with_less_certainty() {
    let told = exchange(Engine::Extended, 1.6e7, true).1;
    let untold = exchange(Engine::Extended, 1.6e7, false).1;
    assert!(is_sound(&untold));
    assert!((untold.mass_kg - mass_kg(1.6e7)).abs() > (told.mass_kg - mass_kg(1.6e7)).abs());
}

#[test]
fn what_was_learnt_makes_a_better_cold_start() {
    // The same cylinder (its seed is the same) first cools, then, newly commissioned, warms by 65 K.
    let mut teacher = observer(Engine::Extended);
    Case::shock().run(&mut teacher);
    let learned = teacher.learned().unwrap();
    let text = serde_json::to_string(&learned).unwrap();
    let restored: Learned = serde_json::from_str(&text).unwrap();
    assert_eq!(restored, learned);
    let case = Case::new(Chamber::SCENARIOS[1], SHOCK_SEED, 60.0);
    let mut cold = observer(Engine::Extended);
    let mut taught = observer(Engine::Extended).with_learned(restored).unwrap();
    let (cold, taught) = (case.run(&mut cold), case.run(&mut taught));
    let mass_rms = |estimates: &[Estimate]| {
        // Constant errors of the sensors shift the mass for ever: what counts is its change.
        let first = estimates[10].mass_kg - case.truth.mass_kg[10];
        let square = |(e, m): (&Estimate, &f64)| (e.mass_kg - m - first).powi(2);
        let tail = estimates.iter().zip(&case.truth.mass_kg).skip(10);
        (tail.map(square).sum::<f64>() / (estimates.len() - 10) as f64).sqrt()
    };
    assert!(mass_rms(&taught) < 0.8 * mass_rms(&cold), "{} {}", mass_rms(&taught), mass_rms(&cold));
    assert!(taught.last().unwrap().mass_sd_kg < cold.last().unwrap().mass_sd_kg);
}

#[test]
fn before_any_swing_the_mass_cannot_be_told_from_the_offset_of_the_transmitter() {
    let mut observer = observer(Engine::Extended);
    for k in 0..300_u32 {
        observer.step(60.0 * f64::from(k), &rest(FILL_PA)).unwrap();
    }
    let report = observer.observability().unwrap();
    let named = |names: &[&str]| {
        report.undetermined.iter().any(|c| names.iter().all(|name| c.terms.iter().any(|(n, _)| n == name)))
    };
    assert!(named(&["mass_kg", "pressure.offset_pa"]), "{:?}", report.undetermined);
    // The mass relative to commissioning is known far better than the mass.
    let (_, covariance) = observer.state(0).unwrap();
    let mass = observer.cylinder().state_map().mass;
    assert!(observer.mass_change_sd_kg().unwrap() < 0.5 * covariance[(mass, mass)].sqrt());
}

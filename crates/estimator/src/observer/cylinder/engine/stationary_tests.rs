use super::*;
use crate::observer::{Commissioning, LeakHypothesis, Observer, ObserverSettings};
use crate::sensor::{ParameterKind, Sensor};
use crate::thermal::vessel::presets;

const REST: [f64; 3] = [288.15, 288.15, 2e7];

fn observer(sensors: &[&str], engine: Engine) -> Observer {
    let sensors: Vec<Sensor> = sensors.iter().map(|name| Sensor::typical(name).unwrap()).collect();
    let bank = vec![LeakHypothesis::walking_mass(5.0)];
    let settings = ObserverSettings { engine, bank, ..ObserverSettings::default() };
    let commissioning = Commissioning::filled(2e7, 288.15);
    Observer::new(&presets::load("nitrogen-20l").unwrap(), &sensors, &commissioning, &settings).unwrap()
}

fn is_settled(observer: &Observer) -> bool {
    observer.bank.is_settled(0)
}

/// Steps every minute until the gain is stationary; their number.
fn settle(observer: &mut Observer, start_s: f64, most: usize) -> usize {
    for k in 1..=most {
        observer.step(start_s + 60.0 * k as f64, &REST).unwrap();
        if is_settled(observer) {
            return k;
        }
    }
    panic!("not settled after {most} samples");
}

#[test]
fn the_gain_becomes_stationary_at_rest_and_again_after_a_gap_and_an_exchange() {
    let mut observer = observer(&["shoulder", "valve", "pressure"], Engine::Stationary);
    observer.step(0.0, &REST).unwrap();
    let mut t = 60.0 * settle(&mut observer, 0.0, 1200) as f64;
    for interruption in ["missing", "rejected", "late", "exchange"] {
        let mut readings = REST;
        t += 60.0;
        match interruption {
            "missing" => readings[1] = f64::NAN,
            "rejected" => readings[0] += 50.0,
            "late" => t += 1.0,
            _ => observer.begin_exchange(),
        }
        observer.step(t, &readings).unwrap();
        observer.end_exchange();
        assert!(!is_settled(&observer), "{interruption}");
        t += 60.0 * settle(&mut observer, t, 1200) as f64;
    }
}

/// A transmitter whose offset has shifted: its offset is as little known as at first, and the gas no better than before.
#[test]
fn a_forgotten_offset_is_as_uncertain_as_its_prior() {
    let mut observer = observer(&["shoulder", "valve", "pressure"], Engine::Stationary);
    observer.step(0.0, &REST).unwrap();
    let t = 60.0 * settle(&mut observer, 0.0, 1200) as f64;
    let pressure = 2;
    let state = observer.cylinder.state_map().offset_of(pressure, observer.cylinder.sensors()).unwrap();
    let gas = observer.cylinder.state_map().gas;
    let before = observer.bank.variance(0, gas);
    observer.forget_offset(pressure);
    let parameters = observer.cylinder.sensors()[pressure].parameters();
    let prior = parameters.iter().find(|of| of.kind == ParameterKind::Offset).unwrap();
    assert_eq!(observer.bank.variance(0, state), prior.sd * prior.sd);
    let relative = observer.bank.variance(0, gas) / before - 1.0;
    assert!(relative > -1e-9, "{relative}");
    let estimate = observer.step(t + 60.0, &REST).unwrap();
    assert!(estimate.mass_kg.is_finite() && estimate.mass_sd_kg > 0.0);
}

/// The Riccati equation's covariance is where the filter itself goes that moves it.
#[test]
fn the_steady_covariance_is_that_of_the_extended_filter_with_known_constants() {
    let mut settings = ObserverSettings::single();
    settings.ln_inside_film.prior_sd = 0.0;
    settings.ln_inside_film.per_sqrt_s = 0.0;
    settings.ln_capacity.prior_sd = 0.0;
    let mut sensors: Vec<Sensor> =
        ["shoulder", "pressure"].iter().map(|name| Sensor::typical(name).unwrap()).collect();
    use crate::sensor::ParameterKind::{Coupling, Offset, Span, TemperatureCoefficient};
    for sensor in &mut sensors {
        for kind in [Coupling, Offset, Span, TemperatureCoefficient] {
            if let Some(parameter) = sensor.parameter_mut(kind) {
                (parameter.sd, parameter.walk_per_sqrt_s) = (0.0, 0.0);
            }
        }
    }
    let commissioning = Commissioning::filled(2e7, 288.15);
    let vessel = presets::load("nitrogen-20l").unwrap();
    let [mut fixed, mut moving] = [Engine::Stationary, Engine::Extended].map(|engine| {
        let settings = ObserverSettings { engine, ..settings.clone() };
        Observer::new(&vessel, &sensors, &commissioning, &settings).unwrap()
    });
    for k in 0..3000 {
        for observer in [&mut fixed, &mut moving] {
            observer.step(60.0 * f64::from(k), &[288.15, 2e7]).unwrap();
        }
    }
    assert!(is_settled(&fixed));
    let (stated, moved) = (fixed.state(0).unwrap().1, moving.state(0).unwrap().1);
    let states = fixed.cylinder().state_map().clone();
    for i in [states.gas, states.mass, 0] {
        // The steady state supposes twice the noise at rest: more uncertainty, by less than that factor.
        let ratio = stated[(i, i)] / moved[(i, i)];
        assert!((1.0..2.0).contains(&ratio), "state {i}: {ratio}");
    }
}

#[test]
fn without_a_pressure_there_is_no_steady_state_and_the_mass_becomes_uncertain() {
    let mut observer = observer(&["shoulder", "valve"], Engine::Stationary);
    let mut sds = Vec::new();
    for k in 0..600 {
        sds.push(observer.step(60.0 * f64::from(k), &REST[..2]).unwrap().mass_sd_kg);
        assert!(!is_settled(&observer));
    }
    // 5 g in the square root of an hour, ten hours.
    let walked = (sds[599].powi(2) - sds[0].powi(2)).sqrt();
    assert!((walked / (5e-3 * (599.0_f64 / 60.0).sqrt()) - 1.0).abs() < 0.02, "{walked}");
}

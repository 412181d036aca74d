use super::*;
use crate::observer::{Commissioning, ObserverSettings};
use crate::sensor::Sensor;
use crate::thermal::vessel::presets;

/// An observer whose constants do not walk at all.
fn observer(engine: Engine) -> Observer {
    let sensors = ["shoulder", "valve", "pressure"].map(|name| Sensor::typical(name).unwrap());
    let mut settings = ObserverSettings { engine, ..ObserverSettings::default() };
    settings.coupling_memory_s = None;
    settings.constants_memory_s = None;
    let constants = [
        &mut settings.ln_inside_film,
        &mut settings.ln_capacity,
        &mut settings.film_slope,
        &mut settings.valve_sun,
    ];
    for walk in constants {
        (walk.per_sqrt_s, walk.memory_s) = (0.0, None);
    }
    settings.bank.truncate(2);
    let commissioning = Commissioning::filled(2e7, 288.15);
    Observer::new(&presets::load("nitrogen-20l").unwrap(), &sensors, &commissioning, &settings).unwrap()
}

/// A cylinder that cools: readings of no particular truth.
fn readings(k: u32) -> [f64; 3] {
    let t = f64::from(k);
    let cold = 8.0 * (1.0 - (-t / 40.0).exp());
    [
        288.15 - cold,
        288.0 - 1.1 * cold,
        2e7 - 0.75e5 * (cold - 1.0 * (t / 15.0).min(1.0)) + 1e3 * (7.0 * t).sin(),
    ]
}

/// A constant is the same at all times, so its smoothed value is everywhere what the filter knows at the end: to rounding, and
/// whatever was linearised where.
#[test]
fn smoothed_constants_are_those_of_the_end_at_every_time() {
    for engine in [Engine::Extended, Engine::Unscented] {
        let mut smoother = Smoother::new(observer(engine)).unwrap();
        for k in 0..150 {
            let mut z = readings(k);
            if k % 9 == 4 {
                z[k as usize % 3] = f64::NAN;
            }
            // Two rows at one time, and a gap.
            let t = f64::from(k) * 60.0 - if k == 30 { 60.0 } else { 0.0 } + if k > 70 { 500.0 } else { 0.0 };
            let out = smoother.push(t, &z).unwrap();
            assert!(out.is_empty(), "{engine:?}: restarted at row {k}");
        }
        let leading = smoother.observer.cylinder.leading();
        let n = smoother.observer.cylinder.states();
        for index in (0..smoother.record.len()).rev() {
            smoother.smoothed_estimate(index);
            for (member, smoothed) in smoother.members.iter().zip(&smoother.smoothed) {
                let bank = &smoother.observer.bank;
                let x = &bank.members[*member].x;
                for (c, x) in x.iter().enumerate().take(n).skip(leading) {
                    let (sd, prior) =
                        (bank.variance(*member, c).sqrt(), smoother.observer.prior[(c, c)].sqrt());
                    let error = (smoothed.x[c] - x).abs();
                    assert!(error <= 1e-6 * prior, "{engine:?}: row {index}, state {c}: {error}, sd {sd}");
                    assert!((smoothed.p[(c, c)].sqrt() - sd).abs() <= 1e-6 * prior, "row {index}, sd of {c}");
                }
            }
            for (pass, backward) in smoother.record[index].passes.iter().zip(&mut smoother.backward) {
                backward.pass_step(pass);
            }
        }
    }
}

/// Freed mass and gas temperature cut the past off: readings after an exchange do not change what is said of before.
#[test]
fn readings_after_an_exchange_say_nothing_about_the_mass_before() {
    let smoothed = |after_pa: f64| {
        let mut smoother = Smoother::new(observer(Engine::Extended)).unwrap();
        let mut out = Vec::new();
        for k in 0..120 {
            let mut z = readings(k);
            if k == 60 {
                smoother.begin_exchange();
            }
            if k >= 60 {
                z[2] += after_pa;
            }
            out.extend(smoother.push(60.0 * f64::from(k), &z).unwrap());
        }
        out.extend(smoother.finish());
        out
    };
    let (same, less) = (smoothed(0.0), smoothed(-40e5));
    assert!((same[119].mass_kg - less[119].mass_kg).abs() > 0.5);
    for k in 0..60 {
        let difference = (same[k].mass_kg - less[k].mass_kg).abs();
        assert!(difference < 0.1 * same[k].mass_sd_kg, "row {k}: {difference} kg");
    }
}

#[test]
fn only_engines_with_their_own_gains_and_fresh_observers_are_smoothed() {
    for word in ["stationary", "mhe"] {
        let refused = Smoother::new(observer(word.parse().unwrap()));
        assert!(matches!(refused, Err(EstimatorError::EngineNotSmoothed)));
    }
    let refused = Smoother::with_rows(observer(Engine::Extended), 1);
    assert!(matches!(refused, Err(EstimatorError::SmootherRows { rows: 1 })));
    let mut begun = observer(Engine::Extended);
    begun.step(0.0, &readings(0)).unwrap();
    assert!(matches!(Smoother::new(begun), Err(EstimatorError::ObserverBegun)));
}

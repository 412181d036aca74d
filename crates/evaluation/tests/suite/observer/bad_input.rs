//! Missing, stuck and wild readings, time that runs backwards, states that cannot be.
use super::*;
use cylwatch_estimator::EstimatorError;
use cylwatch_estimator::observer::{Outcome, Quality};

/// Run the ramp with readings changed; the estimates.
fn run_changed(observer: &mut Observer, change: impl Fn(f64, &mut [f64; 3])) -> Vec<Estimate> {
    let step = |(t, readings): &(f64, [f64; 3])| {
        let mut readings = *readings;
        change(*t, &mut readings);
        observer.step(*t, &readings).unwrap()
    };
    Case::ramp().rows.iter().map(step).collect()
}

#[test]
fn hours_without_any_reading_leave_a_prediction_that_recovers() {
    let gap = 2.0 * 3600.0..4.0 * 3600.0;
    let mut observer = observer(Engine::Extended);
    let estimates = run_changed(&mut observer, |t, z| {
        if gap.contains(&t) {
            *z = [f64::NAN; 3];
        }
    });
    assert!(estimates.iter().all(is_sound));
    assert_eq!(observer.restarts(), 0);
    let during = |e: &&Estimate| gap.contains(&e.time_s);
    assert!(estimates.iter().filter(during).all(|e| e.quality == Quality::Predicted));
    let index = |t: f64| estimates.iter().position(|e| e.time_s >= t).unwrap();
    let (before, end, after) = (index(gap.start) - 1, index(gap.end) - 1, index(gap.end) + 30);
    assert!(estimates[end].gas_mean_sd_k > 5.0 * estimates[before].gas_mean_sd_k);
    // As far as an observer that missed nothing knows it by then: the ramp goes on.
    let complete = run_changed(&mut self::observer(Engine::Extended), |_, _| {});
    assert!(estimates[after].gas_mean_sd_k < 2.0 * complete[after].gas_mean_sd_k);
    let error = estimates[after].gas_mean_k - Case::ramp().truth.gas_mean_k[after];
    assert!(error.abs() < 0.6, "{error} K half an hour after the gap");
}

#[test]
fn any_single_sensor_may_be_missing_throughout() {
    for (missing, bound_k) in [(SHOULDER, 0.6), (VALVE, 0.6), (PRESSURE, 1.0)] {
        let mut observer = observer(Engine::Extended);
        let estimates = run_changed(&mut observer, |_, z| z[missing] = f64::NAN);
        assert!(estimates.iter().all(is_sound), "without {}", SENSORS[missing]);
        assert!(estimates.iter().all(|e| e.quality == Quality::Degraded));
        let rms = Case::ramp().gas_rms_k(&estimates);
        assert!(rms < bound_k, "without {}: rms {rms} K", SENSORS[missing]);
    }
}

#[test]
fn pressure_alone_says_that_it_does_not_know_the_temperature() {
    let mut observer = observer_with(&["pressure"], &ObserverSettings::default());
    let case = Case::ramp();
    let mut last = None;
    for ((t, z), truth) in case.rows.iter().zip(&case.truth.gas_mean_k) {
        let estimate = observer.step(*t, &z[PRESSURE..]).unwrap();
        assert!(is_sound(&estimate));
        assert!((estimate.gas_mean_k - truth).abs() < 4.0 * estimate.gas_mean_sd_k, "at {t} s");
        last = Some(estimate);
    }
    assert!(last.unwrap().gas_mean_sd_k > 1.0);
}

#[test]
fn temperatures_alone_follow_the_gas_and_leave_the_mass_ever_less_certain() {
    let mut observer = observer_with(&["shoulder", "valve"], &ObserverSettings::default());
    let estimates: Vec<Estimate> =
        Case::ramp().rows.iter().map(|(t, z)| observer.step(*t, &z[..PRESSURE]).unwrap()).collect();
    assert!(estimates.iter().all(is_sound));
    assert!(estimates.iter().all(|e| e.pressure_pa.is_nan() && e.pressure_expected_pa.is_finite()));
    assert!(Case::ramp().gas_rms_k(&estimates) < 1.0);
    assert!(estimates.windows(2).all(|w| w[1].mass_sd_kg >= w[0].mass_sd_kg));
}

#[test]
fn a_spike_of_each_sensor_is_rejected_and_changes_little() {
    let at = 7200.0;
    for (sensor, spike) in [(SHOULDER, 40.0), (VALVE, -60.0), (PRESSURE, 80e5)] {
        let mut observer = observer(Engine::Extended);
        let mut calm = self::observer(Engine::Extended);
        for (t, readings) in &Case::ramp().rows {
            let mut spiked = *readings;
            spiked[sensor] += if *t == at { spike } else { 0.0 };
            let estimate = observer.step(*t, &spiked).unwrap();
            let reference = calm.step(*t, readings).unwrap();
            if *t == at {
                assert_eq!(observer.innovations()[sensor].outcome, Outcome::Rejected, "{}", SENSORS[sensor]);
                assert_eq!(estimate.quality, Quality::Degraded);
            }
            assert!((estimate.gas_mean_k - reference.gas_mean_k).abs() < 0.3, "{} at {t} s", SENSORS[sensor]);
        }
    }
}

/// A sensor that sticks while the chamber warms pulls the estimate a little at each sample, within every gate.
#[test]
fn a_stuck_sensor_is_found_and_left_out() {
    let stuck_from = 2.0 * 3600.0;
    for (sensor, bound_k) in [(SHOULDER, 0.8), (VALVE, 0.8), (PRESSURE, 1.2)] {
        let stuck = Case::ramp().rows.iter().find(|(t, _)| *t >= stuck_from).unwrap().1[sensor];
        let mut observer = observer(Engine::Extended);
        let estimates = run_changed(&mut observer, |t, z| {
            if t >= stuck_from {
                z[sensor] = stuck;
            }
        });
        assert!(estimates.iter().all(is_sound));
        let rms = Case::ramp().gas_rms_k(&estimates);
        assert!(rms < bound_k, "{} stuck: rms {rms} K", SENSORS[sensor]);
        assert_eq!(estimates.last().unwrap().quality, Quality::Degraded);
        let counts: Vec<u64> = observer.faults().map(|count| count.stuck).collect();
        assert!(counts[sensor] > 100, "{counts:?}");
        assert_eq!(counts.iter().sum::<u64>(), counts[sensor], "only one is stuck: {counts:?}");
    }
}

#[test]
fn time_that_runs_backwards_is_refused_and_the_observer_unharmed() {
    let case = Case::ramp().until(1.0);
    let mut disturbed = observer(Engine::Extended);
    let mut calm = observer(Engine::Extended);
    for (t, readings) in &case.rows {
        let estimate = disturbed.step(*t, readings).unwrap();
        for wrong_s in [*t - 1.0, f64::NAN, f64::NEG_INFINITY] {
            let refused = disturbed.step(wrong_s, readings);
            assert!(matches!(refused, Err(EstimatorError::TimeBackwards { .. })), "{wrong_s}");
        }
        let short = disturbed.step(*t, &readings[..2]);
        assert!(matches!(short, Err(EstimatorError::RowLength { expected: 3, found: 2 })));
        assert_eq!(estimate, calm.step(*t, readings).unwrap());
    }
}

#[test]
fn infinite_readings_count_as_missing() {
    let missing = |value: f64| {
        let mut observer = observer(Engine::Extended);
        run_changed(&mut observer, |t, z| {
            if t > 3600.0 {
                z[VALVE] = value;
            }
        })
    };
    assert_eq!(missing(f64::INFINITY), missing(f64::NAN));
}

/// Readings that no cylinder can give, long enough to be taken up: the observer begins again or follows, but is never lost.
#[test]
fn impossible_readings_never_end_in_nan_in_any_engine() {
    for engine in ["ekf", "ukf", "stationary", "mhe"] {
        let mut settings = ObserverSettings { engine: engine.parse().unwrap(), ..ObserverSettings::single() };
        if let Engine::MovingHorizon(window) = &mut settings.engine {
            window.samples = 5;
        }
        let mut observer = observer_with(&SENSORS, &settings);
        let case = Case::ramp().until(1.5);
        for (i, (t, readings)) in case.rows.iter().enumerate() {
            let readings = match i {
                20..=40 => [1.0, 1e6, -1e9],
                _ => *readings,
            };
            let estimate = observer.step(*t, &readings).unwrap();
            assert!(is_sound(&estimate), "{engine} at {t} s: {estimate:?}");
        }
        let last = case.rows.len() - 1;
        let gas = observer.cylinder().state_map().gas;
        let error = observer.state(0).unwrap().0[gas] - case.truth.gas_mean_k[last];
        assert!(error.abs() < 20.0, "{engine}: {error} K");
    }
}

#[test]
fn a_doubled_row_tells_nothing_new() {
    let case = Case::ramp().until(2.0);
    let (mut once, mut twice) = (observer(Engine::Extended), observer(Engine::Extended));
    for (t, readings) in &case.rows {
        let expected = once.step(*t, readings).unwrap();
        twice.step(*t, readings).unwrap();
        let doubled = twice.step(*t, readings).unwrap();
        assert_ne!(doubled.quality, Quality::Restarted);
        assert!((doubled.gas_mean_k - expected.gas_mean_k).abs() < 0.1 * expected.gas_mean_sd_k, "at {t} s");
        assert!((doubled.gas_mean_sd_k / expected.gas_mean_sd_k - 1.0).abs() < 0.1, "at {t} s");
    }
}

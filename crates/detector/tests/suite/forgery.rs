//! Cylinders and states with anything in them and the right check sum: refused, or taken by a monitor that goes on with them. `FORGERIES=100000 cargo test -p
//! cylwatch-detector forgery -- --nocapture` is the long run.
use crate::allocations::{HAPPENS, row};
use crate::mutation::{Random, count, forged};
use cylwatch_detector::DetectorError;
use cylwatch_detector::compiled::CompiledCylinder;
use cylwatch_detector::estimator::observer::Commissioning;
use cylwatch_detector::estimator::sensor::Sensor;
use cylwatch_detector::estimator::thermal::vessel::presets;
use cylwatch_detector::monitor::{Monitor, MonitorSettings};
use cylwatch_detector::prognosis::Contents;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::channel;
use std::time::{Duration, Instant};

/// Cases, and how long one may take: a thousand times what it takes.
const USUAL: usize = 2000;
const LONGEST: Duration = Duration::from_secs(20);
/// Cases that may fall before the others are not tried any more.
const MOST: usize = 200;

fn cylinder() -> CompiledCylinder {
    let sensors = ["shoulder", "valve", "pressure"].map(|name| Sensor::typical(name).unwrap());
    CompiledCylinder {
        vessel: presets::load("nitrogen-20l").unwrap(),
        sensors: sensors.to_vec(),
        commissioning: Commissioning::filled(200e5, 288.15),
        settings: MonitorSettings::default(),
        learned: None,
    }
}

/// Rows of some minutes: weather, and a pressure that jumps.
fn feed(monitor: &mut Monitor, minutes: std::ops::Range<u32>) -> Result<(), DetectorError> {
    for minute in minutes {
        let phase = f64::from(minute) / 150.0;
        let (noise, gas_k) = (f64::from(minute * 7919 % 13) / 130.0, 288.0 + 3.0 * phase.sin());
        let jump = if minute % 100 > 95 { 0.97 } else { 1.0 };
        let row = [gas_k + noise, gas_k + 0.1 - noise, jump * 200e5 * gas_k / 288.15 + 1e3 * noise];
        monitor.step(60.0 * f64::from(minute), &row)?;
    }
    monitor.save()?;
    Ok(())
}

/// A cylinder with what an observer of it has learnt, and a state in the middle of much.
fn originals() -> (Vec<u8>, Vec<u8>) {
    let mut cylinder = cylinder();
    let mut monitor = cylinder.monitor().unwrap();
    feed(&mut monitor, 0..1597).unwrap();
    let state = monitor.save().unwrap();
    cylinder.learned = monitor.observer().learned();
    (cylinder.to_bytes().unwrap(), state)
}

/// What becomes of many forgeries: nothing panics, and nothing goes on for ever.
fn try_all(original: &[u8], foreign: &[u8], seed: u64, take: fn(&[u8]) -> Result<(), DetectorError>) {
    let mut random = Random(seed);
    let (mut refused, mut taken, mut fell) = (BTreeMap::new(), 0, BTreeMap::new());
    let mut slowest = Duration::ZERO;
    for round in 0..count("FORGERIES", USUAL) {
        assert!(fell.len() < MOST, "{fell:?}");
        let bytes = forged(original, foreign, &mut random);
        let (sender, receiver) = channel();
        let begun = Instant::now();
        std::thread::spawn(move || {
            let done = catch_unwind(AssertUnwindSafe(|| take(&bytes).map_err(|error| error.to_string())));
            // Nobody waits any more for one that took too long.
            let _ = sender.send(done.map_err(|_| ()));
        });
        match receiver.recv_timeout(LONGEST) {
            Ok(Ok(Ok(()))) => taken += 1,
            Ok(Ok(Err(why))) => *refused.entry(why).or_insert(0_usize) += 1,
            Ok(Err(())) => drop(fell.insert(round, "panicked")),
            Err(_) => drop(fell.insert(round, "took too long")),
        }
        slowest = slowest.max(begun.elapsed());
    }
    let all: usize = refused.values().sum();
    println!("{taken} taken, {all} refused, {} fell: {fell:?}; the slowest took {slowest:?}", fell.len());
    for (why, count) in &refused {
        println!("{count:8} {why}");
    }
    assert!(fell.is_empty(), "{fell:?}");
    assert!(taken > 0 && all > 0);
}

/// What bounds the values of a state refuses none that a monitor has come to, whatever happens, and changes no bit of it.
#[test]
fn every_state_that_a_monitor_comes_to_is_taken_as_it_is() {
    const DAY_S: f64 = 86_400.0;
    let mut cylinder = cylinder();
    let contents = Contents::of(&cylinder.vessel);
    for (number, happens) in HAPPENS.into_iter().enumerate() {
        // Every other one with rows that are held back.
        (cylinder.settings.intake.lateness_s, cylinder.settings.intake.step_s) =
            if number % 2 == 0 { (0.0, 60.0) } else { (300.0, 0.0) };
        let mut rng = ChaCha8Rng::seed_from_u64(11);
        let mut monitor = cylinder.monitor().unwrap();
        for minute in 0..2800_u32 {
            let gap_s = if minute > 2500 { 9000.0 } else { 0.0 };
            let set_s = if minute > 2600 { 7200.0 } else { 0.0 };
            let time_s = 60.0 * f64::from(minute) + gap_s;
            assert!(time_s < 2.1 * DAY_S);
            monitor.take(time_s - set_s, &row(&contents, &mut rng, time_s, happens)).unwrap();
            if minute % 40 == 0 {
                let state = monitor.save().unwrap();
                let restored = cylinder.restored(&state).map(|restored| restored.save().unwrap());
                assert_eq!(restored.unwrap(), state, "{happens}, minute {minute}");
            }
            while monitor.next_output().unwrap().is_some() {}
        }
    }
}

#[test]
fn no_forged_cylinder_makes_a_monitor_panic_or_hang() {
    let (cylinder, state) = originals();
    try_all(&cylinder, &state, 0x5eed_0003, |bytes| {
        feed(&mut CompiledCylinder::from_bytes(bytes)?.monitor()?, 0..6)
    });
}

#[test]
fn no_forged_state_makes_a_monitor_panic_or_hang() {
    let (blob, state) = originals();
    try_all(&state, &blob, 0x5eed_0004, |bytes| feed(&mut cylinder().restored(bytes)?, 1597..1603));
}

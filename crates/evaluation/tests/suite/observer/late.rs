//! Rows in any order give what rows in order give, to the last digit.
use super::*;
use cylwatch_estimator::observer::{Insertion, LateSamples};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const SPAN_S: f64 = 1800.0;

/// The observer's whole knowledge at the end, without loss of a digit.
fn knowledge(observer: &Observer) -> Vec<u64> {
    let leaks = observer.leaks().len();
    let states = (0..leaks).filter_map(|member| observer.state(member));
    states.flat_map(|(x, p)| x.iter().chain(p.iter()).map(|v| v.to_bits()).collect::<Vec<_>>()).collect()
}

fn in_order(engine: Engine, rows: &[(f64, [f64; 3])], events: &[usize; 2]) -> (Vec<Estimate>, Vec<u64>) {
    let mut observer = short(engine);
    let mut estimates = Vec::new();
    for (i, (t, readings)) in rows.iter().enumerate() {
        estimates.push(observer.step(*t, readings).unwrap());
        if i == events[0] {
            observer.begin_exchange();
        }
        if i == events[1] {
            observer.end_exchange();
        }
    }
    let knowledge = knowledge(&observer);
    (estimates, knowledge)
}

/// Two members, and a short window where there is one.
fn short(mut engine: Engine) -> Observer {
    if let Engine::MovingHorizon(window) = &mut engine {
        window.samples = 3;
    }
    let mut settings = ObserverSettings { engine, ..ObserverSettings::default() };
    settings.bank.truncate(2);
    observer_with(&SENSORS, &settings)
}

#[test]
fn rows_out_of_order_give_the_same_to_the_last_digit_with_every_engine() {
    for engine in ["ekf", "ukf", "stationary", "mhe"].map(|word| word.parse::<Engine>().unwrap()) {
        let few = matches!(engine, Engine::Unscented | Engine::MovingHorizon(_));
        let rows = Case::shock().until(if few { 0.3 } else { 1.0 }).rows;
        let (expected, knowledge_in_order) = in_order(engine, &rows, &[usize::MAX; 2]);
        let mut late = LateSamples::new(short(engine), SPAN_S).unwrap();
        let mut random = ChaCha8Rng::seed_from_u64(11);
        // Each row is held back for up to five others; every third is torn into two rows of one time.
        let mut arrivals: Vec<(usize, usize)> =
            (0..rows.len()).map(|i| (i + random.random_range(0..6_usize), i)).collect();
        arrivals.sort();
        let (mut inserted, mut merged) = (0, 0);
        for (_, i) in arrivals {
            let (t, mut readings) = rows[i];
            let whole = readings;
            if i % 3 == 0 {
                readings[PRESSURE] = f64::NAN;
            }
            let insertion = late.insert(t, &readings).unwrap();
            inserted += usize::from(matches!(insertion, Insertion::Inserted { .. }));
            if i % 3 == 0 {
                let rest = [f64::NAN, f64::NAN, whole[PRESSURE]];
                merged += usize::from(matches!(late.insert(t, &rest).unwrap(), Insertion::Merged { .. }));
            }
        }
        assert!(inserted > rows.len() / 3 && merged == rows.len().div_ceil(3));
        assert_eq!(knowledge(late.observer()), knowledge_in_order, "{engine:?}");
        let kept: Vec<&Estimate> = late.estimates().collect();
        let tail = &expected[expected.len() - kept.len()..];
        assert!(kept.len() > 50);
        assert!(kept.iter().zip(tail).all(|(kept, expected)| *kept == expected), "{engine:?}");
        assert_eq!(late.too_late(), 0);
    }
}

#[test]
fn events_keep_their_place_among_late_rows() {
    let rows = Case::ramp().until(1.0).rows;
    let (expected, knowledge_in_order) = in_order(Engine::Extended, &rows, &[20, 30]);
    let mut late = LateSamples::new(short(Engine::Extended), SPAN_S).unwrap();
    let held_back = [5, 18, 25, 33];
    for (i, (t, readings)) in rows.iter().enumerate() {
        if !held_back.contains(&i) {
            late.insert(*t, readings).unwrap();
        }
        if i == 20 {
            late.begin_exchange();
        }
        if i == 30 {
            late.end_exchange();
        }
        // Each comes twenty-two rows, most of half an hour, after its time.
        if let Some(&missed) = held_back.iter().find(|&&missed| missed + 22 == i) {
            let (t, readings) = rows[missed];
            assert!(matches!(late.insert(t, &readings).unwrap(), Insertion::Inserted { .. }));
        }
    }
    assert_eq!(knowledge(late.observer()), knowledge_in_order);
    assert_eq!(*late.estimates().last().unwrap(), *expected.last().unwrap());
}

#[test]
fn a_row_older_than_the_span_is_counted_and_changes_nothing() {
    let rows = Case::ramp().until(2.0).rows;
    let mut late = LateSamples::new(short(Engine::Extended), SPAN_S).unwrap();
    for (t, readings) in &rows {
        late.insert(*t, readings).unwrap();
    }
    let before = knowledge(late.observer());
    let last_s = rows[rows.len() - 1].0;
    for t in [0.0, 30.0, last_s - SPAN_S - 30.0] {
        assert_eq!(late.insert(t, &[200.0, 200.0, 1e6]).unwrap(), Insertion::TooLate);
    }
    assert_eq!(late.too_late(), 3);
    assert_eq!(knowledge(late.observer()), before);
    assert!(matches!(late.insert(last_s - SPAN_S + 30.0, &rows[90].1).unwrap(), Insertion::Inserted { .. }));
}

#[test]
fn a_row_before_the_first_one_becomes_the_first() {
    let rows = Case::ramp().until(0.5).rows;
    let (_, knowledge_in_order) = in_order(Engine::Extended, &rows, &[usize::MAX; 2]);
    let mut late = LateSamples::new(short(Engine::Extended), 7200.0).unwrap();
    for (t, readings) in rows[3..].iter().chain(&rows[..3]) {
        late.insert(*t, readings).unwrap();
    }
    assert_eq!(knowledge(late.observer()), knowledge_in_order);
}

#[test]
fn rows_that_are_none_are_refused_and_change_nothing() {
    let rows = Case::ramp().until(0.5).rows;
    let mut late = LateSamples::new(short(Engine::Extended), SPAN_S).unwrap();
    for (t, readings) in &rows {
        late.insert(*t, readings).unwrap();
    }
    let before = knowledge(late.observer());
    assert!(late.insert(f64::NAN, &rows[0].1).is_err());
    assert!(late.insert(60.0, &[280.0]).is_err());
    assert_eq!(knowledge(late.observer()), before);
    assert!(LateSamples::new(short(Engine::Extended), 0.0).is_err());
}

use cylwatch_estimator::observer::Commissioning;
use cylwatch_estimator::sensor::Sensor;
use cylwatch_estimator::thermal::vessel::{InnerVolume, Vessel, presets};

use super::*;

const FILL_K: f64 = 288.15;

fn observer() -> Observer {
    let sensors = ["shoulder", "valve", "pressure"].map(|name| Sensor::typical(name).unwrap());
    let filled = Commissioning::filled(2e7, FILL_K);
    Observer::new(&presets::load("nitrogen-20l").unwrap(), &sensors, &filled, &observer_settings()).unwrap()
}

/// Observer and evidence after so many hours at rest in which the pressure falls by so much in each, bar, from one hour on.
fn after(hours: usize, leak: (f64, f64)) -> (Observer, Evidence, f64) {
    let (mut observer, mut evidence) = (observer(), Evidence::new(&observer_settings()));
    let mut time_s = 0.0;
    for minute in 0..60 * hours {
        time_s = 60.0 * minute as f64;
        // What never changes counts as stuck.
        let noise = if minute % 2 == 0 { 0.02 } else { -0.02 };
        let lost_pa = 1e5 * leak.0 * (time_s / HOUR_S - leak.1).max(0.0);
        observer.step(time_s, &[FILL_K + noise, FILL_K - noise, 2e7 - lost_pa + 1e4 * noise]).unwrap();
        evidence.update(&observer, time_s, (1.0, 0.0));
    }
    (observer, evidence, time_s)
}

#[test]
fn each_scale_has_the_largest_score_of_its_ages() {
    let (observer, evidence, time_s) = after(40, (0.2, 20.0));
    let statistics = evidence.statistics();
    let mut largest = [0.0_f64; 3];
    for onset in observer.onsets() {
        let age_h = (time_s - onset.since_s) / HOUR_S;
        let scale = if age_h <= 1.1 { 0 } else { 1 + usize::from(age_h > 12.0) };
        largest[scale] = largest[scale].max(onset.rate_kg_s / onset.sd_kg_s);
    }
    // At rest next to nothing is considered.
    for (found, largest) in statistics.iter().zip(largest) {
        assert!((found * evidence.error_sd() / largest - 1.0).abs() < 0.05, "{found} {largest}");
    }
    assert_eq!(statistics[3..], [0.0, 0.0]);
    assert!(statistics[2] > statistics[0] && statistics[2] > 10.0, "{statistics:?}");
}

#[test]
fn what_the_surroundings_do_weighs_on_young_onsets() {
    let mut evidence = Evidence::new(&observer_settings());
    evidence.considered_kg = 0.01;
    // Three times the memory of 1200 s is an hour: up to then all of it may be there, of older ones its part.
    let rate = |age_s: f64| evidence.considered_kg_s(age_s) * age_s;
    assert!((rate(600.0) - 0.01).abs() < 1e-15 && (rate(HOUR_S) - 0.01).abs() < 1e-15);
    assert!((rate(24.0 * HOUR_S) - 0.01 / 24.0).abs() < 1e-15);
}

#[test]
fn the_same_score_counts_for_less_in_a_cylinder_that_is_restless() {
    let (observer, evidence, time_s) = after(40, (0.2, 20.0));
    let mut restless = evidence.clone();
    for _ in 0..1000 {
        restless.usual.update(HOUR_S, 4.0);
    }
    let [calm, shaken] = [evidence, restless].map(|mut evidence| {
        let sd = evidence.error_sd();
        (evidence.update(&observer, time_s + 1.0, (1.0, 0.0))[2], sd)
    });
    assert!((calm.0 / shaken.0 * calm.1 / shaken.1 - 1.0).abs() < 0.02 && shaken.1 > 1.9);
    let mut doubted = after(40, (0.2, 20.0)).1;
    let halved = doubted.update(&observer, time_s + 1.0, (2.0, 0.0))[2];
    assert!((halved / calm.0 - 0.5).abs() < 1e-9, "{halved} {}", calm.0);
}

#[test]
fn what_the_mass_may_be_off_by_is_no_loss() {
    let (observer, mut evidence, time_s) = after(40, (0.2, 20.0));
    let certain = evidence.clone().update(&observer, time_s + 1.0, (1.0, 0.0));
    // 0.2 bar of 200 in each of 20 hours.
    let lost_kg = 4.477 * 0.02;
    let doubted = evidence.update(&observer, time_s + 1.0, (1.0, lost_kg / 2.0));
    assert!(doubted[2] < 0.7 * certain[2] && doubted[2] > 0.3 * certain[2], "{doubted:?} of {certain:?}");
    assert_eq!(evidence.update(&observer, time_s + 2.0, (1.0, 2.0 * lost_kg)), [0.0; 5]);
}

#[test]
fn a_calm_cylinder_learns_that_it_is_calm() {
    let (_, evidence, _) = after(240, (0.0, 0.0));
    assert!(evidence.error_sd() < 0.7 * Evidence::new(&observer_settings()).error_sd());
    assert!(evidence.statistics().iter().all(|statistic| *statistic < 2.0));
}

#[test]
fn a_leak_is_not_what_is_usual_however_long_it_has_been_there() {
    for (rate_bar_h, begins_h) in [(0.02, 0), (0.2, 0), (0.2, 60)] {
        let before = after(begins_h, (0.0, 0.0)).1.error_sd();
        let leaking = after(120, (rate_bar_h, begins_h as f64)).1.error_sd();
        assert!(leaking < 1.01 * before, "{rate_bar_h} bar/h since {begins_h} h: {leaking} {before}");
    }
}

#[test]
fn an_exchange_of_gas_leaves_no_evidence() {
    let (mut observer, mut evidence, time_s) = after(30, (1.0, 20.0));
    assert!(evidence.statistics()[1] > 5.0);
    observer.begin_exchange();
    observer.step(time_s + 60.0, &[FILL_K, FILL_K, 1.9e7]).unwrap();
    assert_eq!(evidence.update(&observer, time_s + 60.0, (1.0, 0.0)), [0.0; 5]);
}

#[test]
fn samples_that_are_not_later_change_nothing() {
    let (observer, mut evidence, time_s) = after(5, (1.0, 1.0));
    let before = evidence.clone();
    evidence.update(&observer, time_s, (3.0, 0.0));
    evidence.update(&observer, time_s - 60.0, (3.0, 0.0));
    assert_eq!(evidence, before);
    evidence.forget();
    assert_eq!(evidence.statistics(), [0.0; 5]);
}

#[test]
fn a_value_at_a_threshold_stands_for_its_mean_time() {
    for years in [1.0, 7.3, 250.0] {
        let mean_time_s = years * 365.25 * 86_400.0;
        let levels = Tails::CYLINDER.thresholds(mean_time_s).unwrap().levels;
        assert!((Tails::CYLINDER.mean_time_s(&levels) / mean_time_s - 1.0).abs() < 1e-9);
        // One of them is enough.
        for scale in Scale::ALL {
            let mut one = [0.0; Scale::ALL.len()];
            one[scale as usize] = levels[scale as usize];
            assert!((Tails::CYLINDER.mean_time_s(&one) / mean_time_s - 1.0).abs() < 1e-9);
        }
    }
    let at = |value: f64| Tails::CYLINDER.mean_time_s(&[value; Scale::ALL.len()]);
    // What speaks for nothing is never rare, and little evidence leaves the prior odds of 1:100 of a leak in ten years: it comes up far more often than that.
    let by_prior_s = 0.01 * 10.0 * 365.25 * 86_400.0;
    assert!(
        at(-1.0) == 0.0 && at(0.0) == 0.0 && at(0.5) > 0.0 && at(0.5) < 0.2 * by_prior_s && at(1000.0) > 1e15
    );
}

#[test]
fn thresholds_rise_with_the_mean_time_and_name_the_scale() {
    let year_s = 365.25 * 86_400.0;
    let [one, ten, hundred] = [1.0, 10.0, 100.0].map(|n| Tails::CYLINDER.thresholds(n * year_s).unwrap());
    for scale in Scale::ALL {
        assert!(one.of(scale) < ten.of(scale) && ten.of(scale) < hundred.of(scale), "{scale:?}");
    }
    assert_eq!(ten.alarm(&[0.0; 5]), None);
    let mut statistics = ten.levels.map(|level| 0.99 * level);
    assert_eq!(ten.alarm(&statistics), None);
    statistics[3] = 1.2 * ten.levels[3];
    statistics[1] = 1.1 * ten.levels[1];
    assert_eq!(ten.alarm(&statistics), Some(Scale::Week));
    assert!(Tails::CYLINDER.thresholds(0.0).is_err());
}

#[test]
fn a_built_in_vessel_has_tails_of_its_own_while_it_is_that_vessel_and_filled_as_it_was_commissioned() {
    let vessel = presets::load("nitrogen-20l").unwrap();
    let own = Tails::of(&vessel, 200e5);
    assert!(own != Tails::CYLINDER && own == Tails::of(&vessel, 180e5));
    assert_eq!(Tails::of(&vessel, 110e5), Tails::CYLINDER);
    assert_eq!(Tails::of(&vessel, 5e5), Tails::TANK);
    let larger = Vessel { volume: InnerVolume { volume_m3: 0.05, ..vessel.volume }, ..vessel };
    assert_eq!(Tails::of(&larger, 200e5), Tails::CYLINDER);
}

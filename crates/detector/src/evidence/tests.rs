use cylwatch_estimator::thermal::vessel::{InnerVolume, Vessel, presets};

use super::*;

const SECOND: f64 = 1.0 / 3600.0;

fn estimate(time_s: f64, quality: Quality) -> Estimate {
    Estimate {
        time_s,
        gas_mean_k: 288.0,
        gas_mean_sd_k: 0.1,
        mass_kg: 4.4,
        mass_sd_kg: 8e-3,
        leak_kg_s: 0.0,
        leak_sd_kg_s: 1e-8,
        pressure_pa: 2e7,
        pressure_expected_pa: 2e7,
        p15_pa: 2e7,
        quality,
    }
}

/// Members of the usual bank whose fastest rate is `z` standard deviations, and whose freest mass misses `missing_g`.
fn leaks(z: f64, missing_g: f64) -> Vec<Leak> {
    let leak = |z: f64, missing_g: f64, mass_sd_g: f64| Leak {
        rate_kg_s: z * 1e-4 * SECOND,
        sd_kg_s: 1e-4 * SECOND,
        mass_kg: 4.4 - 1e-3 * missing_g,
        mass_sd_kg: 1e-3 * mass_sd_g,
        covariance_kg2_s: 0.0,
        begun_anew: false,
    };
    vec![leak(0.0, 0.0, 8.0), leak(z, 0.0, 6.0), leak(9.0, 0.0, 6.0), leak(0.0, missing_g, 10.0)]
}

fn evidence() -> Evidence {
    Evidence::try_new(&observer_settings()).unwrap()
}

#[test]
fn low_passes_of_a_steady_rate_are_those_of_the_closed_form() {
    let mut evidence = evidence();
    for n in 0..=24 * 60 {
        evidence.update(&estimate(60.0 * f64::from(n), Quality::Good), &leaks(0.8, 0.0), Doubt::NONE);
    }
    let [_, half_day, day, week, month] = evidence.statistics().map(|value| value * evidence.usual.sd());
    for (found, hours) in [(half_day, 4.0), (day, 24.0), (week, 96.0)] {
        let expected = 0.8 * (1.0 - (-24.0_f64 / hours).exp());
        assert!((found - expected).abs() < 1e-12, "{hours} h: {found} {expected}");
    }
    // One behind the other: 1 - (a e^(-t/a) - b e^(-t/b))/(a - b).
    let (a, b): (f64, f64) = (168.0, 96.0);
    let expected = 0.8 * (1.0 - (a * (-24.0 / a).exp() - b * (-24.0 / b).exp()) / (a - b));
    assert!((month / expected - 1.0).abs() < 2e-3, "{month} {expected}");
}

#[test]
fn a_missing_mass_is_over_what_is_in_doubt_of_it() {
    let missing = |doubt: Doubt| {
        let mut evidence = evidence();
        for n in 0..600 {
            evidence.update(&estimate(60.0 * f64::from(n), Quality::Good), &leaks(0.0, 22.0), doubt);
        }
        evidence.statistics()[0] * evidence.usual_missing.sd()
    };
    // 22 g over 8.8 g, a part in five hundred of the mass, and with as much again by the surroundings.
    assert!((missing(Doubt::NONE) - 2.5).abs() < 1e-9);
    let tunnel = Doubt { passing_kg: 8.8e-3, ..Doubt::NONE };
    assert!((missing(tunnel) - 2.5 / 2_f64.sqrt()).abs() < 1e-9);
    assert!((missing(Doubt { divisor: 4.0, ..Doubt::NONE }) - 0.625).abs() < 1e-9);
}

#[test]
fn the_same_rate_counts_for_less_in_a_cylinder_that_is_restless() {
    let half_day = |swing: f64| {
        let mut evidence = evidence();
        for n in 0..30 * 24 {
            let z = swing * (f64::from(n) * std::f64::consts::TAU / 24.0).sin();
            evidence.update(&estimate(3600.0 * f64::from(n), Quality::Good), &leaks(z, 0.0), Doubt::NONE);
        }
        for n in 30 * 24..31 * 24 {
            evidence.update(&estimate(3600.0 * f64::from(n), Quality::Good), &leaks(1.0, 0.0), Doubt::NONE);
        }
        evidence.statistics()[1]
    };
    assert!(half_day(0.1) > 5.0 * half_day(2.0), "{} {}", half_day(0.1), half_day(2.0));
}

#[test]
fn a_member_that_begins_anew_does_not_hide_the_mass_it_gave_up() {
    let mut evidence = evidence();
    let mut now = leaks(0.0, 48.0);
    for n in 0..600 {
        evidence.update(&estimate(60.0 * f64::from(n), Quality::Good), &now, Doubt::NONE);
    }
    let before = evidence.statistics()[0];
    (now[2].mass_kg, now[2].begun_anew) = (now[3].mass_kg, true);
    evidence.update(&estimate(36_000.0, Quality::Good), &now, Doubt::NONE);
    assert!((evidence.statistics()[0] - before).abs() < 0.01 * before);
    now[2].begun_anew = false;
    for n in 1..600 {
        evidence.update(&estimate(36_000.0 + 60.0 * f64::from(n), Quality::Good), &now, Doubt::NONE);
    }
    assert!(evidence.statistics()[0] < 0.05 * before);
}

/// Evidence after ten hours of a leak, and then one sample.
fn then(quality: Quality, z: f64) -> Statistics {
    let mut evidence = evidence();
    for n in 0..600 {
        evidence.update(&estimate(60.0 * f64::from(n), Quality::Good), &leaks(2.0, 30.0), Doubt::NONE);
    }
    assert!(evidence.statistics().iter().all(|statistic| *statistic > 0.0));
    evidence.update(&estimate(36_000.0, quality), &leaks(z, 0.0), Doubt::NONE)
}

#[test]
fn an_exchange_of_gas_and_a_restart_leave_no_evidence() {
    assert_eq!(then(Quality::Open, 0.0), [0.0; 5]);
    assert_eq!(then(Quality::Restarted, 0.0), [0.0; 5]);
}

#[test]
fn a_reading_taken_after_many_rejections_leaves_the_evidence_of_the_rate() {
    let [missing, rest @ ..] = then(Quality::Open, 2.0);
    assert_eq!(missing, 0.0);
    assert!(rest.iter().all(|statistic| *statistic > 0.0));
}

#[test]
fn samples_that_are_not_later_and_foreign_banks_change_nothing() {
    let mut evidence = evidence();
    evidence.update(&estimate(0.0, Quality::Good), &leaks(1.0, 5.0), Doubt::NONE);
    evidence.update(&estimate(60.0, Quality::Good), &leaks(1.0, 5.0), Doubt::NONE);
    let before = evidence.clone();
    evidence.update(&estimate(60.0, Quality::Good), &leaks(2.0, 9.0), Doubt::NONE);
    evidence.update(&estimate(30.0, Quality::Good), &leaks(2.0, 9.0), Doubt::NONE);
    evidence.update(&estimate(120.0, Quality::Good), &leaks(2.0, 9.0)[..2], Doubt::NONE);
    assert_eq!(evidence, before);
}

#[test]
fn a_bank_without_the_members_is_refused() {
    let settings = ObserverSettings::single();
    assert!(Evidence::try_new(&settings).is_err());
    let mut settings = observer_settings();
    settings.bank.truncate(3);
    settings.bank[0].mass_walk_kg_per_sqrt_s = 0.0;
    assert!(Evidence::try_new(&settings).is_err());
}

#[test]
fn a_value_at_a_threshold_stands_for_its_mean_time() {
    for years in [1.0, 7.3, 250.0] {
        let mean_time_s = years * 365.25 * 86_400.0;
        let levels = Tails::default().thresholds(mean_time_s).unwrap().levels;
        assert!((Tails::default().mean_time_s(&levels) / mean_time_s - 1.0).abs() < 1e-9);
        // One of them is enough.
        for scale in Scale::ALL {
            let mut one = [0.0; Scale::ALL.len()];
            one[scale as usize] = levels[scale as usize];
            assert!((Tails::default().mean_time_s(&one) / mean_time_s - 1.0).abs() < 1e-9);
        }
    }
    let at = |value: f64| Tails::default().mean_time_s(&[value; Scale::ALL.len()]);
    // No evidence at all leaves the prior odds of 1:100 of a leak in ten years: it comes up far more often than that.
    let by_prior_s = 0.01 * 10.0 * 365.25 * 86_400.0;
    assert!(at(-1.0) < at(0.0) && at(0.0) < 0.2 * by_prior_s && at(1000.0) > 1e15);
}

#[test]
fn thresholds_rise_with_the_mean_time_and_name_the_scale() {
    let year_s = 365.25 * 86_400.0;
    let [one, ten, hundred] = [1.0, 10.0, 100.0].map(|n| Tails::default().thresholds(n * year_s).unwrap());
    for scale in Scale::ALL {
        assert!(one.of(scale) < ten.of(scale) && ten.of(scale) < hundred.of(scale), "{scale:?}");
    }
    assert_eq!(ten.alarm(&[0.0; 5]), None);
    let mut statistics = ten.levels.map(|level| 0.99 * level);
    assert_eq!(ten.alarm(&statistics), None);
    statistics[3] = 1.2 * ten.levels[3];
    statistics[1] = 1.1 * ten.levels[1];
    assert_eq!(ten.alarm(&statistics), Some(Scale::Week));
    assert!(Tails::default().thresholds(0.0).is_err());
}

#[test]
fn a_built_in_vessel_has_tails_of_its_own_while_it_is_that_vessel_and_filled_as_it_was_commissioned() {
    let vessel = presets::load("nitrogen-20l").unwrap();
    let own = Tails::of(&vessel, 200e5);
    assert!(own != Tails::default() && own == Tails::of(&vessel, 180e5));
    assert_eq!(Tails::of(&vessel, 100e5), Tails::default());
    let larger = Vessel { volume: InnerVolume { volume_m3: 0.05, ..vessel.volume }, ..vessel };
    assert_eq!(Tails::of(&larger, 200e5), Tails::default());
}

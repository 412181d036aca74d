//! What is done to the gas and what surroundings do, held against balances and against the course without it.
use cylwatch_thermal::scenario::OutsideFilm;
use cylwatch_thermal::trajectory::Trajectory;
use cylwatch_thermal::units::{BAR_PA, HOUR_S};
use cylwatch_thermal::vessel::presets;

use super::super::disturbance::{Disturbance, Surrounding};
use super::super::{Course, Happenings, Process, TruthSettings, generate_through, simulate_through};
use super::mean;

/// Mass of 1 bar at 200 bar and 15 °C in 20 L, kg (CoolProp).
const BAR_KG: f64 = 0.01918;

fn settings() -> TruthSettings {
    TruthSettings { cylinder_cells: 2, gas_cells: 1, relative_tolerance: 1e-6, ..TruthSettings::default() }
}

fn day() -> Course {
    Course::RailwayWeeks { days: 1.0 }
}

fn through(happenings: &Happenings) -> Trajectory {
    simulate_through(&day(), 3, 60.0, &settings(), happenings).unwrap().1
}

fn process(process: Process) -> Trajectory {
    through(&Happenings { processes: vec![process], ..Happenings::default() })
}

/// A disturbance from 2 h on, and the same course without it.
fn disturbed(lasting_s: f64, kind: Surrounding) -> (Trajectory, Trajectory) {
    let disturbance = Disturbance { start_s: 2.0 * HOUR_S, lasting_s, kind };
    let happenings = Happenings { disturbances: vec![disturbance], ..Happenings::default() };
    (through(&happenings), through(&Happenings::default()))
}

/// Values of minutes between two times in hours.
fn between(values: &[f64], from_h: f64, to_h: f64) -> &[f64] {
    &values[(from_h * 60.0) as usize..(to_h * 60.0) as usize]
}

fn differences(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn a_fast_refill_is_hot_first_and_looks_like_a_loss_while_it_cools() {
    let rise_pa = 40.0 * BAR_PA;
    let refill = Process::Refill { start_s: 2.0 * HOUR_S, lasting_s: 120.0, rise_pa, source_k: 288.15 };
    let happenings =
        Happenings { fill_pa: Some(160.0 * BAR_PA), processes: vec![refill], ..Happenings::default() };
    let course = through(&happenings);
    let gained_kg = course.mass_kg[1439] - course.mass_kg[0];
    // From 183.10 to 223.19 kg/m³ in 20 L (CoolProp), which grow by half a percent of that.
    assert!((gained_kg / 0.8017 - 1.0).abs() < 0.01, "{gained_kg} kg");
    let peak_pa = largest(between(&course.pressure_pa, 2.0, 2.5));
    let settled_pa = between(&course.pressure_pa, 4.0, 4.1)[0];
    assert!(peak_pa - settled_pa > 8.0 * BAR_PA, "{peak_pa} to {settled_pa}");
}

#[test]
fn a_discharge_closes_at_its_pressure_and_rebounds() {
    let until_pa = 160.0 * BAR_PA;
    let discharge =
        Process::Discharge { start_s: 2.0 * HOUR_S, lasting_s: 60.0, diameter_m: 0.003, until_pa };
    let course = process(discharge);
    let after = between(&course.pressure_pa, 2.0, 4.0);
    // It closed between two samples, and the gas is already warmer at the second one.
    assert!(after[1] < 165.0 * BAR_PA && largest(after) > until_pa + 5.0 * BAR_PA, "{after:?}");
    assert!((course.mass_kg[125] - course.mass_kg[1439]).abs() < 1e-9);
}

#[test]
fn puffs_take_their_pressure_each() {
    let puffs = Process::Puffs { start_s: HOUR_S, every_s: HOUR_S, count: 5, drop_pa: 2.0 * BAR_PA };
    let course = process(puffs);
    let lost_kg = course.mass_kg[0] - course.mass_kg[1439];
    assert!((lost_kg / (10.0 * BAR_KG) - 1.0).abs() < 0.01, "{lost_kg} kg");
}

#[test]
fn leaks_lose_the_integral_of_their_rate() {
    let rate_pa_s = 0.2 * BAR_PA / HOUR_S;
    let lost_bar = |leak: Process| {
        let course = process(leak);
        (course.mass_kg[0] - course.mass_kg[1439]) / BAR_KG
    };
    let close = |bar: f64, expected: f64| assert!((bar / expected - 1.0).abs() < 0.01, "{bar} bar");
    let (start_s, stop_s) = (2.0 * HOUR_S, 12.0 * HOUR_S);
    close(lost_bar(Process::Leak { start_s, stop_s, rate_pa_s }), 2.0);
    // Doubling every 2 h for 10 h: 0.2 * 2/ln 2 * (2^5 - 1) bar; capped at four times the first rate from 4 h on.
    let growing = |largest_pa_s| Process::GrowingLeak {
        start_s,
        stop_s,
        rate_pa_s,
        doubling_s: 2.0 * HOUR_S,
        largest_pa_s,
    };
    close(lost_bar(growing(f64::MAX)), 0.2 * 2.0 / 2_f64.ln() * 31.0);
    close(lost_bar(growing(4.0 * rate_pa_s)), 0.2 * 2.0 / 2_f64.ln() * 3.0 + 0.8 * 6.0);
}

#[test]
fn a_cold_leak_is_open_only_while_it_is_cold() {
    let (_, usual) = simulate_through(&day(), 3, 60.0, &settings(), &Happenings::default()).unwrap();
    let mut sorted = usual.ambient_k.clone();
    sorted.sort_by(f64::total_cmp);
    let below_k = sorted[720];
    let rate_pa_s = BAR_PA / HOUR_S;
    let course = process(Process::ColdLeak { start_s: 0.0, stop_s: 24.0 * HOUR_S, rate_pa_s, below_k });
    let flowing = |minute: &usize| course.outflow_kg_s[*minute] > 0.0;
    let (open, shut): (Vec<usize>, Vec<usize>) = (0..1440).partition(flowing);
    let air =
        |minutes: &[usize]| mean(&minutes.iter().map(|&minute| course.ambient_k[minute]).collect::<Vec<_>>());
    assert!((open.len() as f64 - 720.0).abs() < 120.0, "{} minutes open", open.len());
    assert!(air(&open) < below_k && air(&shut) > below_k);
}

#[test]
fn a_masked_leak_holds_the_pressure_of_a_gas_that_becomes_warmer() {
    let warming = Disturbance {
        start_s: 2.0 * HOUR_S,
        lasting_s: 20.0 * HOUR_S,
        kind: Surrounding::Air { by_k: 20.0, within_s: 8.0 * HOUR_S },
    };
    let happenings = Happenings { disturbances: vec![warming], ..Happenings::default() };
    let (cylinder, usual) = simulate_through(&day(), 3, 60.0, &settings(), &happenings).unwrap();
    let span_s = (2.5 * HOUR_S, 4.5 * HOUR_S);
    let masked = |course: &Trajectory| {
        let leak = Process::masked(&cylinder.vessel, course, span_s, 600.0).unwrap();
        through(&Happenings { processes: vec![leak], ..happenings.clone() })
    };
    // The leak cools the gas: the second time it is masked with the temperature that it has itself.
    let masked = masked(&masked(&usual));
    let rise = |course: &Trajectory| {
        let during = between(&course.pressure_pa, 2.5, 4.5);
        during[during.len() - 1] - during[0]
    };
    assert!(rise(&usual) > 2.0 * BAR_PA, "{} Pa", rise(&usual));
    assert!(rise(&masked).abs() < 0.03 * rise(&usual), "{} Pa of {}", rise(&masked), rise(&usual));
    assert!(masked.mass_kg[0] - masked.mass_kg[1439] > 2.0 * BAR_KG);
}

#[test]
fn another_bottle_follows_after_a_while_without_rows() {
    let truth = |seed| generate_through(&day(), seed, 60.0, &settings(), &Happenings::default()).unwrap();
    let (first, second) = (truth(3), truth(4));
    let both = first.exchanged(&second, 10.0 * HOUR_S, 1800.0);
    assert_eq!(both.time_s.len(), both.log.time_s.len());
    let at = both.time_s.partition_point(|&t| t < 10.0 * HOUR_S);
    assert_eq!((both.time_s[at - 1], both.time_s[at]), (10.0 * HOUR_S - 60.0, 10.5 * HOUR_S));
    assert_eq!(both.log.row(at - 1), first.log.row(599));
    assert_eq!(both.log.row(at), second.log.row(630));
    assert_eq!(both.mass_kg[at], second.mass_kg[630]);
}

#[test]
fn hourly_tunnels_have_their_air_from_portal_to_portal() {
    let kind = Surrounding::Tunnels { air_k: 315.0, stay_s: 1500.0, every_s: HOUR_S };
    let (course, usual) = disturbed(4.0 * HOUR_S, kind);
    for hour in [2.0, 3.0, 4.0, 5.0] {
        let inside = between(&course.ambient_k, hour + 0.02, hour + 0.4);
        assert!(inside.iter().all(|air| (air - 315.0).abs() < 0.5), "{inside:?}");
        // Fifteen seconds of 3 K/s after the portal the air outside is back.
        let outside = between(&course.ambient_k, hour + 0.45, hour + 0.98);
        let before = between(&usual.ambient_k, hour + 0.45, hour + 0.98);
        assert!(differences(outside, before).iter().all(|by| by.abs() < 1e-6));
    }
}

#[test]
fn a_cold_night_cools_the_gas_and_ends() {
    let kind = Surrounding::Air { by_k: -20.0, within_s: 8.0 * HOUR_S };
    let (course, usual) = disturbed(18.0 * HOUR_S, kind);
    let by = |values: &[f64], usual: &[f64], hour: f64| {
        let both = (between(values, hour, hour + 0.5), between(usual, hour, hour + 0.5));
        mean(&differences(both.0, both.1))
    };
    assert!((by(&course.ambient_k, &usual.ambient_k, 6.0) + 10.6).abs() < 0.1);
    assert!((by(&course.ambient_k, &usual.ambient_k, 11.0) + 20.0).abs() < 1e-6);
    assert!(by(&course.gas_mean_k, &usual.gas_mean_k, 11.5) < -15.0);
    assert!(by(&course.ambient_k, &usual.ambient_k, 21.0).abs() < 1e-6);
}

#[test]
fn sun_on_a_standing_train_makes_the_shoulder_warmer_than_the_rest() {
    let kind = Surrounding::Sun { irradiance_w_m2: 1120.0, film_w_m2_k: 5.0 };
    let (course, usual) = disturbed(2.0 * HOUR_S, kind);
    let by = |course: &Trajectory, usual: &Trajectory, place: &str| {
        let shoulder = |course: &Trajectory| course.surface_k(place).unwrap();
        largest(&differences(between(&shoulder(course), 2.0, 4.0), between(&shoulder(usual), 2.0, 4.0)))
    };
    let shoulder_k = by(&course, &usual, "shoulder");
    assert!((4.0..15.0).contains(&shoulder_k), "{shoulder_k} K");
    assert!(by(&course, &usual, "bottom") < 0.5 * shoulder_k);
}

#[test]
fn washing_takes_the_skin_to_the_water_and_ice_holds_it_at_zero() {
    let kind = Surrounding::Wet { by_k: -10.0, melting_s: HOUR_S };
    let (course, usual) = disturbed(3.0 * HOUR_S, kind);
    let skin = course.surface_k("middle").unwrap();
    let wet = between(&skin, 3.5, 3.9);
    let air = between(&usual.ambient_k, 3.5, 3.9);
    for (skin_k, air_k) in wet.iter().zip(air) {
        let water_k = (air_k - 10.0).max(273.15);
        assert!((skin_k - water_k).abs() < 2.0, "{skin_k} {water_k}");
    }
    let icy = between(&skin, 4.5, 4.95);
    assert!(icy.iter().all(|skin_k| (skin_k - 273.15).abs() < 1.0), "{icy:?}");
}

#[test]
fn a_heater_warms_one_end_and_a_hall_all_of_it() {
    let (course, usual) = disturbed(6.0 * HOUR_S, Surrounding::Heater { difference_k: 20.0 });
    let by = |place: &str| {
        let surface = |course: &Trajectory| between(&course.surface_k(place).unwrap(), 6.0, 7.5).to_vec();
        mean(&differences(&surface(&course), &surface(&usual)))
    };
    assert!(by("shoulder") > 1.0 && by("bottom") < -1.0, "{} {}", by("shoulder"), by("bottom"));
    let (course, _) = disturbed(6.0 * HOUR_S, Surrounding::Hall { air_k: 293.15 });
    assert!(between(&course.ambient_k, 2.1, 7.9).iter().all(|air| (air - 293.15).abs() < 1e-6));
    // What it radiates to lags behind by half an hour.
    let around = course.scenario.surroundings.radiation_k.as_ref().unwrap();
    assert!((around.at(7.9 * HOUR_S) - 293.15).abs() < 0.2 && (around.at(2.1 * HOUR_S) - 293.15).abs() > 1.0);
}

#[test]
fn air_conditioning_swings_and_speed_changes_the_film() {
    let (course, usual) = disturbed(6.0 * HOUR_S, Surrounding::Cycling { by_k: 5.0, period_s: 900.0 });
    let by = differences(between(&course.ambient_k, 2.1, 7.9), between(&usual.ambient_k, 2.1, 7.9));
    let least = -largest(&by.iter().map(|by| -by).collect::<Vec<_>>());
    assert!((largest(&by) - 5.0).abs() < 0.5 && (least + 5.0).abs() < 0.5, "{least} {}", largest(&by));
    let kind = Surrounding::Speed { standing_w_m2_k: 5.0, fast_w_m2_k: 45.0, period_s: 2.0 * HOUR_S };
    let (course, _) = disturbed(6.0 * HOUR_S, kind);
    let OutsideFilm::Coefficient { film_w_m2_k } = &course.scenario.surroundings.film else {
        panic!("the film of a course is a coefficient")
    };
    let of_cylinder = film_w_m2_k.at(2.5 * HOUR_S) / film_w_m2_k.at(3.5 * HOUR_S);
    assert!((of_cylinder - 9.0).abs() < 1e-6, "{of_cylinder}");
}

#[test]
fn nothing_happening_changes_no_bit_and_what_happens_can_be_written_down() {
    let (_, plain) = super::super::simulate_truth(&day(), 3, 60.0, &settings()).unwrap();
    assert_eq!(plain.pressure_pa, through(&Happenings::default()).pressure_pa);
    let happenings = Happenings {
        fill_pa: Some(2e7),
        processes: vec![Process::Puffs { start_s: 1.0, every_s: 2.0, count: 3, drop_pa: 4.0 }],
        disturbances: vec![Disturbance {
            start_s: 1.0,
            lasting_s: 2.0,
            kind: Surrounding::Hall { air_k: 290.0 },
        }],
    };
    let text = serde_json::to_string(&happenings).unwrap();
    assert_eq!(serde_json::from_str::<Happenings>(&text).unwrap(), happenings);
    let vessel = presets::load("nitrogen-20l").unwrap();
    let mut scenario = super::super::draw_weather(&day(), 1).unwrap();
    let wrong = Happenings { processes: happenings.processes, fill_pa: Some(f64::NAN), disturbances: vec![] };
    assert!(wrong.apply(&vessel, &mut scenario).is_err());
}

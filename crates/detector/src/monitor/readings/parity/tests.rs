use super::*;
use crate::units::HOUR_S;

/// One per cent of the mass.
const MUCH_K: f64 = 2.9;

/// A course of minutes.
struct Watched {
    parity: Parity,
    /// What the gas may be off by, K.
    doubts: Vec<f64>,
    /// Hours at which something changed.
    changes: Vec<(f64, Disturbance)>,
    /// Hours at which another one deviates, and by how much, K.
    deviating: Vec<(f64, Option<(usize, f64)>)>,
}

/// So many hours of both thermometers and the temperature that the pressure stands for, K.
fn compared(hours: f64, course: impl Fn(f64) -> [f64; 3]) -> Watched {
    let parity = Parity::new(0.12);
    let mut watched = Watched { parity, doubts: Vec::new(), changes: Vec::new(), deviating: Vec::new() };
    for minute in 0..(60.0 * hours) as u32 {
        let hour = f64::from(minute) / 60.0;
        let noise = |n: u32| 0.01 * f64::from((minute * n) % 11) - 0.05;
        let [shoulder, valve, gas] = course(hour);
        let readings = [shoulder + noise(7), valve + noise(4)];
        let change = watched.parity.push(HOUR_S * hour, readings, gas, |gas_k, _| gas_k);
        watched.changes.extend(change.map(|change| (hour, change)));
        watched.doubts.push(watched.parity.doubt_k());
        let deviating = watched.parity.deviating();
        let which = |of: &Option<(usize, f64)>| of.map(|(which, _)| which);
        if watched.deviating.last().and_then(|(_, last)| which(last)) != which(&deviating) {
            watched.deviating.push((hour, deviating));
        }
    }
    watched
}

/// What the gas may be off by, K, in a course without a pressure, and the hours at which something changed.
fn watched(
    hours: f64,
    shoulder: impl Fn(f64) -> f64,
    valve: impl Fn(f64) -> f64,
) -> (Vec<f64>, Vec<(f64, Disturbance)>) {
    let watched = compared(hours, |hour| [shoulder(hour), valve(hour), f64::NAN]);
    assert!(watched.deviating.is_empty());
    (watched.doubts, watched.changes)
}

/// Night and day, by half a kelvin.
fn day_k(hour: f64) -> f64 {
    0.5 * (std::f64::consts::TAU * hour / 24.0).sin()
}

#[test]
fn the_one_that_leaves_the_pressure_is_named_and_is_shifted_when_it_lasts() {
    // From hour 40 on the valve reads 1 K more; a leak lets the pressure stand for less from then on.
    for leak_k_h in [0.0, 0.1, 1.0] {
        let course = |hour: f64| {
            let since: f64 = if hour > 40.0 { 1.0 } else { 0.0 };
            let leak_k = leak_k_h * (hour - 40.0).max(0.0);
            [280.0 + day_k(hour), 280.0 + day_k(hour) + since, 280.0 - leak_k]
        };
        let watched = compared(60.0, course);
        let Some(&(named_h, Some((1, by_k)))) = watched.deviating.first() else {
            panic!("{:?} with {leak_k_h} K/h", watched.deviating)
        };
        assert!((40.4..41.2).contains(&named_h) && (by_k - 1.0).abs() < 0.15, "{named_h} h, {by_k} K");
        let shifted = watched.changes.iter().find_map(|(hour, change)| match change {
            Disturbance::Shifted(which, by_k) => Some((*hour, *which, *by_k)),
            _ => None,
        });
        let (shifted_h, which, by_k) = shifted.expect("it lasts");
        assert!((56.0..57.5).contains(&shifted_h) && which == 1 && (by_k - 1.0).abs() < 0.1, "{shifted_h} h");
    }
}

#[test]
fn one_that_was_named_is_no_more_when_too_few_calm_windows_are_left_to_tell_what_is_usual() {
    // From hour 40 on both are shaken but for a few minutes in two hours, so that by hour 86 too few windows of two days are calm. The
    // valve reads 1 K more for ten hours before.
    let course = |hour: f64| {
        let shaken = if hour > 40.0 && hour % 2.0 > 0.2 { 3.0 * (7.0 * hour).fract() } else { 0.0 };
        let off = if (75.0..85.0).contains(&hour) { 1.0 } else { 0.0 };
        [280.0 + shaken, 280.0 + shaken + off, 280.0]
    };
    let watched = compared(120.0, course);
    assert!(!watched.deviating.is_empty(), "it is named at first");
    let shifted = watched.changes.iter().find(|(_, change)| matches!(change, Disturbance::Shifted(..)));
    assert!(shifted.is_none(), "{:?}", watched.changes);
}

#[test]
fn a_difference_that_swings_with_every_day_is_usual_and_a_heater_beside_it_is_not() {
    let swing = |hour: f64| 1.2 * (std::f64::consts::TAU * hour / 24.0).sin();
    let heater = |hour: f64| if hour > 130.0 { 5.0 } else { 0.0 };
    let (doubts, _) = watched(140.0, |hour| 280.0 + swing(hour) + heater(hour), |_| 280.0);
    let at = |hour: f64| doubts[(60.0 * hour) as usize];
    let later: Vec<f64> = (60..130).map(|hour| at(f64::from(hour))).collect();
    assert!(later.iter().all(|doubt_k| *doubt_k < MUCH_K), "{later:?}");
    assert!(at(132.0) > MUCH_K, "{}", at(132.0));
}

#[test]
fn what_the_sun_does_to_one_end_every_morning_is_usual_a_day_later_and_a_heater_beside_it_is_not() {
    let morning = |hour: f64| {
        let of_day = hour % 24.0;
        if (8.0..10.5).contains(&of_day) { 1.4 * (1.0 - (of_day - 9.25).abs() / 1.25) } else { 0.0 }
    };
    let heater = |hour: f64| if hour > 156.0 { 5.0 } else { 0.0 };
    let (doubts, changes) = watched(160.0, |hour| 280.0 + morning(hour) + heater(hour), |_| 280.0);
    let day = |n: usize| doubts[1440 * n..1440 * (n + 1)].iter().copied().fold(0.0, f64::max);
    assert!(day(0) > 2.0, "nobody knows it yet: {}", day(0));
    assert!((1..6).all(|n| day(n) < 1.5), "{:?}", (1..6).map(day).collect::<Vec<_>>());
    assert!(doubts[60 * 158] > MUCH_K);
    assert!(changes.iter().all(|(hour, _)| *hour < 24.0 || *hour > 156.0), "{changes:?}");
}

#[test]
fn sun_on_one_of_them_warms_the_gas_and_names_nobody() {
    let sun = |hour: f64| if (40.0..46.0).contains(&hour) { 1.0 } else { 0.0 };
    let watched = compared(60.0, |hour| [280.0 + 1.6 * sun(hour), 280.0 + 0.8 * sun(hour), 280.0]);
    assert!(watched.deviating.is_empty(), "{:?}", watched.deviating);
    let [(_, Disturbance::Begun(_)), (_, Disturbance::Over(by_k))] = watched.changes[..] else {
        panic!("{:?}", watched.changes)
    };
    assert!(by_k.abs() < 0.1, "the usual difference is what it was, not {by_k} K from it");
}

#[test]
fn a_difference_that_became_usual_is_told_with_its_end() {
    let (_, changes) = watched(90.0, |hour| if hour > 40.0 { 281.0 } else { 280.0 }, |_| 280.0);
    let Some((over_h, Disturbance::Over(by_k))) = changes.last() else { panic!("{changes:?}") };
    assert!((60.0..68.0).contains(over_h) && (by_k - 1.0).abs() < 0.1, "{by_k} K at {over_h} h");
}

#[test]
fn tunnels_are_no_disturbance() {
    // The body warms by 12 K/h inside, and cools as fast after it.
    let tunnel = |hour: f64, share: f64| match hour % 3.0 {
        inside if inside < 0.4 => 280.0 + 40.0 * share + 12.0 * inside,
        after => 280.0 + (4.8 - 12.0 * (after - 0.4)).max(0.0),
    };
    let (doubts, changes) = watched(72.0, |hour| tunnel(hour, 0.15), |hour| tunnel(hour, 0.05));
    assert!(doubts.iter().all(|doubt_k| *doubt_k == 0.0) && changes.is_empty());
}

#[test]
fn one_end_that_is_warmed_leaves_the_gas_in_doubt_until_it_is_over() {
    let warmed = |hour: f64| if (40.0..52.0).contains(&hour) { 281.0 } else { 280.0 };
    let (doubts, changes) = watched(90.0, warmed, |_| 280.0);
    let at = |hour: f64| doubts[(60.0 * hour) as usize];
    assert_eq!(at(39.0), 0.0);
    // Twice the root of 1.0^2 - 0.3^2 K^2, and a third of it six hours later.
    for hour in [41.0, 46.0, 51.0] {
        assert!((at(hour) - 1.9).abs() < 0.2, "{} at {hour} h", at(hour));
    }
    assert!((at(58.5) - 0.7).abs() < 0.15 && at(85.0) < 0.05, "{} and {}", at(58.5), at(85.0));
    let [(begun_h, Disturbance::Begun(off_k)), (over_h, Disturbance::Over(_))] = changes[..] else {
        panic!("{changes:?}")
    };
    assert!((41.0..42.0).contains(&begun_h) && (52.0..53.0).contains(&over_h), "{changes:?}");
    assert!((off_k - 1.0).abs() < 0.1, "{off_k} K");
}

#[test]
fn sun_of_an_hour_is_no_reason_to_forget_and_missing_readings_are_none() {
    let sunny = |hour: f64| if (40.0..41.5).contains(&hour) { 281.0 } else { 280.0 };
    let (_, changes) = watched(60.0, sunny, |_| 280.0);
    assert!(matches!(changes[..], [(_, Disturbance::Begun(_))]), "{changes:?}");
    let (doubts, _) = watched(60.0, |hour| if hour > 40.0 { f64::NAN } else { 280.0 }, |_| 280.0);
    assert!(doubts.iter().all(|doubt_k| *doubt_k == 0.0));
    // One that is lost while it is off says nothing more: a day later it is likelier over than not.
    let lost = |hour: f64| if hour > 41.0 { f64::NAN } else { 281.0 + (hour - 40.0).signum() };
    let (doubts, _) = watched(90.0, lost, |_| 280.0);
    let (then, last) = (doubts[2460], *doubts.last().unwrap());
    assert!(then > 3.0 && (last / then - (-49.0_f64 / 24.0).exp()).abs() < 0.05, "{then} K, then {last} K");
}

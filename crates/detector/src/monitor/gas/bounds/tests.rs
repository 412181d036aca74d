use super::*;

/// An ideal gas: 1 kg at 100 bar and 300 K.
fn mass_kg(pressure_pa: f64, temperature_k: f64) -> f64 {
    pressure_pa / 100e5 * 300.0 / temperature_k
}

fn seen(minute: f64, pressure_pa: f64, extremes_k: (f64, f64)) -> Seen {
    let time_s = 60.0 * minute;
    let (contact, coefficient_pa_k, noise_pa) = (Contact::Wall, 0.0, 1e3);
    Seen { time_s, extremes_k, contact, pressure_pa, coefficient_pa_k, noise_pa }
}

/// The first certainty of pressures and extremes of every minute of two days.
fn certain(course: impl Fn(f64) -> (f64, (f64, f64))) -> Option<(f64, Certain)> {
    let mut bounds = GasBounds::default();
    (0..2880).map(f64::from).find_map(|minute| {
        let (pressure_pa, extremes_k) = course(minute);
        Some((minute, bounds.push(&seen(minute, pressure_pa, extremes_k), mass_kg)?))
    })
}

#[test]
fn a_tight_cylinder_whose_gas_is_between_its_walls_is_never_certain_to_have_lost_gas() {
    // Gas that lags by half an hour behind a wall that swings by 40 K within an hour, a part of it 10 K warmer by day.
    let wall_k = |minute: f64| 290.0 + 20.0 * (minute / 60.0).sin();
    let gas_k = |minute: f64| 290.0 + 20.0 * 0.9 * (minute / 60.0 - 0.46).sin();
    let sun_k = |minute: f64| (10.0 * (minute / 230.0).sin()).max(0.0);
    assert_eq!(
        certain(|minute| {
            let warmed_k = wall_k(minute) + sun_k(minute);
            (100e5 * gas_k(minute) / 300.0, (warmed_k, warmed_k))
        }),
        None
    );
}

#[test]
fn a_fifth_of_the_gas_is_certainly_gone_or_come_within_minutes() {
    for (way, certainly) in [(-1.0, Certain::Out), (1.0, Certain::In)] {
        let pressure = |minute: f64| 100e5 * (1.0 + 0.02 * way * (minute - 600.0).clamp(0.0, 20.0));
        let (minute, which) = certain(|minute| (pressure(minute), (300.0, 300.0))).expect("40 %");
        assert_eq!(which, certainly);
        assert!((601.0..612.0).contains(&minute), "{minute} min");
    }
}

#[test]
fn what_was_lost_is_lost_once() {
    let mut bounds = GasBounds::default();
    let pressure = |minute: f64| if minute < 600.0 { 100e5 } else { 70e5 };
    let minutes = (0..2880).map(f64::from);
    let lost = |bounds: &mut GasBounds, minute: f64| {
        let certain = bounds.push(&seen(minute, pressure(minute), (300.0, 300.0)), mass_kg);
        certain.into_iter().for_each(|way| bounds.gone(way));
        certain.is_some()
    };
    let times = minutes.filter(|&minute| lost(&mut bounds, minute)).count();
    assert_eq!(times, 1);
    assert!(bounds.allow(0.7) && !bounds.allow(1.0));
}

#[test]
fn what_is_lost_again_after_a_refill_is_lost() {
    let mut bounds = GasBounds::default();
    let pressure = |minute: f64| match minute {
        m if m < 60.0 => 100e5,
        m if m < 120.0 => 300e5,
        _ => 200e5,
    };
    let mut ways = Vec::new();
    for minute in (0..240).map(f64::from) {
        let certain = bounds.push(&seen(minute, pressure(minute), (300.0, 300.0)), mass_kg);
        certain.into_iter().for_each(|way| bounds.gone(way));
        ways.extend(certain);
    }
    assert_eq!(ways, [Certain::In, Certain::Out]);
}

#[test]
fn three_readings_far_off_are_no_gas_and_four_are() {
    let spikes =
        |rows: f64| move |minute: f64| if minute % 60.0 < rows && minute > 100.0 { 50e5 } else { 100e5 };
    assert_eq!(certain(|minute| (spikes(3.0)(minute), (300.0, 300.0))), None);
    let told = certain(|minute| (spikes(4.0)(minute), (300.0, 300.0)));
    assert!(matches!(told, Some((_, Certain::Out))), "{told:?}");
}

/// Spikes of three rows, of which one day two meet.
#[test]
fn spikes_that_meet_are_no_gas_and_what_stays_is() {
    let spikes = |minute: f64| minute % 60.0 < 3.0 || (900.0..906.0).contains(&minute);
    let pressure = |minute: f64| if spikes(minute) && minute > 100.0 { 50e5 } else { 100e5 };
    assert_eq!(certain(|minute| (pressure(minute), (300.0, 300.0))), None);
    let lost = |minute: f64| if minute < 1510.0 { pressure(minute) } else { 50e5 };
    let (minute, way) = certain(|minute| (lost(minute), (300.0, 300.0))).unwrap();
    assert_eq!((minute, way), (1510.0 + 12.0, Certain::Out), "thirteen rows");
    // What was long ago says nothing of today.
    let late = |minute: f64| if minute < 120.0 { pressure(minute) } else { 100e5 };
    let mut bounds = GasBounds::default();
    let days = 1440.0 * 6.0;
    let told = (0..10_000).map(f64::from).find(|&minute| {
        let pressure_pa = if minute < days { late(minute) } else { 50e5 };
        bounds.push(&seen(minute, pressure_pa, (300.0, 300.0)), mass_kg).is_some()
    });
    assert_eq!(told, Some(days + 3.0));
}

/// What was certain and not believed, since it was being examined, makes no later loss wait.
#[test]
fn a_certainty_that_came_back_is_no_spike() {
    let mut bounds = GasBounds::default();
    let pressure =
        |minute: f64| if (200.0..240.0).contains(&minute) || minute >= 300.0 { 50e5 } else { 100e5 };
    let mut told = (0..400)
        .map(f64::from)
        .filter(|&minute| bounds.push(&seen(minute, pressure(minute), (300.0, 300.0)), mass_kg).is_some());
    assert_eq!(told.find(|&minute| minute > 250.0), Some(303.0));
}

#[test]
fn one_reading_far_off_is_no_gas() {
    let spikes = |minute: f64| 100e5 * if minute % 7.0 == 3.0 { 0.5 } else { 1.0 };
    assert_eq!(certain(|minute| (spikes(minute), (300.0, 300.0))), None);
    let upwards = |minute: f64| 100e5 * if minute % 7.0 == 3.0 { 1.5 } else { 1.0 };
    assert_eq!(certain(|minute| (upwards(minute), (300.0, 300.0))), None);
}

/// A mass of so many parts that the observer says, known to a part.
fn flow(mass_kg: f64, sd_kg: f64) -> Flow {
    Flow {
        mass_kg,
        mass_sd_kg: 0.01,
        passing_sd_kg: sd_kg,
        considered_sd_kg: 0.0,
        gas_mean_k: 300.0,
        gas_mean_sd_k: 1.0,
        rate_kg_s: 0.0,
        rate_sd_kg_s: 1e-3,
    }
}

#[test]
fn what_the_observer_says_counts_beyond_what_comes_and_goes() {
    let mut bounds = GasBounds::default();
    let minutes = |from: u32| (from..from + 60).map(|minute| 60.0 * f64::from(minute));
    // Errors of its size, and constant ones however large, are none.
    let errors =
        minutes(0).find_map(|t| bounds.push_flow(t, &flow(1.0 + 2e-3 * (t / 500.0).sin(), 2e-3), 1.0, 0.0));
    assert_eq!(errors, None);
    // 2.2 sd, with the usual wander 0.23 %, and 0.3 % on either side are 1.6 %.
    assert_eq!(bounds.push_flow(3600.0, &flow(0.988, 2e-3), 1.0, 0.0), None);
    let lost = minutes(61).find_map(|t| bounds.push_flow(t, &flow(0.98, 2e-3), 1.0, 0.0));
    assert_eq!(lost, Some(Certain::Out));
    bounds.gone(Certain::Out);
    assert_eq!(minutes(121).find_map(|t| bounds.push_flow(t, &flow(0.98, 2e-3), 1.0, 0.0)), None, "once");
    let mut shaken = bounds.clone();
    let come = flow(1.0, 2e-3);
    assert_eq!(shaken.push_flow(181.0 * 60.0, &come, 1.0, 0.01), None, "a row in which all moves is none");
    assert_eq!(shaken.push_flow(182.0 * 60.0, &come, 1.0, 0.01), Some(Certain::In));
    assert_eq!(minutes(181).find_map(|t| bounds.push_flow(t, &flow(1.0, 2e-3), 1.0, 0.0)), Some(Certain::In));
}

#[test]
fn a_gain_waits_until_the_surroundings_make_no_more_of_it_and_a_loss_does_not() {
    let told = |mass_kg: f64, considered_sd_kg: f64| {
        let mut bounds = GasBounds::default();
        let of = |mass_kg: f64, considered_sd_kg: f64| Flow { considered_sd_kg, ..flow(mass_kg, 2e-3) };
        (0..60).for_each(|minute| {
            bounds.push_flow(60.0 * f64::from(minute), &of(1.0, 0.0), 1.0, 0.0);
        });
        bounds.push_flow(3600.0, &of(mass_kg, considered_sd_kg), 1.0, 0.0)
    };
    assert_eq!(told(1.05, 0.004), None);
    assert_eq!(told(1.05, 0.002), Some(Certain::In));
    assert_eq!(told(0.95, 0.004), Some(Certain::Out));
}

#[test]
fn what_a_transmitter_does_to_an_empty_cylinder_is_no_gas() {
    let mut bounds = GasBounds::default();
    let hours = (0..48).map(|hour| 3600.0 * f64::from(hour));
    // A fifth of what is left, by day and by night: 0.2 % of the fill.
    let empty = |t: f64| flow(0.01 + 1e-3 * (t / 13_751.0).sin(), 1e-5);
    assert_eq!(hours.into_iter().find_map(|t| bounds.push_flow(t, &empty(t), 1.0, 0.0)), None);
}

#[test]
fn what_the_observer_learns_slowly_is_no_gas() {
    // 3 % within a week, as a bound that fades within hours allows and one that stays would not.
    let mut bounds = GasBounds::default();
    let hours = (0..168).map(|hour| 3600.0 * f64::from(hour));
    let wanders = |t: f64| flow(1.0 - 0.03 * t / 604_800.0, 1e-3);
    assert_eq!(hours.into_iter().find_map(|t| bounds.push_flow(t, &wanders(t), 1.0, 0.0)), None);
}

#[test]
fn a_mass_that_swings_with_every_day_is_no_gas_once_that_is_known_and_a_loss_beside_it_is() {
    // 1 % by day and by night.
    let swings = |hour: f64| 1.0 + 0.01 * (std::f64::consts::TAU * hour / 24.0).sin();
    let ways_of = |mass: &dyn Fn(f64) -> f64| {
        let mut bounds = GasBounds::default();
        let hours = (0..30 * 24).map(f64::from);
        let certain = |hour: f64| {
            let certain = bounds.push_flow(3600.0 * hour, &flow(mass(hour), 1e-3), 1.0, 0.0);
            certain.into_iter().for_each(|way| bounds.gone(way));
            certain.map(|way| (hour, way))
        };
        hours.filter_map(certain).collect::<Vec<_>>()
    };
    let days = |ways: &[(f64, Certain)]| ways.iter().map(|(hour, _)| hour / 24.0).fold(0.0, f64::max);
    assert!(days(&ways_of(&swings)) < 8.0, "{:?}", ways_of(&swings));
    let lost = |hour: f64| swings(hour) - if hour > 700.0 { 0.08 } else { 0.0 };
    assert_eq!(ways_of(&lost).last(), Some(&(701.0, Certain::Out)));
}

#[test]
fn a_row_outside_the_gas_says_nothing() {
    let mut bounds = GasBounds::default();
    bounds.push(&seen(0.0, 100e5, (300.0, 300.0)), mass_kg);
    let before = bounds.clone();
    assert_eq!(bounds.push(&seen(1.0, 10e5, (300.0, 300.0)), |_, _| f64::NAN), None);
    assert_eq!(before.walls, bounds.walls);
}

//! Rows of the fault table that happen to the cylinder, where the film is a coefficient and where it is a wind.
use super::request;
use crate::world::{FaultRow, Overlay, Simulated, World, WorldEventKind};
use cylwatch_thermal::scenario::OutsideFilm;
use cylwatch_thermal::units::DAY_S;
use cylwatch_thermal::units::HOUR_S;

/// A climate with a coefficient and one with a wind, both without tunnels.
const CLIMATES: [&str; 2] = ["showers", "parked"];
const SEED: u64 = 5;

/// A simulation without and with a row, and its world.
fn pair(row: FaultRow, climate: &str, seed: u64) -> (Simulated, Simulated, World) {
    let tight = request(&format!("nitrogen-20l/{climate}/mixed/class-b/300s"), seed, 3.0);
    let fault = tight.with(Overlay::Fault { row, onset_s: DAY_S, leak: None });
    let simulated = Simulated::run(&fault).unwrap();
    let world = simulated.world(&fault).unwrap();
    (Simulated::run(&tight).unwrap(), simulated, world)
}

/// Change of the air at a time after the onset, K.
fn warmer_k((before, after): (&Simulated, &Simulated), since_s: f64) -> f64 {
    let t = DAY_S + since_s + before.drawn.fill.lead_s;
    after.surroundings.air_k.at(t) - before.surroundings.air_k.at(t)
}

fn flow(simulated: &Simulated, since_s: f64) -> f64 {
    simulated.surroundings.film.signal().at(DAY_S + since_s + simulated.drawn.fill.lead_s)
}

#[test]
fn hourly_tunnels_bring_the_air_to_32_to_42_degrees_for_half_an_hour() {
    for climate in CLIMATES {
        let (_, after, world) = pair(FaultRow::E1, climate, SEED);
        let air =
            |since_s: f64| after.surroundings.air_k.at(DAY_S + since_s + after.drawn.fill.lead_s) - 273.15;
        for hour in 0..12 {
            let inside = air(f64::from(hour) * HOUR_S + 900.0);
            assert!((31.9..42.1).contains(&inside), "{climate}, hour {hour}: {inside}");
        }
        assert!(world.fault.is_none());
    }
}

#[test]
fn a_cold_night_takes_twenty_kelvin_and_gives_them_back() {
    for climate in CLIMATES {
        let (before, after, _) = pair(FaultRow::E2, climate, SEED);
        assert!((warmer_k((&before, &after), 9.0 * HOUR_S) + 20.0).abs() < 0.1, "{climate}");
        assert!(warmer_k((&before, &after), -HOUR_S).abs() < 1e-9);
        assert!(warmer_k((&before, &after), 27.0 * HOUR_S).abs() < 1e-6);
        // The gas follows.
        let at = |simulated: &Simulated| {
            let t = DAY_S + 9.0 * HOUR_S + simulated.drawn.fill.lead_s;
            simulated.samples.at(&simulated.samples.gas_mean_k, t)
        };
        assert!(at(&after) < at(&before) - 10.0, "{climate}");
    }
}

#[test]
fn strong_sun_meets_a_weak_film_and_warms_the_shoulder() {
    for climate in CLIMATES {
        let (before, after, _) = pair(FaultRow::E3, climate, SEED);
        let is_wind = matches!(after.surroundings.film, OutsideFilm::Convection { .. });
        let expected = if is_wind { 0.5 } else { 5.0 };
        assert!((flow(&after, HOUR_S) - expected).abs() < 1e-6, "{climate}: {}", flow(&after, HOUR_S));
        let shoulder_k = |simulated: &Simulated, minute: f64| {
            let t = DAY_S + 60.0 * minute + simulated.drawn.fill.lead_s;
            simulated.samples.at(&simulated.samples.shoulder_k, t)
        };
        let warmest_k = (60..120)
            .map(|minute| shoulder_k(&after, f64::from(minute)) - shoulder_k(&before, f64::from(minute)))
            .fold(f64::MIN, f64::max);
        assert!(warmest_k > 5.0, "{climate}: {warmest_k} K");
    }
}

#[test]
fn water_runs_over_the_cylinder_with_the_film_of_rain_or_of_the_strongest_wind() {
    for climate in CLIMATES {
        let (_, after, _) = pair(FaultRow::E4, climate, SEED);
        let is_wind = matches!(after.surroundings.film, OutsideFilm::Convection { .. });
        let expected = if is_wind { 40.0 } else { 150.0 };
        assert!((flow(&after, HOUR_S) - expected).abs() < 1e-6, "{climate}: {}", flow(&after, HOUR_S));
        let highest = after.surroundings.film.signal().range().1;
        assert!(highest <= expected.max(200.0), "{climate}: {highest}");
    }
}

#[test]
fn a_heater_warms_one_end_a_hall_all_of_it_and_air_conditioning_swings() {
    let mut kinds = [0; 3];
    for seed in 0..12 {
        let (before, after, _) = pair(FaultRow::E5, "parked", seed);
        let difference = |simulated: &Simulated, since_s: f64| {
            let t = DAY_S + since_s + simulated.drawn.fill.lead_s;
            simulated.surroundings.axial.air_difference_k.as_ref().unwrap().at(t)
        };
        let along_k = (difference(&after, 3.0 * HOUR_S) - difference(&before, 3.0 * HOUR_S)).abs();
        let hall_k = after.surroundings.air_k.at(DAY_S + 3.0 * HOUR_S + after.drawn.fill.lead_s) - 293.15;
        let swing_k: f64 =
            (0..60).map(|k| warmer_k((&before, &after), HOUR_S + 60.0 * f64::from(k)).abs()).sum();
        let kind = if along_k > 1e-9 {
            0
        } else if hall_k.abs() < 1e-6 {
            1
        } else {
            2
        };
        kinds[kind] += 1;
        assert!(kind != 0 || along_k <= 20.0);
        // Mean magnitude of a triangle of 5 K: 2.5 K.
        assert!(kind != 2 || (swing_k / 60.0 - 2.5).abs() < 0.2, "{swing_k}");
    }
    assert!(kinds.iter().all(|&count| count > 0), "{kinds:?}");
}

#[test]
fn standing_and_fast_travel_change_the_film_or_the_wind() {
    for climate in CLIMATES {
        let (_, after, _) = pair(FaultRow::E6, climate, SEED);
        let is_wind = matches!(after.surroundings.film, OutsideFilm::Convection { .. });
        let (standing, fast) = if is_wind { (0.3, 15.0) } else { (5.0, 50.0) };
        let flows: Vec<f64> = (10..1380).map(|minute| flow(&after, 60.0 * f64::from(minute))).collect();
        let (low, high) =
            flows.iter().fold((f64::MAX, f64::MIN), |(low, high), &x| (low.min(x), high.max(x)));
        let near = |found: f64, wanted: f64| (found - wanted).abs() < 0.02 * fast;
        assert!(near(low, standing) && near(high, fast), "{climate}: {low} to {high}");
    }
}

#[test]
fn a_leak_masked_by_warming_holds_the_pressure_while_the_air_warms_by_twenty_kelvin() {
    let (before, after, world) = pair(FaultRow::G5, "workshop", SEED);
    assert!((warmer_k((&before, &after), 11.0 * HOUR_S) - 20.0).abs() < 0.1);
    let at = |since_h: f64| {
        let t = DAY_S + since_h * HOUR_S + after.drawn.fill.lead_s;
        (after.samples.at(&after.samples.pressure_pa, t), after.samples.at(&after.samples.mass_kg, t))
    };
    let ((first_pa, first_kg), (last_pa, last_kg)) = (at(1.0), at(10.0));
    assert!((last_pa / first_pa - 1.0).abs() < 0.005, "{first_pa} Pa, {last_pa} Pa");
    // 16 K and more of warming meanwhile, of some 290.
    assert!(last_kg < 0.96 * first_kg, "{first_kg} kg, {last_kg} kg");
    let fault = world.events.iter().find(|h| h.kind == WorldEventKind::Fault(FaultRow::G5)).unwrap();
    let stated = 1.0 / world.drawn.cylinder.vessel.volume;
    assert!((fault.lost_kg - (first_kg - last_kg) * stated).abs() < 0.01 * fault.lost_kg);
}

#[test]
fn a_bottle_filled_elsewhere_has_no_rows_meanwhile() {
    let mut away = 0;
    for seed in 0..6 {
        let (_, _, world) = pair(FaultRow::G1, "workshop", seed);
        let without = world.truth.time_s.iter().filter(|t| (DAY_S..DAY_S + HOUR_S).contains(t)).count() == 0;
        let gap = world.events.iter().any(|event| event.kind == WorldEventKind::Gap);
        assert_eq!(without, gap);
        away += usize::from(without);
    }
    assert!(away > 0 && away < 6, "{away} of 6");
}

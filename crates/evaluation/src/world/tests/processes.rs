//! What is done to the gas, and what surroundings do, each by itself: a cylinder in a calm room for a day.
use cylwatch_thermal::scenario::{AxialVariation, Initial, OutsideFilm, Scenario, Series, Surroundings};
use cylwatch_thermal::simulate::{SimulationSettings, simulate};
use cylwatch_thermal::trajectory::Trajectory;
use cylwatch_thermal::units::{BAR_PA, DAY_S, HOUR_S};
use cylwatch_thermal::vessel::{Fill, GasResolution, Vessel};

use crate::world::VesselKind;
use crate::world::disturbance::{Disturbance, Surrounding};
use crate::world::process::{Process, Settled};
use crate::world::statistics::mean;

/// 1 bar at 200 bar and 15 °C in 20 L, kg (CoolProp: 223.19 and 222.23 kg/m³, and the volume that gives way).
const BAR_KG: f64 = 0.019_2;

fn vessel() -> Vessel {
    let mut vessel = VesselKind::Nitrogen20.nominal().unwrap().vessel;
    vessel.geometry.cylinder_cells = 3;
    vessel.geometry.layers.iter_mut().for_each(|layer| layer.cells = 1);
    vessel.gas = GasResolution::WellMixed;
    vessel
}

/// A day in air that swings by 5 K either way around 10 °C.
fn day(fill_pa: f64) -> Scenario {
    let hours: Vec<f64> = (0..=24).map(f64::from).collect();
    let air = |hour: &f64| 283.15 + 5.0 * (std::f64::consts::TAU * hour / 24.0).sin();
    let air_k =
        Series::try_new(hours.iter().map(|hour| hour * HOUR_S).collect(), hours.iter().map(air).collect())
            .unwrap();
    Scenario {
        name: "a day".into(),
        initial: Initial {
            fill: Fill::Settled { pressure_pa: fill_pa, temperature_k: 288.15 },
            wall_temperature_k: 283.15,
            gas_temperature_k: 283.15,
        },
        surroundings: Surroundings {
            radiation_k: Some(air_k.clone()),
            air_k,
            film: OutsideFilm::Coefficient { film_w_m2_k: Series::constant(10.0) },
            sun: None,
            axial: AxialVariation::default(),
        },
        flows: Vec::new(),
        pressure_limits_pa: Vec::new(),
        sensors: Vec::new(),
        duration_s: DAY_S,
        sample_time_s: 60.0,
    }
}

fn simulated(scenario: &Scenario) -> Trajectory {
    let settings = SimulationSettings { relative_tolerance: 1e-5, ..SimulationSettings::default() };
    simulate(&vessel(), scenario, &settings, &mut |_| ()).unwrap()
}

fn with(process: &Process, mut scenario: Scenario, fill_pa: f64) -> Trajectory {
    let vessel = vessel();
    let settled = Settled { vessel: &vessel, filled_pa: fill_pa };
    scenario.flows = process.flows(&settled, &scenario.surroundings.air_k).unwrap();
    simulated(&scenario)
}

fn process(process: &Process) -> Trajectory {
    with(process, day(200e5), 200e5)
}

/// A disturbance from two o'clock on.
fn disturbed(lasting_s: f64, kind: Surrounding) -> Scenario {
    let mut scenario = day(200e5);
    Disturbance { start_s: 2.0 * HOUR_S, lasting_s, kind }.apply(&mut scenario.surroundings).unwrap();
    scenario
}

/// Values of minutes between two times in hours.
fn between(values: &[f64], from_h: f64, to_h: f64) -> &[f64] {
    &values[(from_h * 60.0) as usize..(to_h * 60.0) as usize]
}

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

fn lost_kg(day: &Trajectory) -> f64 {
    day.mass_kg[0] - day.mass_kg[1439]
}

#[test]
fn a_fast_refill_is_hot_first_and_looks_like_a_loss_while_it_cools() {
    let rise_pa = 40.0 * BAR_PA;
    let refill = Process::Refill { start_s: 2.0 * HOUR_S, lasting_s: 120.0, rise_pa, source_k: 288.15 };
    let day = with(&refill, day(160.0 * BAR_PA), 160.0 * BAR_PA);
    // From 183.10 to 223.19 kg/m³ in 20 L (CoolProp), which grow by half a percent of that.
    assert!((-lost_kg(&day) / 0.8017 - 1.0).abs() < 0.01, "{} kg", -lost_kg(&day));
    let peak_pa = largest(between(&day.pressure_pa, 2.0, 2.5));
    let settled_pa = between(&day.pressure_pa, 4.0, 4.1)[0];
    assert!(peak_pa - settled_pa > 8.0 * BAR_PA, "{peak_pa} to {settled_pa}");
}

#[test]
fn a_discharge_closes_at_its_pressure_and_rebounds() {
    let until_pa = 160.0 * BAR_PA;
    let discharge = Process::Discharge { start_s: 600.0, lasting_s: 60.0, diameter_m: 0.003, until_pa };
    let day = with(&discharge, Scenario { sample_time_s: 1.0, duration_s: HOUR_S, ..day(200e5) }, 200e5);
    let least_pa = -largest(&day.pressure_pa.iter().map(|pressure_pa| -pressure_pa).collect::<Vec<_>>());
    assert!(least_pa > until_pa - 1.0 && least_pa < until_pa + BAR_PA, "{least_pa} Pa");
    assert!(day.pressure_pa[3600] > until_pa + 5.0 * BAR_PA, "{} Pa", day.pressure_pa[3600]);
    assert!((day.mass_kg[660] - day.mass_kg[3600]).abs() < 1e-9);
}

#[test]
fn puffs_take_their_pressure_each() {
    let puffs = Process::Puffs { start_s: HOUR_S, every_s: HOUR_S, count: 5, drop_pa: 2.0 * BAR_PA };
    let lost_kg = lost_kg(&process(&puffs));
    assert!((lost_kg / (10.0 * BAR_KG) - 1.0).abs() < 0.01, "{lost_kg} kg");
}

#[test]
fn leaks_lose_the_integral_of_their_rate() {
    let rate_pa_s = 0.2 * BAR_PA / HOUR_S;
    let close = |leak: &Process, expected: f64| {
        let bar = lost_kg(&process(leak)) / BAR_KG;
        assert!((bar / expected - 1.0).abs() < 0.01, "{bar} bar by {leak:?}");
    };
    let (start_s, stop_s) = (2.0 * HOUR_S, 12.0 * HOUR_S);
    close(&Process::Leak { start_s, stop_s, rate_pa_s }, 2.0);
    // Doubling every 2 h for 10 h: 0.2 * 2/ln 2 * (2^5 - 1) bar; capped at four times the first rate from 4 h on.
    let growing = |largest_pa_s| Process::GrowingLeak {
        start_s,
        stop_s,
        rate_pa_s,
        doubling_s: 2.0 * HOUR_S,
        largest_pa_s,
    };
    close(&growing(f64::MAX), 0.2 * 2.0 / 2_f64.ln() * 31.0);
    close(&growing(4.0 * rate_pa_s), 0.2 * 2.0 / 2_f64.ln() * 3.0 + 0.8 * 6.0);
}

#[test]
fn a_cold_leak_is_open_only_while_it_is_cold() {
    let (rate_pa_s, below_k) = (BAR_PA / HOUR_S, 283.15);
    let day = process(&Process::ColdLeak { start_s: 0.0, stop_s: DAY_S, rate_pa_s, below_k });
    // The second half of the day is the colder one; the leak changes every half hour.
    assert!(between(&day.outflow_kg_s, 0.1, 11.4).iter().all(|&flow| flow == 0.0));
    assert!(between(&day.outflow_kg_s, 12.6, 23.9).iter().all(|&flow| flow > 0.0));
}

#[test]
fn a_masked_leak_holds_the_pressure_of_a_gas_that_becomes_warmer() {
    let warming = disturbed(20.0 * HOUR_S, Surrounding::Air { by_k: 20.0, within_s: 8.0 * HOUR_S });
    let usual = simulated(&warming);
    let masked = |day: &Trajectory| {
        let leak = Process::masked(&vessel(), day, (2.5 * HOUR_S, 4.5 * HOUR_S), 600.0).unwrap();
        with(&leak, warming.clone(), 200e5)
    };
    // The leak cools the gas: the second time it is masked with the temperature that it has itself.
    let masked = masked(&masked(&usual));
    let rise = |day: &Trajectory| {
        let during = between(&day.pressure_pa, 2.5, 4.5);
        during[during.len() - 1] - during[0]
    };
    assert!(rise(&usual) > 2.0 * BAR_PA, "{} Pa", rise(&usual));
    assert!(rise(&masked).abs() < 0.03 * rise(&usual), "{} Pa of {}", rise(&masked), rise(&usual));
    assert!(lost_kg(&masked) > 2.0 * BAR_KG);
}

#[test]
fn washing_takes_the_skin_to_the_water_and_ice_holds_it_at_zero() {
    let wet = disturbed(3.0 * HOUR_S, Surrounding::Wet { by_k: -10.0, melting_s: HOUR_S });
    let skin_k = simulated(&wet).surface_k("middle").unwrap();
    let air_k = &day(200e5).surroundings.air_k;
    for minute in 210..234 {
        let water_k = (air_k.at(60.0 * f64::from(minute)) - 10.0).max(273.15);
        let skin_k = skin_k[minute as usize];
        assert!((skin_k - water_k).abs() < 2.0, "{skin_k} {water_k}");
    }
    let icy = between(&skin_k, 4.5, 4.95);
    assert!(icy.iter().all(|skin_k| (skin_k - 273.15).abs() < 1.0), "{icy:?}");
}

#[test]
fn a_heater_warms_one_end_and_what_a_hall_radiates_lags() {
    let heated = simulated(&disturbed(6.0 * HOUR_S, Surrounding::Heater { difference_k: 20.0 }));
    let usual = simulated(&day(200e5));
    let by_k = |place: &str| {
        let surface_k = |day: &Trajectory| mean(between(&day.surface_k(place).unwrap(), 6.0, 7.5));
        surface_k(&heated) - surface_k(&usual)
    };
    assert!(by_k("shoulder") > 1.0 && by_k("bottom") < -1.0, "{} {}", by_k("shoulder"), by_k("bottom"));
    let mut hall = day(200e5).surroundings;
    (hall.air_k, hall.radiation_k) = (Series::constant(283.15), Some(Series::constant(283.15)));
    let kind = Surrounding::Hall { air_k: 303.15 };
    Disturbance { start_s: 2.0 * HOUR_S, lasting_s: 6.0 * HOUR_S, kind }.apply(&mut hall).unwrap();
    // What it radiates to lags behind by half an hour.
    let around_k = |hour: f64| hall.radiation_k.as_ref().unwrap().at(hour * HOUR_S);
    assert!((around_k(7.9) - 303.15).abs() < 0.2 && (around_k(2.1) - 303.15).abs() > 1.0);
}

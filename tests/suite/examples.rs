//! What the examples claim.
#[allow(dead_code)]
#[path = "../../examples/cold_night.rs"]
mod cold_night;
#[allow(dead_code)]
#[path = "../../examples/leak.rs"]
mod leak;
#[allow(dead_code)]
#[path = "../../examples/leak_masked_by_warming.rs"]
mod leak_masked_by_warming;
#[allow(dead_code)]
#[path = "../../examples/own_detector.rs"]
mod own_detector;
#[allow(dead_code)]
#[path = "../../examples/refill.rs"]
mod refill;
#[allow(dead_code)]
#[path = "../../examples/scenario_1.rs"]
mod scenario_1;
#[allow(dead_code)]
#[path = "../../examples/scenario_2.rs"]
mod scenario_2;
#[allow(dead_code)]
#[path = "../../examples/scenario_3.rs"]
mod scenario_3;
#[allow(dead_code)]
#[path = "../../examples/scenario_4.rs"]
mod scenario_4;
#[allow(dead_code)]
#[path = "../../examples/sensor_placement.rs"]
mod sensor_placement;
#[allow(dead_code)]
#[path = "../../examples/tunnel_passage.rs"]
mod tunnel_passage;

use approx::assert_abs_diff_eq;
use cylwatch::detector::monitor::Verdict;
use std::collections::VecDeque;

#[test]
fn a_tight_cylinder_stays_above_160_bar_at_minus_25_degrees_and_alarms_when_it_is_colder() {
    let [paper, colder, coldest] = &scenario_1::run().unwrap()[..] else { panic!("three steps") };
    // A rigid tight cylinder reads 160.09 bar at -25 °C (CoolProp); the steel's shrinking adds 0.3 to 0.4 bar.
    assert_abs_diff_eq!(paper.pressure_bar[1], 160.45, epsilon = 0.15);
    assert_eq!(paper.limit_min, None);
    let [late, early] = [colder, coldest].map(|fall| fall.limit_min.unwrap());
    assert!(20.0 < early && early < late && late < 90.0, "{early} {late}");
    assert!(coldest.pressure_bar[1] < colder.pressure_bar[1] && colder.pressure_bar[1] < 157.0);
}

#[test]
fn the_gas_lags_a_minute_or_two_behind_the_wall_and_more_behind_valve_and_sensors() {
    let lags = scenario_2::run().unwrap();
    let of = |place: &str| lags.iter().find(|lag| lag.place == place).unwrap();
    for place in ["bottom", "middle", "shoulder"] {
        assert!((50.0..130.0).contains(&of(place).lag_s), "{place}: {} s", of(place).lag_s);
        assert!((2.0..4.0).contains(&of(place).largest_k), "{place}: {} K", of(place).largest_k);
    }
    assert!((180.0..300.0).contains(&of("valve").lag_s));
    for place in ["shoulder", "valve"] {
        let sensor = of(&format!("{place} sensor"));
        assert!(sensor.lag_s > of(place).lag_s + 120.0, "{place}: {} s", sensor.lag_s);
    }
}

#[test]
fn the_shoulder_follows_a_slow_ramp_within_half_a_kelvin_and_its_sensor_within_one_bar() {
    let moments = scenario_3::run().unwrap();
    assert_eq!(moments.len(), 6);
    for moment in &moments[1..] {
        assert!((0.3..0.5).contains(&moment.ahead_k[0]), "{} h: {} K", moment.time_h, moment.ahead_k[0]);
        assert!((0.9..1.1).contains(&moment.ahead_k[1]), "{} h: {} K", moment.time_h, moment.ahead_k[1]);
        assert!(
            (0.8..1.1).contains(&moment.pressure_bar),
            "{} h: {} bar",
            moment.time_h,
            moment.pressure_bar
        );
    }
}

#[test]
fn the_ideal_gas_explains_seven_tenths_of_the_fall_of_a_cooling_cylinder() {
    let [real, ideal] = scenario_4::run().unwrap();
    let fall = |cooling: &scenario_4::Cooling| cooling.pressure_bar[0] - cooling.pressure_bar[1];
    assert_abs_diff_eq!(fall(&ideal) / fall(&real), 0.70, epsilon = 0.02);
    // 0.992 and 0.694 bar/K for a rigid volume (CoolProp); the expansion of the steel takes 0.01 to 0.03.
    assert_abs_diff_eq!(real.slope_bar_k, 0.97, epsilon = 0.02);
    assert_abs_diff_eq!(ideal.slope_bar_k, 0.685, epsilon = 0.02);
    assert!(ideal.mass_kg > real.mass_kg);
}

#[test]
fn a_tunnel_silences_the_switch_of_a_tight_and_of_a_leaky_cylinder_alike() {
    let [tight, leaky] = tunnel_passage::run().unwrap();
    for passage in [&tight, &leaky] {
        assert!(passage.alarm_at_start, "{}", passage.cylinder);
        let [silent, alarm] = passage.changes_min[..] else { panic!("{}", passage.cylinder) };
        assert!(30.0 < silent && silent < 60.0 && 60.0 < alarm, "{}", passage.cylinder);
    }
    assert!(tight.pressure_bar[1] > leaky.pressure_bar[1] + 20.0);
}

#[test]
fn a_cold_and_a_leaking_cylinder_show_the_same_pressure_and_differ_by_their_mass() {
    let [cold, leaking] = leak::run().unwrap();
    // A minute of 60 g/h is 0.05 bar.
    assert_abs_diff_eq!(cold.pressure_bar, leaking.pressure_bar, epsilon = 0.06);
    assert_abs_diff_eq!(cold.lost_g, 0.0, epsilon = 0.01);
    assert_abs_diff_eq!(leaking.lost_g, 60.0 * leaking.time_h, epsilon = 0.01);
    assert!(leaking.lost_g > 500.0 && leaking.gas_degc > cold.gas_degc + 29.0);
}

#[test]
fn a_leak_that_a_warming_day_hides_from_the_gauge_is_found_with_its_rate_and_onset() {
    let masked = leak_masked_by_warming::run().unwrap();
    let (spread_bar, lost_g) = masked.spread_and_loss();
    assert!(spread_bar < 2.5, "{spread_bar} bar");
    assert_abs_diff_eq!(lost_g, 14.7 * leak_masked_by_warming::LEAK_G_H, epsilon = 0.1);
    assert!(!masked.false_alarm);
    assert!(masked.found_s.is_some_and(|found_s| found_s < 54.0 * 3600.0), "{:?}", masked.found_s);
    let finding = masked.finding.unwrap();
    let rate = finding.rate_kg_s.scaled(3.6e6);
    assert!(rate.holds(leak_masked_by_warming::LEAK_G_H), "{rate:?}");
    assert!(finding.onset_s.holds(48.3 * 3600.0), "{:?}", finding.onset_s);
    assert_eq!(leak_masked_by_warming::figure(&masked).panels.len(), 3);
}

#[test]
fn a_cold_night_trips_the_switch_and_the_monitor_has_warned_of_it_and_says_tight() {
    let night = cold_night::run().unwrap();
    let (switch_s, gas_degc) = night.switch.unwrap();
    // A tight rigid cylinder of 180 bar reads 160 bar at -7.9 degC (CoolProp); a transmitter that is right within 0.6 bar and
    // 0.03 bar/K, and steel that shrinks by 0.2 bar, move it by 2 K.
    assert_abs_diff_eq!(gas_degc, -7.9, epsilon = 2.0);
    let (warned_s, warned_bar) = night.warning.unwrap();
    assert!(warned_s + 12.0 * 3600.0 < switch_s, "{warned_s} {switch_s}");
    assert_abs_diff_eq!(warned_bar, 156.0, epsilon = 1.5);
    assert!(night.verdict == Verdict::Tight && !night.leak, "{}", night.verdict);
}

#[test]
fn a_refill_is_recognised_and_its_cooling_is_no_leak() {
    let refill = refill::run().unwrap();
    let (peak_bar, fall_bar) = refill.peak_and_fall();
    assert!(peak_bar > 220.0 && fall_bar > 18.0, "{peak_bar} {fall_bar}");
    let (gained_kg, said_s) = refill.recognised.unwrap();
    assert_abs_diff_eq!(gained_kg / refill.filled_kg, 1.0, epsilon = 0.1);
    assert!(said_s < refill::REFILL_S + 3600.0, "{said_s}");
    assert!(refill.verdicts.iter().any(|(_, verdict)| *verdict == Verdict::Refill));
    assert!(refill.verdicts.iter().all(|(_, verdict)| *verdict != Verdict::Leak));
    assert_eq!(refill.verdicts.last().map(|(_, verdict)| *verdict), Some(Verdict::Tight));
}

#[test]
fn a_thermometer_at_the_middle_knows_gas_and_leak_better_than_one_at_shoulder_or_valve_in_either_attitude() {
    for attitude in sensor_placement::run().unwrap() {
        let of = |place: &str| {
            let position = attitude.position(place).unwrap();
            (position.steady.unwrap(), position.robust_k[0])
        };
        let (middle, robust_k) = of("middle");
        for place in ["shoulder", "valve"] {
            let (other, other_robust_k) = of(place);
            let name = attitude.name;
            assert!(middle.gas_sd_k < other.gas_sd_k && robust_k < other_robust_k, "{name}, {place}");
            assert!(middle.smallest_leak_kg_s < 0.7 * other.smallest_leak_kg_s, "{name}, {place}");
        }
        assert_eq!(attitude.best().len(), 2);
        assert!(attitude.report().figure().title.contains("20 L"));
    }
}

#[test]
fn a_detector_of_ones_own_is_judged_beside_the_papers_and_finds_a_large_leak() {
    use cylwatch::evaluation::judge::candidate::{CandidateRun, Row};
    // A tight cylinder that warms by 10 K from one day to the next misses nothing; one that has lost a bar misses it.
    let missing_pa = |shoulder_k, pressure_bar: f64| {
        let mut detector = own_detector::Watching { columns: [1, 0], past: VecDeque::new() };
        let mut statements = Vec::new();
        for (stamp_s, readings) in [(0.0, [200e5, 288.15]), (86_400.0, [1e5 * pressure_bar, shoulder_k])] {
            detector.step(&Row { stamp_s, readings: &readings, historical: false }, &mut statements).unwrap();
        }
        assert_eq!(statements.len(), 1);
        statements[0].statistic.unwrap()
    };
    assert_abs_diff_eq!(missing_pa(298.15, 209.92), 0.0, epsilon = 1.0);
    assert_abs_diff_eq!(missing_pa(288.15, 199.0), 1e5, epsilon = 1.0);
    let table = own_detector::run().unwrap();
    let [own, paper] = &table.candidates[..] else { panic!("two detectors") };
    assert_eq!([&own.name[..], &paper.name[..]], ["day before", "paper"]);
    assert!(table.is_whole() && own.threshold.is_some());
    let largest = own.judged().unwrap().leaks.as_ref().unwrap().by_rate.last().unwrap();
    assert_eq!((largest.delay.leaks, largest.delay.found), (5, 5));
}

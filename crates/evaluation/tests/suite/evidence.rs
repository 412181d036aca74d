//! Evidence from an observer on a cylinder under a train: tight, leaking, with gaps, exchanged, and saved in between.
use cylwatch_thermal::units::{DAY_S, HOUR_S, YEAR_S};
use std::sync::OnceLock;

use cylwatch_detector::evidence::{Evidence, Scale, Statistics, Tails, observer_settings};
use cylwatch_estimator::observer::Observer;
use cylwatch_evaluation::world::{Overlay, Request, Simulated, World};

const SEED: u64 = 77;
const ONSET_S: f64 = 5.0 * DAY_S;
/// Part of the gas of 200 bar that is 1 bar at 15 °C.
const PART_PER_BAR: f64 = 0.004_3;

type Row = (f64, [f64; 3]);

/// Eight days of the 20 L cylinder under a train, with a leak of so many bar/h from the sixth on.
fn world(rate_bar_h: f64) -> World {
    let leak = Overlay::Leak { part_per_h: PART_PER_BAR * rate_bar_h, onset_s: ONSET_S };
    let overlay = if rate_bar_h > 0.0 { leak } else { Overlay::Nothing };
    let family = "nitrogen-20l/railway/mixed/class-b/120s".parse().unwrap();
    let request = Request::tight(family, SEED, 8.0 * DAY_S).with(overlay);
    Simulated::run(&request).unwrap().world_of_even_rows(&request).unwrap()
}

fn rows_of(world: &World) -> Vec<Row> {
    world.log.rows().map(|(time_s, row)| (time_s, [row[0], row[1], row[2]])).collect()
}

fn tight_world() -> &'static World {
    static WORLD: OnceLock<World> = OnceLock::new();
    WORLD.get_or_init(|| world(0.0))
}

fn tight() -> &'static [Row] {
    static ROWS: OnceLock<Vec<Row>> = OnceLock::new();
    ROWS.get_or_init(|| rows_of(tight_world()))
}

fn leaking() -> &'static [Row] {
    static ROWS: OnceLock<Vec<Row>> = OnceLock::new();
    ROWS.get_or_init(|| rows_of(&world(0.3)))
}

fn observer() -> Observer {
    let data = &tight_world().operator_data;
    Observer::new(&data.vessel, &data.sensors, &data.commissioning, &observer_settings()).unwrap()
}

fn evidence() -> Evidence {
    Evidence::new(&observer_settings())
}

/// Statistics after each row; `before` may do something to the observer before a row.
fn run(rows: &[Row], mut before: impl FnMut(f64, &mut Observer)) -> Vec<(f64, Statistics)> {
    let (observer, mut evidence) = (&mut observer(), evidence());
    let step = |(time_s, row): &Row| {
        before(*time_s, observer);
        observer.step(*time_s, row).unwrap();
        (*time_s, evidence.update(observer, *time_s, (1.0, 0.0)))
    };
    rows.iter().map(step).collect()
}

/// Time of the first alarm at one false alarm in ten years, s, and its scale.
fn alarm(statistics: &[(f64, Statistics)]) -> Option<(f64, Scale)> {
    let thresholds = Tails::CYLINDER.thresholds(10.0 * YEAR_S).unwrap();
    statistics.iter().find_map(|(time_s, statistics)| Some((*time_s, thresholds.alarm(statistics)?)))
}

#[test]
fn a_tight_cylinder_raises_nothing() {
    let statistics = run(tight(), |_, _| {});
    assert_eq!(alarm(&statistics), None);
    assert!(statistics.iter().all(|(_, values)| values.iter().all(|value| value.is_finite())));
}

#[test]
fn a_leak_is_found_within_a_day_and_not_before_it_begins() {
    let (alarm_s, scale) = alarm(&run(leaking(), |_, _| {})).unwrap();
    println!("0.3 bar/h found after {:.1} h by {scale:?}", (alarm_s - ONSET_S) / HOUR_S);
    assert!(alarm_s > ONSET_S && alarm_s < ONSET_S + DAY_S, "{alarm_s} {scale:?}");
}

#[test]
fn a_fast_leak_is_found_within_an_hour() {
    let (alarm_s, scale) = alarm(&run(&rows_of(&world(8.0)), |_, _| {})).unwrap();
    println!("8 bar/h found after {:.2} h by {scale:?}", (alarm_s - ONSET_S) / HOUR_S);
    assert!(alarm_s > ONSET_S && alarm_s < ONSET_S + HOUR_S, "{alarm_s} {scale:?}");
}

#[test]
fn gaps_raise_nothing_and_what_leaks_in_them_is_found() {
    let without = |rows: &[Row], from_d: f64, to_d: f64| -> Vec<Row> {
        let kept = |row: &&Row| !(from_d * DAY_S..to_d * DAY_S).contains(&row.0);
        rows.iter().filter(kept).copied().collect()
    };
    for (from_d, to_d) in [(3.3, 5.1), (0.4, 6.0)] {
        assert_eq!(alarm(&run(&without(tight(), from_d, to_d), |_, _| {})), None, "{from_d} to {to_d} d");
    }
    // 0.3 bar/h through a day without rows.
    let (alarm_s, _) = alarm(&run(&without(leaking(), 4.9, 6.0), |_, _| {})).unwrap();
    assert!(alarm_s < 6.5 * DAY_S, "{} d", alarm_s / DAY_S);
}

#[test]
fn after_an_exchange_the_leak_of_the_old_cylinder_is_forgotten() {
    // The leaking cylinder gives way to a full, tight one on the eighth day.
    let exchange_s = 7.0 * DAY_S;
    let rows: Vec<Row> = leaking()
        .iter()
        .zip(tight())
        .map(|(old, new)| if old.0 < exchange_s { *old } else { *new })
        .collect();
    let statistics = run(&rows, |time_s, observer| {
        if time_s == exchange_s {
            observer.begin_exchange();
        }
        if time_s == exchange_s + 600.0 {
            observer.end_exchange();
        }
    });
    let (old, new): (Vec<_>, Vec<_>) = statistics.into_iter().partition(|(time_s, _)| *time_s < exchange_s);
    assert!(alarm(&old).is_some());
    assert_eq!(alarm(&new), None);
    assert!(new[0].1.iter().all(|value| value.abs() < 1e-9), "{:?}", new[0]);
}

#[test]
fn saved_and_restored_at_any_sample_it_goes_on_bit_for_bit() {
    let (mut observer, mut whole) = (observer(), evidence());
    let mut restored = whole.clone();
    for (n, (time_s, row)) in leaking().iter().enumerate().skip(3000).take(1500) {
        observer.step(*time_s, row).unwrap();
        if n % 7 == 0 {
            restored = serde_json::from_str(&serde_json::to_string(&restored).unwrap()).unwrap();
        }
        let bits = |statistics: Statistics| statistics.map(f64::to_bits);
        assert_eq!(
            bits(whole.update(&observer, *time_s, (1.0, 0.0))),
            bits(restored.update(&observer, *time_s, (1.0, 0.0)))
        );
    }
    assert_eq!(whole, restored);
}

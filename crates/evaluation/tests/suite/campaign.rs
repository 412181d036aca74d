//! A short fault campaign, rows of data only, and what the judge makes of histories. The long one: example `fault_campaign`.
use cylwatch_detector::monitor::{Event, EventKind, Health, MonitorSettings, Reason, Verdict};
use cylwatch_estimator::observer::Commissioning;
use cylwatch_estimator::sensor::Sensor;
use cylwatch_estimator::thermal::vessel::presets;
use cylwatch_evaluation::fault::{
    Case, CaseLeak, Fault, History, Missed, Record, Snapshot, Step, Subject, TableRow, allowed_delay_s, judge,
};
use cylwatch_evaluation::truth::{Course, TruthSettings, generate_with};

const MINUTE_S: f64 = 60.0;
const HOUR_S: f64 = 3600.0;
const DAY_S: f64 = 86_400.0;
const SENSORS: [&str; 3] = ["shoulder", "valve", "pressure"];

fn subject() -> Subject {
    Subject {
        vessel: presets::load("nitrogen-20l").unwrap(),
        sensors: SENSORS.map(|name| Sensor::typical(name).unwrap()).to_vec(),
        commissioning: Commissioning { settled: false, ..Commissioning::filled(200e5, 288.15) },
        settings: MonitorSettings::default(),
    }
}

/// Two days of a cylinder, with the air around it as a further channel.
fn record(seed: u64) -> Record {
    let settings = TruthSettings { cylinder_cells: 2, ..TruthSettings::fast() };
    let truth = generate_with(&Course::RailwayWeeks { days: 2.0 }, seed, MINUTE_S, &settings).unwrap();
    let mut record = Record::of_log(&truth.log, &SENSORS).unwrap();
    record.sensors.push("ambient".into());
    record.rows_mut().zip(&truth.ambient_k).for_each(|(row, air_k)| row.readings.push(*air_k));
    record
}

fn rows(record: &Record, from_s: f64, to_s: f64) -> Record {
    let within = |step: &&Step| step.row().is_some_and(|row| (from_s..to_s).contains(&row.stamp_s));
    Record { sensors: record.sensors.clone(), steps: record.steps.iter().filter(within).cloned().collect() }
}

/// Left to the long campaign are faults of the installation, which a monitor has from its first row on, and offsets (P2, T2): after a day of
/// learning, half a bar or a kelvin while wall and gas move is not told from a loss of 10 g.
const FROM_A_TIME_ON: [TableRow; 11] = [
    TableRow::P1,
    TableRow::P3,
    TableRow::P6,
    TableRow::P7,
    TableRow::T1,
    TableRow::T4,
    TableRow::T5,
    TableRow::E7,
    TableRow::D1,
    TableRow::D3,
    TableRow::D5,
];

#[test]
fn faults_of_the_data_end_in_no_panic_no_nan_no_blind_tightness_and_no_leak() {
    let (learnt_s, onset_s, until_s) = (1.25 * DAY_S, 1.3 * DAY_S, 1.8 * DAY_S);
    let subject = subject();
    for seed in [21, 22] {
        let record = record(seed);
        let state = subject.state_after(&rows(&record, 0.0, learnt_s).without("ambient")).unwrap();
        let good = rows(&record, learnt_s, until_s);
        for row in FROM_A_TIME_ON {
            let fault = row.draw(seed).unwrap();
            let faulty = fault.inject(&good, onset_s, seed).unwrap().without("ambient");
            let history = subject.run(Some(&state), &faulty).unwrap();
            assert!(history.outputs > 0 || matches!(fault, Fault::Gap { .. }), "{fault:?}");
            let unbroken = subject.run(Some(&state), &good.clone().without("ambient")).unwrap().digest;
            let (leak, exchanges) = (None, Vec::new());
            let case = Case { row, fault: Some(fault), onset_s, leak, exchanges, from_s: learnt_s, until_s };
            let missed = judge(&case, &history, Some(unbroken));
            assert!(missed.is_empty(), "{seed} {:?}: {missed:?}", case.fault);
        }
    }
}

/// A history of verdicts and of whether a leak was stated, by hours.
fn history(verdicts: &[(f64, Verdict)], leaking: &[(f64, bool)]) -> History {
    let hours = |at: &f64| at * HOUR_S;
    History {
        verdicts: verdicts.iter().map(|(at, verdict)| (hours(at), *verdict)).collect(),
        leaking: leaking.iter().map(|(at, is)| (hours(at), *is)).collect(),
        outputs: 1,
        ..History::default()
    }
}

fn case(row: TableRow, fault: Option<Fault>) -> Case {
    let (leak, exchanges) = (None, Vec::new());
    Case { row, fault, onset_s: 10.0 * HOUR_S, leak, exchanges, from_s: 0.0, until_s: 100.0 * HOUR_S }
}

fn leaking(row: TableRow, fault: Option<Fault>) -> Case {
    let leak = CaseLeak { rate_pa_s: 1e5 / HOUR_S, onset_s: 20.0 * HOUR_S };
    Case { leak: Some(leak), ..case(row, fault) }
}

fn stuck(hours: f64) -> Option<Fault> {
    Some(Fault::Stuck { sensor: "pressure".into(), lasting_s: hours * HOUR_S })
}

#[test]
fn a_leak_must_be_found_within_its_time_and_not_before_its_onset() {
    // 8^(2/3) = 4.
    assert!((allowed_delay_s(1e5 / HOUR_S / 8.0) / HOUR_S - 24.0).abs() < 1e-9);
    let judged = |from_h: f64| {
        let history = history(&[(0.0, Verdict::Tight)], &[(0.0, false), (from_h, true)]);
        judge(&leaking(TableRow::D4, None), &history, None)
    };
    assert_eq!(judged(25.0), []);
    assert_eq!(judged(27.0), [Missed::NotFound]);
    assert_eq!(judged(19.0), [Missed::FalseLeak]);
    let tight = case(TableRow::D4, None);
    assert_eq!(judge(&tight, &history(&[], &[(50.0, true)]), None), [Missed::FalseLeak]);
    assert_eq!(judge(&tight, &history(&[], &[(0.0, false)]), None), []);
}

#[test]
fn while_blind_nothing_is_tight_and_blind_time_does_not_count_against_a_leak() {
    let blind = Verdict::Unknown(Reason::Stuck);
    let flagged = |verdicts: &[(f64, Verdict)], found_h: f64| {
        let mut history = history(verdicts, &[(found_h, true)]);
        history.health.push((10.2 * HOUR_S, 2, Health::Stuck));
        judge(&leaking(TableRow::P1, stuck(30.0)), &history, None)
    };
    let in_time = [(0.0, Verdict::Tight), (10.5, blind), (40.5, Verdict::Tight)];
    assert_eq!(flagged(&in_time, 45.0), []);
    assert_eq!(flagged(&in_time, 47.0), [Missed::NotFound]);
    let late = [(0.0, Verdict::Tight), (11.5, blind)];
    assert_eq!(flagged(&late, 45.0), [Missed::TightWhileBlind]);
    // Beside a heater it may be said for a while that it cannot be known; that time does not count.
    let beside_heater = |unknown_h: f64, found_h: f64| {
        let disturbed = Verdict::Unknown(Reason::Disturbed);
        let verdicts = [(0.0, Verdict::Tight), (22.0, disturbed), (22.0 + unknown_h, Verdict::Tight)];
        judge(&leaking(TableRow::E5, None), &history(&verdicts, &[(0.0, false), (found_h, true)]), None)
    };
    assert_eq!(beside_heater(1.0, 30.0), [Missed::NotFound]);
    assert_eq!(beside_heater(6.0, 30.0), []);
    // Who says at the deadline that it cannot be told has not missed the leak.
    assert_eq!(flagged(&[(0.0, Verdict::Tight), (10.5, blind)], 90.0), []);
}

#[test]
fn a_sensor_must_be_named_soon_after_its_fault() {
    let judged = |at_h: f64, sensor: usize| {
        let mut history = history(&[(0.0, Verdict::Unknown(Reason::Stuck))], &[]);
        history.health.push((at_h * HOUR_S, sensor, Health::Stuck));
        judge(&case(TableRow::P1, stuck(30.0)), &history, None)
    };
    assert_eq!(judged(10.5, 2), []);
    assert_eq!(judged(11.5, 2), [Missed::NotFlagged]);
    assert_eq!(judged(10.5, 0), [Missed::NotFlagged]);
}

#[test]
fn exchanges_of_gas_must_be_told_in_their_direction() {
    let judged = |kind: EventKind, at_h: f64| {
        let mut history = history(&[], &[]);
        history.events.push((at_h * HOUR_S, Event::new(at_h * HOUR_S, at_h * HOUR_S, kind)));
        let refill = Case { exchanges: vec![(10.0 * HOUR_S, false)], ..case(TableRow::G1, None) };
        judge(&refill, &history, None)
    };
    assert_eq!(judged(EventKind::Refill(0.8), 11.0), []);
    assert_eq!(judged(EventKind::Refill(0.8), 14.0), [Missed::NotRecognised]);
    assert_eq!(judged(EventKind::Discharge(0.8), 11.0), [Missed::NotRecognised]);
}

#[test]
fn a_restart_goes_on_bit_for_bit_or_is_declared() {
    let cycles = |snapshot| Some(Fault::PowerCycles { mean_s: HOUR_S, snapshot });
    let judged = |snapshot, history: &History, unbroken| {
        judge(&case(TableRow::D5, cycles(snapshot)), history, Some(unbroken))
    };
    let same = History { digest: 7, ..history(&[(0.0, Verdict::Tight)], &[]) };
    assert_eq!(judged(Snapshot::Current, &same, 7), []);
    assert_eq!(judged(Snapshot::Current, &same, 8), [Missed::SilentRestart]);
    let cold = |verdict| History {
        cold_starts_s: vec![12.0 * HOUR_S],
        ..history(&[(0.0, Verdict::Tight), (12.01, verdict)], &[])
    };
    assert_eq!(judged(Snapshot::Truncated, &cold(Verdict::Unknown(Reason::Learning)), 0), []);
    assert_eq!(
        judged(Snapshot::Truncated, &cold(Verdict::Unknown(Reason::Jump)), 0),
        [Missed::SilentRestart]
    );
    assert_eq!(judged(Snapshot::Corrupted, &same, 0), [Missed::SilentRestart]);
    let taken = History { wrongly_restored: 1, ..cold(Verdict::Unknown(Reason::Learning)) };
    assert_eq!(judged(Snapshot::Foreign, &taken, 0), [Missed::SilentRestart]);
}

#[test]
fn drift_downwards_may_be_taken_for_a_leak_and_upwards_not() {
    let judged = |per_s: f64| {
        let drift = Fault::Drift { sensor: "pressure".into(), per_s };
        judge(&case(TableRow::P3, Some(drift)), &history(&[], &[(50.0, true)]), None)
    };
    assert_eq!(judged(-0.03), []);
    assert_eq!(judged(0.03), [Missed::FalseLeak]);
}

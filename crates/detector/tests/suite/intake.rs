//! The intake: order, duplicates, gaps, clocks that jump, bins, and the state in between.
use cylwatch_detector::DetectorError;
use cylwatch_detector::estimator::thermal::units::{DAY_S, HOUR_S, MINUTE_S};
use cylwatch_detector::monitor::intake::{Intake, IntakeSettings, Readings, Row, Taken};
use cylwatch_detector::monitor::{Event, EventKind};
use proptest::prelude::*;

type Arrival = (f64, Vec<f64>);

fn intake(settings: IntakeSettings) -> Intake {
    Intake::new(settings, 2).unwrap()
}

/// Each row by itself.
fn each() -> IntakeSettings {
    IntakeSettings { step_s: 0.0, ..IntakeSettings::default() }
}

fn late(lateness_s: f64) -> IntakeSettings {
    IntakeSettings { lateness_s, ..each() }
}

/// All that comes out of rows and the end of the file.
fn all(intake: &mut Intake, rows: &[Arrival]) -> Taken {
    let mut out = Taken::default();
    let mut add = |taken: Taken| {
        out.rows.extend(taken.rows);
        out.events.extend(taken.events);
    };
    rows.iter().for_each(|(stamp_s, readings)| add(intake.take(*stamp_s, readings).unwrap()));
    add(intake.flush());
    out
}

/// Bits of all that comes out: NaN is equal to NaN.
fn bits<'a>(rows: impl IntoIterator<Item = &'a Row>) -> Vec<Vec<u64>> {
    let row = |row: &Row| [&[row.time_s, row.stamp_s], &row.readings[..]].concat();
    rows.into_iter().map(|r| row(r).into_iter().map(f64::to_bits).collect()).collect()
}

fn minutes(from: usize, to: usize) -> Vec<Arrival> {
    (from..to).map(|k| (k as f64 * MINUTE_S, vec![k as f64, 280.0 + k as f64])).collect()
}

fn shifted(rows: Vec<Arrival>, by_s: f64) -> Vec<Arrival> {
    rows.into_iter().map(|(stamp_s, readings)| (stamp_s + by_s, readings)).collect()
}

fn times(taken: &Taken) -> Vec<f64> {
    taken.rows.iter().map(|row| row.time_s).collect()
}

fn jumps(events: &[Event]) -> Vec<f64> {
    let jump = |event: &Event| match event.kind {
        EventKind::ClockJump(jump_s) => Some(jump_s),
        _ => None,
    };
    events.iter().filter_map(jump).collect()
}

#[test]
fn rows_in_order_come_out_at_once_as_they_are() {
    let mut intake = intake(each());
    for (stamp_s, readings) in minutes(0, 100) {
        let taken = intake.take(stamp_s, &readings).unwrap();
        assert_eq!(taken, Taken { rows: [row(stamp_s, &readings)].into(), events: vec![] });
    }
    assert_eq!(intake.flush(), Taken::default());
    assert_eq!(intake.usual_interval_s(), Some(MINUTE_S));
}

#[test]
fn a_row_waits_for_its_lateness_and_no_longer() {
    let mut intake = intake(late(150.0));
    let out: Vec<usize> = minutes(0, 6).iter().map(|(t, r)| intake.take(*t, r).unwrap().rows.len()).collect();
    assert_eq!(out, [0, 0, 0, 1, 1, 1]);
    assert_eq!((intake.held(), intake.flush().rows.len(), intake.held()), (3, 3, 0));
}

#[test]
fn a_row_later_than_the_lateness_is_reported_and_not_used() {
    let mut rows = minutes(0, 20);
    let belated = rows.remove(3);
    rows.insert(16, belated);
    let mut intake = intake(late(600.0));
    let out = all(&mut intake, &rows);
    assert_eq!(out.rows.len(), 19);
    assert_eq!(intake.counts().too_late, 1);
    let [event] = &out.events[..] else { panic!("{:?}", out.events) };
    assert_eq!((event.kind, event.onset_s), (EventKind::TooLate, 180.0));
}

#[test]
fn readings_of_one_time_are_one_row_or_follow_each_other() {
    let rows = [(0.0, vec![1.0, f64::NAN]), (0.0, vec![f64::NAN, 2.0]), (0.0, vec![1.0, 2.0])];
    // Held back they are one row.
    let mut waiting = intake(late(60.0));
    let out = all(&mut waiting, &rows);
    assert_eq!(out.rows, [row(0.0, &[1.0, 2.0])]);
    assert_eq!((waiting.counts().merged, waiting.counts().duplicates), (1, 1));
    // At once, the second one has what the first had not, and the third says nothing new.
    let out = all(&mut intake(each()), &rows);
    assert_eq!(bits(&out.rows), bits(&rows[..2].iter().map(|(t, r)| row(*t, r)).collect::<Vec<_>>()));
}

fn row(t: f64, readings: &[f64]) -> Row {
    Row { time_s: t, stamp_s: t, readings: Readings::from_slice(readings) }
}

#[test]
fn of_two_values_the_later_stands_until_it_is_handed_out() {
    let rows = [(0.0, vec![1.0, 5.0]), (0.0, vec![2.0, f64::INFINITY]), (60.0, vec![3.0, 6.0])];
    let (mut waiting, mut at_once) = (intake(late(30.0)), intake(each()));
    assert_eq!(all(&mut waiting, &rows).rows[0].readings[..], [2.0, 5.0]);
    assert_eq!(all(&mut at_once, &rows).rows.len(), 2);
    assert_eq!((waiting.counts().contradictions, at_once.counts().contradictions), (1, 1));
}

#[test]
fn summer_time_is_a_gap_of_an_hour() {
    let mut rows = minutes(0, 50);
    rows.extend(shifted(minutes(50, 100), HOUR_S));
    let mut intake = intake(each());
    let out = all(&mut intake, &rows);
    assert_eq!(times(&out), rows.iter().map(|(t, _)| *t).collect::<Vec<_>>());
    assert_eq!(out.events.len(), 1);
    assert_eq!(out.events[0].kind, EventKind::Gap(HOUR_S + MINUTE_S));
    assert_eq!((out.events[0].onset_s, out.events[0].time_s), (49.0 * MINUTE_S, HOUR_S + 50.0 * MINUTE_S));
    assert_eq!(intake.offset_s(), 0.0);
}

#[test]
fn a_clock_that_jumps_leaves_the_internal_time_as_it_would_have_been() {
    let year_s = 365.25 * DAY_S;
    for jump_s in [-HOUR_S, -1800.0, -56.0 * year_s, 10.0 * year_s, -HOUR_S - 17.3] {
        for lateness_s in [0.0, 600.0] {
            let mut rows = minutes(0, 50);
            rows.extend(shifted(minutes(50, 100), jump_s));
            let mut intake = intake(late(lateness_s));
            let out = all(&mut intake, &rows);
            assert_eq!(out.rows.len(), 100, "jump {jump_s}");
            let error = |(time_s, k): (&f64, usize)| (time_s - k as f64 * MINUTE_S).abs();
            let worst = times(&out).iter().zip(0..).map(error).fold(0.0, f64::max);
            assert!(worst < 1e-6, "jump {jump_s}: {worst} s");
            let jumps = jumps(&out.events);
            assert!(jumps.len() == 1 && (jumps[0] - jump_s).abs() < 1e-6, "{jumps:?}");
            assert!((intake.offset_s() - jump_s).abs() < 1e-6);
        }
    }
}

#[test]
fn a_clock_that_comes_back_from_1970_finds_its_axis_again() {
    let now_s = 1.7e9;
    let mut rows = shifted(minutes(0, 30), now_s);
    rows.extend(minutes(0, 30));
    rows.extend(shifted(minutes(60, 90), now_s));
    let mut intake = intake(each());
    let out = all(&mut intake, &rows);
    assert_eq!((out.rows.len(), intake.counts().jumps), (90, 2));
    assert!(intake.offset_s().abs() < 1e-6);
    let intervals = times(&out).windows(2).map(|pair| pair[1] - pair[0]).collect::<Vec<_>>();
    assert!(intervals.iter().all(|dt| (dt - MINUTE_S).abs() < 1e-6));
}

#[test]
fn single_wild_stamps_are_dropped_and_counted() {
    for wild_s in [1e9, f64::NAN, f64::INFINITY, -1e300, 2.0 * DAY_S] {
        let mut rows = minutes(0, 50);
        rows[25].0 = wild_s;
        let mut intake = intake(each());
        let out = all(&mut intake, &rows);
        assert_eq!(out.rows.len(), 49, "{wild_s}");
        assert!(intake.counts().wild == 1 && out.events.is_empty(), "{wild_s}: {:?}", out.events);
    }
}

#[test]
fn seconds_of_network_time_cost_a_row_at_most() {
    for (jump_s, jumped) in [(30.0, false), (-30.0, true), (-59.0, true)] {
        // Every 10 s.
        let every_10_s = |rows: Vec<Arrival>| rows.into_iter().map(|(t, r)| (t / 6.0, r)).collect::<Vec<_>>();
        let mut rows = every_10_s(minutes(0, 50));
        rows.extend(shifted(every_10_s(minutes(50, 100)), jump_s));
        let mut intake = intake(each());
        let out = all(&mut intake, &rows);
        let lost = 100 - out.rows.len();
        // A clock set back by 30 s repeats stamps that rows have; set back further it has jumped.
        assert!(lost <= if jumped { 3 } else { 0 }, "{jump_s}: {lost} lost");
        assert!(times(&out).windows(2).all(|pair| pair[1] > pair[0]));
    }
}

#[test]
fn gaps_are_reported_but_rows_that_always_come_rarely_are_none() {
    let mut rows = minutes(0, 20);
    rows.extend(shifted(minutes(20, 40), 60.0 * DAY_S));
    let out = all(&mut intake(each()), &rows);
    assert_eq!(out.events[0].kind, EventKind::Gap(60.0 * DAY_S + MINUTE_S));
    assert_eq!(out.rows.len(), 40);
    // Twice a day: the first interval is a gap, the others are usual.
    let rare: Vec<Arrival> = (0..40).map(|k| (k as f64 * 0.5 * DAY_S, vec![1.0, k as f64])).collect();
    let mut intake = intake(each());
    let out = all(&mut intake, &rare);
    assert!(out.rows.len() == 40 && intake.counts().gaps == 1, "{:?}", intake.counts());
}

#[test]
fn a_replay_of_rows_that_were_used_is_no_news_and_no_jump_of_the_clock() {
    let mut rows = minutes(0, 2000);
    let replay = rows[100..1600].to_vec();
    rows.extend(replay);
    rows.extend(minutes(2000, 2050));
    let mut intake = intake(each());
    let out = all(&mut intake, &rows);
    assert_eq!(bits(&out.rows), bits(&all(&mut self::intake(late(0.0)), &minutes(0, 2050)).rows));
    assert_eq!((out.events.len(), intake.counts().duplicates), (0, 1500));
}

#[test]
fn rows_of_a_time_without_any_come_from_a_store_and_move_no_clock() {
    let mut rows = minutes(0, 100);
    rows.extend(minutes(400, 410));
    rows.extend(minutes(100, 400));
    rows.extend(minutes(410, 450));
    let mut intake = intake(each());
    let out = all(&mut intake, &rows);
    assert_eq!((out.rows.len(), intake.counts().too_late, intake.counts().jumps), (150, 300, 0));
    assert_eq!(intake.offset_s(), 0.0);
}

#[test]
fn a_replay_that_says_so_never_moves_the_clock() {
    let mut intake = intake(each());
    for (stamp_s, readings) in minutes(100, 150) {
        intake.take(stamp_s, &readings).unwrap();
    }
    for (stamp_s, readings) in minutes(0, 50) {
        let taken = intake.take_historical(stamp_s, &readings).unwrap();
        assert!(taken.rows.is_empty() && taken.events[0].kind == EventKind::TooLate);
    }
    assert_eq!(
        (intake.offset_s(), intake.counts().too_late, intake.take(9e3, &[1.0, 2.0]).unwrap().rows.len()),
        (0.0, 50, 1)
    );
}

#[test]
fn a_clock_that_stands_still_is_astray() {
    for lateness_s in [0.0, 600.0] {
        let mut intake = intake(late(lateness_s));
        for (stamp_s, readings) in minutes(0, 20) {
            intake.take(stamp_s, &readings).unwrap();
            assert!(!intake.is_astray());
        }
        for k in 0..10 {
            intake.take(1140.0, &[k as f64 + 0.5, 1.0]).unwrap();
        }
        assert!(intake.is_astray());
        intake.take(1200.0, &[1.0, 1.0]).unwrap();
        assert!(!intake.is_astray());
    }
}

#[test]
fn bins_have_the_median_and_the_time_of_their_last_row() {
    let stamps = [0.0, 10.0, 20.0, 30.0, 61.0, 70.0, 130.0, 250.0];
    let first = [1.0, 2.0, 1e6, 3.0, 4.0, 8.0, f64::NAN, 9.0];
    let rows: Vec<Arrival> = stamps.iter().zip(first).map(|(&t, v)| (t, vec![v, f64::NAN])).collect();
    let mut intake = intake(IntakeSettings { step_s: MINUTE_S, ..each() });
    let out = all(&mut intake, &rows);
    assert_eq!(times(&out), [30.0, 70.0, 130.0, 250.0]);
    let of_first: Vec<f64> = out.rows.iter().map(|row| row.readings[0]).collect();
    assert!(of_first[..2] == [2.5, 6.0] && of_first[2].is_nan() && of_first[3] == 9.0, "{of_first:?}");
    assert!(out.rows.iter().all(|row| row.readings[1].is_nan()));
}

#[test]
fn rows_at_the_step_come_out_at_once_after_the_first() {
    let mut intake = intake(IntakeSettings { step_s: MINUTE_S, ..each() });
    for (k, (stamp_s, readings)) in minutes(0, 20).into_iter().enumerate() {
        let out = intake.take(stamp_s, &readings).unwrap();
        let expected = match k {
            0 => vec![],
            1 => vec![0.0, MINUTE_S],
            _ => vec![stamp_s],
        };
        assert_eq!(times(&out), expected);
    }
    // A faster row is held from then on, until a slow one comes.
    for (stamp_s, expected) in
        [(1150.0, vec![]), (1160.0, vec![]), (1205.0, vec![1160.0]), (1265.0, vec![1205.0, 1265.0])]
    {
        assert_eq!(times(&intake.take(stamp_s, &[1.0, 2.0]).unwrap()), expected);
    }
}

#[test]
fn bins_no_wider_than_the_interval_change_nothing() {
    let settings = IntakeSettings { step_s: MINUTE_S, ..each() };
    let (binned, plain) = (all(&mut intake(settings), &minutes(0, 50)), minutes(0, 50));
    assert_eq!(bits(&binned.rows), bits(&plain.iter().map(|(t, r)| row(*t, r)).collect::<Vec<_>>()));
}

#[test]
fn a_million_rows_in_a_second_are_held_in_bounds() {
    let settings = IntakeSettings { lateness_s: HOUR_S, step_s: DAY_S, ..each() };
    let mut intake = intake(settings);
    let mut most = 0;
    for k in 0..20_000 {
        intake.take(k as f64 * 1e-3, &[1.0, 2.0]).unwrap();
        most = most.max(intake.held());
    }
    assert!(most <= 4096 + 256, "{most}");
}

#[test]
fn settings_and_rows_that_do_not_fit_are_refused() {
    let default = each;
    for (settings, name) in [
        (IntakeSettings { lateness_s: -1.0, ..default() }, "lateness_s"),
        (IntakeSettings { step_s: f64::NAN, ..default() }, "step_s"),
        (IntakeSettings { gap_s: 0.0, ..default() }, "gap_s"),
        (IntakeSettings { longest_gap_s: 60.0, ..default() }, "longest_gap_s"),
    ] {
        let error = Intake::new(settings, 2).unwrap_err();
        assert!(matches!(error, DetectorError::Setting { setting, .. } if setting == name), "{error}");
    }
    let mut intake = intake(default());
    let before = intake.clone();
    let error = intake.take(0.0, &[1.0]).unwrap_err();
    assert!(matches!(error, DetectorError::RowLength { expected: 2, found: 1 }));
    assert_eq!(intake, before);
}

/// Rows at irregular intervals with gaps, some of them in two halves of one time.
fn ordered() -> impl Strategy<Value = Vec<Arrival>> {
    let interval = prop_oneof![6 => 1.0..120.0, 2 => Just(60.0), 1 => 1e3..5e4];
    let reading = prop_oneof![8 => -1e3..1e3, 1 => Just(f64::NAN), 1 => Just(f64::INFINITY)];
    prop::collection::vec((interval, reading.clone(), reading, any::<bool>()), 2..60).prop_map(|rows| {
        let mut time_s = 0.0;
        let mut arrivals = Vec::new();
        for (interval_s, a, b, halves) in rows {
            time_s += interval_s;
            if halves {
                arrivals.push((time_s, vec![a, f64::NAN]));
                arrivals.push((time_s, vec![f64::NAN, b]));
            } else {
                arrivals.push((time_s, vec![a, b]));
            }
        }
        arrivals
    })
}

/// Arrivals delayed by less than the lateness, some of them twice.
fn shuffled(rows: &[Arrival], lateness_s: f64, delays: &[(f64, bool)]) -> Vec<Arrival> {
    let mut keyed: Vec<(f64, &Arrival)> = Vec::new();
    for (index, row) in rows.iter().enumerate() {
        let (share, twice) = delays[index % delays.len()];
        keyed.push((row.0 + share * lateness_s, row));
        if twice {
            keyed.push((row.0 + (1.0 - share) * lateness_s, row));
        }
    }
    keyed.sort_by(|a, b| a.0.total_cmp(&b.0));
    keyed.into_iter().map(|(_, row)| row.clone()).collect()
}

fn delays() -> impl Strategy<Value = Vec<(f64, bool)>> {
    prop::collection::vec((0.0..0.999, any::<bool>()), 7..40)
}

proptest! {
    #[test]
    fn order_and_repetition_within_the_lateness_change_no_bit(
        rows in ordered(), delays in delays(), step_s in prop_oneof![Just(0.0), 30.0..300.0],
    ) {
        let settings = IntakeSettings { lateness_s: 600.0, step_s, ..each() };
        let in_order = all(&mut intake(settings), &rows);
        let out = all(&mut intake(settings), &shuffled(&rows, 600.0, &delays));
        prop_assert_eq!(bits(&in_order.rows), bits(&out.rows));
        prop_assert_eq!(in_order.events, out.events);
    }

    #[test]
    fn saved_and_restored_at_any_row_it_goes_on_bit_for_bit(
        rows in ordered(), delays in delays(), jump_s in prop_oneof![Just(-3600.0), Just(1e9), -1e5..1e5],
    ) {
        let settings = IntakeSettings { lateness_s: 300.0, step_s: 90.0, ..each() };
        let mut rows = shuffled(&rows, 600.0, &delays);
        let half = rows.len() / 2;
        rows[half..].iter_mut().for_each(|row| row.0 += jump_s);
        let (mut straight, mut restored) = (intake(settings), intake(settings));
        for (stamp_s, readings) in &rows {
            restored = postcard::from_bytes(&postcard::to_allocvec(&restored).unwrap()).unwrap();
            let (a, b) = (straight.take(*stamp_s, readings).unwrap(), restored.take(*stamp_s, readings).unwrap());
            prop_assert_eq!(bits(&a.rows), bits(&b.rows));
            prop_assert_eq!(a.events, b.events);
        }
        prop_assert_eq!(bits(&straight.flush().rows), bits(&restored.flush().rows));
    }

    #[test]
    fn time_never_runs_backwards_whatever_the_stamps_are(
        stamps in prop::collection::vec(
            prop_oneof![4 => 0.0..1e4, 1 => -1e10..1e10, 1 => any::<f64>(), 2 => Just(60.0)], 1..200),
        lateness_s in prop_oneof![Just(0.0), 1.0..1e4],
    ) {
        let rows: Vec<Arrival> = stamps.iter().map(|&stamp_s| (stamp_s, vec![stamp_s, 1.0])).collect();
        let mut intake = intake(late(lateness_s));
        let out = all(&mut intake, &rows);
        prop_assert!(times(&out).iter().all(|time_s| time_s.is_finite()));
        prop_assert!(times(&out).windows(2).all(|pair| pair[1] >= pair[0]));
        let counts = intake.counts();
        let unused = counts.duplicates + counts.merged + counts.contradictions + counts.too_late + counts.wild;
        prop_assert_eq!(counts.rows, out.rows.len() as u64 + unused);
        prop_assert!(out.events.iter().all(|event| event.onset_s.is_finite() && event.time_s.is_finite()));
    }
}

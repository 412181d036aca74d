use super::*;
use crate::DetectorError;
use crate::units::{DAY_S, MINUTE_S};
use proptest::prelude::*;

fn off_normal(timing: Timing) -> Alarm<OffNormal> {
    Alarm { trigger: OffNormal { severity: 700 }, timing }
}

fn at_once() -> Timing {
    Timing { re_alarm_time_s: None, ..Timing::default() }
}

/// 160 and 165 bar, deadbands of 1 and 2 bar, in bar.
fn limits(timing: Timing) -> Alarm<ExclusiveLimit> {
    let low = Limit { limit: 165.0, deadband: 2.0, severity: 600 };
    let low_low = Some(Limit { limit: 160.0, deadband: 1.0, severity: 900 });
    Alarm { trigger: ExclusiveLimit { low, low_low }, timing }
}

/// A condition after a course of samples, and all changes with their times.
fn run<T: Trigger>(
    alarm: &Alarm<T>,
    from: Condition,
    samples: impl IntoIterator<Item = (f64, T::Signal)>,
) -> (Condition, Vec<(f64, Change)>) {
    let mut changes = Vec::new();
    let condition = samples.into_iter().fold(from, |condition, (time_s, signal)| {
        let (condition, transitions) = alarm.step(condition, time_s, signal);
        changes.extend(transitions.iter().map(|transition| (transition.time_s, transition.change)));
        condition
    });
    (condition, changes)
}

/// A constant signal once a minute, both ends included.
fn minutely<S: Copy>(from: u32, to: u32, signal: S) -> impl Iterator<Item = (f64, S)> {
    (from..=to).map(move |minute| (f64::from(minute) * MINUTE_S, signal))
}

#[test]
fn a_signal_that_lasts_shorter_than_the_on_delay_raises_nothing() {
    let alarm = off_normal(Timing { on_delay_s: 600.0, ..at_once() });
    let blink = minutely(0, 9, Some(true)).chain(minutely(10, 10, Some(false)));
    let (condition, changes) = run(&alarm, Condition::default(), blink.chain(minutely(11, 20, Some(true))));
    assert!(!condition.active && changes.is_empty());
    // From minute 11 on: ten minutes are over at minute 21.
    let (condition, changes) = run(&alarm, condition, minutely(21, 30, Some(true)));
    assert_eq!(changes, [(21.0 * MINUTE_S, Change::Active)]);
    assert_eq!((condition.active, condition.active_since_s), (true, Some(21.0 * MINUTE_S)));
}

#[test]
fn a_gap_without_samples_does_not_serve_the_on_delay_and_sparse_samples_do_in_the_end() {
    let alarm = off_normal(Timing { on_delay_s: 3600.0, longest_step_s: 900.0, ..at_once() });
    let (condition, changes) =
        run(&alarm, Condition::default(), [(0.0, Some(true)), (30.0 * DAY_S, Some(true))]);
    assert!(!condition.active && changes.is_empty());
    // Once in two hours: each counts for a quarter of an hour.
    let sparse = (0..10).map(|n| (f64::from(n) * 7200.0, Some(true)));
    assert_eq!(run(&alarm, Condition::default(), sparse).1, [(4.0 * 7200.0, Change::Active)]);
}

#[test]
fn an_active_alarm_ends_only_after_the_off_delay_without_a_break() {
    let alarm = off_normal(Timing { off_delay_s: 300.0, ..at_once() });
    let samples = minutely(0, 0, Some(true))
        .chain(minutely(1, 5, Some(false)))
        .chain(minutely(6, 6, Some(true)))
        .chain(minutely(7, 20, Some(false)));
    let (condition, changes) = run(&alarm, Condition::default(), samples);
    assert_eq!(changes, [(0.0, Change::Active), (12.0 * MINUTE_S, Change::Inactive)]);
    assert!(!condition.active && condition.limit.is_none());
}

#[test]
fn not_to_know_neither_clears_an_alarm_nor_serves_a_delay() {
    let alarm = off_normal(Timing { on_delay_s: 300.0, off_delay_s: 300.0, ..at_once() });
    // Three minutes seen, an hour not, two more minutes seen.
    let samples = minutely(0, 3, Some(true)).chain(minutely(4, 63, None)).chain(minutely(64, 65, Some(true)));
    let (condition, changes) = run(&alarm, Condition::default(), samples);
    assert_eq!(changes, [(65.0 * MINUTE_S, Change::Active)]);
    let samples =
        minutely(66, 70, Some(false)).chain(minutely(71, 200, None)).chain(minutely(201, 206, Some(false)));
    let (condition, changes) = run(&alarm, condition, samples);
    assert_eq!(changes, [(206.0 * MINUTE_S, Change::Inactive)]);
    assert!(!condition.active);
    // A value that is no number, and a time that is none.
    let (condition, _) = run(&limits(at_once()), Condition::default(), [(0.0, 150.0), (60.0, f64::NAN)]);
    assert_eq!(condition.limit, Some(LimitState::LowLow));
    let (same, changes) = limits(at_once()).step(condition.clone(), f64::NAN, 200.0);
    assert_eq!((same, changes.len()), (condition, 0));
}

#[test]
fn a_latched_alarm_holds_after_the_return_to_normal_until_it_is_acknowledged_confirmed_and_reset() {
    let alarm = off_normal(Timing { latching: true, confirming: true, ..at_once() });
    let samples = [(0.0, Some(true)), (60.0, Some(false))];
    let (condition, changes) = run(&alarm, Condition::default(), samples);
    assert_eq!(changes, [(0.0, Change::Active), (60.0, Change::Inactive)]);
    assert!(!condition.active && condition.latched && condition.retain());
    let refusal = |outcome: Result<(Condition, Transition), DetectorError>| outcome.unwrap_err().to_string();
    assert!(refusal(condition.clone().reset(70.0, "")).contains("acknowledged first"));
    assert!(refusal(condition.clone().confirm(70.0, "")).contains("acknowledged first"));
    let (condition, transition) = condition.acknowledge(70.0, true, "seen").unwrap();
    assert_eq!((transition.change, transition.condition.comment.as_str()), (Change::Acknowledged, "seen"));
    assert!(condition.acked && !condition.confirmed);
    assert!(refusal(condition.clone().reset(80.0, "")).contains("confirmed first"));
    assert!(refusal(condition.clone().acknowledge(80.0, true, "")).contains("has been acknowledged"));
    let (condition, _) = condition.confirm(80.0, "seal replaced").unwrap();
    assert!(condition.retain());
    let (condition, transition) = condition.reset(90.0, "").unwrap();
    assert_eq!((transition.time_s, transition.change), (90.0, Change::Reset));
    // An empty comment leaves the last one.
    assert!(!condition.latched && !condition.retain() && condition.comment == "seal replaced");
    assert!(refusal(condition.reset(91.0, "")).contains("not latched"));
}

#[test]
fn an_active_alarm_cannot_be_reset_and_one_that_is_seen_ends_by_itself_where_it_does_not_latch() {
    let latching = off_normal(Timing { latching: true, ..at_once() });
    let (condition, _) = run(&latching, Condition::default(), [(0.0, Some(true))]);
    let (condition, _) = condition.acknowledge(1.0, false, "").unwrap();
    assert!(condition.clone().reset(2.0, "").unwrap_err().to_string().contains("still active"));
    assert!(condition.clone().confirm(2.0, "").unwrap_err().to_string().contains("nothing to confirm"));
    let plain = off_normal(at_once());
    let (condition, _) = run(&plain, Condition::default(), [(0.0, Some(true))]);
    let (condition, _) = condition.acknowledge(1.0, false, "").unwrap();
    let (condition, _) = run(&plain, condition, [(60.0, Some(false))]);
    assert!(!condition.retain());
    // One that nobody has seen stays on the list although it has ended.
    let (condition, _) = run(&plain, condition, [(120.0, Some(true)), (180.0, Some(false))]);
    assert!(!condition.active && condition.retain());
}

#[test]
fn noise_inside_the_deadband_raises_one_alarm() {
    let alarm = limits(at_once());
    let noise = (0..100).map(|n| (f64::from(n) * MINUTE_S, 165.0 + f64::from(n % 5) * 0.5 - 1.0));
    let (condition, changes) = run(&alarm, Condition::default(), noise);
    assert_eq!(changes.iter().map(|(_, change)| *change).collect::<Vec<_>>(), [Change::Active]);
    let (condition, changes) = run(&alarm, condition, [(7000.0, 167.0), (7060.0, 167.01)]);
    assert_eq!(changes, [(7060.0, Change::Inactive)]);
    assert!(!condition.active);
}

#[test]
fn limit_states_exclude_each_other_and_each_has_its_own_deadband_and_severity() {
    let alarm = limits(at_once());
    let course = [164.0, 160.0, 160.9, 161.1, 166.9, 167.1];
    let mut condition = Condition::default();
    let mut states = Vec::new();
    for (minute, value) in course.into_iter().enumerate() {
        let (next, changes) = alarm.step(condition, minute as f64 * MINUTE_S, value);
        states.push((next.limit, next.severity, changes.first().map(|transition| transition.change)));
        condition = next;
    }
    let (low, low_low) = (Some(LimitState::Low), Some(LimitState::LowLow));
    assert_eq!(
        states,
        [
            (low, 600, Some(Change::Active)),
            (low_low, 900, Some(Change::LimitChanged)),
            (low_low, 900, None),
            (low, 600, Some(Change::LimitChanged)),
            (low, 600, None),
            (None, 600, Some(Change::Inactive)),
        ]
    );
}

#[test]
fn a_worse_limit_must_be_acknowledged_anew_and_a_better_one_not() {
    let alarm = limits(at_once());
    let (condition, _) = run(&alarm, Condition::default(), [(0.0, 164.0)]);
    let (condition, _) = condition.acknowledge(10.0, false, "").unwrap();
    let (condition, _) = run(&alarm, condition, [(60.0, 159.0)]);
    assert!(!condition.acked && condition.alarmed_s == Some(60.0) && condition.active_since_s == Some(0.0));
    let (condition, _) = condition.acknowledge(70.0, false, "").unwrap();
    let (condition, _) = run(&alarm, condition, [(120.0, 163.0)]);
    assert!(condition.acked && condition.limit == Some(LimitState::Low));
}

#[test]
fn an_alarm_that_is_still_active_is_raised_again_and_counted_until_it_ends() {
    let alarm = off_normal(Timing { re_alarm_time_s: Some(600.0), ..at_once() });
    let (condition, _) = run(&alarm, Condition::default(), [(0.0, Some(true))]);
    let (condition, _) = condition.acknowledge(30.0, false, "").unwrap();
    let (condition, changes) = run(&alarm, condition, minutely(1, 25, Some(true)));
    assert_eq!(changes, [(600.0, Change::ReAlarm), (1200.0, Change::ReAlarm)]);
    assert!(!condition.acked && condition.re_alarm_repeat_count == 2);
    assert_eq!((condition.active_since_s, condition.alarmed_s), (Some(0.0), Some(1200.0)));
    // Over a gap of many times the time it is raised once, also where nothing is known.
    let (condition, changes) = run(&alarm, condition, [(DAY_S, None)]);
    assert_eq!(changes, [(DAY_S, Change::ReAlarm)]);
    let (condition, _) = run(&alarm, condition, [(DAY_S + 60.0, Some(false))]);
    assert_eq!(condition.re_alarm_repeat_count, 0);
}

#[test]
fn a_clock_that_is_set_back_serves_no_delay_and_does_not_keep_an_alarm_from_being_raised_again() {
    let alarm = off_normal(Timing { on_delay_s: 300.0, re_alarm_time_s: Some(600.0), ..at_once() });
    let (condition, changes) =
        run(&alarm, Condition::default(), [(1e9, Some(true)), (0.0, Some(true)), (240.0, Some(true))]);
    assert!(changes.is_empty());
    let (condition, changes) = run(&alarm, condition, [(300.0, Some(true))]);
    assert_eq!(changes, [(300.0, Change::Active)]);
    let (condition, _) = run(&alarm, condition, [(1e9, Some(true))]);
    let (_, changes) = run(&alarm, condition, [(0.0, Some(true)), (600.0, Some(true))]);
    assert_eq!(changes, [(600.0, Change::ReAlarm)]);
}

#[test]
fn a_disabled_alarm_is_silent_and_what_was_left_to_do_is_there_again_when_it_is_enabled() {
    let alarm = off_normal(Timing { latching: true, ..at_once() });
    let (condition, _) = run(&alarm, Condition::default(), [(0.0, Some(true))]);
    let (condition, transition) = condition.set_enabled(10.0, false);
    assert_eq!(transition.unwrap().change, Change::Disabled);
    let (condition, changes) = run(&alarm, condition, minutely(1, 10, Some(true)));
    assert!(changes.is_empty() && !condition.active && !condition.retain());
    assert!(condition.clone().acknowledge(20.0, false, "").is_err());
    let (condition, transition) = condition.set_enabled(700.0, true);
    assert!(transition.is_some() && condition.retain() && condition.latched);
    assert!(condition.clone().set_enabled(710.0, true).1.is_none());
    let (condition, changes) = run(&alarm, condition, [(720.0, Some(true))]);
    assert!(condition.active && changes == [(720.0, Change::Active)]);
}

#[test]
fn settings_out_of_their_bounds_are_refused_by_name() {
    assert!(AlarmSettings::default().validate().is_ok());
    let refused = |change: fn(&mut AlarmSettings), name: &str| {
        let mut settings = AlarmSettings::default();
        change(&mut settings);
        let error = settings.validate().unwrap_err().to_string();
        assert!(error.contains(name), "{error}");
    };
    refused(|s| s.leak.timing.on_delay_s = -1.0, "on_delay_s");
    refused(|s| s.leak.timing.off_delay_s = f64::NAN, "off_delay_s");
    refused(|s| s.unknown.timing.longest_step_s = 0.0, "longest_step_s");
    refused(|s| s.sensor_fault.timing.re_alarm_time_s = Some(0.0), "re_alarm_time_s");
    refused(|s| s.leak.trigger.severity = 0, "severity");
    refused(|s| s.cold_night.trigger.low.severity = 1001, "severity");
    refused(|s| s.cold_night.trigger.low.deadband = -1.0, "deadband");
    refused(|s| s.maintenance_limit.trigger.low.limit = f64::INFINITY, "limit");
    refused(|s| s.operational_limit.trigger.low.limit = 100e5, "low_low.limit");
    refused(
        |s| {
            s.operational_limit.trigger.low_low = Some(Limit { limit: 160e5, deadband: 7e5, severity: 900 });
        },
        "low_low.deadband",
    );
}

/// Everything is as it should be.
fn normal() -> AlarmInputs {
    AlarmInputs {
        leak: Some(false),
        p15_pa: 198e5,
        filling: 0.99,
        sensor_fault: Some(false),
        unknown: Some(false),
        cold_pressure_pa: 163e5,
    }
}

#[test]
fn each_input_of_the_panel_raises_its_own_alarm_and_no_other() {
    let settings = AlarmSettings::default();
    let cases = [
        (AlarmName::Leak, AlarmInputs { leak: Some(true), ..normal() }),
        (AlarmName::OperationalLimit, AlarmInputs { p15_pa: 159e5, ..normal() }),
        (AlarmName::MaintenanceLimit, AlarmInputs { filling: 0.94, ..normal() }),
        (AlarmName::SensorFault, AlarmInputs { sensor_fault: Some(true), ..normal() }),
        (AlarmName::Unknown, AlarmInputs { unknown: Some(true), ..normal() }),
        (AlarmName::ColdNight, AlarmInputs { cold_pressure_pa: 158.9e5, ..normal() }),
    ];
    for (name, inputs) in cases {
        let mut panel = AlarmPanel::default();
        let mut raised = Vec::new();
        for minute in 0..=120 {
            panel.step(&settings, f64::from(minute) * MINUTE_S, &inputs, &mut raised);
        }
        assert_eq!(raised.len(), 1, "{name:?}: {raised:?}");
        assert_eq!((raised[0].alarm, raised[0].transition.change), (name, Change::Active));
        let ms = raised[0].transition.time_s * 1e3;
        assert_eq!(raised[0].id().to_string(), format!("alarm-{}-active-{ms}", name.as_str()));
        assert_eq!(panel.retained().iter().map(|(name, _)| *name).collect::<Vec<_>>(), [name]);
    }
}

#[test]
fn the_most_severe_alarm_is_shown_first_and_all_are_dealt_with_in_one_go() {
    let settings = AlarmSettings::default();
    let mut panel = AlarmPanel::default();
    let bad = AlarmInputs { leak: Some(true), p15_pa: 150e5, filling: 0.75, ..normal() };
    for minute in 0..=120 {
        panel.step(&settings, f64::from(minute) * MINUTE_S, &bad, &mut Vec::new());
    }
    let names: Vec<AlarmName> = panel.retained().into_iter().map(|(name, _)| name).collect();
    assert_eq!(names, [AlarmName::OperationalLimit, AlarmName::Leak, AlarmName::MaintenanceLimit]);
    let events = panel.acknowledge_all(&settings, 7300.0, "fitter is coming");
    assert!(events.iter().all(|event| event.transition.change != Change::Reset));
    assert!(panel.retained().iter().all(|(_, condition)| condition.acked && condition.confirmed));
    // Refilled: the latch of the leak is what is left.
    for minute in 130..=300 {
        panel.step(&settings, f64::from(minute) * MINUTE_S, &normal(), &mut Vec::new());
    }
    assert_eq!(panel.retained().iter().map(|(name, _)| *name).collect::<Vec<_>>(), [AlarmName::Leak]);
    let events = panel.acknowledge_all(&settings, 20_000.0, "valve replaced");
    assert_eq!(events.iter().map(|event| event.transition.change).collect::<Vec<_>>(), [Change::Reset]);
    assert!(panel.retained().is_empty());
    assert_eq!(panel.condition(AlarmName::Leak).comment, "valve replaced");
}

/// Times that go on, stand still, jump and run back, with signals.
fn samples() -> impl Strategy<Value = Vec<(f64, Option<bool>)>> {
    let step = prop_oneof![8 => 1.0..600.0, 1 => Just(0.0), 1 => 1e4..1e6, 1 => -1e5..0.0];
    let signal = prop_oneof![3 => Just(Some(true)), 3 => Just(Some(false)), 1 => Just(None)];
    prop::collection::vec((step, signal), 1..80).prop_map(|steps| {
        steps.into_iter().fold(
            Vec::new(),
            |mut samples: Vec<(f64, Option<bool>)>, (step_s, signal): (f64, _)| {
                let time_s: f64 = samples.last().map_or(0.0, |(time_s, _)| time_s + step_s);
                // Quarters of a second come through a text as they are.
                samples.push(((time_s * 4.0).round() / 4.0, signal));
                samples
            },
        )
    })
}

proptest! {
    #[test]
    fn whatever_the_steps_a_latch_holds_and_nothing_changes_without_a_transition(samples in samples()) {
        let timing = Timing {
            on_delay_s: 900.0, off_delay_s: 600.0, latching: true, confirming: true,
            re_alarm_time_s: Some(7200.0), ..Timing::default()
        };
        let alarm = off_normal(timing);
        let mut condition = Condition::default();
        for (time_s, signal) in samples {
            let before = condition.clone();
            let (next, transitions) = alarm.step(condition, time_s, signal);
            prop_assert!(next.latched >= before.latched);
            prop_assert!(!next.active || next.latched);
            prop_assert!(transitions.iter().all(|transition| transition.time_s == time_s));
            let seen = |c: &Condition| (c.active, c.acked, c.latched, c.re_alarm_repeat_count, c.limit);
            prop_assert_eq!(seen(&next) == seen(&before), transitions.is_empty());
            // An alarm starts only with a signal that is there, and ends only with one that is known to be away.
            prop_assert!(next.active <= before.active || signal == Some(true));
            prop_assert!(before.active <= next.active || signal == Some(false));
            if let Some(last) = transitions.last() {
                prop_assert_eq!(&last.condition, &next);
            }
            condition = next;
        }
    }

    #[test]
    fn a_state_that_was_written_and_read_again_goes_on_as_if_nothing_had_happened(
        samples in samples(),
        cut in 0..80_usize,
    ) {
        let timing = Timing { on_delay_s: 900.0, off_delay_s: 600.0, re_alarm_time_s: Some(7200.0), ..Timing::default() };
        let alarm = off_normal(timing);
        let (whole, changes) = run(&alarm, Condition::default(), samples.clone());
        let (head, tail) = samples.split_at(cut.min(samples.len()));
        let (condition, mut first) = run(&alarm, Condition::default(), head.iter().copied());
        let text = serde_json::to_string(&condition).unwrap();
        let (pieced, second) = run(&alarm, serde_json::from_str(&text).unwrap(), tail.iter().copied());
        first.extend(second);
        prop_assert_eq!((pieced, first), (whole, changes));
    }

    #[test]
    fn low_low_is_never_on_without_low(values in prop::collection::vec(150.0..175.0_f64, 1..100)) {
        let alarm = limits(Timing { on_delay_s: 120.0, off_delay_s: 180.0, ..at_once() });
        let mut condition = Condition::default();
        for (minute, value) in values.into_iter().enumerate() {
            condition = alarm.step(condition, minute as f64 * MINUTE_S, value).0;
            prop_assert!(condition.levels[0].on || !condition.levels[1].on);
        }
    }
}

//! Alarms: in words for people, and as lines of JSON with the names of OPC UA Part 9.
use crate::detector::monitor::alarm::{AlarmEvent, AlarmName, Change, Condition, Transition};
use crate::report::Clock;
use serde_json::json;

/// A change of an alarm in words.
pub(crate) fn alarm_text(event: &AlarmEvent, clock: &Clock) -> String {
    transition_text(event.alarm.as_str(), &event.transition, clock)
}

/// The same of any alarm, by its name.
pub(crate) fn transition_text(alarm: &str, transition: &Transition, clock: &Clock) -> String {
    let condition = &transition.condition;
    let limit = condition.limit.map_or(String::new(), |limit| format!(" at {}", limit.as_str()));
    let what = match transition.change {
        Change::Active => format!("raised{limit}, severity {}", condition.severity),
        Change::LimitChanged => format!("now{limit}, severity {}", condition.severity),
        Change::ReAlarm => format!("still active{limit}, raised again ({})", condition.re_alarm_repeat_count),
        Change::Inactive if condition.latched => {
            "returned to normal, latched until it is acknowledged".to_owned()
        }
        Change::Inactive => "returned to normal".to_owned(),
        Change::Acknowledged => commented("acknowledged", condition),
        Change::Confirmed => commented("confirmed", condition),
        Change::Reset => commented("reset", condition),
        Change::Enabled => "enabled".to_owned(),
        Change::Disabled => "disabled".to_owned(),
    };
    format!("{}: alarm {alarm} {what}", clock.text(transition.time_s))
}

fn commented(what: &str, condition: &Condition) -> String {
    if condition.comment.is_empty() { what.to_owned() } else { format!("{what}: {}", condition.comment) }
}

/// A change of an alarm as one line of JSON, without its end.
pub(crate) fn alarm_line(event: &AlarmEvent, clock: &Clock) -> String {
    transition_line(&event.id().to_string(), event.alarm.as_str(), &event.transition, clock)
}

/// The same of any alarm, by its identity and name.
pub(crate) fn transition_line(id: &str, alarm: &str, transition: &Transition, clock: &Clock) -> String {
    let condition = &transition.condition;
    json!({
        "id": id,
        "event": "alarm",
        "time_s": clock.of_log_s(transition.time_s),
        "time": clock.date(transition.time_s),
        "alarm": alarm,
        "change": transition.change.as_str(),
        "Severity": condition.severity,
        "EnabledState": condition.enabled,
        "ActiveState": condition.active,
        "LimitState": condition.limit.map(|limit| limit.as_str()),
        "AckedState": condition.acked,
        "ConfirmedState": condition.confirmed,
        "LatchedState": condition.latched,
        "Retain": condition.retain(),
        "ReAlarmRepeatCount": condition.re_alarm_repeat_count,
        "active_since_s": condition.active_since_s.map(|time_s| clock.of_log_s(time_s)),
        "Comment": condition.comment,
    })
    .to_string()
}

/// An alarm that is worth showing, for a summary.
pub(super) fn standing(name: AlarmName, condition: &Condition, clock: &Clock) -> String {
    let limit = condition.limit.map_or(String::new(), |limit| format!(" {}", limit.as_str()));
    let since = condition.active_since_s.map_or(String::new(), |time_s| clock.text(time_s));
    let mut words = if condition.active {
        format!("{}{limit}: active since {since}", name.as_str())
    } else {
        format!("{}: back to normal, was active since {since}", name.as_str())
    };
    let duty = match (condition.acked, condition.confirmed, condition.latched) {
        (false, _, _) => ", not acknowledged",
        (true, false, _) => ", not confirmed",
        (true, true, true) if !condition.active => ", to be reset",
        (true, true, _) => ", acknowledged",
    };
    words.push_str(duty);
    words
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::detector::monitor::alarm::{AlarmInputs, AlarmPanel, AlarmSettings};

    fn leak(leak: bool) -> AlarmInputs {
        AlarmInputs {
            leak: Some(leak),
            p15_pa: 198e5,
            filling: 1.0,
            sensor_fault: Some(false),
            unknown: Some(false),
            cold_pressure_pa: 170e5,
        }
    }

    #[test]
    fn an_alarm_from_its_rise_to_its_reset_in_words_and_lines() {
        let (settings, clock) = (AlarmSettings::default(), Clock::default());
        let (mut panel, mut first, mut end) = (AlarmPanel::default(), Vec::new(), Vec::new());
        panel.step(&settings, 60.0, &leak(true), &mut first);
        let name = panel.retained()[0].0;
        assert_eq!(
            standing(name, panel.condition(name), &clock),
            "leak: active since t = 60 s, not acknowledged"
        );
        panel.acknowledge_all(&settings, 70.0, "seen by A");
        assert!(standing(name, panel.condition(name), &clock).ends_with(", acknowledged"));
        for minute in 0..=60 {
            panel.step(&settings, 120.0 + 60.0 * f64::from(minute), &leak(false), &mut end);
        }
        assert!(standing(name, panel.condition(name), &clock).ends_with(", to be reset"));
        let reset = panel.acknowledge_all(&settings, 4000.0, "");
        let said: Vec<String> =
            first.iter().chain(&end).chain(&reset).map(|event| alarm_text(event, &clock)).collect();
        assert_eq!(
            said,
            [
                "t = 60 s: alarm leak raised, severity 800",
                "t = 3720 s: alarm leak returned to normal, latched until it is acknowledged",
                "t = 4000 s: alarm leak reset: seen by A"
            ]
        );
        let line: serde_json::Value = serde_json::from_str(&alarm_line(&first[0], &clock)).unwrap();
        assert_eq!((line["ActiveState"].as_bool(), line["AckedState"].as_bool()), (Some(true), Some(false)));
        assert_eq!((&line["id"], &line["Retain"]), (&"alarm-leak-active-60000".into(), &true.into()));
    }
}

//! What a run keeps for whoever runs many: what happened, and the course of the pressure at 15 °C.
use crate::detector::monitor::Output;
use crate::detector::monitor::alarm::AlarmEvent;
use crate::report::fleet::Trace;
use crate::report::monitor::{Naming, alarm_line, alarm_text, event_line, event_text};
use serde::{Deserialize, Serialize};

/// An event or a change of an alarm, as `--events` writes it and in words.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Told {
    /// Identity: the same for the same event of another run.
    pub id: String,
    /// Name of the event, or `alarm`.
    pub event: String,
    /// Time of the log, s.
    pub time_s: f64,
    /// The same as date; empty: the log has none.
    pub time: String,
    /// In words.
    pub words: String,
    /// Line of JSON.
    pub line: String,
}

/// What [`Told::event`] calls the change of an alarm.
pub(in crate::cli) const ALARM: &str = "alarm";

/// What is kept of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::cli) struct Course {
    /// Events and changes of alarms, in their order.
    pub told: Vec<Told>,
    /// Course of the pressure at 15 °C.
    pub trace: Trace,
}

impl Course {
    /// Takes in an output.
    pub(super) fn push(&mut self, output: &Output, naming: &Naming) {
        self.trace.push(output.stamp_s, output.estimate.p15_pa);
        self.told.extend(told(output, naming));
    }
}

/// What happened with an output, in its order.
pub(super) fn told(output: &Output, naming: &Naming) -> impl Iterator<Item = Told> {
    let clock = &naming.clock;
    let at = |time_s: f64| (clock.of_log_s(time_s), clock.date(time_s).unwrap_or_default());
    let events = output.events.iter().map(move |event| {
        let (time_s, time) = at(event.time_s);
        Told {
            id: event.id().to_string(),
            event: event.kind.name().to_owned(),
            time_s,
            time,
            words: event_text(event, naming),
            line: event_line(event, naming),
        }
    });
    events.chain(output.alarms.iter().map(|alarm| told_alarm(alarm, naming)))
}

/// A change of an alarm.
pub(super) fn told_alarm(alarm: &AlarmEvent, naming: &Naming) -> Told {
    let (clock, time_s) = (&naming.clock, alarm.transition.time_s);
    Told {
        id: alarm.id().to_string(),
        event: ALARM.to_owned(),
        time_s: clock.of_log_s(time_s),
        time: clock.date(time_s).unwrap_or_default(),
        words: alarm_text(alarm, clock),
        line: alarm_line(alarm, clock),
    }
}

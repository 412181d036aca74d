//! What a run keeps for whoever runs many: what happened, and the course of the pressure at 15 °C.
use crate::detector::monitor::Output;
use crate::report::fleet::Trace;
use crate::report::monitor::{Naming, alarm_line, alarm_text, event_line, event_text};
use serde::{Deserialize, Serialize};

/// An event or a change of an alarm, as `--events` writes it and in words.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::cli) struct Told {
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
        let clock = &naming.clock;
        self.trace.push(output.stamp_s, output.estimate.p15_pa);
        let at = |time_s: f64| (clock.of_log_s(time_s), clock.date(time_s).unwrap_or_default());
        for event in &output.events {
            let (time_s, time) = at(event.time_s);
            self.told.push(Told {
                id: event.id.to_string(),
                event: event.kind.name().to_owned(),
                time_s,
                time,
                words: event_text(event, naming),
                line: event_line(event, naming),
            });
        }
        for alarm in &output.alarms {
            let (time_s, time) = at(alarm.transition.time_s);
            self.told.push(Told {
                id: alarm.id.to_string(),
                event: "alarm".to_owned(),
                time_s,
                time,
                words: alarm_text(alarm, clock),
                line: alarm_line(alarm, clock),
            });
        }
    }
}

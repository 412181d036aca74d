//! What is marked in a figure: leaks, exchanges of gas, alarms of the limits.
use crate::detector::monitor::alarm::{AlarmEvent, AlarmName, Change};
use crate::detector::monitor::{Event, EventKind};
use crate::report::figure::Mark;

/// Most marks that a figure can name without covering itself.
const MAX_MARKS: usize = 12;

/// The first marks of a run; more would hide the curves.
#[derive(Clone, Debug, Default)]
pub(super) struct Marks(Vec<Mark>);

impl Marks {
    /// Marks an event if a figure should show it.
    pub(super) fn event(&mut self, event: &Event) {
        let (at, name) = match &event.kind {
            EventKind::LeakFound(_) => (event.time_s, "leak found"),
            EventKind::LeakEnded => (event.time_s, "leak over"),
            EventKind::Discharge(_) => (event.onset_s, "discharge"),
            EventKind::Refill(_) => (event.onset_s, "refill"),
            EventKind::Verdict { .. }
            | EventKind::Sensor { .. }
            | EventKind::ColdNight(_)
            | EventKind::FillingDoubted { .. }
            | EventKind::Swapped(_)
            | EventKind::Late { .. }
            | EventKind::Disturbed { .. }
            | EventKind::ClockJump(_)
            | EventKind::Gap(_)
            | EventKind::TooLate
            | EventKind::Restarted => return,
        };
        self.push(at, name);
    }

    /// Marks an alarm of a limit that is raised.
    pub(super) fn alarm(&mut self, event: &AlarmEvent) {
        let is_raised = matches!(event.transition.change, Change::Active | Change::LimitChanged);
        let name = match event.alarm {
            AlarmName::OperationalLimit => "operational limit",
            AlarmName::MaintenanceLimit => "maintenance limit",
            AlarmName::ColdNight => "cold night",
            AlarmName::Leak | AlarmName::SensorFault | AlarmName::Unknown => return,
        };
        if is_raised && event.transition.condition.active {
            self.push(event.transition.time_s, name);
        }
    }

    fn push(&mut self, at: f64, name: &str) {
        if self.0.len() < MAX_MARKS {
            self.0.push(Mark { at, name: name.to_owned() });
        }
    }

    /// The marks, shifted by an origin, s.
    pub(super) fn shifted(&self, origin_s: f64) -> Vec<Mark> {
        self.0.iter().map(|mark| Mark { at: mark.at - origin_s, name: mark.name.clone() }).collect()
    }
}

//! Where events and alarms go: lines of a file as they happen, or words on stderr.
use crate::cli::appended::Appended;
use crate::cli::message::Messages;
use crate::cli::output::Target;
use crate::cli::progress::Progress;
use crate::detector::monitor::Event;
use crate::detector::monitor::alarm::AlarmEvent;
use crate::report::monitor::{Naming, alarm_line, alarm_text, event_line, event_text};
use serde_json::json;

/// A sink of events.
pub(super) enum EventSink {
    /// Lines of JSON.
    File(Appended),
    /// Words.
    Stderr,
    /// Lines of JSON in memory.
    Kept(Vec<String>),
}

impl EventSink {
    /// Opens the file, if one is wanted; `goes_on` keeps what it has.
    pub(super) fn open(target: Option<&Target>, goes_on: bool, messages: &Messages) -> anyhow::Result<Self> {
        Ok(match target {
            Some(Target::Memory) => Self::Kept(Vec::new()),
            Some(target) => Self::File(Appended::open(target, goes_on, messages)?),
            None => Self::Stderr,
        })
    }

    /// Reports an event.
    pub(super) fn event(&mut self, event: &Event, naming: &Naming, console: &Console) -> anyhow::Result<()> {
        match self {
            Self::File(file) => file.line(&event_line(event, naming)),
            Self::Stderr => console.print(&event_text(event, naming)),
            Self::Kept(lines) => {
                lines.push(event_line(event, naming));
                Ok(())
            }
        }
    }

    /// Reports a change of an alarm.
    pub(super) fn alarm(
        &mut self,
        alarm: &AlarmEvent,
        naming: &Naming,
        console: &Console,
    ) -> anyhow::Result<()> {
        match self {
            Self::File(file) => file.line(&alarm_line(alarm, &naming.clock)),
            Self::Stderr => console.print(&alarm_text(alarm, &naming.clock)),
            Self::Kept(lines) => {
                lines.push(alarm_line(alarm, &naming.clock));
                Ok(())
            }
        }
    }

    /// Ends the file, or hands out the lines in memory.
    pub(super) fn finish(self) -> anyhow::Result<Vec<String>> {
        match self {
            Self::File(file) => file.finish().map(|()| Vec::new()),
            Self::Stderr => Ok(Vec::new()),
            Self::Kept(lines) => Ok(lines),
        }
    }

    /// Reports a cold start; people get a caution instead.
    pub(super) fn cold_start(&mut self, reason: &str) -> anyhow::Result<()> {
        match self {
            Self::File(file) => file.line(&json!({ "event": "cold-start", "reason": reason }).to_string()),
            Self::Stderr | Self::Kept(_) => Ok(()),
        }
    }
}

/// Words beside a progress bar.
pub(super) struct Console<'a> {
    /// Words on stderr.
    pub messages: &'a Messages,
    /// The bar that must not be written over.
    pub progress: &'a Progress,
}

impl Console<'_> {
    fn print(&self, words: &str) -> anyhow::Result<()> {
        self.progress.suspended(|| self.messages.say(words));
        Ok(())
    }
}

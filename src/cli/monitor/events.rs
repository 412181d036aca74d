//! Where events and alarms go: lines of a file as they happen, or words on stderr.
use crate::cli::message::Messages;
use crate::cli::output::{Appended, Target};
use crate::cli::progress::Progress;
use cylwatch::detector::monitor::Event;
use cylwatch::detector::monitor::alarm::AlarmEvent;
use cylwatch::report::monitor::{Naming, alarm_line, alarm_words, event_line, event_words};
use serde_json::json;

/// A sink of events.
pub enum EventSink {
    /// Lines of JSON.
    File(Appended),
    /// Words.
    Stderr,
}

impl EventSink {
    /// Opens the file, if one is wanted; `goes_on` keeps what it has.
    pub fn open(target: Option<&Target>, goes_on: bool) -> anyhow::Result<Self> {
        Ok(match target {
            Some(target) => Self::File(target.append(goes_on)?),
            None => Self::Stderr,
        })
    }

    /// Tells an event.
    pub fn event(&mut self, event: &Event, naming: &Naming, say: &Say) -> anyhow::Result<()> {
        match self {
            Self::File(file) => file.line(&event_line(event, naming)),
            Self::Stderr => say.words(&event_words(event, naming)),
        }
    }

    /// Tells a change of an alarm.
    pub fn alarm(&mut self, alarm: &AlarmEvent, naming: &Naming, say: &Say) -> anyhow::Result<()> {
        match self {
            Self::File(file) => file.line(&alarm_line(alarm, &naming.clock)),
            Self::Stderr => say.words(&alarm_words(alarm, &naming.clock)),
        }
    }

    /// Tells that a state was not gone on from; the words for people are a caution.
    pub fn cold_start(&mut self, reason: &str) -> anyhow::Result<()> {
        match self {
            Self::File(file) => file.line(&json!({ "event": "cold-start", "reason": reason }).to_string()),
            Self::Stderr => Ok(()),
        }
    }
}

/// Words beside a progress bar.
pub struct Say<'a> {
    /// Words on stderr.
    pub messages: &'a Messages,
    /// The bar that must not be written over.
    pub progress: &'a Progress,
}

impl Say<'_> {
    fn words(&self, words: &str) -> anyhow::Result<()> {
        self.progress.suspended(|| self.messages.say(words));
        Ok(())
    }
}

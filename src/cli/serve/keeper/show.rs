//! What the page says of the cylinders, made while somebody looks, a few milliseconds at a time.
use super::*;
use crate::cli::fleet::LAST_EVENTS;
use crate::cli::serve::alarms::SEVERITY;
use crate::cli::serve::board::REFRESH;
use crate::detector::monitor::Outcome;
use crate::report::fleet;
use jiff::Timestamp;
use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// Longest stretch for which messages wait.
const SLICE: Duration = Duration::from_millis(5);

/// What the page says beside the monitor.
#[derive(Clone)]
pub(super) struct Notes {
    /// Whether something has happened that the page does not have.
    is_new: bool,
    /// Whether the monitor goes on from a state.
    goes_on: bool,
    /// Whether a row has come.
    has_rows: bool,
    events: usize,
    /// The last events, in words.
    last_events: VecDeque<String>,
}

impl Notes {
    pub(super) fn of(steps: &Steps) -> Self {
        let goes_on = steps.has_begun();
        Self { is_new: true, goes_on, has_rows: false, events: 0, last_events: VecDeque::new() }
    }

    /// Those of a monitor that goes on with other options.
    pub(super) fn gone_on(&self) -> Self {
        Self { is_new: true, goes_on: true, ..self.clone() }
    }

    /// A row came.
    pub(super) fn hear(&mut self) {
        (self.is_new, self.has_rows) = (true, true);
    }

    /// Something happened.
    pub(super) fn tell(&mut self, words: &str) {
        self.is_new = true;
        self.events += 1;
        self.last_events.push_back(words.to_owned());
        if self.last_events.len() > LAST_EVENTS {
            self.last_events.pop_front();
        }
    }

    /// The monitor began anew.
    pub(super) fn begin_anew(&mut self, reason: &str) {
        self.goes_on = false;
        self.tell(&format!("the monitor began anew: {reason}"));
    }
}

/// What is to be shown.
#[derive(Default)]
pub(super) struct Showing {
    names: Vec<String>,
    begun: Option<Instant>,
    looked: Option<Instant>,
}

/// Whether it is time again.
fn is_due(last: Option<Instant>) -> bool {
    last.is_none_or(|last| last.elapsed() >= REFRESH)
}

impl Keeper<'_> {
    /// Shows what has changed, while somebody looks; `true`: there is more.
    pub(in crate::cli::serve) fn show(&mut self) -> bool {
        let status = Arc::clone(&self.status);
        if !status.board.is_watched() {
            return false;
        }
        let now = Instant::now();
        if self.showing.names.is_empty() {
            if !is_due(self.showing.begun) {
                return false;
            }
            self.showing.begun = Some(now);
            let new = self.cylinders.iter().filter(|(_, cylinder)| cylinder.notes.is_new);
            self.showing.names = new.map(|(name, _)| name.clone()).collect();
        }
        while let Some(name) = self.showing.names.pop() {
            if let Some(cylinder) = self.cylinders.get_mut(&name) {
                cylinder.notes.is_new = false;
                status.board.put(shown(&name, cylinder, &self.alarms.active(&name), status.started));
            }
            if now.elapsed() >= SLICE {
                break;
            }
        }
        if self.showing.names.is_empty() {
            status.board.complete(self.cylinders.len(), |name| self.cylinders.contains_key(name));
        }
        !self.showing.names.is_empty()
    }

    /// When the most silent cylinder had a row; looked for once in a while.
    pub(in crate::cli::serve) fn most_silent(&mut self) -> Option<Instant> {
        if !is_due(self.showing.looked) {
            return None;
        }
        let now = Instant::now();
        self.showing.looked = Some(now);
        Some(self.silence.longest().unwrap_or(now))
    }
}

/// With the alarms of the gateway: what was found of a cylinder that sends nothing any more is not what is.
fn shown(name: &str, cylinder: &Cylinder, alarms: &[&str], started: Timestamp) -> fleet::Cylinder {
    let Cylinder { assigned, steps, notes, .. } = cylinder;
    let mut found = steps.finding();
    if let Some(found) = &mut found
        && !alarms.is_empty()
    {
        found.alarms.extend(alarms.iter().map(|alarm| (*alarm).to_owned()));
        found.severity = found.severity.max(SEVERITY);
        if alarms.contains(&Kind::Silent.name()) && found.outcome == Outcome::NoLoss {
            (found.outcome, found.reaction) = (Outcome::Unknown, None);
        }
    }
    let fault = match (&found, steps.has_begun()) {
        (Some(_), _) => "",
        (None, true) => "no verdict yet: all rows wait for later ones",
        (None, false) if !notes.has_rows => "no row has come yet: look at its sender and its topic",
        (None, false) => "no verdict yet: its rows wait for a pressure",
    };
    let started = started.strftime("%Y-%m-%dT%H:%M:%SZ");
    let goes_on = notes.goes_on.then(|| {
        format!("The gateway started at {started}: events, course and intervals of rows before are not known here.")
    });
    fleet::Cylinder {
        name: name.to_owned(),
        vessel: assigned.vessel(),
        logs: Vec::new(),
        found,
        fault: fault.to_owned(),
        cautions: goes_on.into_iter().collect(),
        events: notes.events,
        last_events: notes.last_events.iter().cloned().collect(),
    }
}

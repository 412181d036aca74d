//! Monitors and their states on disk.
//!
//! # What is guaranteed
//! A row that the broker delivered at quality of service 1 goes into the [journal](super::journal) before it is acknowledged, and to the
//! monitor after that. A state is written when all events of its rows have arrived at the broker, and the segments of the journal go when every
//! state knows their rows. So whatever moment the process is killed at,
//! - no accepted row is lost: those since the last state are in the journal, and are taken in again at the start;
//! - no event is lost: an event that had not arrived belongs to a row that no state knows, and comes out of it again;
//! - no event has a second identity: it is computed from the same rows by the same monitor, and its identity is a function of those;
//! - at most the rows since the last state are computed twice.
//!
//! A state that is damaged, and one of a monitor that failed, is set aside under another name, and the monitor begins anew; that is an event.
mod anew;
mod own;
mod pattern;
mod reload;
mod replay;
mod rows;
mod saving;
mod show;
#[cfg(test)]
mod tests;

use super::alarms::{Alarms, Kind};
use super::config::{Assigned, Settings};
use super::file::{read, set_aside};
use super::journal::{Entry, Journal, Segment};
use super::mapping::{Accepted, Refusal};
use super::outbox::Outbox;
use super::publication;
use super::recent::Recent;
use super::saver::Saver;
use super::silence::Silence;
use super::status::Status;
use crate::cli::StepTime;
use crate::cli::fleet::{locked, stem};
use crate::cli::message::Messages;
use crate::cli::monitor::{NotResumed, Steps, Told};
use crate::cli::output::{make_folder, remove_orphans};
use crate::report::Input;
use anyhow::{Context, bail};
use show::{Notes, Showing};
use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

/// The zone in which times are told.
const ZONE: &str = "UTC";

/// A cylinder.
struct Cylinder {
    assigned: Assigned,
    steps: Steps,
    /// The oldest segment with rows that its state does not know, and of those that the state knows that is being written.
    unsaved_since: Option<u64>,
    saving_since: Option<u64>,
    /// Why its monitor has failed, until it has begun anew.
    failed: Option<String>,
    notes: Notes,
}

/// What goes to a monitor.
pub(super) enum Delivered {
    Row(Accepted),
    Acknowledge(String),
}

/// All monitors.
pub(super) struct Keeper<'a> {
    settings: Arc<Settings>,
    messages: &'a Messages,
    names: Vec<String>,
    journal: Journal,
    cylinders: BTreeMap<String, Cylinder>,
    /// Cylinders that came by the pattern.
    by_pattern: usize,
    /// Their names on disk.
    noted: Vec<String>,
    /// Cylinders whose monitors have failed.
    failed: BTreeSet<String>,
    alarms: Alarms,
    /// Changes of these alarms that are not published yet.
    own: Vec<(String, Told)>,
    pub silence: Silence,
    pub outbox: Outbox,
    pub recent: Recent,
    saver: Saver,
    pub status: Arc<Status>,
    showing: Showing,
    _lock: File,
}

impl<'a> Keeper<'a> {
    /// Goes on from what is on disk.
    pub(super) fn open(settings: Arc<Settings>, messages: &'a Messages) -> anyhow::Result<Self> {
        let folder = &settings.folder;
        make_folder(folder)?;
        let lock = locked(folder, "choose another folder in [store]")?;
        for name in ["states", "journal"] {
            make_folder(&folder.join(name))?;
            remove_orphans(&folder.join(name));
        }
        let names: Vec<String> =
            settings.mapping.readings.iter().map(|reading| reading.name.clone()).collect();
        let (journal, segments) = Journal::open(&folder.join("journal"), &names)?;
        let (alarms, damage) = Alarms::open(&folder.join("alarms"))?;
        if let Some(damage) = damage {
            messages.caution(&format!("{damage}; it is set aside, and what was silent is told anew"));
        }
        let mut keeper = Self {
            by_pattern: 0,
            noted: Vec::new(),
            failed: BTreeSet::new(),
            own: alarms.told().map(|(name, told)| (name.to_owned(), told.clone())).collect(),
            alarms,
            silence: Silence::default(),
            settings: Arc::clone(&settings),
            messages,
            names,
            journal,
            cylinders: BTreeMap::new(),
            outbox: Outbox::default(),
            recent: Recent::default(),
            saver: Saver::new(),
            status: Arc::default(),
            showing: Showing::default(),
            _lock: lock,
        };
        keeper.replay(segments)?;
        for (name, assigned) in &settings.named {
            keeper.know(name, assigned)?;
        }
        keeper.take_up_noted()?;
        keeper.begin_failed_anew()?;
        keeper.publish_alarms()?;
        Ok(keeper)
    }

    fn file(&self, name: &str, ending: &str) -> PathBuf {
        self.settings.folder.join("states").join(format!("{}.{ending}", stem(name)))
    }

    /// The files of a cylinder, the one that counts first: a state, or rows that wait for a pressure.
    fn files(&self, name: &str) -> [PathBuf; 2] {
        [self.file(name, "state"), self.file(name, "waiting")]
    }

    /// Whether a cylinder of the pattern is there, or may come.
    pub(super) fn admits(&mut self, name: &str) -> Result<(), (Refusal, String)> {
        let refused = |refusal: Refusal| Err((refusal, refusal.words().to_owned()));
        if self.settings.named.contains_key(name) {
            return refused(Refusal::UnknownTopic);
        }
        if self.cylinders.contains_key(name) {
            return Ok(());
        }
        let most = self.settings.mapping.pattern.as_ref().map_or(0, |pattern| pattern.most);
        if self.by_pattern >= most || self.cylinders.len() >= self.settings.cylinders {
            return refused(Refusal::TooManyCylinders);
        }
        let Some(assigned) = self.settings.by_pattern.clone() else { return refused(Refusal::UnknownTopic) };
        self.know(name, &assigned).map_err(|error| (Refusal::Monitor, format!("{error:#}")))
    }

    /// Whether there is a cylinder of this name.
    pub(super) fn knows(&self, name: &str) -> bool {
        self.cylinders.contains_key(name)
    }

    /// Takes a cylinder up, with its state if it has one.
    fn know(&mut self, name: &str, assigned: &Assigned) -> anyhow::Result<()> {
        if self.cylinders.contains_key(name) {
            return Ok(());
        }
        let mut steps = assigned.monitor()?;
        let [state, waiting] = self.files(name);
        let resumed = match (read(&state)?, read(&waiting)?) {
            (Some(bytes), _) => match steps.resume(&self.names, &bytes) {
                Err(NotResumed::Other(error)) => {
                    bail!(
                        "{}: {error:#}: state it as it was, or move the file away and the monitor begins anew",
                        state.display()
                    )
                }
                Err(NotResumed::Damaged(reason)) => Err(format!("{}: {reason}", state.display())),
                Ok(()) => Ok(()),
            },
            (None, Some(bytes)) => {
                steps.restore(&bytes).map_err(|error| format!("{}: {error:#}", waiting.display()))
            }
            (None, None) => Ok(()),
        };
        self.by_pattern += usize::from(!self.settings.named.contains_key(name));
        self.silence.watch(name, assigned.silent_after, Instant::now());
        let notes = Notes::of(&steps);
        self.cylinders.insert(
            name.to_owned(),
            Cylinder {
                notes,
                assigned: assigned.clone(),
                steps,
                unsaved_since: None,
                saving_since: None,
                failed: None,
            },
        );
        match resumed {
            Ok(()) => Ok(()),
            Err(reason) => self.begin_anew(name, &reason),
        }
    }

    /// Number of cylinders.
    pub(super) fn len(&self) -> usize {
        self.cylinders.len()
    }
}

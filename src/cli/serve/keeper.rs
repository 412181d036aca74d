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
mod replay;
mod show;
#[cfg(test)]
mod tests;

use super::config::{Assigned, Settings};
use super::journal::{Entry, Journal, Segment};
use super::mapping::{Accepted, Refusal};
use super::outbox::Outbox;
use super::publication;
use super::recent::Recent;
use super::status::Status;
use crate::cli::StepTime;
use crate::cli::fleet::{locked, stem};
use crate::cli::message::Messages;
use crate::cli::monitor::{NotResumed, Steps, Told};
use crate::cli::output::{make_folder, remove_orphans, write_file};
use crate::report::Input;
use anyhow::{Context, bail};
use show::{Notes, Showing};
use std::collections::BTreeMap;
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
    /// The oldest segment with rows that its state does not know.
    unsaved_since: Option<u64>,
    notes: Notes,
}

/// What goes to a monitor.
pub(super) enum Delivered {
    Row(Accepted),
    Acknowledge(String),
}

/// All monitors.
pub(super) struct Keeper<'a> {
    settings: &'a Settings,
    messages: &'a Messages,
    names: Vec<String>,
    journal: Journal,
    cylinders: BTreeMap<String, Cylinder>,
    /// Cylinders that came by the pattern.
    by_pattern: usize,
    pub outbox: Outbox,
    pub recent: Recent,
    pub status: Arc<Status>,
    showing: Showing,
    _lock: File,
}

impl<'a> Keeper<'a> {
    /// Goes on from what is on disk.
    pub(super) fn open(settings: &'a Settings, messages: &'a Messages) -> anyhow::Result<Self> {
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
        let mut keeper = Self {
            by_pattern: 0,
            settings,
            messages,
            names,
            journal,
            cylinders: BTreeMap::new(),
            outbox: Outbox::default(),
            recent: Recent::default(),
            status: Arc::default(),
            showing: Showing::default(),
            _lock: lock,
        };
        keeper.replay(segments)?;
        for (name, assigned) in &settings.named {
            keeper.know(name, assigned)?;
        }
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
        let Some(assigned) = &self.settings.by_pattern else { return refused(Refusal::UnknownTopic) };
        self.know(name, assigned).map_err(|error| (Refusal::Monitor, format!("{error:#}")))
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
        let notes = Notes::of(&steps);
        let cylinder = Cylinder { assigned: assigned.clone(), steps, unsaved_since: None, notes };
        self.cylinders.insert(name.to_owned(), cylinder);
        match resumed {
            Ok(()) => Ok(()),
            Err(reason) => self.begin_anew(name, &reason),
        }
    }

    /// Puts rows and acknowledgements on disk; only then they are accepted.
    pub(super) fn record(&mut self, inputs: &[(String, Delivered)]) -> anyhow::Result<()> {
        let entry = |(name, input): &(String, Delivered)| match input {
            Delivered::Row(Accepted { time_ns, cells }) => {
                Entry::Row { cylinder: name.clone(), time_ns: *time_ns, cells: cells.clone() }
            }
            Delivered::Acknowledge(comment) => {
                Entry::Acknowledged { cylinder: name.clone(), comment: comment.clone() }
            }
        };
        let begin = Instant::now();
        self.journal.append(&inputs.iter().map(entry).collect::<Vec<_>>())?;
        self.status.journal.observe(begin.elapsed());
        Ok(())
    }

    /// Gives what was recorded to its monitor.
    pub(super) fn take(
        &mut self,
        name: &str,
        input: Delivered,
    ) -> anyhow::Result<Result<(), (Refusal, String)>> {
        let number = self.journal.number();
        if let Some(cylinder) = self.cylinders.get_mut(name) {
            cylinder.unsaved_since.get_or_insert(number);
        }
        match input {
            Delivered::Row(Accepted { time_ns, cells }) => {
                self.status.row(time_ns);
                let (names, begin) = (self.names.clone(), Instant::now());
                let stepped = self.step(name, &names, time_ns, &cells);
                self.status.step.observe(begin.elapsed());
                stepped
            }
            Delivered::Acknowledge(comment) => {
                self.acknowledge(name, &comment);
                Ok(Ok(()))
            }
        }
    }

    fn step(
        &mut self,
        name: &str,
        names: &[String],
        time_ns: i64,
        cells: &[f64],
    ) -> anyhow::Result<Result<(), (Refusal, String)>> {
        let Some(cylinder) = self.cylinders.get_mut(name) else { return Ok(Ok(())) };
        let readings: Vec<(&str, f64)> =
            names.iter().map(String::as_str).zip(cells.iter().copied()).collect();
        let had_begun = cylinder.steps.has_begun();
        cylinder.notes.hear();
        match cylinder.steps.step(StepTime::Instant(time_ns, ZONE.to_owned()), &readings) {
            Ok((table, told)) => {
                self.tell(name, &told);
                publication::last_row(&self.settings.prefix, name, &table)
                    .into_iter()
                    .for_each(|message| self.outbox.push(message));
                Ok(Ok(()))
            }
            Err(error) => {
                let reason = format!("{error:#}");
                if had_begun {
                    // It may have taken in a part of the row.
                    self.begin_anew(name, &reason)?;
                }
                Ok(Err((Refusal::Monitor, reason)))
            }
        }
    }

    fn acknowledge(&mut self, name: &str, comment: &str) {
        let told = self.cylinders.get_mut(name).map(|cylinder| cylinder.steps.acknowledge(comment));
        self.tell(name, &told.unwrap_or_default());
    }

    fn tell(&mut self, name: &str, told: &[Told]) {
        for one in told {
            self.messages.say(&format!("{name}: {}", one.words));
            self.outbox.push(publication::told(&self.settings.prefix, name, one));
            self.cylinders.get_mut(name).into_iter().for_each(|cylinder| cylinder.notes.tell(&one.words));
        }
    }

    /// Begins a monitor anew: said, an event, and what it had is set aside.
    fn begin_anew(&mut self, name: &str, reason: &str) -> anyhow::Result<()> {
        self.messages
            .caution(&format!("{name}: {reason}; its state is set aside and its monitor begins anew"));
        self.journal.append(&[Entry::Anew { cylinder: name.to_owned(), reason: reason.to_owned() }])?;
        self.set_aside(name)?;
        let number = self.journal.number();
        if let Some(cylinder) = self.cylinders.get_mut(name) {
            cylinder.steps = cylinder.assigned.monitor()?;
            cylinder.notes.begin_anew(reason);
            cylinder.unsaved_since.get_or_insert(number);
        }
        self.outbox.push(publication::anew(&self.settings.prefix, name, reason));
        Ok(())
    }

    /// Gives the files of a cylinder names that nothing reads.
    fn set_aside(&self, name: &str) -> anyhow::Result<()> {
        for file in self.files(name) {
            if let Some(bytes) = read(&file)? {
                let mut aside = file.clone().into_os_string();
                aside.push(format!(".{}.aside", &Input::of("", &bytes).sha256[..12]));
                std::fs::rename(&file, &aside)
                    .with_context(|| format!("{} cannot be renamed", file.display()))?;
            }
        }
        Ok(())
    }

    /// Names of the cylinders whose states do not know all.
    pub(super) fn unsaved(&self) -> Vec<String> {
        let unsaved = self.cylinders.iter().filter(|(_, cylinder)| cylinder.unsaved_since.is_some());
        unsaved.map(|(name, _)| name.clone()).collect()
    }

    /// Saves the state of a cylinder; `false`: it waits until its events have arrived.
    pub(super) fn save(&mut self, name: &str) -> anyhow::Result<bool> {
        let Some(cylinder) = self.cylinders.get(name).filter(|cylinder| cylinder.unsaved_since.is_some())
        else {
            return Ok(true);
        };
        if self.outbox.has_events(name) {
            return Ok(false);
        }
        let [state, waiting] = self.files(name);
        let (file, bytes) = match cylinder.steps.state_file()? {
            Some(bytes) => (&state, bytes),
            None => (&waiting, cylinder.steps.save()?),
        };
        let sha256 = Input::of("", &bytes).sha256;
        self.journal.append(&[Entry::Saving { cylinder: name.to_owned(), sha256 }])?;
        write_file(file, &bytes)?;
        if *file == state && waiting.is_file() {
            std::fs::remove_file(&waiting)
                .with_context(|| format!("{} cannot be removed", waiting.display()))?;
        }
        if let Some(cylinder) = self.cylinders.get_mut(name) {
            cylinder.unsaved_since = None;
        }
        self.status.states_saved.add();
        Ok(true)
    }

    /// Begins a segment, and removes those that no state needs, but for the last of them: what is delivered again is known by it.
    pub(super) fn turn_over(&mut self) -> anyhow::Result<()> {
        let oldest = self.cylinders.values().filter_map(|cylinder| cylinder.unsaved_since).min();
        let needed = oldest.unwrap_or(self.journal.number());
        self.journal.remove_before(needed.saturating_sub(1))?;
        self.journal.rotate()
    }

    /// Number of cylinders.
    pub(super) fn len(&self) -> usize {
        self.cylinders.len()
    }
}

fn read(file: &std::path::Path) -> anyhow::Result<Option<Vec<u8>>> {
    match std::fs::read(file) {
        Ok(bytes) => Ok(Some(bytes)),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error).with_context(|| format!("{} cannot be read", file.display())),
    }
}

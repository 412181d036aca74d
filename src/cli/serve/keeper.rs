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
mod reload;
mod replay;
#[cfg(test)]
mod tests;

use super::alarms::{Alarms, Kind};
use super::config::{Assigned, Settings};
use super::journal::{Entry, Journal, Segment};
use super::mapping::{Accepted, Refusal};
use super::outbox::Outbox;
use super::publication;
use super::recent::Recent;
use super::silence::Silence;
use crate::cli::StepTime;
use crate::cli::fleet::{locked, stem};
use crate::cli::message::Messages;
use crate::cli::monitor::{NotResumed, Steps, Told};
use crate::cli::output::{make_folder, remove_orphans, write_file};
use crate::report::Input;
use anyhow::{Context, bail};
use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::path::{Path, PathBuf};
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
    /// Why its monitor has failed, until it has begun anew.
    failed: Option<String>,
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
    /// Cylinders whose monitors have failed.
    failed: BTreeSet<String>,
    alarms: Alarms,
    /// Changes of these alarms that are not published yet.
    own: Vec<(String, Told)>,
    pub silence: Silence,
    pub outbox: Outbox,
    pub recent: Recent,
    /// Rows that were taken in.
    pub rows: u64,
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
            rows: 0,
            _lock: lock,
        };
        keeper.replay(segments)?;
        for (name, assigned) in &settings.named {
            keeper.know(name, assigned)?;
        }
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
        self.cylinders.insert(
            name.to_owned(),
            Cylinder { assigned: assigned.clone(), steps, unsaved_since: None, failed: None },
        );
        match resumed {
            Ok(()) => Ok(()),
            Err(reason) => self.begin_anew(name, &reason),
        }
    }

    /// Puts rows and acknowledgements on disk; only then they are accepted.
    pub(super) fn record(&mut self, inputs: &[(String, Delivered)]) -> anyhow::Result<()> {
        for (name, input) in inputs {
            // A later alarm must not be acknowledged when the journal is read again: those of the gateway are before it.
            if let Delivered::Acknowledge(comment) = input {
                let told = self.alarms.acknowledge(name, comment);
                self.own.extend(told.into_iter().map(|told| (name.clone(), told)));
            }
        }
        self.publish_alarms()?;
        let entry = |(name, input): &(String, Delivered)| match input {
            Delivered::Row(Accepted { time_ns, cells }) => {
                Entry::Row { cylinder: name.clone(), time_ns: *time_ns, cells: cells.clone() }
            }
            Delivered::Acknowledge(comment) => {
                Entry::Acknowledged { cylinder: name.clone(), comment: comment.clone() }
            }
        };
        self.journal.append(&inputs.iter().map(entry).collect::<Vec<_>>())
    }

    /// Gives what was recorded to its monitor.
    pub(super) fn take(&mut self, name: &str, input: Delivered) -> Result<(), (Refusal, String)> {
        let number = self.journal.number();
        if let Some(cylinder) = self.cylinders.get_mut(name) {
            cylinder.unsaved_since.get_or_insert(number);
        }
        match input {
            Delivered::Row(Accepted { time_ns, cells }) => {
                self.rows += 1;
                self.recent.note(name, time_ns, &cells);
                self.silence.heard(name, Instant::now());
                if self.alarms.must_clear(name) {
                    self.set_alarm(name, Kind::Silent, false, time_ns as f64 * 1e-9);
                }
                let names = self.names.clone();
                self.step(name, &names, time_ns, &cells)
            }
            Delivered::Acknowledge(comment) => {
                self.acknowledge(name, &comment);
                Ok(())
            }
        }
    }

    fn step(
        &mut self,
        name: &str,
        names: &[String],
        time_ns: i64,
        cells: &[f64],
    ) -> Result<(), (Refusal, String)> {
        let Some(cylinder) = self.cylinders.get_mut(name) else { return Ok(()) };
        if cylinder.failed.is_some() {
            return Err((Refusal::Monitor, "its monitor begins anew after this row".to_owned()));
        }
        let readings: Vec<(&str, f64)> =
            names.iter().map(String::as_str).zip(cells.iter().copied()).collect();
        let had_begun = cylinder.steps.has_begun();
        match cylinder.steps.step(StepTime::Instant(time_ns, ZONE.to_owned()), &readings) {
            Ok((table, told)) => {
                self.tell(name, &told);
                publication::last_row(&self.settings.prefix, name, &table)
                    .into_iter()
                    .for_each(|message| self.outbox.push(message));
                Ok(())
            }
            Err(error) => {
                let reason = format!("{error:#}");
                // It may have taken in a part of the row.
                if had_begun {
                    cylinder.failed = Some(reason.clone());
                    self.failed.insert(name.to_owned());
                }
                Err((Refusal::Monitor, reason))
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
        }
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

/// Gives a file, if it is there, a name that nothing reads.
pub(super) fn set_aside(file: &Path) -> anyhow::Result<()> {
    if let Some(bytes) = read(file)? {
        let mut aside = file.to_owned().into_os_string();
        aside.push(format!(".{}.aside", &Input::of("", &bytes).sha256[..12]));
        std::fs::rename(file, &aside).with_context(|| format!("{} cannot be renamed", file.display()))?;
    }
    Ok(())
}

fn read(file: &Path) -> anyhow::Result<Option<Vec<u8>>> {
    match std::fs::read(file) {
        Ok(bytes) => Ok(Some(bytes)),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error).with_context(|| format!("{} cannot be read", file.display())),
    }
}

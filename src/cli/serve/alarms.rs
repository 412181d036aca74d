//! Alarms of the gateway itself, beside those of the monitors: a cylinder that has fallen silent, and a state that was lost.
//!
//! They follow the rules of the monitor's alarms (OPC UA Part 9) and need to be acknowledged. Their times are those of rows: `silent` is
//! active since the last row and ends with the next one, so that a gateway that was killed gives the same change the same identity. `state-lost` ends when it
//! is acknowledged.
//!
//! The conditions are in a file of their own. A change is written before it is published, and what the file has is published again at the
//! start, so that no change is lost. A file that is damaged is set aside: every cylinder is then told anew at its next row.
use super::file::{read, set_aside};
use crate::cli::monitor::{ALARM, Told};
use crate::cli::output::write_file;
use crate::cli::steps::{decoded, encoded};
use crate::detector::monitor::alarm::{Alarm, Condition, OffNormal, Timing, Transition};
use crate::report::Clock;
use crate::report::monitor::{transition_line, transition_text};
use jiff::Timestamp;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Somebody must look.
pub(super) const SEVERITY: u16 = 500;

/// What the gateway raises.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(super) enum Kind {
    /// No row came for the time that the configuration states.
    Silent,
    /// The state was damaged, or the monitor failed, and it began anew.
    StateLost,
}

impl Kind {
    const ALL: [Self; 2] = [Self::Silent, Self::StateLost];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Silent => "silent",
            Self::StateLost => "state-lost",
        }
    }
}

/// An alarm of a cylinder.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Standing {
    condition: Condition,
    /// Its last change.
    told: Told,
}

/// Alarms by cylinder and kind; those that are not there are normal.
type Standings = BTreeMap<String, BTreeMap<Kind, Standing>>;

/// All alarms of the gateway.
pub(super) struct Alarms {
    path: PathBuf,
    standing: Standings,
    is_written: bool,
    /// Whether what was told before is not known.
    is_unsure: bool,
}

impl Alarms {
    /// From a file, if there is one; and why it was set aside.
    pub(super) fn open(path: &Path) -> anyhow::Result<(Self, Option<String>)> {
        let (standing, damage) = match read(path)?.map(|bytes| decoded::<Standings>(&bytes)) {
            None => (Standings::new(), None),
            Some(Ok(standing)) => (standing, None),
            Some(Err(error)) => {
                set_aside(path)?;
                (Standings::new(), Some(format!("{}: {error:#}", path.display())))
            }
        };
        let alarms = Self { path: path.to_owned(), standing, is_written: true, is_unsure: damage.is_some() };
        Ok((alarms, damage))
    }

    /// What may not have arrived before the start.
    pub(super) fn told(&self) -> impl Iterator<Item = (&str, &Told)> {
        let all = self.standing.iter();
        all.flat_map(|(name, of)| of.values().map(|standing| (name.as_str(), &standing.told)))
    }

    /// Whether an alarm was raised at this time, whatever has become of it.
    pub(super) fn is_known(&self, name: &str, kind: Kind, time_s: f64) -> bool {
        self.condition(name, kind).active_since_s == Some(time_s)
    }

    /// Names of the alarms of a cylinder that are active.
    pub(super) fn active(&self, name: &str) -> Vec<&'static str> {
        let is_active =
            |kind: &Kind| self.standing(name, *kind).is_some_and(|standing| standing.condition.active);
        Kind::ALL.into_iter().filter(is_active).map(Kind::name).collect()
    }

    /// Whether a row says that a cylinder is not silent, where it was or may have been.
    pub(super) fn must_clear(&self, name: &str) -> bool {
        let silent = self.standing(name, Kind::Silent);
        silent.map_or(self.is_unsure, |standing| standing.condition.active)
    }

    /// Sets an alarm to what is seen at a time since 1970, s; says what changed.
    pub(super) fn set(&mut self, name: &str, kind: Kind, active: bool, time_s: f64) -> Vec<Told> {
        let mut before = self.condition(name, kind);
        if self.is_unsure && !active && self.standing(name, kind).is_none() {
            // It may have been told before.
            before = rules().step(before, time_s, Some(true)).0;
        }
        let (_, transitions) = rules().step(before, time_s, Some(active));
        transitions.into_iter().map(|transition| self.changed(name, kind, &transition)).collect()
    }

    /// Acknowledges and confirms all alarms of a cylinder.
    pub(super) fn acknowledge(&mut self, name: &str, comment: &str) -> Vec<Told> {
        let mut told = Vec::new();
        for kind in Kind::ALL {
            let condition = self.condition(name, kind);
            let time_s = condition.last_s.unwrap_or_default();
            if let Ok((_, transition)) = condition.acknowledge(time_s, false, comment) {
                told.push(self.changed(name, kind, &transition));
                if kind == Kind::StateLost {
                    told.extend(self.set(name, kind, false, time_s));
                }
            }
        }
        told
    }

    /// Writes the file if anything has changed; `keeps` names cylinders with changes that have not arrived.
    pub(super) fn write(&mut self, keeps: impl Fn(&str) -> bool) -> anyhow::Result<()> {
        if self.is_written {
            return Ok(());
        }
        let mut kept = self.standing.clone();
        kept.retain(|name, of| {
            of.retain(|_, standing| standing.condition.retain() || self.is_unsure || keeps(name));
            !of.is_empty()
        });
        write_file(&self.path, &encoded(&kept)?)?;
        (self.standing, self.is_written) = (kept, true);
        Ok(())
    }

    /// Forgets a cylinder.
    pub(super) fn forget(&mut self, name: &str) {
        self.is_written &= self.standing.remove(name).is_none();
    }

    fn standing(&self, name: &str, kind: Kind) -> Option<&Standing> {
        self.standing.get(name)?.get(&kind)
    }

    fn condition(&self, name: &str, kind: Kind) -> Condition {
        self.standing(name, kind).map(|standing| standing.condition.clone()).unwrap_or_default()
    }

    fn changed(&mut self, name: &str, kind: Kind, transition: &Transition) -> Told {
        let told = told(kind.name(), transition);
        let standing = Standing { condition: transition.condition.clone(), told: told.clone() };
        self.standing.entry(name.to_owned()).or_default().insert(kind, standing);
        self.is_written = false;
        told
    }
}

/// It is raised at once and stays until somebody has seen it.
fn rules() -> Alarm<OffNormal> {
    let timing = Timing { re_alarm_time_s: None, ..Timing::default() };
    Alarm { trigger: OffNormal { severity: SEVERITY }, timing }
}

fn told(alarm: &str, transition: &Transition) -> Told {
    let clock = Clock::new(Some(Timestamp::UNIX_EPOCH), None);
    let (change, time_s) = (transition.change.as_str(), transition.time_s);
    let id = format!("{ALARM}-{alarm}-{change}-{}", (time_s * 1e3).round());
    Told {
        event: ALARM.to_owned(),
        time_s,
        time: clock.date(time_s).unwrap_or_default(),
        words: transition_text(alarm, transition, &clock),
        line: transition_line(&id, alarm, transition, &clock),
        id,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tempfile::tempdir;

    const T_S: f64 = 1_767_225_600.0;

    fn ids(told: &[Told]) -> Vec<&str> {
        told.iter().map(|told| told.id.as_str()).collect()
    }

    #[test]
    fn a_silence_is_raised_once_ends_with_a_row_and_is_known_after_a_kill_until_it_is_acknowledged() {
        let folder = tempdir().unwrap();
        let path = folder.path().join("alarms");
        let (mut alarms, damage) = Alarms::open(&path).unwrap();
        assert!(damage.is_none());
        let raised = alarms.set("A", Kind::Silent, true, T_S);
        assert_eq!(ids(&raised), ["alarm-silent-active-1767225600000"]);
        assert_eq!(raised[0].time, "2026-01-01T00:00:00Z");
        assert!(alarms.set("A", Kind::Silent, true, T_S).is_empty());
        alarms.write(|_| false).unwrap();
        drop(alarms);
        let (mut alarms, _) = Alarms::open(&path).unwrap();
        assert_eq!(alarms.told().collect::<Vec<_>>(), [("A", &raised[0])]);
        assert!(alarms.set("A", Kind::Silent, true, T_S).is_empty());
        assert!(alarms.must_clear("A") && !alarms.must_clear("B"));
        assert!(alarms.active("A") == ["silent"] && alarms.active("B").is_empty());
        assert_eq!(
            ids(&alarms.set("A", Kind::Silent, false, T_S + 60.0)),
            ["alarm-silent-inactive-1767225660000"]
        );
        alarms.write(|_| false).unwrap();
        assert_eq!(alarms.told().count(), 1, "nobody has seen it");
        assert_eq!(ids(&alarms.acknowledge("A", "seen")), ["alarm-silent-acknowledged-1767225660000"]);
        alarms.write(|_| true).unwrap();
        assert_eq!(alarms.told().count(), 1, "it has not arrived");
        alarms.forget("C");
        assert!(alarms.is_written);
        alarms.is_written = false;
        alarms.write(|_| false).unwrap();
        assert_eq!(alarms.told().count(), 0);
    }

    #[test]
    fn a_lost_state_stands_until_it_is_acknowledged() {
        let folder = tempdir().unwrap();
        let (mut alarms, _) = Alarms::open(&folder.path().join("alarms")).unwrap();
        assert_eq!(alarms.set("A", Kind::StateLost, true, T_S).len(), 1);
        assert!(
            alarms.is_known("A", Kind::StateLost, T_S) && !alarms.is_known("A", Kind::StateLost, T_S + 1.0)
        );
        let told = alarms.acknowledge("A", "the disk was changed");
        assert_eq!(
            told.iter().map(|told| told.line.contains("the disk was changed")).collect::<Vec<_>>(),
            [true; 2]
        );
        assert!(told[1].line.contains("\"Retain\":false"));
    }

    #[test]
    fn a_damaged_file_is_set_aside_and_every_cylinder_told_anew() {
        let folder = tempdir().unwrap();
        let path = folder.path().join("alarms");
        std::fs::write(&path, "no alarms").unwrap();
        let (mut alarms, damage) = Alarms::open(&path).unwrap();
        assert!(damage.unwrap().contains("alarms: "));
        assert!(!path.exists() && std::fs::read_dir(folder.path()).unwrap().count() == 1);
        assert!(alarms.must_clear("A"));
        assert_eq!(ids(&alarms.set("A", Kind::Silent, false, T_S)), ["alarm-silent-inactive-1767225600000"]);
        assert!(!alarms.must_clear("A"), "it is known now");
    }
}

//! Whether what a monitor said is what a row of the table requires.
//!
//! Stated for a fault from `onset` on and a leak of rate `r` from its own onset on:
//!
//! * *False leak*: a leak is stated while there is none. Only a transmitter that drifts downwards may be taken for one.
//! * *Found*: a leak is stated within `6 h (1 bar/h / r)^(2/3)` of its onset: 28 h for 0.1 bar/h, 5.4 d for 0.01 bar/h, about
//!   twice the least delay that any detector can have with a model error of 0.3 bar and 3 h. Time in which nothing usable is read does not
//!   count, nor, where it may be said that it cannot be known, time in which that is said, and an exchange of gas begins it anew once it has settled.
//!   A loss that follows a tunnel (G5) goes as fast as a discharge, and may be stated as one.
//! * *Flagged*: the sensor's health is said not to be good, or the verdict is that of a sensor at fault, within a time of the onset.
//! * *Blind*: no usable pressure or no usable temperature for more than an hour, or the first row after six hours without any. Then the
//!   verdict must not be "tight".
use serde::{Deserialize, Serialize};

use super::{Fault, History, MixUp, Requirement, Snapshot, TableRow};
use crate::detector::monitor::{EventKind, Reason, Verdict};

const MINUTE_S: f64 = 60.0;
const HOUR_S: f64 = 3600.0;
const BAR_PA: f64 = 1e5;
/// Time without a usable reading from which nothing may be called tight, s.
const BLIND_AFTER_S: f64 = HOUR_S;
/// Time without rows from which the same holds for the row after it, s.
const LONG_GAP_S: f64 = 6.0 * HOUR_S;
/// Time after an exchange of gas until it has settled, s.
const SETTLED_S: f64 = 3.0 * HOUR_S;
/// Delay within which a leak of 1 bar/h must be found, s.
const DELAY_S: f64 = 6.0 * HOUR_S;
const DELAY_POWER: f64 = 2.0 / 3.0;

/// A case: what was wrong, and what was true.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Case {
    /// Row of the table.
    pub row: TableRow,
    /// The fault, if it is one of data.
    pub fault: Option<Fault>,
    /// When it began, s.
    pub onset_s: f64,
    /// The leak.
    pub leak: Option<CaseLeak>,
    /// Exchanges of gas that must be recognised: time, s, and whether gas went out.
    pub exchanges: Vec<(f64, bool)>,
    /// Judged from, s: after learning.
    pub from_s: f64,
    /// End of the record, s.
    pub until_s: f64,
}

/// A leak of a case.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CaseLeak {
    /// Loss of pressure at 15 °C, Pa/s.
    pub rate_pa_s: f64,
    /// When it began, s.
    pub onset_s: f64,
}

/// How a monitor fell short.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Missed {
    /// A leak was stated while there was none.
    FalseLeak,
    /// A leak was not found in time.
    NotFound,
    /// The sensor was not named.
    NotFlagged,
    /// The exchange of gas was not recognised.
    NotRecognised,
    /// A sensor in wrong units went unnoticed.
    NotWarned,
    /// A restart changed what was said, or was not declared.
    SilentRestart,
    /// "Tight" while nothing usable was read.
    TightWhileBlind,
    /// A number that is none in an output.
    NotANumber,
}

/// Delay within which a leak must be found, s.
pub fn allowed_delay_s(rate_pa_s: f64) -> f64 {
    DELAY_S * (BAR_PA / HOUR_S / rate_pa_s).powf(DELAY_POWER)
}

/// Everything in which a monitor fell short of a case; nothing: all is as required. `unbroken` is the digest of the same record
/// without power cycles.
pub fn judge(case: &Case, history: &History, unbroken: Option<u64>) -> Vec<Missed> {
    let judgement = Judgement { case, history };
    let mut missed = vec![
        (Missed::NotANumber, history.not_numbers > 0),
        (Missed::TightWhileBlind, judgement.is_tight_while_blind()),
        (Missed::FalseLeak, judgement.has_false_leak()),
        (Missed::NotFound, judgement.has_missed_the_leak()),
    ];
    missed.push(match case.row.requirement() {
        Requirement::Flagged => (Missed::NotFlagged, !judgement.is_flagged()),
        Requirement::Warned => (Missed::NotWarned, !judgement.is_warned()),
        Requirement::Recognised => (Missed::NotRecognised, !judgement.is_recognised()),
        Requirement::Continued => (Missed::SilentRestart, judgement.is_silent(unbroken)),
        Requirement::Survived
        | Requirement::NotALeak
        | Requirement::Undecidable
        | Requirement::Degraded
        | Requirement::Found => return only(missed),
    });
    only(missed)
}

fn only(missed: Vec<(Missed, bool)>) -> Vec<Missed> {
    missed.into_iter().filter(|(_, is)| *is).map(|(missed, _)| missed).collect()
}

/// Time from the onset of a fault within which it must be flagged, s.
fn flag_within_s(row: TableRow) -> f64 {
    match row {
        TableRow::P1 => HOUR_S,
        TableRow::P7 => 30.0 * MINUTE_S,
        TableRow::T1 => HOUR_S,
        TableRow::T2 => 3.0 * HOUR_S,
        _ => 48.0 * HOUR_S,
    }
}

struct Judgement<'a> {
    case: &'a Case,
    history: &'a History,
}

impl Judgement<'_> {
    /// Time in which nothing usable is read, s.
    fn blind_s(&self) -> Option<(f64, f64)> {
        let fault = self.case.fault.as_ref()?;
        let of_pressure = fault.sensors().contains(&"pressure");
        let blind = match fault {
            Fault::Stuck { .. } | Fault::Dead { .. } => of_pressure,
            Fault::Lost { sensors, .. } => of_pressure || sensors.len() > 1,
            Fault::Gap { .. } => true,
            _ => false,
        };
        blind.then(|| (self.case.onset_s, self.case.onset_s + fault.lasting_s()))
    }

    fn is_tight_while_blind(&self) -> bool {
        let Some((from_s, to_s)) = self.blind_s() else { return false };
        let tight = |verdict| verdict == Verdict::Tight;
        if matches!(self.case.fault, Some(Fault::Gap { .. })) {
            // During a gap nothing is said; what counts is the first row after it.
            let first_s = self.history.verdicts.iter().map(|(at_s, _)| *at_s).find(|at_s| *at_s >= to_s);
            let held_s = first_s.unwrap_or(to_s).min(to_s + 3.0 * MINUTE_S);
            return to_s - from_s > LONG_GAP_S
                && to_s < self.case.until_s
                && self.history.verdict_at(held_s).is_some_and(tight);
        }
        let (from_s, to_s) = (from_s + BLIND_AFTER_S, to_s.min(self.case.until_s) - MINUTE_S);
        from_s < to_s && self.history.any_verdict(from_s, to_s, tight)
    }

    fn has_false_leak(&self) -> bool {
        let until_s = self.case.leak.map_or(self.case.until_s, |leak| leak.onset_s);
        let mistakable = match &self.case.fault {
            Some(Fault::Drift { sensor, per_s }) => sensor == "pressure" && *per_s < 0.0,
            _ => false,
        };
        let until_s = if mistakable { until_s.min(self.case.onset_s) } else { until_s };
        until_s > self.case.from_s && self.history.any_leak(self.case.from_s, until_s)
    }

    fn has_missed_the_leak(&self) -> bool {
        let Some(leak) = self.case.leak else { return false };
        // With an exchange of gas a new episode begins.
        let exchanged_s = self.case.exchanges.last().map_or(f64::NEG_INFINITY, |(at_s, _)| at_s + SETTLED_S);
        let allowed_s = (exchanged_s - leak.onset_s).max(0.0) + allowed_delay_s(leak.rate_pa_s);
        let deadline_s = match self.blind_s() {
            // What was blind of the allowed time is added to it.
            Some((from_s, to_s)) if from_s < leak.onset_s + allowed_s && to_s > leak.onset_s => {
                to_s + allowed_s
            }
            _ => leak.onset_s + allowed_s,
        };
        let undecided = matches!(
            self.case.row.requirement(),
            Requirement::Flagged | Requirement::Degraded | Requirement::Undecidable | Requirement::Warned
        );
        // Where it may be said to the end that it cannot be known, it may be said for a while.
        let may_wait = undecided && self.blind_s().is_none();
        let unknown_s = if may_wait { self.history.unknown_s(leak.onset_s, deadline_s) } else { 0.0 };
        let deadline_s = deadline_s + unknown_s;
        let until_s = deadline_s.min(self.case.until_s);
        let discharged = |kind: &EventKind| matches!(kind, EventKind::Discharge(_));
        if self.history.any_leak(leak.onset_s, until_s)
            || self.case.row == TableRow::G5 && self.history.events_in(leak.onset_s, until_s).any(discharged)
        {
            return false;
        }
        if deadline_s > self.case.until_s {
            // Blind to the end, or cut off: nothing can be required but that it is not called tight while blind.
            return false;
        }
        let said = self.history.verdict_at(deadline_s);
        // Nothing can be found with a wrong unit: that it is said is enough.
        let warned = matches!(self.case.fault, Some(Fault::Units { .. })) && self.is_warned();
        !(warned || undecided && matches!(said, Some(Verdict::Unknown(_))))
    }

    fn is_flagged(&self) -> bool {
        let Some(fault) = &self.case.fault else { return false };
        let to_s = self.case.onset_s + flag_within_s(self.case.row).min(fault.lasting_s());
        self.is_named(fault, self.case.onset_s, to_s)
    }

    /// Whether a sensor of the fault is named, or that a sensor is at fault.
    fn is_named(&self, fault: &Fault, from_s: f64, to_s: f64) -> bool {
        let names = ["shoulder", "valve", "pressure"];
        let index = |name: &str| names.iter().position(|known| *known == name);
        let indices: Vec<usize> = fault.sensors().into_iter().filter_map(index).collect();
        indices.iter().any(|&sensor| self.history.any_fault(sensor, from_s, to_s))
            || self.history.any_verdict(from_s, to_s, |verdict| verdict == Verdict::SensorFault)
    }

    /// A reading in a wrong unit must be named or never be called tight, swapped thermometers must be told; a gauge pressure is harmless.
    fn is_warned(&self) -> bool {
        match &self.case.fault {
            Some(Fault::Units { mix_up: MixUp::GaugeAsAbsolute, .. }) => true,
            Some(Fault::Swapped { .. }) => self
                .history
                .events_in(f64::NEG_INFINITY, self.case.until_s)
                .any(|kind| matches!(kind, EventKind::Swapped(_))),
            Some(fault @ Fault::Units { .. }) => {
                let (from_s, to_s) = (f64::NEG_INFINITY, self.case.until_s);
                self.is_named(fault, from_s, to_s)
                    || !self.history.any_verdict(self.case.from_s, to_s, |verdict| verdict == Verdict::Tight)
            }
            _ => false,
        }
    }

    fn is_recognised(&self) -> bool {
        self.case.exchanges.iter().all(|&(at_s, out)| {
            let mut events = self.history.events_in(at_s - 10.0 * MINUTE_S, at_s + 3.0 * HOUR_S);
            events.any(|kind| match kind {
                EventKind::Discharge(_) => out,
                EventKind::Refill(_) => !out,
                _ => false,
            })
        })
    }

    /// A sound snapshot goes on bit for bit, or from an hour ago; a broken one is refused and the monitor says that it learns.
    fn is_silent(&self, unbroken: Option<u64>) -> bool {
        let Some(Fault::PowerCycles { snapshot, .. }) = self.case.fault else { return true };
        let declared = |at_s: &f64| {
            self.history.any_verdict(*at_s, at_s + 5.0 * MINUTE_S, |verdict| {
                verdict == Verdict::Unknown(Reason::Learning)
            })
        };
        match snapshot {
            Snapshot::Current => unbroken != Some(self.history.digest),
            Snapshot::Old => false,
            Snapshot::Truncated | Snapshot::Corrupted | Snapshot::Foreign => {
                self.history.wrongly_restored > 0
                    || self.history.cold_starts_s.is_empty()
                    || !self.history.cold_starts_s.iter().all(declared)
            }
        }
    }
}

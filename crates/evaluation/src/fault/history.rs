//! What a monitor said to a record: run through, with its power cycles, and kept as changes.
use serde::{Deserialize, Serialize};

use super::{Record, Snapshot, Step};
use crate::EvaluationError;
use crate::detector::DetectorError;
use crate::detector::monitor::{Event, EventKind, Health, Monitor, MonitorSettings, Output, Verdict};
use crate::estimator::observer::Commissioning;
use crate::estimator::sensor::Sensor;
use crate::thermal::vessel::Vessel;

/// Age of a snapshot that counts as old, s.
const OLD_S: f64 = 3600.0;

/// A monitor to be put to the test.
#[derive(Clone, Debug)]
pub struct Subject {
    /// Vessel.
    pub vessel: Vessel,
    /// Sensors in the order of the readings.
    pub sensors: Vec<Sensor>,
    /// What is known at the start.
    pub commissioning: Commissioning,
    /// Settings.
    pub settings: MonitorSettings,
}

/// What a monitor said, as changes at the times at which the rows were measured, s.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct History {
    /// Verdicts.
    pub verdicts: Vec<(f64, Verdict)>,
    /// Whether a leak was stated.
    pub leaking: Vec<(f64, bool)>,
    /// Health of a sensor by its index.
    pub health: Vec<(f64, usize, Health)>,
    /// Events but those of verdicts and sensors.
    pub events: Vec<(f64, Event)>,
    /// Outputs.
    pub outputs: u64,
    /// Outputs with a number that is none.
    pub not_numbers: u64,
    /// Time after a power cycle at which the monitor began anew since the snapshot was refused, s.
    pub cold_starts_s: Vec<f64>,
    /// Snapshots that were taken up although they are broken or another's.
    pub wrongly_restored: u64,
    /// Bits of all estimates, leaks and verdicts together.
    pub digest: u64,
}

impl Subject {
    /// The monitor before its first row.
    ///
    /// # Errors
    /// As [`Monitor::new`].
    pub fn monitor(&self) -> Result<Monitor, EvaluationError> {
        Ok(Monitor::new(&self.vessel, &self.sensors, &self.commissioning, &self.settings)?)
    }

    /// Run a record through, from saved bytes or from the start, and end it.
    ///
    /// # Errors
    /// As [`Monitor::step`] and [`Monitor::restore`] from `begin`.
    pub fn run(&self, begin: Option<&[u8]>, record: &Record) -> Result<History, EvaluationError> {
        let monitor = match begin {
            Some(bytes) => Monitor::restore(&self.vessel, &self.sensors, &self.settings, bytes)?,
            None => self.monitor()?,
        };
        let old = record.steps.contains(&Step::PowerCycle(Snapshot::Old)).then_some(Vec::new());
        let mut run = Run {
            subject: self,
            monitor,
            history: History::default(),
            now_s: f64::NEG_INFINITY,
            old,
            saved_s: f64::NEG_INFINITY,
        };
        for step in &record.steps {
            run.take(step)?;
        }
        let last = run.monitor.finish()?;
        last.iter().for_each(|output| run.history.note(run.now_s, output));
        Ok(run.history)
    }

    /// The state after a record, without ending it.
    ///
    /// # Errors
    /// As [`Monitor::step`] and [`Monitor::save`].
    pub fn state_after(&self, record: &Record) -> Result<Vec<u8>, EvaluationError> {
        let mut monitor = self.monitor()?;
        for row in record.rows() {
            monitor.step(row.stamp_s, &row.readings)?;
        }
        saved(&monitor)
    }
}

struct Run<'a> {
    subject: &'a Subject,
    monitor: Monitor,
    history: History,
    now_s: f64,
    /// A snapshot of some time ago, if the record needs one.
    old: Option<Vec<u8>>,
    saved_s: f64,
}

impl Run<'_> {
    fn take(&mut self, step: &Step) -> Result<(), EvaluationError> {
        let row = match step {
            Step::Row(row) => row,
            Step::PowerCycle(snapshot) => return self.power_cycle(*snapshot),
        };
        self.now_s = self.now_s.max(row.measured_s);
        if let Some(old) = &mut self.old
            && self.now_s >= self.saved_s + OLD_S
        {
            *old = saved(&self.monitor)?;
            self.saved_s = self.now_s;
        }
        let outputs = if row.historical {
            self.monitor.step_historical(row.stamp_s, &row.readings)?
        } else {
            self.monitor.step(row.stamp_s, &row.readings)?
        };
        outputs.iter().for_each(|output| self.history.note(self.now_s, output));
        Ok(())
    }

    fn power_cycle(&mut self, snapshot: Snapshot) -> Result<(), EvaluationError> {
        let Subject { vessel, sensors, settings, .. } = self.subject;
        let mut bytes = match (snapshot, &self.old) {
            (Snapshot::Old, Some(old)) => old.clone(),
            (Snapshot::Foreign, _) => self.foreign()?,
            _ => saved(&self.monitor)?,
        };
        match snapshot {
            Snapshot::Truncated => bytes.truncate(bytes.len() / 2),
            Snapshot::Corrupted => {
                let middle = bytes.len() / 2;
                bytes[middle] ^= 1;
            }
            Snapshot::Current | Snapshot::Old | Snapshot::Foreign => {}
        }
        let sound = matches!(snapshot, Snapshot::Current | Snapshot::Old);
        match Monitor::restore(vessel, sensors, settings, &bytes) {
            Ok(monitor) => {
                self.monitor = monitor;
                self.history.wrongly_restored += u64::from(!sound);
            }
            Err(error) if sound => return Err(error.into()),
            Err(_) => {
                self.monitor = self.subject.monitor()?;
                self.history.cold_starts_s.push(self.now_s);
            }
        }
        Ok(())
    }

    /// The state of a monitor without the first of the sensors.
    fn foreign(&self) -> Result<Vec<u8>, EvaluationError> {
        let sensors = self.subject.sensors[1..].to_vec();
        saved(&Subject { sensors, ..self.subject.clone() }.monitor()?)
    }
}

impl History {
    /// Take in what was said at a time, s.
    fn note(&mut self, now_s: f64, output: &Output) {
        self.outputs += 1;
        self.not_numbers += u64::from(!is_finite(output));
        if self.verdicts.last().is_none_or(|(_, last)| *last != output.decision.verdict) {
            self.verdicts.push((now_s, output.decision.verdict));
        }
        let leaking = output.leak.is_some();
        if self.leaking.last().is_none_or(|(_, last)| *last != leaking) {
            self.leaking.push((now_s, leaking));
        }
        let said =
            |event: &&Event| !matches!(event.kind, EventKind::Verdict { .. } | EventKind::Sensor { .. });
        self.events.extend(output.events.iter().filter(said).map(|event| (now_s, event.clone())));
        for event in &output.events {
            if let EventKind::Sensor { sensor, health } = event.kind {
                self.health.push((now_s, sensor, health));
            }
        }
        self.digest = digest(self.digest, output);
    }

    /// Verdict at a time, s; `None` before the first.
    pub fn verdict_at(&self, time_s: f64) -> Option<Verdict> {
        let next = self.verdicts.partition_point(|(at_s, _)| *at_s <= time_s);
        next.checked_sub(1).map(|last| self.verdicts[last].1)
    }

    /// Whether a verdict that fulfils a condition was given in `[from_s, to_s]`.
    pub fn any_verdict(&self, from_s: f64, to_s: f64, is: impl Fn(Verdict) -> bool) -> bool {
        self.verdict_at(from_s).is_some_and(&is)
            || self.verdicts.iter().any(|(at_s, verdict)| (from_s..=to_s).contains(at_s) && is(*verdict))
    }

    /// Time in `[from_s, to_s]` in which the verdict was unknown, s.
    pub fn unknown_s(&self, from_s: f64, to_s: f64) -> f64 {
        let ends = self.verdicts.iter().skip(1).map(|(at_s, _)| *at_s).chain([f64::INFINITY]);
        let spans = self.verdicts.iter().zip(ends).filter(|((_, verdict), _)| verdict.reason().is_some());
        spans.map(|((begun_s, _), end_s)| (end_s.min(to_s) - begun_s.max(from_s)).max(0.0)).sum()
    }

    /// Whether a leak was stated at any time in `[from_s, to_s]`.
    pub fn any_leak(&self, from_s: f64, to_s: f64) -> bool {
        let next = self.leaking.partition_point(|(at_s, _)| *at_s <= from_s);
        let before = next.checked_sub(1).is_some_and(|last| self.leaking[last].1);
        before || self.leaking.iter().any(|(at_s, leaking)| *leaking && (from_s..=to_s).contains(at_s))
    }

    /// When a leak was stated first in `[from_s, to_s]`, s.
    pub fn first_leak_s(&self, from_s: f64, to_s: f64) -> Option<f64> {
        let found = self.leaking.iter().find(|(at_s, leaking)| *leaking && (from_s..=to_s).contains(at_s));
        found.map(|(at_s, _)| *at_s)
    }

    /// Whether a sensor was said not to be good at any time in `[from_s, to_s]`.
    pub fn any_fault(&self, sensor: usize, from_s: f64, to_s: f64) -> bool {
        let of_sensor = || self.health.iter().filter(|(_, of, _)| *of == sensor);
        let before = of_sensor().take_while(|(at_s, ..)| *at_s < from_s).last();
        before.is_some_and(|(_, _, health)| *health != Health::Good)
            || of_sensor().any(|(at_s, _, health)| *health != Health::Good && (from_s..=to_s).contains(at_s))
    }

    /// Events in `[from_s, to_s]`.
    pub fn events_in(&self, from_s: f64, to_s: f64) -> impl Iterator<Item = &EventKind> {
        self.events
            .iter()
            .filter(move |(at_s, _)| (from_s..=to_s).contains(at_s))
            .map(|(_, event)| &event.kind)
    }
}

/// The state of a monitor as bytes.
fn saved(monitor: &Monitor) -> Result<Vec<u8>, EvaluationError> {
    Ok(monitor.save().map_err(DetectorError::from)?)
}

/// Whether all that is estimated is a number; a missing reading is none.
fn is_finite(output: &Output) -> bool {
    let estimate = &output.estimate;
    let values = [
        estimate.time_s,
        estimate.gas_mean_k,
        estimate.gas_mean_sd_k,
        estimate.mass_kg,
        estimate.mass_sd_kg,
        estimate.leak_kg_s,
        estimate.leak_sd_kg_s,
        estimate.pressure_expected_pa,
        estimate.p15_pa,
        output.decision.leak_probability.unwrap_or(0.0),
        output.cold_pressure_pa,
    ];
    let leak = output.leak.iter().flat_map(|leak| {
        [leak.rate_kg_s, leak.rate_pa_s, leak.onset_s, leak.lost_kg].map(|i| i.value + i.low + i.high)
    });
    values.into_iter().chain(leak).all(f64::is_finite)
}

/// FNV-1a over what was said.
fn digest(before: u64, output: &Output) -> u64 {
    const PRIME: u64 = 0x0000_0100_0000_01b3;
    let leak = output.leak.map_or(0.0, |leak| leak.rate_kg_s.value);
    let numbers = [output.estimate.time_s, output.estimate.mass_kg, output.estimate.gas_mean_k, leak];
    let verdict = output.decision.verdict.as_str().len() as f64;
    numbers.iter().chain([&verdict]).fold(before, |hash, value| (hash ^ value.to_bits()).wrapping_mul(PRIME))
}

//! This project's monitor as a candidate: the one place that reads its output.
use std::sync::Arc;

use serde_json::Value;

use super::{Candidate, Contender, Row, overlaid};
use crate::detector::monitor::alarm::{AlarmName, AlarmSettings};
use crate::detector::monitor::{Health, Monitor, MonitorSettings, Output, Verdict};
use crate::estimator::observer::Outcome;
use crate::judge::JudgeError;
use crate::judge::measures::Class;
use crate::judge::said::{Decision, Estimates, Innovation, Said, normal};
use crate::world::{Snapshot, Told};

/// Operational limit as a part of the stated filling: 160 bar of 200.
const LIMIT: f64 = 0.8;

/// The monitor, with the settings of a plan laid over its own.
///
/// # Errors
/// A setting that it does not have.
pub fn monitor(settings: &Value) -> Result<Arc<dyn Candidate>, JudgeError> {
    overlaid(&MonitorSettings::default(), settings)?.validate()?;
    Ok(Arc::new(Monitors { settings: settings.clone() }))
}

struct Monitors {
    settings: Value,
}

impl Candidate for Monitors {
    fn start(&self, told: &Told) -> Result<Box<dyn Contender>, JudgeError> {
        let mut settings = MonitorSettings::default();
        settings.limits.operational_pa = LIMIT * super::statistic::stated_filling(told)?.pressure_pa;
        settings.alarms = AlarmSettings::with_limit(settings.limits.operational_pa);
        let settings = overlaid(&settings, &self.settings)?;
        let monitor = Monitor::new(&told.vessel, &told.sensors, &told.commissioning, &settings)?;
        let pressure = told.sensors.iter().position(|sensor| sensor.name == "pressure");
        Ok(Box::new(Monitored { told: told.clone(), settings, monitor, pressure, was_lost: false, old: None }))
    }
}

struct Monitored {
    told: Told,
    settings: MonitorSettings,
    monitor: Monitor,
    /// Index of the pressure.
    pressure: Option<usize>,
    /// Whether a leak has been found in this log.
    was_lost: bool,
    /// State of up to an hour ago.
    old: Option<Vec<u8>>,
}

impl Contender for Monitored {
    fn step(&mut self, row: &Row<'_>, said: &mut Vec<Said>) -> Result<(), JudgeError> {
        let outputs = if row.historical {
            self.monitor.step_historical(row.stamp_s, row.readings)?
        } else {
            self.monitor.step(row.stamp_s, row.readings)?
        };
        self.say(&outputs, said);
        Ok(())
    }

    fn finish(&mut self, said: &mut Vec<Said>) -> Result<(), JudgeError> {
        let outputs = self.monitor.finish()?;
        self.say(&outputs, said);
        Ok(())
    }

    fn keep(&mut self) -> Result<(), JudgeError> {
        self.old = Some(self.monitor.save().map_err(crate::detector::DetectorError::from)?);
        Ok(())
    }

    fn power_cycle(&mut self, snapshot: Snapshot) -> Result<(), JudgeError> {
        let mut bytes = match (snapshot, &self.old) {
            (Snapshot::Old, Some(old)) => old.clone(),
            _ => self.monitor.save().map_err(crate::detector::DetectorError::from)?,
        };
        let mut sensors = self.told.sensors.clone();
        match snapshot {
            Snapshot::Truncated => bytes.truncate(bytes.len() / 2),
            Snapshot::Corrupted => {
                let middle = bytes.len() / 2;
                bytes[middle] ^= 1;
            }
            // A state of the same vessel with other sensors.
            Snapshot::Foreign => {
                sensors.remove(0);
                let other =
                    Monitor::new(&self.told.vessel, &sensors, &self.told.commissioning, &self.settings)?;
                bytes = other.save().map_err(crate::detector::DetectorError::from)?;
            }
            Snapshot::Current | Snapshot::Old => {}
        }
        let Told { vessel, sensors, commissioning, .. } = &self.told;
        self.monitor = match Monitor::restore(vessel, sensors, &self.settings, &bytes) {
            Ok(monitor) => monitor,
            Err(error) if matches!(snapshot, Snapshot::Current | Snapshot::Old) => return Err(error.into()),
            Err(_) => Monitor::new(vessel, sensors, commissioning, &self.settings)?,
        };
        Ok(())
    }
}

impl Monitored {
    fn say(&mut self, outputs: &[Output], said: &mut Vec<Said>) {
        for (index, output) in outputs.iter().enumerate() {
            let decision = self.decision(output, index + 1 == outputs.len());
            said.push(Said {
                stamp_s: output.stamp_s,
                decision: Some(decision),
                estimates: estimates(output),
                ..Said::default()
            });
        }
        // The observer inside stands at the last row.
        let Some(last) = said.last_mut().filter(|_| !outputs.is_empty()) else { return };
        let innovations = self.monitor.observer().innovations();
        last.innovation = self
            .pressure
            .and_then(|pressure| innovations.get(pressure))
            .filter(|innovation| innovation.outcome != Outcome::Missing)
            .map(|innovation| Innovation { nu: innovation.nu, s: innovation.s });
        last.free_mass_kg = self.monitor.observer().leaks().last().map(|leak| leak.mass_kg);
    }

    /// As the program would report and exit if the log ended here.
    fn decision(&mut self, output: &Output, is_last: bool) -> Decision {
        let class = Class::from(output.verdict);
        let leak = output.leak.is_some();
        self.was_lost |= leak || output.verdict == Verdict::Leak;
        let exit_code = match output.verdict {
            _ if self.was_lost => 1,
            Verdict::Unknown(_) => 3,
            _ => 0,
        };
        let is_named = |health: &Health| !matches!(health, Health::Good | Health::Spikes);
        Decision {
            class,
            leak,
            leak_probability: Some(output.leak_probability),
            alarm: is_last.then(|| self.monitor.alarms().condition(AlarmName::Leak).active),
            reaction: output.outlook.map(|outlook| outlook.advice.reaction),
            exit_code,
            sensor_named: class == Class::SensorFault || output.health.iter().any(is_named),
        }
    }
}

fn estimates(output: &Output) -> Estimates {
    let estimate = &output.estimate;
    let unbound = normal(estimate.leak_kg_s, estimate.leak_sd_kg_s);
    Estimates {
        mass_kg: Some(normal(estimate.mass_kg, estimate.mass_sd_kg)),
        gas_mean_k: Some(normal(estimate.gas_mean_k, estimate.gas_mean_sd_k)),
        leak_kg_s: Some(output.leak.map_or(unbound, |leak| leak.rate_kg_s.into()))
            .filter(|leak| leak.value.is_finite()),
        onset_s: output.leak.map(|leak| leak.onset_s.into()),
    }
}

//! This project's monitor as a candidate: the one place that reads its output.
use std::sync::Arc;

use serde_json::Value;

use super::{Candidate, CandidateRun, Row, overlaid};
use crate::detector::evidence::Tails;
use crate::detector::monitor::alarm::{AlarmName, AlarmSettings};
use crate::detector::monitor::{
    EventKind, Health, LIKELY, Monitor, MonitorSettings, Outcome as Loss, Output,
};
use crate::estimator::observer::Outcome;
use crate::judge::JudgeError;
use crate::judge::measures::Class;
use crate::judge::statement::{Decision, Estimates, Innovation, Statement, normal};
use crate::tails::Commissioned;
use crate::world::{OperatorData, Snapshot};

/// Operational limit as a part of the stated filling: 160 bar of 200.
const LIMIT: f64 = 0.8;

/// Setting of a plan that names a file of commissioned tails.
const COMMISSIONED: &str = "commissioned";

/// The monitor, with the settings of a plan laid over its own.
///
/// # Errors
/// A setting that it does not have, or a file of commissioned tails that is none.
pub fn monitor(settings: &Value) -> Result<Arc<dyn Candidate>, JudgeError> {
    let mut settings = settings.clone();
    if let Some(named) = settings.as_object_mut().and_then(|settings| settings.remove(COMMISSIONED)) {
        settings["tails"] = serde_json::to_value(commissioned(named.as_str().unwrap_or_default())?)?;
    }
    overlaid(&MonitorSettings::default(), &settings)?.validate()?;
    Ok(Arc::new(Monitors { settings }))
}

/// The tails of a file.
fn commissioned(path: &str) -> Result<Tails, JudgeError> {
    let failed = |source| JudgeError::File { path: path.into(), source };
    let text = std::fs::read_to_string(path).map_err(failed)?;
    let commissioned: Commissioned = serde_json::from_str(&text)?;
    commissioned.tails().map_err(|error| failed(std::io::Error::other(error)))
}

struct Monitors {
    settings: Value,
}

impl Candidate for Monitors {
    fn start(&self, data: &OperatorData) -> Result<Box<dyn CandidateRun>, JudgeError> {
        let mut settings = MonitorSettings::default();
        settings.limits.operational_pa = LIMIT * super::statistic::stated_filling(data).pressure_pa;
        settings.alarms = AlarmSettings::with_limit(settings.limits.operational_pa);
        let settings = overlaid(&settings, &self.settings)?;
        let monitor = begun(data, &settings)?;
        let pressure = data.sensors.iter().position(|sensor| sensor.name == "pressure");
        Ok(Box::new(Monitored {
            data: data.clone(),
            settings,
            monitor,
            pressure,
            was_lost: false,
            old: None,
        }))
    }

    fn decision_level(&self) -> f64 {
        LIKELY
    }
}

/// A monitor before its first row, told of the discharges that are ordered.
fn begun(data: &OperatorData, settings: &MonitorSettings) -> Result<Monitor, JudgeError> {
    let mut monitor = Monitor::new(&data.vessel, &data.sensors, &data.commissioning, settings)?;
    data.announced.iter().for_each(|(from_s, until_s)| monitor.announce(*from_s, *until_s));
    Ok(monitor)
}

struct Monitored {
    data: OperatorData,
    settings: MonitorSettings,
    monitor: Monitor,
    /// Index of the pressure.
    pressure: Option<usize>,
    /// Whether a loss has been said in this log.
    was_lost: bool,
    /// State of up to an hour ago.
    old: Option<Vec<u8>>,
}

impl CandidateRun for Monitored {
    fn step(&mut self, row: &Row<'_>, statements: &mut Vec<Statement>) -> Result<(), JudgeError> {
        let outputs = if row.historical {
            self.monitor.take_historical(row.stamp_s, row.readings)?;
            self.monitor.outputs()?
        } else {
            self.monitor.step(row.stamp_s, row.readings)?
        };
        self.say(&outputs, statements);
        Ok(())
    }

    fn finish(&mut self, statements: &mut Vec<Statement>) -> Result<(), JudgeError> {
        let outputs = self.monitor.finish()?;
        self.say(&outputs, statements);
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
        let mut sensors = self.data.sensors.clone();
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
                    Monitor::new(&self.data.vessel, &sensors, &self.data.commissioning, &self.settings)?;
                bytes = other.save().map_err(crate::detector::DetectorError::from)?;
            }
            Snapshot::Current | Snapshot::Old => {}
        }
        let OperatorData { vessel, sensors, .. } = &self.data;
        self.monitor = match Monitor::restore(vessel, sensors, &self.settings, &bytes) {
            Ok(monitor) => monitor,
            Err(error) if matches!(snapshot, Snapshot::Current | Snapshot::Old) => return Err(error.into()),
            Err(_) => begun(&self.data, &self.settings)?,
        };
        Ok(())
    }
}

impl Monitored {
    fn say(&mut self, outputs: &[Output], statements: &mut Vec<Statement>) {
        for (index, output) in outputs.iter().enumerate() {
            let decision = self.decision(output, index + 1 == outputs.len());
            statements.push(Statement {
                stamp_s: output.stamp_s,
                decision: Some(decision),
                estimates: estimates(output),
                ..Statement::default()
            });
        }
        // The observer inside stands at the last row.
        let Some(last) = statements.last_mut().filter(|_| !outputs.is_empty()) else { return };
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
        let decided = &output.decision;
        let class = Class::from(decided.verdict);
        let loss = decided.outcome == Loss::Loss;
        self.was_lost |= loss;
        let is_named = |health: &Health| !matches!(health, Health::Good | Health::Spikes);
        Decision {
            class,
            leak: output.leak.is_some(),
            loss,
            leak_probability: decided.leak_probability,
            alarm: is_last.then(|| self.monitor.alarms().condition(AlarmName::Leak).active),
            reaction: decided.reaction,
            exit_code: if self.was_lost { 1 } else { decided.outcome.exit_code() },
            sensor_named: class == Class::SensorFault || output.health.iter().any(is_named),
            exchange: matches!(class, Class::Discharge | Class::Refill)
                || output.events.iter().any(|event| is_exchange(&event.kind)),
        }
    }
}

fn is_exchange(kind: &EventKind) -> bool {
    matches!(kind, EventKind::Discharge(_) | EventKind::Refill(_))
}

fn estimates(output: &Output) -> Estimates {
    let estimate = &output.estimate;
    Estimates {
        mass_kg: Some(normal(estimate.mass_kg, estimate.mass_sd_kg)),
        gas_mean_k: Some(normal(estimate.gas_mean_k, estimate.gas_mean_sd_k)),
        leak_kg_s: Some(output.leak_rate_kg_s.into()),
        onset_s: output.leak.map(|leak| leak.onset_s.into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::detector::evidence::{Scale, Tail};
    use crate::judge::table::Rate;
    use crate::tails::CommissionedScale;
    use serde_json::json;

    #[test]
    fn a_plan_names_commissioned_thresholds_by_their_file() {
        let tail = Tail { level: 1.0, interval_s: 1e6, scale: 0.5, shape: 0.1 };
        let of = |scale| CommissionedScale { scale, tail, threshold: 3.0, threshold_interval: (2.0, 4.0) };
        let rate = Rate {
            count: 0,
            cylinder_years: 1.0,
            per_ten_years: 0.0,
            poisson: (0.0, 36.9),
            simulations: 1,
            simulations_with: 0,
            by_simulation: (0.0, 36.9),
        };
        let found = Commissioned { scales: Scale::ALL.map(of), false_alarms: rate };
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("thresholds.json").to_str().unwrap().to_owned();
        std::fs::write(&path, serde_json::to_string(&found).unwrap()).unwrap();
        assert_eq!(commissioned(&path).unwrap(), Tails([tail; Scale::ALL.len()]));
        assert!(monitor(&json!({ "commissioned": path, "learning_s": 10.0 })).is_ok());
        let missing = format!("{path}.not");
        let error = monitor(&json!({ "commissioned": missing })).err().unwrap().to_string();
        assert!(error.contains(&missing), "{error}");
        std::fs::write(&path, "{}").unwrap();
        assert!(monitor(&json!({ "commissioned": path })).is_err());
    }
}

//! The observer alone: estimates and innovations without a verdict.
use std::sync::Arc;

use serde_json::Value;

use super::{Candidate, CandidateRun, Row, overlaid};
use crate::estimator::observer::{Observer, ObserverSettings, Outcome};
use crate::judge::JudgeError;
use crate::judge::statement::{Estimates, Innovation, Statement, normal};
use crate::world::OperatorData;

/// The observer, with the settings of a plan laid over its own.
///
/// # Errors
/// A setting that it does not have.
pub(crate) fn observer(settings: &Value) -> Result<Arc<dyn Candidate>, JudgeError> {
    Ok(Arc::new(Observers { settings: overlaid(&ObserverSettings::default(), settings)? }))
}

struct Observers {
    settings: ObserverSettings,
}

struct Observed {
    observer: Observer,
    pressure: Option<usize>,
    last_s: f64,
}

impl Candidate for Observers {
    fn start(&self, data: &OperatorData) -> Result<Box<dyn CandidateRun>, JudgeError> {
        let observer = Observer::new(&data.vessel, &data.sensors, &data.commissioning, &self.settings)?;
        let pressure = data.sensors.iter().position(|sensor| sensor.name == "pressure");
        Ok(Box::new(Observed { observer, pressure, last_s: f64::NEG_INFINITY }))
    }
}

impl CandidateRun for Observed {
    /// A row that is not later than the one before is left out, as the observer demands.
    fn step(&mut self, row: &Row<'_>, statements: &mut Vec<Statement>) -> Result<(), JudgeError> {
        if row.stamp_s <= self.last_s {
            return Ok(());
        }
        self.last_s = row.stamp_s;
        let estimate = self.observer.step(row.stamp_s, row.readings)?;
        let innovations = self.observer.innovations();
        let innovation = self
            .pressure
            .and_then(|pressure| innovations.get(pressure))
            .filter(|innovation| innovation.outcome != Outcome::Missing);
        statements.push(Statement {
            stamp_s: row.stamp_s,
            estimates: Estimates {
                mass_kg: Some(normal(estimate.mass_kg, estimate.mass_sd_kg)),
                gas_mean_k: Some(normal(estimate.gas_mean_k, estimate.gas_mean_sd_k)),
                leak_kg_s: Some(normal(estimate.leak_kg_s, estimate.leak_sd_kg_s))
                    .filter(|leak| leak.value.is_finite()),
                onset_s: None,
            },
            innovation: innovation.map(|innovation| Innovation { nu: innovation.nu, s: innovation.s }),
            free_mass_kg: self.observer.leaks().last().map(|leak| leak.mass_kg),
            ..Statement::default()
        });
        Ok(())
    }
}

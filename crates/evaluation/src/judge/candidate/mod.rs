//! Monitors and estimators that can be judged: rows in, statements out.
//!
//! A plan names a candidate by its kind; a kind is a function from settings to a [`Candidate`] in a [`Registry`]. A new one is an
//! implementation of the two traits and one line of registration:
//!
//! | kind | what it is |
//! |---|---|
//! | `monitor` | this project's monitor; `settings` are laid over [`MonitorSettings`](crate::detector::monitor::MonitorSettings); `settings.commissioned` names a file of [`Commissioned`](crate::tails::Commissioned) thresholds |
//! | `observer` | the observer alone: estimates and innovations, no verdict; `settings` over those of the observer |
//! | `paper` | the paper's detector as published: its transfer function and slope, a threshold held for 10 min |
//! | `paper-refitted` | gain 1, refitted pole, equation of state, mean error of four days taken off, held for an hour |
//! | `textbook-cusum` | a cumulative sum of that error as if it were white |
//! | `ideal-gas` | pressure over temperature of the shoulder |
//! | `pressure-switch` | the raw pressure against a limit |
//!
//! Those without a verdict say a statistic in parts of the stated filling; the judge finds its threshold on the families that tune.
mod monitored;
mod observed;
mod statistic;

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

use super::JudgeError;
use super::statement::Statement;
use crate::world::{OperatorData, Snapshot};

pub use monitored::monitor;
pub(crate) use observed::observer;

/// A row as it arrives.
#[derive(Clone, Copy, Debug)]
pub struct Row<'a> {
    /// Stamp, s.
    pub stamp_s: f64,
    /// One reading per sensor, SI; NaN: missing.
    pub readings: &'a [f64],
    /// Whether it says that it is replayed from a store.
    pub historical: bool,
}

/// A monitor or an estimator.
pub trait Candidate: Send + Sync {
    /// At the beginning of a log, told what may be known.
    ///
    /// # Errors
    /// What it refuses.
    fn start(&self, data: &OperatorData) -> Result<Box<dyn CandidateRun>, JudgeError>;

    /// Probability of a leak from which on it decides for one.
    fn decision_level(&self) -> f64 {
        0.5
    }

    /// Whether it says a statistic that needs a threshold, instead of a verdict.
    fn needs_threshold(&self) -> bool {
        false
    }
}

/// A candidate at work on one log.
pub trait CandidateRun {
    /// Take a row and append what is said now: once for each row that is ready.
    ///
    /// # Errors
    /// What it cannot go on with.
    fn step(&mut self, row: &Row<'_>, statements: &mut Vec<Statement>) -> Result<(), JudgeError>;

    /// The log has ended: what was held back.
    ///
    /// # Errors
    /// As [`CandidateRun::step`].
    fn finish(&mut self, _statements: &mut Vec<Statement>) -> Result<(), JudgeError> {
        Ok(())
    }

    /// Store the state, as a device does every hour: the old snapshot of a later power cycle.
    ///
    /// # Errors
    /// The state cannot be stored.
    fn keep(&mut self) -> Result<(), JudgeError> {
        Ok(())
    }

    /// The power was away, and this is the snapshot that is left. Without a stored state nothing changes.
    ///
    /// # Errors
    /// A sound snapshot that is refused.
    fn power_cycle(&mut self, _snapshot: Snapshot) -> Result<(), JudgeError> {
        Ok(())
    }
}

/// Makes a candidate from the settings of a plan.
pub(crate) type Kind = fn(&Value) -> Result<Arc<dyn Candidate>, JudgeError>;

/// Kinds of candidates by name.
#[derive(Clone, Debug)]
pub struct Registry(BTreeMap<String, Kind>);

impl Default for Registry {
    /// All kinds of this project.
    fn default() -> Self {
        let mut registry = Self(BTreeMap::new());
        registry.register("monitor", monitor);
        registry.register("observer", observer);
        statistic::KINDS.iter().for_each(|(name, kind)| registry.register(name, *kind));
        registry
    }
}

impl Registry {
    /// Add a kind; one of the same name is replaced.
    pub fn register(&mut self, name: &str, kind: Kind) {
        self.0.insert(name.to_owned(), kind);
    }

    /// A kind by its name.
    pub(crate) fn kind(&self, name: &str) -> Option<Kind> {
        self.0.get(name).copied()
    }

    /// Names of all kinds.
    pub(crate) fn names(&self) -> Vec<&str> {
        self.0.keys().map(String::as_str).collect()
    }
}

/// Settings with those of a plan laid over them; null: none.
fn overlaid<S: Serialize + DeserializeOwned>(settings: &S, over: &Value) -> Result<S, JudgeError> {
    let mut document = serde_json::to_value(settings)?;
    lay_over(&mut document, over);
    Ok(serde_json::from_value(document)?)
}

fn lay_over(document: &mut Value, over: &Value) {
    match (document, over) {
        (_, Value::Null) => {}
        (Value::Object(document), Value::Object(over)) => {
            for (key, value) in over {
                lay_over(document.entry(key.clone()).or_insert(Value::Null), value);
            }
        }
        (document, over) => *document = over.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::detector::monitor::MonitorSettings;

    #[test]
    fn settings_of_a_plan_change_what_they_name_and_nothing_else() {
        let over = serde_json::json!({ "learning_s": 10.0, "limits": { "operational_pa": 5e5 } });
        let changed = overlaid(&MonitorSettings::default(), &over).unwrap();
        let usual = MonitorSettings::default();
        assert_eq!((changed.learning_s, changed.limits.operational_pa), (10.0, 5e5));
        assert_eq!(changed.limits.maintenance_loss, usual.limits.maintenance_loss);
        assert_eq!(MonitorSettings { learning_s: usual.learning_s, limits: usual.limits, ..changed }, usual);
        assert_eq!(overlaid(&usual, &Value::Null).unwrap(), usual);
    }
}

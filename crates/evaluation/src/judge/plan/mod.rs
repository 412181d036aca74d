//! Plans: which families tune and which judge, which candidates watch which worlds. Written before a run, and checked before it.
mod document;
mod expand;
mod extent;
mod pattern;
pub mod presets;

use cylwatch_thermal::units::YEAR_S;
use std::path::Path;
use std::sync::Arc;

use serde::Serialize;
use serde_json::Value;
use sha2::{Digest, Sha256};

pub use document::{CandidateDocument, GroupDocument, OverlayDocument, PlanDocument};
pub use expand::{Task, Unit};
pub use extent::Extent;
pub use pattern::Axis;
pub(crate) use pattern::Pattern;

use super::JudgeError;
use super::candidate::{Candidate, Registry};
use crate::world::{Family, Overlay};

/// A checked plan.
#[derive(Clone)]
pub struct Plan {
    /// As written.
    pub document: PlanDocument,
    /// Kinds of families that judge instead of tuning.
    pub left_out: Vec<Axis>,
    /// Candidates with their names, in the order of the plan.
    pub candidates: Vec<PlanCandidate>,
    /// All worlds, in the order of the plan.
    pub tasks: Vec<Task>,
    tune: Vec<Pattern>,
    judge: Vec<Pattern>,
}

/// A candidate by its name.
#[derive(Clone)]
pub struct PlanCandidate {
    /// Name in the table.
    pub name: String,
    /// The candidate.
    pub candidate: Arc<dyn Candidate>,
}

/// What a family is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Role {
    /// It is reported.
    Judge,
    /// Thresholds are set on it.
    Tune,
}

impl Plan {
    /// Read and check a file.
    ///
    /// # Errors
    /// One message with file, key, value and remedy.
    pub fn read(path: &Path, registry: &Registry, left_out: &[String]) -> Result<Self, JudgeError> {
        let name = path.display().to_string();
        let text = std::fs::read_to_string(path)
            .map_err(|source| JudgeError::File { path: path.to_owned(), source })?;
        Self::parse(&text, &name, registry, left_out)
    }

    /// From the text of a file, whose name is for messages; `left_out` as in `climate=desert`.
    ///
    /// # Errors
    /// As [`Plan::read`].
    pub fn parse(
        text: &str,
        file: &str,
        registry: &Registry,
        left_out: &[String],
    ) -> Result<Self, JudgeError> {
        let document: PlanDocument = toml::from_str(text).map_err(|error| {
            let before = error.span().map_or(0, |span| span.start.min(text.len()));
            let line = 1 + text[..before].matches('\n').count();
            JudgeError::Document { file: file.to_owned(), line, reason: error.message().to_owned() }
        })?;
        let check = Check { file };
        let positive = document.between_false_alarms_y > 0.0 && document.between_false_alarms_y.is_finite();
        let years = document.between_false_alarms_y;
        check.that(positive, "between_false_alarms_y", years, "must be positive and finite")?;
        let patterns = |key: &str, all: &[String]| -> Result<Vec<Pattern>, JudgeError> {
            all.iter().map(|text| check.parsed(key, text)).collect()
        };
        let (tune, judge) = (patterns("tune", &document.tune)?, patterns("judge", &document.judge)?);
        let left_out = left_out
            .iter()
            .map(|text| check.parsed("--leave-out", text))
            .collect::<Result<Vec<Axis>, _>>()?;
        let candidates = candidates(&check, &document, registry)?;
        let mut plan = Self { document, left_out, candidates, tasks: Vec::new(), tune, judge };
        plan.tasks = expand::tasks(&plan, &check)?;
        let needing = plan.candidates.iter().find(|named| named.candidate.needs_threshold());
        if let Some(named) = needing {
            let tuned = plan.tasks.iter().any(|task| task.role == Role::Tune);
            let remedy =
                "needs a threshold: give families to tune on, and groups that run them without an overlay";
            check.that(tuned, "candidate.name", &named.name, remedy)?;
        }
        Ok(plan)
    }

    /// What a family is for; `None`: the plan does not say, or says both.
    fn role(&self, family: &Family) -> Option<Role> {
        let holds = |patterns: &[Pattern]| patterns.iter().any(|pattern| pattern.holds(family));
        match (holds(&self.tune), holds(&self.judge)) {
            (true, false) if self.left_out.iter().any(|axis| axis.holds(family)) => Some(Role::Judge),
            (true, false) => Some(Role::Tune),
            (false, true) => Some(Role::Judge),
            _ => None,
        }
    }

    /// Wished mean time between false alarms, s.
    pub(crate) fn between_false_alarms_s(&self) -> f64 {
        self.document.between_false_alarms_y * YEAR_S
    }

    /// Worlds that share one simulation, in the order of the plan.
    pub fn units(&self) -> Vec<Unit> {
        expand::units(&self.tasks)
    }

    /// Whether there are leaks whose delays are judged.
    pub fn has_leaks(&self) -> bool {
        let is_leak = |task: &Task| matches!(task.request.overlay, Overlay::Leak { .. });
        self.tasks.iter().any(|task| task.role == Role::Judge && is_leak(task))
    }

    /// SHA-256 over all that decides the results; comments and order of keys do not.
    ///
    /// # Errors
    /// A number that JSON cannot hold.
    pub(crate) fn hash(&self) -> Result<String, JudgeError> {
        let left_out: Vec<String> = self.left_out.iter().map(ToString::to_string).collect();
        let text = serde_json::to_vec(&(&self.document, left_out))?;
        Ok(hex(&Sha256::digest(text)))
    }
}

/// Bytes in hexadecimal digits.
pub(super) fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

fn candidates(
    check: &Check<'_>,
    document: &PlanDocument,
    registry: &Registry,
) -> Result<Vec<PlanCandidate>, JudgeError> {
    check.that(!document.candidate.is_empty(), "candidate", "none", "give at least one [[candidate]]")?;
    let mut all: Vec<PlanCandidate> = Vec::new();
    for CandidateDocument { name, kind, settings } in &document.candidate {
        let unique = all.iter().all(|known| known.name != *name);
        check.that(
            unique,
            "candidate.name",
            name,
            "is there twice; give each candidate a name of its own",
        )?;
        let kind_of = registry.kind(kind);
        let known = format!("is no kind; known are {}", registry.names().join(", "));
        let Some(make) = kind_of else { return Err(check.refuse("candidate.kind", kind, &known)) };
        let settings = settings.as_ref().map_or(Ok(Value::Null), serde_json::to_value)?;
        let candidate = make(&settings).map_err(|error| {
            check.refuse(&format!("candidate.{name}.settings"), &settings, &error.to_string())
        })?;
        all.push(PlanCandidate { name: name.clone(), candidate });
    }
    Ok(all)
}

/// Refusals with the name of the file.
pub(super) struct Check<'a> {
    file: &'a str,
}

impl Check<'_> {
    fn refuse(&self, key: &str, value: impl std::fmt::Display, remedy: &str) -> JudgeError {
        let (file, key, value) = (self.file.to_owned(), key.to_owned(), value.to_string());
        JudgeError::Plan { file, key, value, remedy: remedy.to_owned() }
    }

    fn that(
        &self,
        holds: bool,
        key: &str,
        value: impl std::fmt::Display,
        remedy: &str,
    ) -> Result<(), JudgeError> {
        if holds { Ok(()) } else { Err(self.refuse(key, value, remedy)) }
    }

    fn parsed<T: std::str::FromStr<Err: std::fmt::Display>>(
        &self,
        key: &str,
        text: &str,
    ) -> Result<T, JudgeError> {
        text.parse().map_err(|error: T::Err| self.refuse(key, text, &error.to_string()))
    }
}

#[cfg(test)]
mod tests;

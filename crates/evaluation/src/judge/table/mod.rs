//! The table by family, from the journal: as JSON, and as Markdown for people.
//!
//! Worlds are read simulation by simulation, in the order of their keys, whatever the order in which they were finished.
mod clustered;
mod group;
mod markdown;
mod report;
mod tally;
mod threshold;

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;

pub(crate) use self::clustered::Clustered;
pub use self::clustered::{Rate, Share};
pub(crate) use self::group::Group;
pub use self::report::{
    CandidateReport, CoverageRow, DisagreementReport, FastRow, FaultRowReport, GroupReport, InnovationRow,
    LeakRow, Leaks, Tight,
};
pub use self::threshold::Tuned;

use self::tally::Tally;
use self::threshold::{Tuning, at_threshold};
use super::JudgeError;
use super::entry::Entry;
use super::journal::Results;
use super::plan::{Plan, Role};
use crate::noise::Noise;
use crate::world::{Overlay, Request, SimulationKey};

/// Names of the files of the table.
pub(crate) const TABLE: [&str; 2] = ["table.md", "table.json"];
/// Failure of a candidate that is not judged at all.
const NO_THRESHOLD: &str = "no threshold: it says a number in fewer than five tight worlds that tune; give it more of them, or more time in each";
/// Failures that are told one by one.
const LISTED_FAILURES: usize = 10;

/// What the table is of.
#[derive(Clone, Debug, Serialize)]
pub struct Provenance {
    /// Title of the plan.
    pub title: String,
    /// Hash of the plan.
    pub plan_sha256: String,
    /// Version of this crate.
    pub version: &'static str,
    /// Worlds of the plan.
    pub worlds: usize,
    /// Worlds that are finished.
    pub finished: usize,
    /// Patterns of families that thresholds are set on.
    pub tune: Vec<String>,
    /// Patterns of families that judge.
    pub judge: Vec<String>,
    /// Kinds that judge instead of tuning.
    pub left_out: Vec<String>,
    /// Wished mean time between false alarms, years.
    pub between_false_alarms_y: f64,
    /// Worlds that could not be made.
    pub failed_worlds: usize,
    /// Why: the first ones.
    pub failures: Vec<String>,
}

/// The whole table.
#[derive(Clone, Debug, Serialize)]
pub struct Table {
    /// What it is of.
    pub provenance: Provenance,
    /// By candidate, in the order of the plan.
    pub candidates: Vec<CandidateReport>,
}

/// Write the table of the worlds that are finished, and return it.
///
/// # Errors
/// The journal cannot be read, or a file not be written.
pub(crate) fn write(plan: &Plan, results: &mut Results, folder: &Path) -> Result<Table, JudgeError> {
    let table = Table::of(plan, results)?;
    let texts = [table.to_markdown(), table.to_json()?];
    for (name, text) in TABLE.into_iter().zip(texts) {
        // A kill leaves the old file or the new one.
        let (path, fresh) = (folder.join(name), folder.join(format!("{name}.new")));
        let written = std::fs::write(&fresh, text).and_then(|()| std::fs::rename(&fresh, &path));
        written.map_err(|source| JudgeError::File { path, source })?;
    }
    Ok(table)
}

/// Sums by candidate and group.
type Tallies = Vec<BTreeMap<Group, Tally>>;

impl Table {
    /// From the worlds that are finished.
    ///
    /// # Errors
    /// The journal cannot be read.
    pub(crate) fn of(plan: &Plan, results: &mut Results) -> Result<Self, JudgeError> {
        let mut order: Vec<usize> = (0..plan.tasks.len()).collect();
        order.sort_by_key(|task| (SimulationKey::of(&plan.tasks[*task].request), *task));
        let thresholds = tune(plan, results, &order)?;
        let mut provenance = provenance(plan, results)?;
        let mut reports: Vec<CandidateReport> = plan
            .candidates
            .iter()
            .zip(&thresholds)
            .map(|(named, threshold)| CandidateReport {
                name: named.name.clone(),
                threshold: *threshold,
                failures: match threshold {
                    None if named.candidate.needs_threshold() => vec![NO_THRESHOLD.to_owned()],
                    _ => Vec::new(),
                },
                contradictions: Vec::new(),
                groups: Vec::new(),
            })
            .collect();
        let mut tallies: Tallies = vec![BTreeMap::new(); plan.candidates.len()];
        for task in order {
            let Some(entry) = results.of::<Entry>(task)? else { continue };
            if let Err(reason) = &entry.facts {
                provenance.failed_worlds += 1;
                note(&mut provenance.failures, plan, task, reason);
            }
            add(plan, task, entry, &thresholds, &mut tallies, &mut reports);
        }
        let between_s = plan.between_false_alarms_s();
        for (report, of) in reports.iter_mut().zip(&tallies) {
            let group = |(group, tally): (&Group, &Tally)| {
                GroupReport::of(group, tally, smallest_noise(&tallies, group), between_s)
            };
            report.groups = of.iter().map(group).collect();
        }
        Ok(Self { provenance, candidates: reports })
    }

    /// As JSON.
    ///
    /// # Errors
    /// A number that JSON cannot hold.
    pub fn to_json(&self) -> Result<String, JudgeError> {
        Ok(serde_json::to_string_pretty(self)? + "\n")
    }

    /// Whether all worlds are finished and none of them, and no candidate in them, has failed.
    pub fn is_whole(&self) -> bool {
        let Provenance { worlds, finished, failed_worlds, .. } = self.provenance;
        finished == worlds && failed_worlds == 0 && self.candidates.iter().all(|of| of.failures.is_empty())
    }
}

/// Add the scores of a world to all groups that it is in.
fn add(
    plan: &Plan,
    index: usize,
    entry: Entry,
    thresholds: &[Option<Tuned>],
    tallies: &mut Tallies,
    reports: &mut [CandidateReport],
) {
    let task = &plan.tasks[index];
    let Ok(facts) = entry.facts else { return };
    for (&candidate, score) in task.candidates.iter().zip(entry.scores) {
        let groups = Group::all(task);
        let of = &mut tallies[candidate];
        match score {
            Err(reason) => {
                note(&mut reports[candidate].failures, plan, index, &reason);
                groups.iter().for_each(|group| of.entry(*group).or_default().add_failed(task));
            }
            Ok(mut score) => {
                if let Some(found) = score.disagreements.filter(|found| found.disagreeing > 0) {
                    note(&mut reports[candidate].contradictions, plan, index, &found.description());
                }
                if let Some(tuned) = thresholds[candidate] {
                    at_threshold(&mut score, tuned.level.threshold, &facts, &task.request.overlay);
                }
                groups.iter().for_each(|group| of.entry(*group).or_default().add(task, &facts, &score));
            }
        }
    }
}

/// Keep the first failures, with the request that makes the world again.
fn note(failures: &mut Vec<String>, plan: &Plan, task: usize, reason: &str) {
    if failures.len() < LISTED_FAILURES {
        let request = &plan.tasks[task].request;
        let Request { family, seed, set, length_s, overlay } = request;
        failures.push(format!("{family} seed {seed} set {set}, {length_s} s, {overlay:?}: {reason}"));
    }
}

/// Thresholds of the candidates that need one, from the families that tune.
fn tune(plan: &Plan, results: &mut Results, order: &[usize]) -> Result<Vec<Option<Tuned>>, JudgeError> {
    let mut tunings = vec![Tuning::default(); plan.candidates.len()];
    let needs = |candidate: &usize| plan.candidates[*candidate].candidate.needs_threshold();
    for &index in order {
        let task = &plan.tasks[index];
        let tunes = task.role == Role::Tune && task.request.overlay == Overlay::Nothing;
        if !tunes || !task.candidates.iter().any(needs) {
            continue;
        }
        let Some(Entry { facts: Ok(facts), scores }) = results.of::<Entry>(index)? else { continue };
        for (&candidate, score) in task.candidates.iter().zip(&scores) {
            if let (true, Ok(score)) = (needs(&candidate), score) {
                tunings[candidate].take(score, &facts);
            }
        }
    }
    Ok(tunings.iter().map(|tuning| tuning.finish(plan.between_false_alarms_s())).collect())
}

/// The noise of the candidate whose freest mass is quietest in a group.
fn smallest_noise(tallies: &Tallies, group: &Group) -> Option<Noise> {
    let noises = tallies.iter().filter_map(|of| report::noise_of(of.get(group)?));
    noises.min_by(|a, b| a.sd.total_cmp(&b.sd))
}

fn provenance(plan: &Plan, results: &Results) -> Result<Provenance, JudgeError> {
    let document = &plan.document;
    Ok(Provenance {
        title: document.title.clone(),
        plan_sha256: plan.hash()?,
        version: env!("CARGO_PKG_VERSION"),
        worlds: plan.tasks.len(),
        finished: results.len(),
        tune: document.tune.clone(),
        judge: document.judge.clone(),
        left_out: plan.left_out.iter().map(ToString::to_string).collect(),
        between_false_alarms_y: document.between_false_alarms_y,
        failed_worlds: 0,
        failures: Vec::new(),
    })
}

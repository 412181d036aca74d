//! `cylwatch place`: where sensors should sit.
mod arguments;
mod options;
mod quantities;
mod stop;

pub(super) use arguments::PlaceArguments;

use super::beside::beside;
use super::format::Format;
use super::host::{Outcome, Stopped};
use super::input::Inputs;
use super::interrupt;
use super::message::Messages;
use super::output::Target;
use super::progress::Progress;
use super::result::{Contents, Destination};
use super::views::Views;
use crate::estimator::placement::search::SearchControl;
use crate::estimator::placement::study::{Placement, Study, StudySettings};
use crate::estimator::placement::{Candidates, Status, read_candidates};
use crate::evaluation::placement::{ClosedLoop, ClosedLoopSettings, confirm_study};
use crate::report::Provenance;
use crate::report::place::{CAPTION, PlacementReport, matrices};
use crate::thermal::scenario::Scenario;
use crate::thermal::vessel::Vessel;
use anyhow::bail;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Exit code of a search that was ended early.
const PARTIAL: u8 = 3;

/// Validated options.
struct Options {
    vessel: String,
    scenarios: Vec<String>,
    candidates: Option<String>,
    settings: StudySettings,
    runs: ClosedLoopSettings,
    time_limit: Option<Duration>,
    data: Target,
    format: Option<Format>,
    views: Views,
    matrices: Option<Target>,
}

/// A finished study, with what it is of.
struct Finished {
    vessel: Vessel,
    candidates: Candidates,
    placement: Placement,
    study: Study,
    closed_loop: Option<ClosedLoop>,
    runs: ClosedLoopSettings,
    provenance: Provenance,
}

/// Searches, judges, writes; exit code 3 if it was ended early.
pub(super) fn run(arguments: PlaceArguments, messages: &Messages) -> anyhow::Result<ExitCode> {
    let begun = Instant::now();
    let options = Options::checked(arguments)?;
    let inputs = Inputs::default();
    let finished = options.finished(begun, &inputs, messages, || interrupt::listen(|| {}))?;
    finished.with_contents(|contents| options.write(contents, &finished, &inputs, messages))?;
    Ok(ExitCode::from(finished.exit_code(messages)))
}

/// The same for a caller: nothing is written.
pub(super) fn kept(
    arguments: PlaceArguments,
    inputs: &Inputs,
    messages: &Messages,
) -> anyhow::Result<Outcome> {
    let begun = Instant::now();
    let options = Options::checked(arguments)?;
    let finished = options.finished(begun, inputs, messages, || Ok(()))?;
    let rows = finished.report().table();
    let outcome =
        finished.with_contents(|contents| contents.kept(rows, inputs, finished.provenance.clone()))?;
    Ok(Outcome { exit_code: finished.exit_code(messages), ..outcome })
}

fn judged(
    placement: &Placement,
    runs: &ClosedLoopSettings,
    control: &SearchControl,
) -> anyhow::Result<(Study, Option<ClosedLoop>)> {
    let study = placement.run(control)?;
    let closed_loop = confirm_study(placement, &study, runs, control)?;
    Ok((study, closed_loop))
}

impl Options {
    /// The candidates of the file, or every place, with no more sensors wanted than may be taken.
    fn candidates(&self, inputs: &Inputs, vessel: &Vessel) -> anyhow::Result<Candidates> {
        let candidates = match &self.candidates {
            Some(file) => read_candidates(&inputs.read(file)?, &super::input::shown(file), vessel)?,
            None => Candidates::of_vessel(vessel)?,
        };
        let open = candidates.list.iter().filter(|candidate| candidate.status != Status::Forbidden).count();
        if self.settings.sensors > open {
            bail!("--sensors {}: only {open} candidates may be taken", self.settings.sensors);
        }
        Ok(candidates)
    }

    /// Reads, searches and judges; `listen` is called when all has been read.
    fn finished(
        &self,
        begun: Instant,
        inputs: &Inputs,
        messages: &Messages,
        listen: impl FnOnce() -> anyhow::Result<()>,
    ) -> anyhow::Result<Finished> {
        let vessel = inputs.vessel(&self.vessel, messages)?;
        let candidates = self.candidates(inputs, &vessel)?;
        let scenarios = self.scenarios.iter().map(|name| inputs.scenario(name));
        let scenarios: Vec<Scenario> = scenarios.collect::<anyhow::Result<_>>()?;
        listen()?;
        let deadline = self.time_limit.and_then(|limit| begun.checked_add(limit));
        let progress = Progress::open_ended(messages, "running the scenarios");
        let abandoned = Arc::new(AtomicBool::new(false));
        let placement = Placement::new(&vessel, &candidates, &scenarios, &self.settings)?;
        let placement = placement.abandoned_by(&abandoned);
        drop(progress);
        let (study, closed_loop) = self.study(&placement, deadline, &abandoned, (inputs, messages))?;
        let seed = Some(self.settings.published.first_seed);
        let provenance = Provenance { seed, ..inputs.provenance() };
        Ok(Finished { vessel, candidates, placement, study, closed_loop, runs: self.runs, provenance })
    }

    /// Runs the study, then its best layouts in closed loop, beside who may end it.
    fn study(
        &self,
        placement: &Placement,
        deadline: Option<Instant>,
        abandoned: &AtomicBool,
        (inputs, messages): (&Inputs, &Messages),
    ) -> anyhow::Result<(Study, Option<ClosedLoop>)> {
        let control = SearchControl::default();
        let expected = placement.evaluations();
        let progress = match expected {
            Some(_) => Progress::new(messages),
            None => Progress::open_ended(messages, "placing sensors"),
        };
        let is_due = || {
            // What a caller ends is dropped; what the time ends is kept.
            abandoned.fetch_or(inputs.is_stopped(), Ordering::Relaxed);
            abandoned.load(Ordering::Relaxed) || stop::is_due(deadline)
        };
        control.stop.store(is_due(), Ordering::Relaxed);
        let attend = || stop::attend(&control, is_due(), (&progress, expected));
        let found = beside(|| judged(placement, &self.runs, &control), attend);
        if abandoned.load(Ordering::Relaxed) { Err(Stopped.into()) } else { found }
    }

    fn write(
        &self,
        contents: Contents<'_>,
        finished: &Finished,
        inputs: &Inputs,
        messages: &Messages,
    ) -> anyhow::Result<()> {
        let provenance = &finished.provenance;
        let matrices = self.matrices.as_ref().map(|target| {
            let matrices = matrices(&finished.placement, provenance);
            anyhow::Ok((target, serde_json::to_string(&matrices)? + "\n"))
        });
        let matrices = matrices.transpose()?;
        let destination = Destination { data: &self.data, format: self.format, views: &self.views };
        destination.write(contents, inputs, provenance, messages)?;
        matrices.map_or(Ok(()), |(target, text)| target.write(text.as_bytes()))
    }
}

impl Finished {
    fn report(&self) -> PlacementReport<'_> {
        PlacementReport {
            study: &self.study,
            candidates: &self.candidates,
            vessel: &self.vessel,
            runs: self.runs,
            closed_loop: self.closed_loop.as_ref(),
        }
    }

    /// What the study consists of, for whoever takes it.
    fn with_contents<T>(&self, take: impl FnOnce(Contents<'_>) -> T) -> T {
        let placed = self.report();
        take(Contents {
            summary: placed.summary(),
            csv: &|provenance| placed.csv(provenance),
            json: &|provenance| placed.document(provenance),
            picture: &|| placed.figure(),
            report: &|picture, _| placed.answer().picture(picture, CAPTION).then(placed.tables()),
        })
    }

    /// The exit code; a caution where it was ended early.
    fn exit_code(&self, messages: &Messages) -> u8 {
        if self.report().is_partial() {
            messages.caution("the search was ended early: the results are partial");
            return PARTIAL;
        }
        0
    }
}

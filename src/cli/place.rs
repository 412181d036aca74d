//! `cylwatch place`: where sensors should sit.
mod arguments;
mod options;
mod quantities;
mod stop;

pub(super) use arguments::PlaceArguments;

use super::format::Format;
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
use std::sync::atomic::Ordering;
use std::sync::mpsc::channel;
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

/// Searches, judges, writes; exit code 3 if it was ended early.
pub(super) fn run(arguments: PlaceArguments, messages: &Messages) -> anyhow::Result<ExitCode> {
    let begun = Instant::now();
    let options = Options::checked(arguments)?;
    let inputs = Inputs::default();
    let vessel = inputs.vessel(&options.vessel, messages)?;
    let candidates = options.candidates(&inputs, &vessel)?;
    let scenarios: Vec<Scenario> =
        options.scenarios.iter().map(|name| inputs.scenario(name)).collect::<anyhow::Result<_>>()?;
    interrupt::listen(|| {})?;
    let deadline = options.time_limit.and_then(|limit| begun.checked_add(limit));
    let progress = Progress::open_ended(messages, "running the scenarios");
    let placement = Placement::new(&vessel, &candidates, &scenarios, &options.settings)?;
    drop(progress);
    let expected = placement.evaluations();
    let progress = match expected {
        Some(_) => Progress::new(messages),
        None => Progress::open_ended(messages, "placing sensors"),
    };
    let (study, closed_loop) = study(&placement, &options.runs, deadline, (&progress, expected))?;
    drop(progress);
    let placed = PlacementReport {
        study: &study,
        candidates: &candidates,
        vessel: &vessel,
        runs: options.runs,
        closed_loop: closed_loop.as_ref(),
    };
    let seed = Some(options.settings.published.first_seed);
    let provenance = Provenance { seed, ..inputs.provenance() };
    options.write(&placed, &placement, (&inputs, &provenance), messages)?;
    if placed.is_partial() {
        messages.caution("the search was ended early: the results are partial");
        return Ok(ExitCode::from(PARTIAL));
    }
    Ok(ExitCode::SUCCESS)
}

/// Runs the study, then its best layouts in closed loop, beside a thread that ends it when it is due.
fn study(
    placement: &Placement,
    runs: &ClosedLoopSettings,
    deadline: Option<Instant>,
    progress: (&Progress, Option<f64>),
) -> anyhow::Result<(Study, Option<ClosedLoop>)> {
    let control = SearchControl::default();
    control.stop.store(stop::is_due(deadline), Ordering::Relaxed);
    std::thread::scope(|scope| {
        let (done, ended) = channel();
        let control = &control;
        scope.spawn(move || stop::attend(control, deadline, progress, &ended));
        let found = judged(placement, runs, control);
        drop(done);
        found
    })
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

    fn write(
        &self,
        placed: &PlacementReport,
        placement: &Placement,
        (inputs, provenance): (&Inputs, &Provenance),
        messages: &Messages,
    ) -> anyhow::Result<()> {
        let contents = Contents {
            summary: placed.summary(),
            csv: &|provenance| placed.csv(provenance),
            json: &|provenance| placed.document(provenance),
            picture: &|| placed.figure(),
            report: &|picture, _| placed.answer().picture(picture, CAPTION).then(placed.tables()),
        };
        let matrices = self.matrices.as_ref().map(|target| {
            anyhow::Ok((target, serde_json::to_string(&matrices(placement, provenance))? + "\n"))
        });
        let matrices = matrices.transpose()?;
        let destination = Destination { data: &self.data, format: self.format, views: &self.views };
        destination.write(contents, inputs, provenance, messages)?;
        matrices.map_or(Ok(()), |(target, text)| target.write(text.as_bytes()))
    }
}

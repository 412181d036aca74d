//! Options that fit each other.
use super::*;
use crate::cli::output::check_distinct;
use crate::estimator::placement::search::Method;
use crate::estimator::placement::{
    Criterion, DetectionSettings, PublishedSettings, SteadySettings, signature_threshold_sd,
};
use crate::report::number;
use std::path::Path;

/// Scenario where none is named: a train in a tunnel in winter, for which the paper places its sensors.
const USUAL_SCENARIO: &str = "tunnel-winter";
/// What stands for no scenario.
const NO_SCENARIO: &str = "none";

impl Options {
    /// Checks everything that can be checked before a file is read.
    pub(super) fn checked(arguments: PlaceArguments) -> anyhow::Result<Self> {
        let scenarios = scenarios(&arguments.scenarios)?;
        let settings = settings(&arguments, scenarios.is_empty())?;
        let runs = runs(&arguments);
        let candidates = arguments.candidates.as_ref().map(|path| path.to_string_lossy().into_owned());
        let mut inputs: Vec<&Path> = vec![Path::new(&arguments.vessel)];
        inputs.extend(scenarios.iter().map(Path::new));
        inputs.extend(arguments.candidates.as_deref());
        if inputs.iter().filter(|input| **input == Path::new("-")).count() > 1 {
            bail!("stdin can be read once: give all but one of vessel, scenarios and candidates as files");
        }
        let data = Target::checked(arguments.data.output.as_deref(), &inputs)?;
        let matrices = arguments.matrices.as_deref();
        let matrices = matrices.map(|path| Target::checked(Some(path), &inputs)).transpose()?;
        check_distinct(&[("--output", Some(&data)), ("--matrices", matrices.as_ref())])?;
        let mut others = vec![&data];
        others.extend(&matrices);
        let views = Views::checked(&arguments.views, &inputs, &others)?;
        let format = arguments.data.format_or_tables(arguments.json);
        let time_limit = arguments.quantities.time_limit()?;
        Ok(Self {
            vessel: arguments.vessel,
            scenarios,
            candidates,
            settings,
            runs,
            time_limit,
            data,
            format,
            views,
            matrices,
        })
    }
}

/// The usual one where none is named, each once.
fn scenarios(named: &[String]) -> anyhow::Result<Vec<String>> {
    if named.is_empty() {
        return Ok(vec![USUAL_SCENARIO.to_owned()]);
    }
    if named == [NO_SCENARIO] {
        return Ok(Vec::new());
    }
    for (k, name) in named.iter().enumerate() {
        if name == NO_SCENARIO {
            bail!("--scenario {NO_SCENARIO} stands alone: leave out the others");
        }
        if named[..k].contains(name) {
            bail!("--scenario {name} is given twice: give it once");
        }
    }
    Ok(named.to_vec())
}

/// What is asked of the study, each option named if it is out of its bounds.
fn settings(arguments: &PlaceArguments, at_rest_only: bool) -> anyhow::Result<StudySettings> {
    let usual = StudySettings::default();
    let criterion = arguments.criterion;
    let word = criterion.as_str();
    if arguments.confirm == 1 {
        bail!("--confirm 1: at least 2 runs have a spread");
    }
    if at_rest_only && matches!(criterion, Criterion::Scenario(_)) {
        bail!("--criterion {word} is a number along a scenario: name one with --scenario");
    }
    let method = arguments.method.map(Method::from);
    if method == Some(Method::BranchAndBound) && !criterion.is_convex() {
        bail!(
            "--method branch-and-bound: {word} is not convex, so nothing bounds it; take exhaustive or greedy, or the \
             criterion gas-temperature, mass or leak-rate"
        );
    }
    Ok(StudySettings {
        steady: steady(arguments)?,
        sensors: arguments.sensors,
        budget: arguments.budget.unwrap_or(f64::INFINITY),
        criterion,
        method,
        within: arguments.within_percent / 100.0,
        leak_kg_s: arguments.quantities.leak_kg_s()?.unwrap_or(usual.leak_kg_s),
        published: PublishedSettings { first_seed: arguments.seed, ..usual.published },
    })
}

/// Runs in the observer's own world, and a fifth as many in drawn cylinders.
fn runs(arguments: &PlaceArguments) -> ClosedLoopSettings {
    ClosedLoopSettings {
        matched: arguments.confirm,
        mismatched: if arguments.confirm > 0 { arguments.confirm.div_ceil(5).max(2) } else { 0 },
        first_seed: arguments.seed,
    }
}

/// Where the cylinder rests, and when a leak counts as found.
fn steady(arguments: &PlaceArguments) -> anyhow::Result<SteadySettings> {
    let usual = SteadySettings::default();
    let conditions = arguments.quantities.conditions()?;
    let within_s = arguments.quantities.within_s()?.unwrap_or(usual.detection.within_s);
    if within_s < conditions.interval_s {
        let [within, interval] = [within_s, conditions.interval_s].map(|time_s| number(time_s / 60.0, 3));
        bail!("--within is {within} min, but readings come every {interval} min: allow at least as long");
    }
    let between_false_alarms_s = arguments.false_alarms.mean_time_s();
    let mut observer = usual.observer;
    observer.wall_nodes = arguments.wall_nodes.unwrap_or(observer.wall_nodes);
    let threshold_sd = signature_threshold_sd(within_s, conditions.interval_s, between_false_alarms_s)?;
    let detection = DetectionSettings { within_s, threshold_sd, ..usual.detection };
    Ok(SteadySettings { observer, conditions, detection })
}

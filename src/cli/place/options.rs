//! Options that fit each other.
use super::*;
use crate::cli::unit_options::between_false_alarms_s;
use cylwatch::estimator::placement::search::Method;
use cylwatch::estimator::placement::{
    Criterion, DetectionSettings, PublishedSettings, SiteSettings, signature_threshold_sd,
};
use cylwatch::report::number;
use std::path::Path;

/// Scenario where none is named: a train in a tunnel in winter, for which the paper places its sensors.
const USUAL_SCENARIO: &str = "tunnel-winter";
/// What stands for no scenario.
const NO_SCENARIO: &str = "none";

impl Options {
    /// Checks everything that can be checked before a file is read.
    pub fn checked(arguments: PlaceArguments) -> anyhow::Result<Self> {
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
        let data = Target::checked(arguments.output.as_deref(), &inputs)?;
        let matrices = arguments.matrices.as_deref().map(|path| matrices_file(path, &inputs, &data));
        let matrices = matrices.transpose()?;
        let mut others = vec![&data];
        others.extend(&matrices);
        let wanted = Wanted { plot: arguments.plot.as_deref(), report: arguments.report.as_deref() };
        let views = Views::checked(wanted, &inputs, &others)?;
        let format = Format::asked(arguments.format, arguments.json, arguments.output.as_deref());
        let time_limit = arguments.amounts.time_limit()?;
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

/// Place of the matrices, which is not that of the data.
fn matrices_file(path: &Path, inputs: &[&Path], data: &Target) -> anyhow::Result<Target> {
    let target = Target::checked(Some(path), inputs)?;
    let both_stdout = matches!((&target, data), (Target::Stdout, Target::Stdout));
    if both_stdout || target.is_same_file(data) {
        bail!("--matrices {} is where the data goes: choose another file", path.display());
    }
    Ok(target)
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
            bail!("--scenario {name} is there twice: name it once");
        }
    }
    Ok(named.to_vec())
}

/// What is asked of the study, each option named if it is out of its bounds.
fn settings(arguments: &PlaceArguments, at_rest_only: bool) -> anyhow::Result<StudySettings> {
    let usual = StudySettings::default();
    let criterion = arguments.criterion;
    let word = criterion.as_str();
    if arguments.sensors == 0 {
        bail!("--sensors 0: a layout has at least 1 sensor");
    }
    if arguments.confirm == 1 {
        bail!("--confirm 1: at least 2 runs have a spread");
    }
    if at_rest_only && matches!(criterion, Criterion::Course(_)) {
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
        site: site(arguments)?,
        sensors: arguments.sensors,
        budget: not_negative("budget", arguments.budget.unwrap_or(f64::INFINITY))?,
        criterion,
        method,
        within: not_negative("within-percent", arguments.within_percent)? / 100.0,
        leak_kg_s: arguments.amounts.leak_kg_s()?.unwrap_or(usual.leak_kg_s),
        published: PublishedSettings { first_seed: arguments.seed, ..usual.published },
    })
}

/// Runs in the observer's own world as asked for, and a fifth as many in drawn cylinders.
fn runs(arguments: &PlaceArguments) -> ClosedLoopSettings {
    ClosedLoopSettings {
        matched: arguments.confirm,
        mismatched: if arguments.confirm > 0 { arguments.confirm.div_ceil(5).max(2) } else { 0 },
        first_seed: arguments.seed,
    }
}

/// Where the cylinder rests, and when a leak counts as found.
fn site(arguments: &PlaceArguments) -> anyhow::Result<SiteSettings> {
    let usual = SiteSettings::default();
    let conditions = arguments.amounts.conditions()?;
    let within_s = arguments.amounts.within_s()?.unwrap_or(usual.detection.within_s);
    if within_s < conditions.interval_s {
        let [within, interval] = [within_s, conditions.interval_s].map(|time_s| number(time_s / 60.0, 3));
        bail!("--within is {within} min, but readings come every {interval} min: allow at least as long");
    }
    let between_false_alarms_s = between_false_alarms_s(arguments.false_alarm_years)?;
    if arguments.wall_nodes == Some(0) {
        bail!("--wall-nodes 0: the wall has at least 1");
    }
    let mut observer = usual.observer;
    observer.wall_nodes = arguments.wall_nodes.unwrap_or(observer.wall_nodes);
    let threshold_sd = signature_threshold_sd(within_s, conditions.interval_s, between_false_alarms_s)?;
    let detection = DetectionSettings { within_s, threshold_sd, ..usual.detection };
    Ok(SiteSettings { observer, conditions, detection })
}

fn not_negative(option: &str, value: f64) -> anyhow::Result<f64> {
    if value.is_nan() || value < 0.0 {
        bail!("--{option} {value}: it must be at least 0");
    }
    Ok(value)
}

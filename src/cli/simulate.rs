//! `cylwatch simulate`: a vessel in a scenario.
use super::arguments::{Format, SimulateArguments};
use super::input::Inputs;
use super::message::Messages;
use super::output::Target;
use super::progress::Progress;
use super::views::{Made, Views, Wanted};
use anyhow::bail;
use cylwatch::report::figure::Picture;
use cylwatch::report::{Provenance, Readings, aligned, simulation};
use cylwatch::thermal::simulate::{SimulationSettings, simulate};
use cylwatch::thermal::trajectory::Trajectory;
use cylwatch::thermal::{scenario, vessel};
use std::path::Path;

/// Validated options.
struct Options {
    vessel: String,
    scenario: String,
    data: Target,
    format: Format,
    views: Views,
    settings: SimulationSettings,
    seed: u64,
}

/// Simulates and writes, or lists the built-in vessels and scenarios.
pub fn run(arguments: SimulateArguments, messages: &Messages) -> anyhow::Result<()> {
    if arguments.list {
        return Target::Stdout.write(list()?.as_bytes());
    }
    let options = Options::checked(arguments)?;
    let inputs = Inputs::default();
    let vessel = inputs.vessel(&options.vessel)?;
    let scenario = inputs.scenario(&options.scenario)?;
    let progress = Progress::new(messages);
    let run =
        simulate(&vessel, &scenario, &options.settings, &mut |done| progress.show(&scenario.name, done))?;
    drop(progress);
    let readings = Readings::sampled(&run, options.seed)?;
    for sensor in &readings.left_out {
        let needs = sensor.misfit(&vessel).unwrap_or_default();
        messages
            .caution(&format!("sensor {} is left out: {} does not have {needs}", sensor.name, vessel.name));
    }
    let provenance = Provenance { seed: Some(options.seed), ..inputs.provenance() };
    // Everything is made before anything is written.
    let data = data(&run, &readings, options.format, &provenance)?;
    let story = simulation::story(&run);
    let views = if options.views.is_wanted() {
        let picture = Picture::Figure(simulation::figure(&run, &readings));
        let with = |picture| story.clone().picture(picture, simulation::CAPTION);
        options.views.make(&picture, with, inputs.sources(), &provenance)?
    } else {
        Made::default()
    };
    views.write()?;
    options.data.write(data.as_bytes())?;
    messages.say(&story.to_text());
    Ok(())
}

impl Options {
    fn checked(arguments: SimulateArguments) -> anyhow::Result<Self> {
        let (Some(vessel), Some(scenario)) = (arguments.vessel, arguments.scenario) else {
            bail!("a simulation takes a vessel and a scenario");
        };
        if vessel == "-" && scenario == "-" {
            bail!("stdin can be the vessel or the scenario, not both: give the other one as a file");
        }
        let inputs = [Path::new(&vessel), Path::new(&scenario)];
        let data = Target::checked(arguments.output.as_deref(), &inputs)?;
        let wanted = Wanted { plot: arguments.plot.as_deref(), report: arguments.report.as_deref() };
        let views = Views::checked(wanted, &inputs, &[&data])?;
        let mut settings = SimulationSettings::default();
        if let Some(tolerance) = arguments.relative_tolerance {
            settings.relative_tolerance = tolerance;
        }
        settings.validate()?;
        let format = arguments.format.unwrap_or_else(|| Format::of(arguments.output.as_deref()));
        Ok(Self { vessel, scenario, data, format, views, settings, seed: arguments.seed })
    }
}

fn data(
    run: &Trajectory,
    readings: &Readings,
    format: Format,
    provenance: &Provenance,
) -> anyhow::Result<String> {
    Ok(match format {
        Format::Csv => simulation::table(run, readings).to_csv(provenance, &simulation::remarks(run)),
        Format::Json => serde_json::to_string(&simulation::document(run, readings, provenance))? + "\n",
    })
}

/// The built-in vessels and scenarios with the names that their files give them.
fn list() -> anyhow::Result<String> {
    let mut rows = Vec::new();
    for name in vessel::presets::names() {
        rows.push(vec!["vessel".to_owned(), name.to_owned(), vessel::presets::load(name)?.name]);
    }
    for name in scenario::presets::names() {
        rows.push(vec!["scenario".to_owned(), name.to_owned(), scenario::presets::load(name)?.name]);
    }
    Ok(aligned(&["kind", "name", "what"], &rows))
}

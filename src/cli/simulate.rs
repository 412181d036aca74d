//! `cylwatch simulate`: a vessel in a scenario.
use super::beside::TICK;
use super::format::Format;
use super::host::Outcome;
use super::input::Inputs;
use super::message::Messages;
use super::number::at_least;
use super::options::{OUTPUT, SolverArguments, ViewArguments};
use super::output::Target;
use super::progress::Progress;
use super::views::Views;
use crate::log::is_parquet;
use crate::report::{Provenance, Readings, aligned, simulation};
use crate::thermal::model::with_real_gas_coefficients;
use crate::thermal::simulate::{SimulationSettings, simulate_while};
use crate::thermal::trajectory::Trajectory;
use crate::thermal::{scenario, vessel};
use anyhow::bail;
use clap::{Args, ValueEnum};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Arguments of `simulate`.
#[derive(Debug, Args)]
#[command(after_help = SIMULATE_EXAMPLES)]
pub(super) struct SimulateArguments {
    /// Vessel: a TOML file, the name of a built-in one, or - for stdin.
    #[arg(required_unless_present = "list")]
    pub vessel: Option<String>,
    /// Scenario: a TOML file, the name of a built-in one, or - for stdin.
    #[arg(required_unless_present = "list")]
    pub scenario: Option<String>,
    /// Write the data to FILE; - is stdout.
    #[arg(long, short, value_name = "FILE", help_heading = OUTPUT)]
    pub output: Option<PathBuf>,
    /// Format of the data [default: by the ending .json or .parquet of the file, else csv].
    #[arg(long, value_enum, help_heading = OUTPUT)]
    pub format: Option<SimulationFormat>,
    #[command(flatten)]
    pub views: ViewArguments,
    #[command(flatten)]
    pub solver: SolverArguments,
    /// Seed of the sensors' specimens and noise, a whole number of at least 0.
    #[arg(long, value_name = "NUMBER", default_value_t = 0, value_parser = at_least(0_u64))]
    pub seed: u64,
    /// List the built-in vessels and scenarios and stop.
    #[arg(long)]
    pub list: bool,
}

const SIMULATE_EXAMPLES: &str = "\
Columns: time_s, ambient_degc, gas_mean_degc, gas_<k>_degc (k = 1 at the bottom),
wall_<name>_degc, shoulder_degc, valve_degc, wall_inner_mean_degc, wall_inner_<name>_degc,
liner_mean_degc, pressure_bar (absolute), mass_kg, outflow_g_h, heat_to_gas_w,
<refill>_source_degc and _bar of a source vessel, and what the scenario's sensors read: measured_<sensor>_degc, _bar or _barg; an
empty cell is a lost reading.

Examples:
  cylwatch simulate --list
  cylwatch simulate nitrogen-20l shock-cold --plot shock.svg -o shock.csv
  cylwatch simulate vessel.toml scenario.toml --format json | jq .events";

/// Format of a simulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum SimulationFormat {
    /// Comma-separated columns; lines that begin with # say where they come from.
    Csv,
    /// A column of doubles each, with the provenance as metadata; in a program that was built with the feature parquet.
    Parquet,
    /// One JSON document with a provenance object.
    Json,
}

impl SimulationFormat {
    /// The format that an output's name asks for.
    fn of(output: Option<&Path>) -> Self {
        match Format::of(output) {
            Format::Json => Self::Json,
            Format::Csv if output.is_some_and(is_parquet) => Self::Parquet,
            Format::Csv => Self::Csv,
        }
    }
}

/// Validated options.
struct Options {
    vessel: String,
    scenario: String,
    data: Target,
    format: SimulationFormat,
    views: Views,
    settings: SimulationSettings,
    seed: u64,
}

/// Simulates and writes, or lists the built-in vessels and scenarios.
pub(super) fn run(arguments: SimulateArguments, messages: &Messages) -> anyhow::Result<()> {
    if arguments.list {
        return Target::Stdout.write(list()?.as_bytes());
    }
    let options = Options::checked(arguments)?;
    let inputs = Inputs::default();
    let (run, readings) = simulated(&options, &inputs, messages)?;
    let provenance = Provenance { seed: Some(options.seed), ..inputs.provenance() };
    // Everything is made before anything is written.
    let data = data(&run, &readings, options.format, &provenance)?;
    let summary = simulation::summary(&run);
    let picture = || simulation::figure(&run, &readings);
    let with = |picture| summary.clone().picture(picture, simulation::CAPTION);
    let views = options.views.make(picture, with, inputs.sources(), &provenance)?;
    views.write()?;
    options.data.write(&data)?;
    messages.say(&summary.to_text());
    Ok(())
}

/// The same for a caller: nothing is written.
pub(super) fn kept(
    arguments: SimulateArguments,
    inputs: &Inputs,
    messages: &Messages,
) -> anyhow::Result<Outcome> {
    let options = Options::checked(arguments)?;
    let (run, readings) = simulated(&options, inputs, messages)?;
    let provenance = Provenance { seed: Some(options.seed), ..inputs.provenance() };
    let mut summary = simulation::document(&run, &readings, &provenance);
    if let Some(members) = summary.as_object_mut() {
        members.shift_remove("columns");
    }
    let report = simulation::summary(&run).picture(simulation::figure(&run, &readings), simulation::CAPTION);
    Ok(Outcome::of(simulation::table(&run, &readings), summary, report, provenance))
}

/// Simulates, and reads the sensors.
fn simulated(
    options: &Options,
    inputs: &Inputs,
    messages: &Messages,
) -> anyhow::Result<(Trajectory, Readings)> {
    let vessel = inputs.vessel(&options.vessel, messages)?;
    let (scenario, converted) = with_real_gas_coefficients(&vessel, &inputs.scenario(&options.scenario)?)?;
    converted.iter().for_each(|one| messages.say(&simulation::conversion(one)));
    if let Some(words) = simulation::lying_layers(&vessel) {
        messages.caution(words);
    }
    let progress = Progress::new(messages);
    let mut asked = Instant::now();
    let run = simulate_while(&vessel, &scenario, &options.settings, &mut |done| {
        if asked.elapsed() < TICK {
            return true;
        }
        asked = Instant::now();
        progress.show(&scenario.name, done);
        !inputs.is_stopped()
    })?;
    drop(progress);
    let readings = Readings::sampled(&run, options.seed)?;
    for sensor in &readings.left_out {
        let needs = sensor.misfit(&vessel).unwrap_or_default();
        messages
            .caution(&format!("sensor {} is left out: {} does not have {needs}", sensor.name, vessel.name));
    }
    Ok((run, readings))
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
        let views = Views::checked(&arguments.views, &inputs, &[&data])?;
        let mut settings = SimulationSettings::default();
        if let Some(tolerance) = arguments.solver.relative_tolerance {
            settings.relative_tolerance = tolerance;
        }
        settings.validate()?;
        let format = arguments.format.unwrap_or_else(|| SimulationFormat::of(arguments.output.as_deref()));
        if format == SimulationFormat::Parquet && !cfg!(feature = "parquet") {
            bail!(
                "this program was built without Parquet: build it with `cargo build --release --features parquet`, or \
                 choose --format csv or json"
            );
        }
        Ok(Self { vessel, scenario, data, format, views, settings, seed: arguments.seed })
    }
}

fn data(
    run: &Trajectory,
    readings: &Readings,
    format: SimulationFormat,
    provenance: &Provenance,
) -> anyhow::Result<Vec<u8>> {
    let table = || simulation::table(run, readings);
    Ok(match format {
        SimulationFormat::Csv => table().to_csv(provenance, &simulation::remarks(run)).into_bytes(),
        SimulationFormat::Json => {
            (serde_json::to_string(&simulation::document(run, readings, provenance))? + "\n").into_bytes()
        }
        #[cfg(feature = "parquet")]
        SimulationFormat::Parquet => table().to_parquet(provenance, &simulation::remarks(run))?,
        #[cfg(not(feature = "parquet"))]
        SimulationFormat::Parquet => bail!("this program was built without Parquet"),
    })
}

/// The built-in vessels and scenarios with the names that their files give them.
fn list() -> anyhow::Result<String> {
    let mut rows = Vec::new();
    for name in vessel::presets::FILES.names() {
        rows.push(vec!["vessel".to_owned(), name.to_owned(), vessel::presets::load(name)?.name]);
    }
    for name in scenario::presets::FILES.names() {
        rows.push(vec!["scenario".to_owned(), name.to_owned(), scenario::presets::load(name)?.name]);
    }
    Ok(aligned(&["kind", "name", "what"], &rows))
}

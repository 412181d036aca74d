//! The raw arguments: they mirror the command line and decide nothing.
use super::bench_detector::BenchDetectorArguments;
use super::calibrate::CalibrateArguments;
use super::commission::CommissionArguments;
use super::estimate::EstimateArguments;
use super::identify::IdentifyArguments;
use super::inspect::InspectArguments;
use super::man::ManArguments;
use super::monitor::MonitorArguments;
use super::number::{at_least, with_negative_numbers, within};
use super::options::{
    DataArguments, OUTPUT, ReportArguments, SolverArguments, ViewArguments, without_experts,
};
use super::place::PlaceArguments;
use super::simulate::SimulationFormat;
use super::states::GivenQuantities;
use clap::{Args, CommandFactory, Parser, Subcommand, ValueEnum};
use std::path::{Path, PathBuf};

/// Tells a leaking gas cylinder from a cold one: thermal model of a pressure cylinder.
#[derive(Debug, Parser)]
#[command(name = "cylwatch", version, max_term_width = 110, after_help = EXAMPLES)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
    /// Print errors only.
    #[arg(long, short, global = true, display_order = 900)]
    pub quiet: bool,
}

impl Arguments {
    /// The command line with what concerns all options.
    pub fn prepared() -> clap::Command {
        without_experts(with_negative_numbers(Self::command()))
    }
}

const EXAMPLES: &str = "\
Examples:
  cylwatch simulate nitrogen-20l shock-cold -o run.csv --plot run.svg
  cylwatch inspect logger.csv
  cylwatch estimate nitrogen-20l run.csv -o est.csv --plot est.svg
  cylwatch monitor nitrogen-20l run.csv -o rows.csv --plot monitor.svg
  cylwatch commission nitrogen-20l -o thresholds.json
  cylwatch identify run.csv --input shoulder --output gas_mean --plot model.svg
  cylwatch calibrate my-cylinder.toml log.csv -o calibrated.toml --plot fit.svg
  cylwatch place nitrogen-20l --sensors 3 --plot places.svg
  cylwatch properties nitrogen --temperature-degc 15 --pressure-bar 200
  cylwatch init my-cylinder
  cylwatch reproduce --out out/reproduce

Exit codes: 0 done and no leak, 1 leak found (monitor), 2 error, 3 inconclusive (monitor) or ended early (place). Data goes to stdout, words to stderr; NO_COLOR is respected.";

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Rebuild every figure and table of the paper beside its own numbers, in one report; under a minute.
    Reproduce(ReproduceArguments),
    /// Simulate a vessel in a scenario: temperatures, pressure, mass and sensor readings against time.
    Simulate(SimulateArguments),
    /// Say what an unknown log holds, what is odd about it, and which command can use it.
    Inspect(InspectArguments),
    /// Estimate gas temperature, mass and leak rate from a log of sensors outside.
    Estimate(Box<EstimateArguments>),
    /// Decide whether gas is being lost: verdict, leak rate, onset, time left, events and alarms from a log.
    Monitor(Box<MonitorArguments>),
    /// Find the leak thresholds of a vessel by simulation, with the rate of false alarms that they have; twenty minutes.
    Commission(Box<CommissionArguments>),
    /// Identify a transfer function from one column of a log to another, with intervals, beside the paper's.
    Identify(Box<IdentifyArguments>),
    /// Fit physical parameters of a vessel to logs and write a calibrated vessel file, with intervals.
    Calibrate(Box<CalibrateArguments>),
    /// Compare leak detectors on simulated cylinders: false alarms, smallest leaks found, delays; ten minutes and more.
    BenchDetector(BenchDetectorArguments),
    /// Find where sensors should sit, with a proof that no better layout was missed; takes seconds to minutes.
    Place(Box<PlaceArguments>),
    /// Print the properties of a gas, at one state or for every row of a file.
    Properties(PropertiesArguments),
    /// Write start files vessel.toml and scenario.toml, with comments, to edit.
    Init(InitArguments),
    /// Print the JSON schema of vessel, scenario and candidates files, for editors.
    Schema(SchemaArguments),
    /// Write manual pages, as for `man`.
    Man(ManArguments),
    /// Print a completion script for a shell.
    Completions(CompletionsArguments),
}

/// Format of data.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Comma-separated columns; lines that begin with # say where they come from.
    Csv,
    /// One JSON document with a provenance object.
    Json,
}

impl Format {
    /// The format that an output's name asks for: JSON for `.json`, CSV for all others and for stdout.
    pub fn of(output: Option<&Path>) -> Self {
        let ending = output.and_then(Path::extension);
        if ending.is_some_and(|ending| ending.eq_ignore_ascii_case("json")) { Self::Json } else { Self::Csv }
    }
}

/// Arguments of `reproduce`.
#[derive(Debug, Args)]
pub struct ReproduceArguments {
    /// Folder for report.html, figures (SVG and PNG), CSV files and results.json; it is made if it is not there.
    #[arg(long, value_name = "DIR", default_value = "out/reproduce")]
    pub out: PathBuf,
    /// Seed of noise and drawn cylinders, a whole number of at least 0.
    #[arg(long, value_name = "NUMBER", default_value_t = 1, value_parser = at_least(0_u64))]
    pub seed: u64,
    /// Drawn cylinders of each case, 1 to 1000; the time goes with it.
    #[arg(long, value_name = "NUMBER", default_value_t = 8, value_parser = within(1_u64, 1000))]
    pub cylinders: u64,
    #[command(flatten)]
    pub report: ReportArguments,
    #[command(flatten)]
    pub solver: SolverArguments,
}

/// Arguments of `simulate`.
#[derive(Debug, Args)]
#[command(after_help = SIMULATE_EXAMPLES)]
pub struct SimulateArguments {
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
wall_<name>_degc, shoulder_degc, valve_degc, pressure_bar (absolute), mass_kg, outflow_g_h,
heat_to_gas_w, and what the scenario's sensors read: measured_<sensor>_degc, _bar or _barg; an
empty cell is a lost reading.

Examples:
  cylwatch simulate --list
  cylwatch simulate nitrogen-20l shock-cold --plot shock.svg -o shock.csv
  cylwatch simulate vessel.toml scenario.toml --format json | jq .events";

/// Equation of state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum EquationName {
    /// Reference equation of the gas (nitrogen: Span et al. 2000).
    Reference,
    /// Ideal gas with the reference equation's heat capacity.
    IdealGas,
    /// Cubic equation of Peng and Robinson.
    PengRobinson,
}

/// Arguments of `properties`.
#[derive(Debug, Args)]
#[command(after_help = PROPERTIES_EXAMPLES)]
pub struct PropertiesArguments {
    /// Gas, e.g. nitrogen.
    pub fluid: String,
    /// The two quantities that fix the state.
    #[command(flatten)]
    pub given: GivenQuantities,
    /// CSV file with a state a row, or - for stdin: any two of temperature, pressure, density with unit suffixes.
    #[arg(long, value_name = "FILE")]
    pub states: Option<PathBuf>,
    /// Equation of state.
    #[arg(long, value_enum, default_value = "reference")]
    pub equation: EquationName,
    #[command(flatten)]
    pub data: DataArguments,
    #[command(flatten)]
    pub report: ReportArguments,
}

const PROPERTIES_EXAMPLES: &str = "\
Without --output and --format one state is a table for people.

Examples:
  cylwatch properties nitrogen --temperature-degc 15 --pressure-bar 200
  cylwatch properties nitrogen --density-kg-m3 223.2 --temperature-degc -25 --format json
  printf 'temperature_degc,pressure_barg\\n15,199\\n' | cylwatch properties nitrogen --states -";

/// Arguments of `init`.
#[derive(Debug, Args)]
pub struct InitArguments {
    /// Folder for the files; it is made if it is not there. Files that are there are not overwritten.
    #[arg(value_name = "DIR", default_value = ".")]
    pub folder: PathBuf,
    /// Built-in vessel to start from.
    #[arg(long, default_value = "nitrogen-20l")]
    pub vessel: String,
    /// Built-in scenario to start from.
    #[arg(long, default_value = "shock-cold")]
    pub scenario: String,
}

/// A kind of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Document {
    /// Vessel files.
    Vessel,
    /// Scenario files.
    Scenario,
    /// Files of `place --candidates`.
    Candidates,
}

/// Arguments of `schema`.
#[derive(Debug, Args)]
pub struct SchemaArguments {
    /// Which schema [default: all, as one object].
    #[arg(value_enum)]
    pub document: Option<Document>,
}

/// Arguments of `completions`.
#[derive(Debug, Args)]
pub struct CompletionsArguments {
    /// Shell.
    #[arg(value_enum)]
    pub shell: clap_complete::Shell,
}

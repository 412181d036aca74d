//! The command line: its commands, with the arguments that each of them declares.
use super::bench_detector::BenchDetectorArguments;
use super::calibrate::CalibrateArguments;
use super::commission::CommissionArguments;
use super::compile::CompileArguments;
use super::completions::CompletionsArguments;
use super::estimate::EstimateArguments;
use super::fleet::{FleetArguments, without_single_runs};
use super::fmu::FmuArguments;
use super::identify::IdentifyArguments;
use super::init::InitArguments;
use super::inspect::InspectArguments;
use super::inspection::{InspectionArguments, without_fill_of_log};
use super::man::ManArguments;
use super::monitor::MonitorArguments;
use super::number::with_negative_numbers;
use super::options::without_experts;
use super::place::PlaceArguments;
use super::properties::PropertiesArguments;
use super::reproduce::ReproduceArguments;
use super::schema::SchemaArguments;
#[cfg(feature = "serve")]
use super::serve::ServeArguments;
use super::simulate::SimulateArguments;
use clap::{CommandFactory, Parser, Subcommand};

/// Tells a leaking gas cylinder from a cold one: thermal model of a pressure cylinder.
#[derive(Debug, Parser)]
#[command(name = "cylwatch", version, max_term_width = 110, after_help = EXAMPLES)]
pub(super) struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
    /// Print errors only.
    #[arg(long, short, global = true, display_order = 900)]
    pub quiet: bool,
}

impl Arguments {
    /// The command line with what concerns all options.
    pub(super) fn prepared() -> clap::Command {
        let command = Self::command()
            .mut_subcommand("inspection", without_fill_of_log)
            .mut_subcommand("fleet", without_single_runs);
        without_experts(with_negative_numbers(command))
    }
}

const EXAMPLES: &str = "\
Examples:
  cylwatch simulate nitrogen-20l shock-cold -o run.csv --plot run.svg
  cylwatch inspect logger.csv
  cylwatch estimate nitrogen-20l run.csv -o est.csv --plot est.svg
  cylwatch monitor nitrogen-20l run.csv -o rows.csv --plot monitor.svg
  cylwatch fleet logs/ --vessels fleet.csv -o fleet
  cylwatch commission nitrogen-20l -o thresholds.json
  cylwatch compile nitrogen-20l --fill-pressure-bar 200 --fill-temperature-degc 15 -o cylinder.bin
  cylwatch fmu nitrogen-20l --kind plant --fill-pressure-bar 200 --fill-temperature-degc 15 -o plant.fmu
  cylwatch inspection nitrogen-20l week.csv --fill-pressure-bar 200 --fill-temperature-degc 15
  cylwatch identify run.csv --input shoulder --output gas_mean --plot model.svg
  cylwatch calibrate my-cylinder.toml log.csv -o calibrated.toml --plot fit.svg
  cylwatch place nitrogen-20l --sensors 3 --plot places.svg
  cylwatch properties nitrogen --temperature-degc 15 --pressure-bar 200
  cylwatch init my-cylinder
  cylwatch reproduce --out out/reproduce

Exit codes: 0 done and no leak, 1 leak found (monitor, fleet), 2 error, 3 inconclusive (monitor, fleet), ended early (place) or with worlds missing (bench-detector). Data goes to stdout, words to stderr; NO_COLOR is respected.";

/// The commands.
#[derive(Debug, Subcommand)]
pub(super) enum Command {
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
    /// Monitor many cylinders at once, on all cores: tables with the most urgent first, states, and a page.
    Fleet(Box<FleetArguments>),
    /// Monitor cylinders whose readings come through an MQTT broker, for years: verdicts, events and alarms as messages.
    #[cfg(feature = "serve")]
    Serve(ServeArguments),
    /// This program has no gateway.
    #[cfg(not(feature = "serve"))]
    #[command(hide = true)]
    Serve {
        /// Whatever it was given.
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        anything: Vec<String>,
    },
    /// Find the leak thresholds of a vessel by simulation, with the rate of false alarms that they have; twenty minutes.
    Commission(Box<CommissionArguments>),
    /// Compile a cylinder into bytes for a controller, which reads no files.
    Compile(Box<CompileArguments>),
    /// Write a simulated cylinder or its monitor as a Functional Mock-up Unit, for the co-simulation with other programs.
    Fmu(Box<FmuArguments>),
    /// Judge the loss of pressure adjusted for temperature since the fill, as ISO 14520 words it: pass, refill or cannot be told.
    Inspection(Box<InspectionArguments>),
    /// Identify a transfer function from one column of a log to another, with intervals, beside the paper's.
    Identify(Box<IdentifyArguments>),
    /// Fit physical parameters of a vessel to logs and write a calibrated vessel file, with intervals.
    Calibrate(Box<CalibrateArguments>),
    /// Compare leak detectors on simulated cylinders: false alarms, smallest leaks found, delays; minutes to a night.
    BenchDetector(BenchDetectorArguments),
    /// Find where sensors should sit, with a proof that no better layout was missed; takes seconds to minutes.
    Place(Box<PlaceArguments>),
    /// Print the properties of a gas, at one state or for every row of a file.
    Properties(PropertiesArguments),
    /// Write start files vessel.toml and scenario.toml, with comments, to edit.
    Init(InitArguments),
    /// Print the JSON schema of vessel, scenario, candidates and gateway files and of what the gateway publishes.
    Schema(SchemaArguments),
    /// Write manual pages, as for `man`.
    Man(ManArguments),
    /// Print a completion script for a shell.
    Completions(CompletionsArguments),
}

//! `cylwatch properties`: a gas at one state, or at every state of a file.
use super::format::Format;
use super::input::Inputs;
use super::message::Messages;
use super::options::{DataArguments, ReportArguments};
use super::output::Target;
use super::states;
use super::states::Quantities;
use super::views::Views;
use crate::properties::{self, Row};
use crate::report::{Provenance, Report, Table};
use crate::thermal::fluid::{Equation, Fluid};
use anyhow::bail;
use clap::{Args, ValueEnum};
use serde_json::json;
use std::path::PathBuf;

/// Equation of state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum EquationName {
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
pub(super) struct PropertiesArguments {
    /// Gas, e.g. nitrogen.
    pub fluid: String,
    /// The two quantities that fix the state.
    #[command(flatten)]
    pub given: Quantities,
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
Without --output and --format one state is a table for people. A state of --states that the gas does
not have (two-phase, solid, out of range) leaves its cells empty and costs a caution.

Examples:
  cylwatch properties nitrogen --temperature-degc 15 --pressure-bar 200
  cylwatch properties nitrogen --density-kg-m3 223.2 --temperature-degc -25 --format json
  printf 'temperature_degc,pressure_barg\\n15,199\\n' | cylwatch properties nitrogen --states -";

/// Evaluates and writes.
pub(super) fn run(arguments: PropertiesArguments, messages: &Messages) -> anyhow::Result<()> {
    let inputs: Vec<&std::path::Path> = arguments.states.as_deref().into_iter().collect();
    let target = Target::checked(arguments.data.output.as_deref(), &inputs)?;
    let views = Views::checked(&arguments.report.clone().into(), &inputs, &[&target])?;
    let fluid = fluid(&arguments)?;
    let inputs = Inputs::default();
    let many = arguments.states.is_some();
    let states = match &arguments.states {
        Some(path) => of_file(&fluid, &path.to_string_lossy(), &inputs, messages)?,
        None => vec![Row::Known(properties::evaluate(&fluid, arguments.given.state()?)?)],
    };
    let provenance = inputs.provenance();
    let for_people = arguments.data.format.is_none() && !many && matches!(target, Target::Stdout);
    let text = match (arguments.data.format(), &states[..]) {
        (_, [Row::Known(one)]) if for_people => {
            Report { title: String::new(), ..properties::summary(&arguments.fluid, one) }.to_text()
        }
        (Format::Csv, _) => properties::table(&states).to_csv(&provenance, &[]),
        (Format::Json, _) => document(&arguments, &states, &provenance)?,
    };
    let summary = || match &states[..] {
        [Row::Known(one)] => properties::summary(&arguments.fluid, one),
        many => properties::summary_of_many(&arguments.fluid, many),
    };
    views.make_report(summary, Vec::new(), &provenance)?.write()?;
    target.write(text.as_bytes())
}

/// The properties for a caller: a row.
pub(super) fn kept(arguments: &PropertiesArguments) -> anyhow::Result<Table> {
    let state = properties::evaluate(&fluid(arguments)?, arguments.given.state()?)?;
    Ok(properties::table(&[Row::Known(state)]))
}

fn fluid(arguments: &PropertiesArguments) -> anyhow::Result<Fluid> {
    let equation = match arguments.equation {
        EquationName::Reference => Equation::Reference,
        EquationName::IdealGas => Equation::IdealGas,
        EquationName::PengRobinson => Equation::PengRobinson,
    };
    Ok(Fluid::named(&arguments.fluid)?.with_equation(equation))
}

/// The states of a file. One that the gas does not have leaves its cells empty and is told; where it has none of them, the first is the error.
fn of_file(fluid: &Fluid, file: &str, inputs: &Inputs, messages: &Messages) -> anyhow::Result<Vec<Row>> {
    if file.is_empty() {
        bail!("--states has an empty name: write a file name or `-` for stdin");
    }
    let text = inputs.read(file)?;
    let shown = if file == "-" { "stdin" } else { file };
    let mut rows = Vec::new();
    let mut refused = Vec::new();
    for states::Row { line, given } in states::read(&text, shown, messages)? {
        match properties::evaluate(fluid, given) {
            Ok(state) => rows.push(Row::Known(state)),
            Err(error) => {
                rows.push(Row::Refused(given));
                refused.push(anyhow::Error::new(error).context(format!("{shown}:{line}")));
            }
        }
    }
    if refused.len() == rows.len() {
        return Err(refused.swap_remove(0));
    }
    refused.iter().for_each(|error| messages.caution(&format!("{error:#}; its cells stay empty")));
    Ok(rows)
}

fn document(
    arguments: &PropertiesArguments,
    states: &[Row],
    provenance: &Provenance,
) -> anyhow::Result<String> {
    let document = json!({
        "provenance": provenance.to_json(),
        "fluid": arguments.fluid,
        "columns": properties::table(states).to_json(),
    });
    Ok(serde_json::to_string_pretty(&document)? + "\n")
}

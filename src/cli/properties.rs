//! `cylwatch properties`: a gas at one state, or at every state of a file.
use super::arguments::{EquationName, Format, PropertiesArguments};
use super::input::Inputs;
use super::message::Messages;
use super::output::Target;
use super::states;
use super::views::Views;
use anyhow::{Context, bail};
use cylwatch::properties::{self, Properties};
use cylwatch::report::{Provenance, Report};
use cylwatch::thermal::fluid::{Equation, Fluid};
use serde_json::json;

/// Evaluates and writes.
pub fn run(arguments: PropertiesArguments, messages: &Messages) -> anyhow::Result<()> {
    let inputs: Vec<&std::path::Path> = arguments.states.as_deref().into_iter().collect();
    let target = Target::checked(arguments.data.output.as_deref(), &inputs)?;
    let views = Views::checked(&arguments.report.clone().into(), &inputs, &[&target])?;
    let equation = match arguments.equation {
        EquationName::Reference => Equation::Reference,
        EquationName::IdealGas => Equation::IdealGas,
        EquationName::PengRobinson => Equation::PengRobinson,
    };
    let fluid = Fluid::named(&arguments.fluid)?.with_equation(equation);
    let inputs = Inputs::default();
    let many = arguments.states.is_some();
    let states = match &arguments.states {
        Some(path) => of_file(&fluid, &path.to_string_lossy(), &inputs, messages)?,
        None => vec![properties::evaluate(&fluid, arguments.given.state()?)?],
    };
    let provenance = inputs.provenance();
    let for_people = arguments.data.format.is_none() && !many && matches!(target, Target::Stdout);
    let text = match arguments.data.format() {
        _ if for_people => {
            Report { title: String::new(), ..properties::summary(&arguments.fluid, &states[0]) }.to_text()
        }
        Format::Csv => properties::table(&states).to_csv(&provenance, &[]),
        Format::Json => document(&arguments, &states, &provenance)?,
    };
    let summary = || match &states[..] {
        [one] => properties::summary(&arguments.fluid, one),
        many => properties::summary_of_many(&arguments.fluid, many),
    };
    views.make_report(summary, Vec::new(), &provenance)?.write()?;
    target.write(text.as_bytes())
}

fn of_file(
    fluid: &Fluid,
    file: &str,
    inputs: &Inputs,
    messages: &Messages,
) -> anyhow::Result<Vec<Properties>> {
    if file.is_empty() {
        bail!("--states has an empty name: write a file name or `-` for stdin");
    }
    let text = inputs.read(file)?;
    let shown = if file == "-" { "stdin" } else { file };
    let evaluated = states::read(&text, shown, messages)?
        .into_iter()
        .map(|row| properties::evaluate(fluid, row.given).with_context(|| format!("{shown}:{}", row.line)));
    evaluated.collect()
}

fn document(
    arguments: &PropertiesArguments,
    states: &[Properties],
    provenance: &Provenance,
) -> anyhow::Result<String> {
    let document = json!({
        "provenance": provenance.to_json(),
        "fluid": arguments.fluid,
        "columns": properties::table(states).to_json(),
    });
    Ok(serde_json::to_string_pretty(&document)? + "\n")
}

//! How long does this project take for work that other programs can do too, and what comes out?
//!
//! `cargo run --release --example peers -- inputs > inputs.json`, then
//! `cargo run --release --example peers -- CASE inputs.json` with one of the cases `vessels`, `properties`, `integration`, `filter`, `horizon`.
//!
//! This is one half of `benches/peers/run`: it makes the inputs that both sides read, and prints times and results of
//! this project as JSON. Times are those of one thread, after a warm-up, without start-up and without input and output.
#![allow(clippy::print_stdout)]

mod filter;
mod horizon;
mod integration;
mod linear;
mod properties;
mod stopwatch;
mod vessels;

use anyhow::{Context, bail};
use serde::{Deserialize, Serialize};
use serde_json::{Value, to_value};
use std::time::Duration;
pub(crate) use stopwatch::Stopwatch;

/// Cases, in the order in which they are described.
pub(crate) const CASES: [&str; 5] = ["vessels", "properties", "integration", "filter", "horizon"];
/// Time spent on each timing, s.
const BUDGET: Duration = Duration::from_millis(400);

/// What both sides read.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Inputs {
    vessels: vessels::Inputs,
    properties: properties::Inputs,
    integration: Vec<integration::Inputs>,
    filter: linear::Inputs,
    horizon: horizon::Inputs,
}

/// Makes the inputs.
pub(crate) fn inputs() -> anyhow::Result<Inputs> {
    let filter = filter::inputs()?;
    Ok(Inputs {
        vessels: vessels::Inputs::new(),
        properties: properties::inputs()?,
        integration: integration::inputs()?,
        horizon: horizon::inputs(&filter)?,
        filter,
    })
}

/// Runs one case.
pub(crate) fn run(case: &str, inputs: &Inputs, stopwatch: &Stopwatch) -> anyhow::Result<Value> {
    Ok(match case {
        "vessels" => to_value(vessels::run(stopwatch)?)?,
        "properties" => to_value(properties::run(&inputs.properties, stopwatch)?)?,
        "integration" => to_value(integration::run(stopwatch)?)?,
        "filter" => to_value(filter::run(&inputs.filter, stopwatch)?)?,
        "horizon" => to_value(horizon::run(&inputs.horizon, stopwatch)?)?,
        _ => bail!("no case `{case}`: take one of {}", CASES.join(", ")),
    })
}

fn main() -> anyhow::Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let answer = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["inputs"] => to_value(inputs()?)?,
        [case, file] => {
            let text = std::fs::read_to_string(file).with_context(|| format!("cannot read {file}"))?;
            let inputs = serde_json::from_str(&text).with_context(|| format!("{file} holds no inputs"))?;
            run(case, &inputs, &Stopwatch::new(BUDGET))?
        }
        _ => bail!("give `inputs`, or a case and the file of inputs"),
    };
    println!("{answer}");
    Ok(())
}

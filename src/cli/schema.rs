//! `cylwatch schema`: JSON schemas of the files that the program reads.
use super::output::Target;
use crate::estimator::placement::candidates_schema;
use crate::thermal::{scenario, vessel};
use clap::{Args, ValueEnum};
use serde_json::json;

/// A kind of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Document {
    /// Vessel files.
    Vessel,
    /// Scenario files.
    Scenario,
    /// Files of `place --candidates`.
    Candidates,
}

/// Arguments of `schema`.
#[derive(Debug, Args)]
pub(super) struct SchemaArguments {
    /// Which schema [default: all, as one object].
    #[arg(value_enum)]
    pub document: Option<Document>,
}

/// Writes one schema, or all as an object, to stdout.
pub(super) fn run(arguments: SchemaArguments) -> anyhow::Result<()> {
    let schema = match arguments.document {
        Some(Document::Vessel) => json!(vessel::schema()),
        Some(Document::Scenario) => json!(scenario::schema()),
        Some(Document::Candidates) => candidates_schema(),
        None => json!({
            "vessel": vessel::schema(),
            "scenario": scenario::schema(),
            "candidates": candidates_schema(),
        }),
    };
    Target::Stdout.write(format!("{}\n", serde_json::to_string_pretty(&schema)?).as_bytes())
}

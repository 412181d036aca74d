//! `cylwatch schema`: JSON schemas of the files that the program reads.
use super::arguments::{Document, SchemaArguments};
use super::output::Target;
use cylwatch::estimator::placement::candidates_schema;
use cylwatch::thermal::{scenario, vessel};
use serde_json::json;

/// Writes one schema, or all as an object, to stdout.
pub fn run(arguments: SchemaArguments) -> anyhow::Result<()> {
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

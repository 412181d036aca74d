//! `cylwatch schema`: JSON schemas of the files that the program reads, and of the messages that its gateway publishes.
use super::output::Target;
#[cfg(feature = "serve")]
use super::serve;
use crate::estimator::placement::candidates_schema;
use crate::thermal::{scenario, vessel};
use clap::{Args, ValueEnum};
use serde_json::{Value, json};

/// A kind of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Document {
    /// Vessel files.
    Vessel,
    /// Scenario files.
    Scenario,
    /// Files of `place --candidates`.
    Candidates,
    /// Configurations of `serve`.
    #[cfg(feature = "serve")]
    Gateway,
    /// Published by `serve`: NAME/verdict.
    #[cfg(feature = "serve")]
    Verdict,
    /// Published by `serve`: NAME/estimate.
    #[cfg(feature = "serve")]
    Estimate,
    /// Published by `serve`: NAME/alarm/ALARM.
    #[cfg(feature = "serve")]
    Alarm,
    /// Published by `serve`: NAME/event.
    #[cfg(feature = "serve")]
    Event,
}

impl Document {
    fn schema(self) -> Value {
        match self {
            Self::Vessel => json!(vessel::schema()),
            Self::Scenario => json!(scenario::schema()),
            Self::Candidates => candidates_schema(),
            #[cfg(feature = "serve")]
            Self::Gateway => serve::configuration_schema(),
            #[cfg(feature = "serve")]
            Self::Verdict => serve::published_schema("verdict"),
            #[cfg(feature = "serve")]
            Self::Estimate => serve::published_schema("estimate"),
            #[cfg(feature = "serve")]
            Self::Alarm => serve::published_schema("alarm"),
            #[cfg(feature = "serve")]
            Self::Event => serve::published_schema("event"),
        }
    }

    /// Its name on the command line.
    fn name(self) -> String {
        self.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default()
    }
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
        Some(document) => document.schema(),
        None => {
            let documents = Document::value_variants().iter();
            Value::Object(documents.map(|document| (document.name(), document.schema())).collect())
        }
    };
    Target::Stdout.write(format!("{}\n", serde_json::to_string_pretty(&schema)?).as_bytes())
}

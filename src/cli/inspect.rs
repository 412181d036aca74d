//! `cylwatch inspect`: what an unknown log holds, and what to do with it.
use super::input::Inputs;
use super::message::Messages;
use super::options::{LogArguments, ReportArguments};
use super::output::Target;
use super::progress::Progress;
use super::views::Views;
use crate::report::inspect as report;
use clap::{Args, ValueEnum};
use std::path::{Path, PathBuf};

/// Rows between two looks at the bar.
const ROWS: u64 = 1024;

/// Arguments of `inspect`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct InspectArguments {
    /// Log: a CSV file, also packed with gzip, a Parquet file, or - for CSV on stdin.
    pub log: String,
    #[command(flatten)]
    pub reading: LogArguments,
    /// Format of the result [default: json for a file that ends in .json, else text].
    #[arg(long, value_enum)]
    pub format: Option<InspectionFormat>,
    /// Write the result to FILE; - is stdout.
    #[arg(long, short, value_name = "FILE")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub report: ReportArguments,
}

/// Format of an inspection.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum InspectionFormat {
    /// Words and tables for people.
    Text,
    /// One JSON document with a provenance object.
    Json,
}

const EXAMPLES: &str = "\
Says how the file is written, which times and columns it has and what they are taken for, what is
odd, which --map may fit an unrecognised column, and which of estimate, monitor,
identify and calibrate can use it, with the command line to run next. A log that these commands
would refuse is inspected all the same.

Examples:
  cylwatch inspect logger.csv
  cylwatch inspect logger.csv.gz --map 'shoulder_degc=T1' --zone +01:00
  cylwatch inspect logger.csv --format json | jq .columns";

/// Reads, counts and writes.
pub(super) fn run(arguments: InspectArguments, messages: &Messages) -> anyhow::Result<()> {
    let target = Target::checked(arguments.output.as_deref(), &[Path::new(&arguments.log)])?;
    let views = Views::checked(&arguments.report.into(), &[Path::new(&arguments.log)], &[&target])?;
    let inputs = Inputs::default();
    let mut log = inputs.inspector(&arguments.log, &arguments.reading.options(Vec::new()))?;
    let progress = Progress::new(messages);
    let mut rows = 0_u64;
    while log.reader.step()? {
        rows += 1;
        if rows.is_multiple_of(ROWS) {
            progress.show(&arguments.log, log.fraction_of_bytes());
        }
    }
    drop(progress);
    inputs.record_log(&log);
    let inspection = log.reader.finish();
    let is_json =
        arguments.output.as_deref().and_then(Path::extension).is_some_and(|ending| ending == "json");
    let text = match arguments.format {
        Some(InspectionFormat::Json) => true,
        Some(InspectionFormat::Text) => false,
        None => is_json,
    };
    let made = views.make_report(|| report::summary(&inspection), inputs.sources(), &inputs.provenance())?;
    let text = if text {
        serde_json::to_string_pretty(&report::document(&inspection, &inputs.provenance()))? + "\n"
    } else {
        report::text(&inspection)
    };
    made.write()?;
    target.write(text.as_bytes())
}

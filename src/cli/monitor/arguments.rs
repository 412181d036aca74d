//! The raw arguments of `monitor`.
use crate::cli::arguments::Format;
use crate::cli::fill::GivenFill;
use crate::cli::log_options::LogArguments;
use crate::cli::unit_options::{Choice, Choices, Given};
use clap::Args;
use cylwatch::report::monitor;
use cylwatch::thermal::units::Dimension;
use std::path::PathBuf;

/// What the verdict is held against, and times.
#[derive(Clone, Debug)]
pub struct OfMonitor;

impl Choices for OfMonitor {
    const CHOICES: &'static [Choice] = &[
        (
            "limit",
            Dimension::Pressure,
            "Pressure below which the cylinder is not operational [default: 160 bar]",
        ),
        (
            "coldest",
            Dimension::Temperature,
            "Coldest temperature to expect, for the cold-night forecast [default: -25 degC]",
        ),
        ("next-service", Dimension::Time, "Time until the next service [default: 30 d]"),
        (
            "lateness",
            Dimension::Time,
            "How late a row may come: rows are held back so long and sorted [default: 0, none is held back]",
        ),
        (
            "step",
            Dimension::Time,
            "Rows that lie closer together are made one, their median; 0: each by itself [default: 1 min]",
        ),
        (
            "save-every",
            Dimension::Time,
            "How often the state is saved during a run, by the wall clock [default: 10 min]",
        ),
    ];
}

/// Arguments of `monitor`.
#[derive(Debug, Args)]
#[command(after_help = help())]
pub struct MonitorArguments {
    /// Vessel: a TOML file, the name of a built-in one, or - for stdin.
    pub vessel: String,
    /// Log: a CSV or Parquet file, or - for CSV on stdin.
    pub log: String,
    /// File for the rows; - is stdout [default: stdout].
    #[arg(long, short, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Format of the rows [default: json for a file that ends in .json, else csv].
    #[arg(long, value_enum)]
    pub format: Option<Format>,
    /// Figure of pressures, mass, leak rate and verdict; the ending .svg or .png decides the format.
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
    /// Report with tables, figure and inputs: one HTML file that needs nothing else.
    #[arg(long, value_name = "FILE")]
    pub report: Option<PathBuf>,
    /// Foreign names and zone of the log.
    #[command(flatten)]
    pub reading: LogArguments,
    /// TOML file of the sensors with their errors [default: typical ones, as for `estimate`].
    #[arg(long, value_name = "FILE")]
    pub sensors: Option<PathBuf>,
    /// What is known at the first row.
    #[command(flatten)]
    pub fill: GivenFill,
    /// Limits and times.
    #[command(flatten)]
    pub given: Given<OfMonitor>,
    /// Mean time between false alarms, years.
    #[arg(long, value_name = "YEARS", default_value_t = 10.0)]
    pub false_alarm_years: f64,
    /// File for events and alarms, one JSON object a line, written as they happen; goes on where a state goes on
    /// [default: in words on stderr].
    #[arg(long, value_name = "FILE")]
    pub events: Option<PathBuf>,
    /// File to go on from, if it is there, and to save to.
    #[arg(long, value_name = "FILE")]
    pub state: Option<PathBuf>,
    /// Begin anew although there is a state, and say so.
    #[arg(long, requires = "state")]
    pub cold_start: bool,
    /// Acknowledge and confirm all alarms of the state, and reset those that are back to normal, with a comment.
    #[arg(long, value_name = "COMMENT", requires = "state", conflicts_with = "cold_start")]
    pub acknowledge: Option<String>,
    /// Exchange of gas that was ordered, such as a test of the system, so that it is no loss: times in seconds of the log or dates.
    /// May be given more than once.
    #[arg(long, value_name = "FROM..UNTIL")]
    pub announced: Vec<String>,
    /// JSON file of `commission` with thresholds for this vessel [default: the usual ones, common to seven vessels].
    #[arg(long, value_name = "FILE")]
    pub commissioned: Option<PathBuf>,
    /// JSON file with what `estimate --learned-out` has learnt of cylinder and sensors.
    #[arg(long, value_name = "FILE")]
    pub learned_in: Option<PathBuf>,
}

fn help() -> String {
    format!(
        "\
Logs are read as by `estimate`, but rows may come late or twice, and the clock may jump: see
--lateness-s and book/src/monitor.md.

{}

Exit codes: 0 no loss, 1 gas was lost in these rows, by a leak or by a discharge that was not
announced, 2 error, 3 inconclusive: the verdict is unknown at the end.

Examples:
  cylwatch simulate nitrogen-20l tunnel-winter -o run.csv
  cylwatch monitor nitrogen-20l run.csv -o rows.csv --plot monitor.svg
  cylwatch monitor nitrogen-20l day.csv -o rows.csv --events events.jsonl --state cylinder.state
  cylwatch monitor nitrogen-20l run.csv --commissioned thresholds.json -o rows.csv
  tail -n +1 -f live.csv | cylwatch monitor nitrogen-20l - --state cylinder.state >> rows.csv",
        monitor::DOCUMENTATION
    )
}

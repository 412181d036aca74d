//! Groups of options that commands share, each with one help text.
use super::format::Format;
use super::number::{above, within};
use crate::log::{LogOptions, Mapping, Zone};
use crate::thermal::units::YEAR_S;
use clap::{Arg, Args, Command};
use std::path::{Path, PathBuf};

/// Heading of options that few need; the short help leaves them out, see [`without_experts`].
pub(super) const EXPERT: &str = "Expert options";
/// Heading of what goes in beside the log.
pub(super) const INPUT: &str = "Input";
/// Heading of what comes out.
pub(super) const OUTPUT: &str = "Output";
/// Last line of a short help.
pub(super) const HELP_FOOTER: &str = "All options, columns and examples: --help";

/// Leaves expert options out of the short help of a command and its subcommands.
pub(super) fn without_experts(command: Command) -> Command {
    let is_expert = |arg: &Arg| arg.get_help_heading() == Some(EXPERT);
    command
        .mut_args(|arg| if is_expert(&arg) { arg.hide_short_help(true) } else { arg })
        .mut_subcommands(without_experts)
}

/// Longest time between false alarms that is taken, years: thresholds beyond it rest on no data.
const LONGEST_YEARS: f64 = 1e5;

/// Data of a run.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = OUTPUT)]
pub(super) struct DataArguments {
    /// Write the data to FILE; - is stdout.
    #[arg(long, short, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Format of the data [default: json for a file that ends in .json, else csv].
    #[arg(long, value_enum)]
    pub format: Option<Format>,
}

impl DataArguments {
    /// The format that is asked for, else the one of the file's name.
    pub(super) fn format(&self) -> Format {
        self.format.unwrap_or_else(|| Format::of(self.output.as_deref()))
    }

    /// The format of data; `None`: tables for people, on stdout.
    pub(super) fn format_or_tables(&self, json: bool) -> Option<Format> {
        let named = if json { Some(Format::Json) } else { self.format };
        named.or_else(|| self.output.as_deref().map(|output| Format::of(Some(output))))
    }
}

/// Report of a run.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = OUTPUT)]
pub(super) struct ReportArguments {
    /// Write a report with tables, figure and inputs to FILE, self-contained HTML.
    #[arg(long, value_name = "FILE")]
    pub report: Option<PathBuf>,
}

/// Figure and report of a run.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = OUTPUT)]
pub(super) struct ViewArguments {
    /// Write the figure to FILE; its ending, .svg or .png, is the format.
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
    #[command(flatten)]
    pub report: ReportArguments,
}

impl From<ReportArguments> for ViewArguments {
    fn from(report: ReportArguments) -> Self {
        Self { plot: None, report }
    }
}

/// A vessel and a log of it.
#[derive(Clone, Debug, Args)]
pub(super) struct VesselAndLog {
    /// Vessel: a TOML file, the name of a built-in one, or - for stdin.
    pub vessel: String,
    /// Log: a CSV or Parquet file, or - for CSV on stdin.
    pub log: String,
}

impl VesselAndLog {
    /// The inputs as paths; stdin can be one of them.
    pub(super) fn paths(&self) -> anyhow::Result<Vec<&Path>> {
        if self.vessel == "-" && self.log == "-" {
            anyhow::bail!("stdin can be the vessel or the log, not both: give the other one as a file");
        }
        Ok(vec![Path::new(&self.vessel), Path::new(&self.log)])
    }
}

/// How a log is read: foreign names and zone.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = INPUT)]
pub(super) struct LogArguments {
    /// Name a column, as shoulder_degc=T1; may be given again.
    ///
    /// Two columns make a time: time=Date+Clock.
    #[arg(long = "map", value_name = "OURS=THEIRS")]
    pub mappings: Vec<Mapping>,
    /// Zone of dates that do not say theirs, as Europe/Berlin or +01:00 [default: UTC, with a caution].
    #[arg(long, value_name = "ZONE", allow_hyphen_values = true, hide_short_help = true)]
    pub zone: Option<Zone>,
}

impl LogArguments {
    /// As options of a reader that knows these sensors, too.
    pub(super) fn options(&self, sensors: Vec<String>) -> LogOptions {
        LogOptions {
            mappings: self.mappings.clone(),
            zone: self.zone.clone(),
            sensors,
            ..LogOptions::default()
        }
    }
}

/// Sensors of a log.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = INPUT)]
pub(super) struct SensorArguments {
    /// TOML file of the sensors with their errors [default: typical].
    ///
    /// Typical are Pt100 of class B on the columns shoulder, valve and wall_<place>, and a transmitter of 250 bar and 0.25 % on pressure.
    #[arg(long, value_name = "FILE")]
    pub sensors: Option<PathBuf>,
}

/// Rate of false alarms.
#[derive(Clone, Debug, Args)]
pub(super) struct FalseAlarmArguments {
    /// Mean time between false alarms that thresholds are set for, in years.
    #[arg(long, value_name = "YEARS", default_value_t = 10.0, value_parser = above(0.0).at_most(LONGEST_YEARS))]
    pub false_alarm_years: f64,
}

impl FalseAlarmArguments {
    /// The same in s.
    pub(super) fn mean_time_s(&self) -> f64 {
        self.false_alarm_years * YEAR_S
    }
}

/// Tolerance of a simulation.
#[derive(Clone, Debug, Args)]
pub(super) struct SolverArguments {
    /// Relative tolerance of the solver, 1e-13 to 1e-2 [default: 1e-6, of calibrate 1e-9].
    #[arg(long, value_name = "NUMBER", value_parser = within(1e-13, 1e-2), help_heading = EXPERT)]
    pub relative_tolerance: Option<f64>,
}

//! The raw arguments of `fleet`.
use crate::cli::monitor::{CylinderArguments, MonitorArguments};
use crate::cli::number::within;
use crate::cli::options::{FalseAlarmArguments, HELP_FOOTER, INPUT, LogArguments, OUTPUT, VesselAndLog};
use crate::report::fleet;
use clap::{Args, Command, ValueEnum};
use std::path::PathBuf;

/// Format of the tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum TableFormat {
    /// Comma-separated columns; lines that begin with # say where they come from.
    Csv,
    /// Parquet, with where it comes from as metadata.
    #[cfg(feature = "parquet")]
    Parquet,
}

impl TableFormat {
    #[cfg(feature = "parquet")]
    pub(super) const USUAL: Self = Self::Parquet;
    #[cfg(not(feature = "parquet"))]
    pub(super) const USUAL: Self = Self::Csv;

    /// Ending of a file's name.
    pub(super) fn ending(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            #[cfg(feature = "parquet")]
            Self::Parquet => "parquet",
        }
    }
}

/// Arguments of `fleet`.
#[derive(Debug, Args)]
#[command(after_help = HELP_FOOTER, after_long_help = help())]
pub(crate) struct FleetArguments {
    /// Folder of logs in CSV or Parquet: a file for each cylinder, named after it; folders cylinder=NAME; or files with a column
    /// `cylinder`.
    pub logs: PathBuf,
    /// CSV file with a row for each cylinder: cylinder, vessel, and what differs from the options below.
    #[arg(long, value_name = "FILE", help_heading = INPUT, required_unless_present = "vessel", conflicts_with = "vessel")]
    pub vessels: Option<PathBuf>,
    /// Vessel of all cylinders, where they are alike: a TOML file or the name of a built-in one.
    #[arg(long, value_name = "VESSEL", help_heading = INPUT)]
    pub vessel: Option<String>,
    /// Folder for the results, made if it is not there.
    #[arg(long, short, value_name = "DIR", help_heading = OUTPUT)]
    pub output: PathBuf,
    /// Format of the tables [default: parquet where the program was built with it, else csv].
    #[arg(long, value_enum, help_heading = OUTPUT)]
    pub format: Option<TableFormat>,
    /// Write the rows of each cylinder, too, as CSV in the folder `rows`.
    #[arg(long, help_heading = OUTPUT)]
    pub rows: bool,
    /// Go on from the states although logs before are gone or changed, as in a folder that holds what is new alone.
    ///
    /// Logs that have grown, by rows at their end or by files after the last, go on without it.
    #[arg(long)]
    pub go_on: bool,
    /// Threads; the results do not depend on it [default: the number of cores].
    #[arg(long, value_name = "NUMBER", value_parser = within(1_usize, 1024))]
    pub threads: Option<usize>,
    #[command(flatten)]
    pub reading: LogArguments,
    #[command(flatten)]
    pub false_alarms: FalseAlarmArguments,
    #[command(flatten)]
    pub cylinder: CylinderArguments,
}

impl FleetArguments {
    /// The arguments of `monitor` for the log of a cylinder.
    pub(super) fn of_monitor(
        &self,
        vessel: &str,
        log: &str,
        cylinder: CylinderArguments,
    ) -> MonitorArguments {
        let inputs = VesselAndLog { vessel: vessel.to_owned(), log: log.to_owned() };
        MonitorArguments::of_another(inputs, cylinder, self.false_alarms.clone(), self.reading.clone())
    }
}

/// Hides what concerns a single run alone.
pub(in crate::cli) fn without_single_runs(command: Command) -> Command {
    command.mut_args(|arg| {
        let is_single = arg.get_long().is_some_and(|name| name.starts_with(SAVE_EVERY));
        if is_single { arg.hide(true) } else { arg }
    })
}

/// Beginning of the names of options that say when a run saves its state: a fleet saves each once, at its end.
pub(super) const SAVE_EVERY: &str = "save-every";

fn help() -> String {
    format!(
        "\
Each cylinder is monitored as by `cylwatch monitor VESSEL LOG --state FILE` with the same options.

The file of vessels has the columns cylinder, vessel (a TOML file beside it, or a built-in name), and
any option of `cylwatch monitor` with _ for -, such as fill_pressure_bar, fill_temperature_degc,
settled (yes or no), limit_bar, coldest_degc, sensors. An empty cell means the option of this command.
  cylinder,vessel,fill_pressure_bar,fill_temperature_degc,limit_bar
  A12,nitrogen-20l,200,15,160
  A13,nitrogen-20l,,,

Several files in a folder cylinder=NAME, and several files with a column `cylinder`, continue each
other in the order of their names.

The output folder holds summary, events and errors as tables, page.html, states/ and records/. A run
that was stopped or killed is resumed by the same command: cylinders whose logs, options and vessel are
the same are not done again. Logs that have grown since, by lines at the end or by files after the last,
go on from the states, with the result of one run over all of them. A log that cannot be read does not
end the run: its cylinder is unknown, and errors says why.

{}

Exit codes: 1 gas was lost from a cylinder, 3 from none, and of one it cannot be told or its log
cannot be read, 0 from none; 2 nothing could be read or the arguments are wrong, 130 stopped by Ctrl-C.

Examples:
  cylwatch fleet logs/ --vessels fleet.csv -o fleet
  cylwatch fleet logs/ --vessel nitrogen-20l --fill-pressure-bar 200 --fill-temperature-degc 15 -o fleet
  cylwatch fleet logs/ --vessels fleet.csv -o fleet --rows --format csv --threads 2
  cylwatch fleet tonight/ --vessels fleet.csv -o fleet --go-on",
        fleet::DOCUMENTATION
    )
}

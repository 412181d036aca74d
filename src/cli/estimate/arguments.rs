//! The raw arguments of `estimate`.
use crate::cli::arguments::Format;
use crate::cli::fill::GivenFill;
use crate::cli::log_options::LogArguments;
use clap::{Args, ValueEnum};
use cylwatch::estimator::EstimatorError;
use cylwatch::estimator::observer::Engine;
use cylwatch::report::estimate;
use std::path::PathBuf;

/// Arguments of `estimate`.
#[derive(Debug, Args)]
#[command(after_help = estimate_help())]
pub struct EstimateArguments {
    /// Vessel: a TOML file, the name of a built-in one, or - for stdin.
    pub vessel: String,
    /// Log: a CSV or Parquet file, or - for CSV on stdin.
    pub log: String,
    /// File for the estimates; - is stdout [default: stdout].
    #[arg(long, short, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Format of the estimates [default: json for a file that ends in .json, else csv].
    #[arg(long, value_enum)]
    pub format: Option<Format>,
    /// Figure of estimates and innovations; the ending .svg or .png decides the format.
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
    /// Report with tables, figure and inputs: one HTML file that needs nothing else.
    #[arg(long, value_name = "FILE")]
    pub report: Option<PathBuf>,
    /// Foreign names and zone of the log.
    #[command(flatten)]
    pub reading: LogArguments,
    /// Filter of the observer.
    #[arg(long, value_enum, default_value = "ekf")]
    pub filter: Filter,
    /// Use later readings, too: rows come out half a day later, and are nearer to the truth; ekf and ukf only.
    #[arg(long)]
    pub smooth: bool,
    /// TOML file of the sensors with their errors [default: on the columns shoulder, valve, wall_<place> Pt100 of class
    /// B, on pressure a transmitter of 250 bar and 0.25 %].
    #[arg(long, value_name = "FILE")]
    pub sensors: Option<PathBuf>,
    /// What is known at the first row.
    #[command(flatten)]
    pub fill: GivenFill,
    /// JSON file with what an earlier run has learnt of cylinder and sensors.
    #[arg(long, value_name = "FILE")]
    pub learned_in: Option<PathBuf>,
    /// File for what this run has learnt, as JSON.
    #[arg(long, value_name = "FILE")]
    pub learned_out: Option<PathBuf>,
}

/// Filter of the observer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Filter {
    /// Extended Kalman filter.
    Ekf,
    /// Unscented Kalman filter; about forty times the time.
    Ukf,
    /// Extended Kalman filter with the constant gain of the steady state; it learns no constants.
    Stationary,
    /// Moving-horizon estimation inside physical bounds; some hundred times the time.
    Mhe,
}

impl Filter {
    /// The observer's engine.
    pub fn engine(self) -> Result<Engine, EstimatorError> {
        let word = match self {
            Self::Ekf => "ekf",
            Self::Ukf => "ukf",
            Self::Stationary => "stationary",
            Self::Mhe => "mhe",
        };
        word.parse()
    }
}

fn estimate_help() -> String {
    format!(
        "\
A log has a column time_<unit>, or time for RFC 3339, and readings shoulder, valve, ambient,
pressure, wall_<place> or gas_<name>, each with its unit: shoulder_degc, pressure_barg. Empty
cells, NaN and NA are missing values; rows go upwards in time at any interval. In a simulated log
the columns measured_<name> are the readings, and gas_mean, mass and outflow are taken as truth,
to score the estimates.

{}

Examples:
  cylwatch simulate nitrogen-20l tunnel-winter -o run.csv
  cylwatch estimate nitrogen-20l run.csv -o est.csv --plot est.svg
  cylwatch estimate nitrogen-20l logger.csv --map time=Timestamp --map shoulder_degc=T1
  tail -n +1 -f live.csv | cylwatch estimate nitrogen-20l - --fill-mass-kg 4.48",
        estimate::DOCUMENTATION
    )
}

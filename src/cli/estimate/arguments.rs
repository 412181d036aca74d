//! The raw arguments of `estimate`.
use crate::cli::fill::GivenFill;
use crate::cli::options::{
    DataArguments, EXPERT, HELP_FOOTER, LogArguments, SensorArguments, VesselAndLog, ViewArguments,
};
use crate::estimator::EstimatorError;
use crate::estimator::observer::Engine;
use crate::report::estimate;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Arguments of `estimate`.
#[derive(Debug, Args)]
#[command(after_help = HELP_FOOTER, after_long_help = estimate_help())]
pub(crate) struct EstimateArguments {
    #[command(flatten)]
    pub inputs: VesselAndLog,
    #[command(flatten)]
    pub data: DataArguments,
    #[command(flatten)]
    pub views: ViewArguments,
    #[command(flatten)]
    pub reading: LogArguments,
    #[command(flatten)]
    pub sensors: SensorArguments,
    #[command(flatten)]
    pub fill: GivenFill,
    /// Filter of the observer.
    #[arg(long, value_enum, default_value = "ekf", help_heading = EXPERT)]
    pub filter: Filter,
    /// Smooth with later readings: rows come out half a day later, with smaller errors; ekf and ukf only.
    #[arg(long, help_heading = EXPERT)]
    pub smooth: bool,
    /// JSON file of --learned-out: what an earlier run has learnt of cylinder and sensors.
    #[arg(long, value_name = "FILE", help_heading = EXPERT)]
    pub learned_in: Option<PathBuf>,
    /// Write what this run has learnt to FILE, as JSON.
    #[arg(long, value_name = "FILE", help_heading = EXPERT)]
    pub learned_out: Option<PathBuf>,
}

/// Filter of the observer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Filter {
    /// Extended Kalman filter.
    Ekf,
    /// Unscented Kalman filter; many times slower than ekf.
    Ukf,
    /// Extended Kalman filter with the constant gain of the steady state; learns no constants of the sensors.
    Stationary,
    /// Moving-horizon estimation inside physical bounds; by far the slowest.
    Mhe,
}

impl Filter {
    /// The observer's engine.
    pub(crate) fn engine(self) -> Result<Engine, EstimatorError> {
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

//! The raw arguments of `calibrate`.
use super::amounts::Amounts;
use crate::cli::fill::GivenFill;
use crate::cli::log_options::LogArguments;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Arguments of `calibrate`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct CalibrateArguments {
    /// Vessel to begin with: a TOML file, the name of a built-in one, or - for stdin.
    pub vessel: String,
    /// Logs of the same vessel: CSV or Parquet files, or - for CSV on stdin.
    #[arg(required = true)]
    pub logs: Vec<String>,
    /// File for the calibrated vessel, .toml; - is stdout [default: none, a summary on stdout].
    #[arg(long, short, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// What stdout gets.
    #[arg(long, value_enum, default_value = "text")]
    pub format: CalibrationFormat,
    /// Figure of readings, model, residuals and their autocorrelation; the ending .svg or .png decides the format.
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
    /// Report with tables, figure and inputs: one HTML file that needs nothing else.
    #[arg(long, value_name = "FILE")]
    pub report: Option<PathBuf>,
    /// What happened while the log was recorded: a TOML file or a built-in scenario, whose time is that of the log; of several
    /// logs say LOG=SCENARIO for each [default: the log's column ambient is the air].
    #[arg(long = "scenario", value_name = "SCENARIO")]
    pub scenarios: Vec<String>,
    /// Another vessel that a log belongs to; factors are shared by all vessels; may be given again.
    #[arg(long = "vessel-of", value_name = "LOG=VESSEL")]
    pub vessels: Vec<String>,
    /// Foreign names and zone of the log.
    #[command(flatten)]
    pub reading: LogArguments,
    /// TOML file of the sensors with their errors [default: on the columns shoulder, valve, wall_<place> Pt100 of class
    /// B, on pressure a transmitter of 250 bar and 0.25 %].
    #[arg(long, value_name = "FILE")]
    pub sensors: Option<PathBuf>,
    /// File for what was found of the sensors, .toml, to be given to monitor or estimate as --sensors with rows that were not
    /// fitted.
    #[arg(long, value_name = "FILE")]
    pub sensors_out: Option<PathBuf>,
    /// What is unknown, separated by commas [default: outside-film; inside-film where there is a pressure; valve-contact with
    /// the prior 1,0.5 where there is a thermometer on a valve].
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub fit: Vec<String>,
    /// What is fitted beside it by default and shall not be: offset:shoulder, initial-temperature, ...
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub hold: Vec<String>,
    /// What is known of a parameter, in its unit; may be given again [default: nothing of a factor; the data sheet of a sensor].
    #[arg(long = "prior", value_name = "NAME=MEAN,SD")]
    pub priors: Vec<String>,
    /// Lowest and highest value of a parameter, in its unit; may be given again [default: 0.05 and 20 for factors].
    #[arg(long, value_name = "NAME=LOW,HIGH")]
    pub bounds: Vec<String>,
    /// Where the search begins, in the parameter's unit; may be given again [default: as vessel and sensors say].
    #[arg(long = "start", value_name = "NAME=VALUE")]
    pub starts: Vec<String>,
    /// Score the fit on readings it was not fitted to: the last part of the log, as a fraction between 0 and 1, or another log.
    #[arg(long, value_name = "FRACTION|LOG")]
    pub validate: Option<String>,
    /// Interval of a parameter by its profile likelihood, too; takes a fit for each of some ten points; may be given again.
    #[arg(long = "profile", value_name = "NAME")]
    pub profiles: Vec<String>,
    /// Most steps of the search.
    #[arg(long, value_name = "NUMBER", default_value_t = 40)]
    pub iterations: usize,
    /// Relative tolerance of the solver, without unit, 1e-13 to 1e-2 [default: 1e-9].
    #[arg(long, value_name = "NUMBER")]
    pub relative_tolerance: Option<f64>,
    /// Date that the vessel file records, in the form of RFC 3339 [default: SOURCE_DATE_EPOCH if it is set, else now].
    #[arg(long, value_name = "DATE")]
    pub date: Option<String>,
    /// Surroundings.
    #[command(flatten)]
    pub amounts: Amounts,
    /// What is known at the first row.
    #[command(flatten)]
    pub fill: GivenFill,
}

/// What stdout gets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum CalibrationFormat {
    /// Tables for people.
    Text,
    /// One JSON document with everything; the tables go to stderr.
    Json,
}

const EXAMPLES: &str = "\
Names of what can be fitted. Factors on what the vessel file says: outside-film, inside-film,
wall-capacity, valve-capacity, valve-contact, volume. Of a flow of the scenario:
discharge-coefficient:NAME. Of each log, fitted beside them by default: initial-temperature (K
above the first readings), fill-mass (factor), air-offset (K, of the thermometer of the air that
all others are compared with; not with a scenario). Numbers of a sensor, fitted by default within its
data sheet: offset:NAME (K or bar), coupling:NAME, span:NAME, temperature-coefficient:NAME
(mbar/K); and lag:NAME (s). A sensor's number that --fit names is free of the data sheet.

Without --scenario the log needs a column ambient, the cylinder is taken to be at rest at its
first row, and the outside film is that of still air with radiation, of --wind-m-s, or a
coefficient that contains the radiation, --film-w-m2-k.

A log should begin at rest, go through a change of the air of 10 K or more, last some hours, and
have a row at least every minute or two.

Examples:
  cylwatch calibrate my-cylinder.toml log.csv -o calibrated.toml --plot fit.svg
  cylwatch calibrate my-cylinder.toml log.csv --film-w-m2-k 20 --fit outside-film,wall-capacity \\
      --prior wall-capacity=1,0.05 -o calibrated.toml
  cylwatch calibrate my-cylinder.toml a.csv b.csv --validate c.csv --format json > fit.json
  cylwatch calibrate my-cylinder.toml log.csv -o calibrated.toml --sensors-out sensors.toml
  cylwatch monitor calibrated.toml other.csv --sensors sensors.toml -o rows.csv";

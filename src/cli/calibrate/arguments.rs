//! The raw arguments of `calibrate`.
use super::quantities::Quantities;
use crate::cli::fill::GivenFill;
use crate::cli::number::at_least;
use crate::cli::options::{
    EXPERT, HELP_FOOTER, LogArguments, OUTPUT, SensorArguments, SolverArguments, ViewArguments,
};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Arguments of `calibrate`.
#[derive(Debug, Args)]
#[command(after_help = HELP_FOOTER, after_long_help = EXAMPLES)]
pub(crate) struct CalibrateArguments {
    /// Vessel to begin with: a TOML file, the name of a built-in one, or - for stdin.
    pub vessel: String,
    /// Logs of the same vessel: CSV or Parquet files, or - for CSV on stdin.
    #[arg(required = true)]
    pub logs: Vec<String>,
    /// Scenario of the log: a TOML file or a built-in one [default: the log's column ambient is the air].
    ///
    /// Its time is that of the log; for several logs give LOG=SCENARIO each.
    #[arg(long = "scenario", value_name = "SCENARIO")]
    pub scenarios: Vec<String>,
    /// Parameters to fit, separated by commas [default: those that the sensors can determine].
    ///
    /// By default outside-film; inside-film where there is a pressure; valve-contact with the prior 1,0.5 where there is a thermometer
    /// on a valve.
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub fit: Vec<String>,
    /// Score the fit on other readings: the last part of the log, as a fraction between 0 and 1, or another log.
    #[arg(long, value_name = "FRACTION|LOG")]
    pub validate: Option<String>,
    /// Write the calibrated vessel to FILE, .toml; - is stdout [default: none, a summary on stdout].
    #[arg(long, short, value_name = "FILE", help_heading = OUTPUT)]
    pub output: Option<PathBuf>,
    /// Content of stdout.
    #[arg(long, value_enum, default_value = "text", help_heading = OUTPUT)]
    pub format: CalibrationFormat,
    #[command(flatten)]
    pub views: ViewArguments,
    /// Write the fitted sensors to FILE, .toml, for --sensors of monitor or estimate on rows that were not fitted.
    #[arg(long, value_name = "FILE", help_heading = OUTPUT, hide_short_help = true)]
    pub sensors_out: Option<PathBuf>,
    #[command(flatten)]
    pub reading: LogArguments,
    #[command(flatten)]
    pub sensors: SensorArguments,
    #[command(flatten)]
    pub fill: GivenFill,
    #[command(flatten)]
    pub quantities: Quantities,
    /// Another vessel that a log belongs to; factors are shared by all vessels; may be given again.
    #[arg(long = "vessel-of", value_name = "LOG=VESSEL", help_heading = EXPERT)]
    pub vessels: Vec<String>,
    /// Parameters that are fitted by default and shall not be: offset:shoulder, initial-temperature, ...
    #[arg(long, value_name = "NAMES", value_delimiter = ',', help_heading = EXPERT)]
    pub hold: Vec<String>,
    /// Prior of a parameter, in its unit; may be given again [default: none for a factor; the data sheet of a sensor].
    #[arg(long = "prior", value_name = "NAME=MEAN,SD", help_heading = EXPERT)]
    pub priors: Vec<String>,
    /// Lowest and highest value of a parameter, in its unit; may be given again [default: 0.05 and 20 for factors].
    #[arg(long, value_name = "NAME=LOW,HIGH", help_heading = EXPERT)]
    pub bounds: Vec<String>,
    /// First value of a parameter, in its unit; may be given again [default: that of vessel and sensors].
    #[arg(long = "start", value_name = "NAME=VALUE", help_heading = EXPERT)]
    pub starts: Vec<String>,
    /// Interval of a parameter by its profile likelihood, which takes some ten fits; may be given again.
    #[arg(long = "profile", value_name = "NAME", help_heading = EXPERT)]
    pub profiles: Vec<String>,
    /// Most steps of the search.
    #[arg(long, value_name = "NUMBER", default_value_t = 40, value_parser = at_least(1_usize), help_heading = EXPERT)]
    pub iterations: usize,
    #[command(flatten)]
    pub solver: SolverArguments,
    /// Date in the vessel file, in the form of RFC 3339 [default: SOURCE_DATE_EPOCH if it is set, else now].
    #[arg(long, value_name = "DATE", help_heading = EXPERT)]
    pub date: Option<String>,
}

/// Content of stdout.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum CalibrationFormat {
    /// Tables for people.
    Text,
    /// A row for each parameter, in SI units; the tables go to stderr.
    Csv,
    /// One JSON document with everything; the tables go to stderr.
    Json,
}

const EXAMPLES: &str = "\
Names of what can be fitted. Factors on what the vessel file says: outside-film, inside-film,
jet-film, wall-capacity, valve-capacity, valve-contact, volume. Of a flow of the scenario:
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

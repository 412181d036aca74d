//! The raw arguments of `identify`.
use super::quantities::Quantities;
use crate::cli::format::Format;
use crate::cli::number::{at_least, within};
use crate::cli::options::{EXPERT, HELP_FOOTER, LogArguments, OUTPUT, ViewArguments};
use crate::estimator::identify::{
    DeadTime, ErrorModel, Gain, InitialState, InputModel, Settings, StartMethod, Structure,
};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Arguments of `identify`.
#[derive(Debug, Args)]
#[command(after_help = HELP_FOOTER, after_long_help = EXAMPLES)]
pub(crate) struct IdentifyArguments {
    /// Log: a CSV or Parquet file, or - for CSV on stdin.
    pub log: String,
    /// Column of the input, with or without its unit.
    #[arg(long, value_name = "COLUMN")]
    pub input: String,
    /// Column of the output, with or without its unit.
    #[arg(long, value_name = "COLUMN")]
    pub output: String,
    /// Number of poles, 1 to 3.
    #[arg(long, value_name = "NUMBER", default_value_t = 1, value_parser = within(1_usize, 3))]
    pub order: usize,
    /// Steady-state gain: free, or a number to hold it at.
    #[arg(long, value_name = "GAIN", default_value = "free", allow_hyphen_values = true, value_parser = gain)]
    pub gain: Gain,
    /// Judge the model on other data: the last part of the log, as a fraction between 0 and 1, or another log.
    #[arg(long, value_name = "FRACTION|LOG2")]
    pub validate: Option<String>,
    /// Write the result to FILE: as JSON, or as CSV with data, model and errors row by row; - is stdout [default: a summary on
    /// stdout].
    #[arg(long, short, value_name = "FILE", help_heading = OUTPUT)]
    pub out: Option<PathBuf>,
    /// Format of the result [default: json for a file that ends in .json, else csv].
    #[arg(long, value_enum, help_heading = OUTPUT)]
    pub format: Option<Format>,
    #[command(flatten)]
    pub views: ViewArguments,
    #[command(flatten)]
    pub reading: LogArguments,
    /// Method.
    #[arg(long, value_enum, default_value = "output-error", help_heading = EXPERT)]
    pub method: MethodName,
    /// Number of zeros, below the order [default: one less than the order].
    #[arg(long, value_name = "NUMBER", value_parser = within(0_usize, 2), help_heading = EXPERT)]
    pub zeros: Option<usize>,
    /// Input between its samples.
    #[arg(long, value_enum, default_value = "first", help_heading = EXPERT)]
    pub hold: HoldName,
    /// State at the start: estimated, zero, settled, or the free response there and its derivatives per s, separated by commas
    /// (for order 1 the output less the offset), in the output's unit.
    #[arg(long, value_name = "STATE", default_value = "estimated", allow_hyphen_values = true, value_parser = initial,
        help_heading = EXPERT)]
    pub initial: InitialState,
    /// Estimate a constant that is added to the output.
    #[arg(long, help_heading = EXPERT)]
    pub offset: bool,
    /// Column of another sensor of the input, for the method second-sensor.
    #[arg(long, value_name = "COLUMN", help_heading = EXPERT)]
    pub second: Option<String>,
    #[command(flatten)]
    pub quantities: Quantities,
    /// Model of the true input, for the method maximum-likelihood.
    #[arg(long, value_enum, default_value = "random-walk", help_heading = EXPERT)]
    pub course: InputModelName,
    /// Error model behind the intervals of output-error and refined-instruments.
    #[arg(long, value_enum, default_value = "judged", help_heading = EXPERT)]
    pub errors: ErrorsName,
    /// First model of the iterations.
    #[arg(long, value_enum, default_value = "instrumental-variables", help_heading = EXPERT)]
    pub start: StartName,
    /// Most iterations.
    #[arg(long, value_name = "NUMBER", default_value_t = Settings::default().iterations, value_parser = at_least(1_usize),
        help_heading = EXPERT)]
    pub iterations: usize,
    /// Largest lag of the errors' correlations, samples.
    #[arg(long, value_name = "NUMBER", default_value_t = Settings::default().lags, value_parser = at_least(1_usize),
        help_heading = EXPERT)]
    pub lags: usize,
}

const EXAMPLES: &str = "\
The model is y = e^(-s d) (b_m s^m + ... + b0)/(s^n + ... + a0) u + offset with time in s,
temperatures in degC and pressures in bar. In a simulated log a column is what the sensor read
(measured_shoulder_degc) where there is such a column, else what is true (gas_mean_degc). From
temperature to temperature, the model that the paper publishes stands beside the identified one.

Noise on the input, too, slows the pole that output-error and refined-instruments find. The other
methods take it off: by --input-sd-k (and --output-sd-k), or by a second sensor of the input.

Examples:
  cylwatch identify run.csv --input shoulder --output gas_mean --plot model.svg
  cylwatch identify run.csv --input shoulder --output gas_mean --gain 1 --validate 0.3
  cylwatch identify run.csv --input shoulder --output gas_mean --order 2 --out model.json
  cylwatch identify run.csv --input shoulder --output gas_mean --method compensated-instruments \\
      --input-sd-k 0.05
  cylwatch identify logger.csv --map time=Timestamp --map shoulder_degc=T1 --map gas_top_degc=T2 \\
      --input shoulder --output gas_top";

/// Method of identification.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum MethodName {
    /// Least squares of the simulation's errors, as MATLAB's tfest.
    OutputError,
    /// Simplified refined instrumental variables (SRIVC).
    RefinedInstruments,
    /// Least squares less the bias of known noise; needs --input-sd and --output-sd.
    BiasCompensated,
    /// Refined instruments less the bias of known noise of the input; needs --input-sd.
    CompensatedInstruments,
    /// Instruments from another sensor of the input; needs --second.
    SecondSensor,
    /// Maximum likelihood of both readings by a Kalman filter; needs --input-sd and --output-sd.
    MaximumLikelihood,
}

/// Course of the input between its samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum HoldName {
    /// Straight from sample to sample.
    First,
    /// Constant from a sample to the next one.
    Zero,
}

/// Course of the true input.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum InputModelName {
    /// Random walk.
    RandomWalk,
    /// Integrated random walk: smooth.
    IntegratedRandomWalk,
}

impl From<InputModelName> for InputModel {
    fn from(name: InputModelName) -> Self {
        match name {
            InputModelName::RandomWalk => Self::RandomWalk,
            InputModelName::IntegratedRandomWalk => Self::IntegratedRandomWalk,
        }
    }
}

/// What is supposed of the errors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ErrorsName {
    /// White unless a test at 1 % rejects it.
    Judged,
    /// White.
    White,
    /// Correlated.
    Coloured,
}

/// First model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum StartName {
    /// State-variable filter, then instruments as far as they help.
    InstrumentalVariables,
    /// State-variable filter alone.
    StateVariableFilter,
}

impl IdentifyArguments {
    /// Structure of the model.
    pub(crate) fn structure(&self, quantities: &Quantities) -> anyhow::Result<Structure> {
        Ok(Structure {
            order: self.order,
            zeros: self.zeros.unwrap_or(self.order.saturating_sub(1)),
            dead_time: match quantities.dead_time()? {
                (None, None) => DeadTime::None,
                (Some(fixed_s), None) => DeadTime::Fixed(fixed_s),
                (None, Some(longest_s)) => DeadTime::Free(longest_s),
                _ => anyhow::bail!("--dead-time fixes what --longest-dead-time leaves free: keep one"),
            },
            gain: self.gain,
            offset: self.offset,
            initial: self.initial.clone(),
        })
    }

    /// Settings of the search.
    pub(crate) fn settings(&self, quantities: &Quantities) -> anyhow::Result<Settings> {
        Ok(Settings {
            iterations: self.iterations,
            start: match self.start {
                StartName::InstrumentalVariables => StartMethod::InstrumentalVariables,
                StartName::StateVariableFilter => StartMethod::StateVariableFilter,
            },
            errors: match self.errors {
                ErrorsName::Judged => ErrorModel::Judged,
                ErrorsName::White => ErrorModel::White,
                ErrorsName::Coloured => ErrorModel::Coloured,
            },
            longest_gap_s: quantities.longest_gap_s()?,
            lags: self.lags,
            ..Settings::default()
        })
    }
}

fn initial(text: &str) -> Result<InitialState, String> {
    match text {
        "estimated" => Ok(InitialState::Estimated),
        "zero" => Ok(InitialState::Zero),
        "settled" => Ok(InitialState::Settled),
        numbers => {
            let values = numbers.split(',').map(|number| number.trim().parse::<f64>());
            let values = values.collect::<Result<Vec<_>, _>>();
            values
                .map(InitialState::Given)
                .map_err(|_| "write estimated, zero, settled, or numbers".to_owned())
        }
    }
}

fn gain(text: &str) -> Result<Gain, String> {
    match text {
        "free" => Ok(Gain::Free),
        number => number.parse().map(Gain::Fixed).map_err(|_| "write free, or a number".to_owned()),
    }
}

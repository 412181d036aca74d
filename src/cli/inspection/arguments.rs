//! The raw arguments of `inspection`.
use crate::cli::fill::GivenFill;
use crate::cli::number::{above, within};
use crate::cli::options::{
    DataArguments, EXPERT, HELP_FOOTER, LogArguments, ReportArguments, SensorArguments,
};
use crate::cli::unit_options::{Choice, Choices, QuantityArguments};
use crate::thermal::units::Dimension;
use clap::{Arg, Args, Command, ValueEnum};
use jiff::civil::Date;

/// What was read, and what pressures are adjusted to.
#[derive(Clone, Debug)]
pub(crate) struct InspectionQuantities;

impl Choices for InspectionQuantities {
    const CHOICES: &'static [Choice] = &[
        ("pressure", Dimension::Pressure, "Pressure as read, instead of logs"),
        ("temperature", Dimension::Temperature, "Temperature as read beside it"),
        (
            "rested",
            Dimension::Time,
            "How long the surroundings have been at about that temperature [default: not known]",
        ),
        (
            "reference",
            Dimension::Temperature,
            "Temperature that pressures are adjusted to [default: 15 degc]",
        ),
    ];
    const EXPERT: &'static [&'static str] = &["reference"];
}

/// Where the thermometer of a single reading is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ThermometerPlace {
    /// On the cylinder's shoulder.
    Wall,
    /// In the air about the cylinder.
    Air,
}

/// Arguments of `inspection`.
#[derive(Debug, Args)]
#[command(after_help = HELP_FOOTER, after_long_help = HELP)]
pub(crate) struct InspectionArguments {
    /// Vessel: a TOML file, the name of a built-in one, or - for stdin.
    pub vessel: String,
    /// Logs, a cylinder each; folders of logs; or a CSV file of single readings with a column `cylinder`.
    pub logs: Vec<String>,
    #[command(flatten)]
    pub given: QuantityArguments<InspectionQuantities>,
    /// Where the thermometer of single readings is.
    #[arg(long, value_enum, default_value = "wall")]
    pub thermometer: ThermometerPlace,
    /// Accuracy class of the gauge of single readings, in % of its range (EN 837-1), which is that of the fill.
    #[arg(long, value_name = "NUMBER", default_value_t = 1.6, value_parser = above(0.0).at_most(10.0))]
    pub gauge_class_percent: f64,
    #[command(flatten)]
    pub fill: GivenFill,
    /// Largest loss of pressure adjusted for temperature, in % of the fill's.
    #[arg(long, value_name = "NUMBER", default_value_t = 5.0, value_parser = above(0.0).at_most(99.0))]
    pub loss_limit_percent: f64,
    /// Probability from which on a cylinder passes or is to be refilled, in %.
    #[arg(long, value_name = "NUMBER", default_value_t = 95.0, value_parser = within(50.1, 99.9999))]
    pub certainty_percent: f64,
    /// Date of the inspection, as 2026-11-27 [default: that of a log's last row].
    #[arg(long, value_name = "DATE")]
    pub date: Option<Date>,
    /// Date of the last comparison of the gauge, for the date of the next.
    #[arg(long, value_name = "DATE")]
    pub gauge_compared: Option<Date>,
    /// Months from one inspection to the next.
    #[arg(long, value_name = "NUMBER", default_value_t = 6, value_parser = within(1, 240), help_heading = EXPERT)]
    pub inspection_months: i32,
    /// Months from one comparison of the gauge to the next.
    #[arg(long, value_name = "NUMBER", default_value_t = 12, value_parser = within(1, 240), help_heading = EXPERT)]
    pub gauge_months: i32,
    #[command(flatten)]
    pub data: DataArguments,
    #[command(flatten)]
    pub report: ReportArguments,
    #[command(flatten)]
    pub reading: LogArguments,
    #[command(flatten)]
    pub sensors: SensorArguments,
}

/// The options of the fill without what a log would say of it: here nothing is taken from a log.
pub(in crate::cli) fn without_fill_of_log(command: Command) -> Command {
    let needed = |arg: Arg| match arg.get_id().as_str() {
        "fill-pressure-bar" => {
            arg.help("Pressure that the cylinder was filled to, in bar absolute").long_help(None::<&str>)
        }
        "fill-temperature-degc" => {
            arg.help("Temperature at which it was so, in degc").long_help(None::<&str>)
        }
        "mass_sd_percent" => arg
            .help("Standard deviation of the gas mass of the fill, in % [default: 1]")
            .long_help(None::<&str>),
        "settled" => {
            arg.help("Gas, wall and air had one temperature at the first row of the log, within 1 K")
        }
        _ => arg,
    };
    command.mut_args(needed)
}

const HELP: &str = "\
The fill is what the cylinder was filled with: --fill-pressure-bar and --fill-temperature-degc, or
--fill-mass-kg. The log does not tell it, so one of them is needed.

A file of single readings has a row for each cylinder: cylinder, pressure_bar (or _barg, _psig ...),
temperature_degc, and if known rested_h, date, fill_pressure_bar with fill_temperature_degc.

Columns:
  cylinder, date         name of the log or row, and when
  judgement              pass, refill or cannot-be-told
  refill_probability     that the loss is above the limit
  adjusted_bar, _low_, _high_   pressure at the reference temperature, with its 95 % interval
  filled_bar             the same of the fill
  loss_percent, _low_, _high_   loss of that pressure against the fill, with its 95 % interval
  basis                  what the judgement rests on
  reason                 why it cannot be told, and what would help
  next_inspection, next_gauge_comparison   dates due

The criterion is that of ISO 14520 as a setting: a loss of pressure, adjusted for temperature, of more
than 5 %; contents at least every six months, gauges compared at least once a year. The outcome is no
certificate.

Exit codes: 0 all pass, 1 a cylinder is to be refilled, 2 error, 3 none is, and of some it cannot be told.

Examples:
  cylwatch inspection nitrogen-20l week.csv --fill-pressure-bar 200 --fill-temperature-degc 15
  cylwatch inspection nitrogen-20l logs/ --fill-pressure-bar 200 --fill-temperature-degc 15 --report page.html
  cylwatch inspection nitrogen-20l round.csv --fill-pressure-bar 200 --fill-temperature-degc 15 -o outcome.csv
  cylwatch inspection nitrogen-20l --pressure-barg 188 --temperature-degc 9 --rested-h 4 \\
      --fill-pressure-bar 200 --fill-temperature-degc 15";

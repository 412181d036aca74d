//! The raw arguments of `commission`.
use crate::cli::number::{above, at_least};
use crate::cli::options::FalseAlarmArguments;
use crate::cli::unit_options::{Choice, Choices, QuantityArguments};
use crate::evaluation::tails::Campaign;
use crate::evaluation::world::{Climate, GasKind, RowPattern, SensorClass};
use crate::thermal::units::Dimension;
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use std::path::PathBuf;
use std::str::FromStr;

/// Pressures of the cylinder and its transmitter.
#[derive(Clone, Debug)]
pub(crate) struct CommissionQuantities;

impl Choices for CommissionQuantities {
    const CHOICES: &'static [Choice] = &[
        (
            "fill-pressure",
            Dimension::Pressure,
            "Pressure that cylinders are filled to at 15 degC; they are drawn from 0.9 of it on [default: 200 bar]",
        ),
        (
            "full-scale",
            Dimension::Pressure,
            "Upper end of the transmitter's range [default: 1.25 of the fill]",
        ),
    ];
}

/// Arguments of `commission`.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct CommissionArguments {
    /// Vessel: a TOML file, the name of a built-in one, or - for stdin.
    pub vessel: String,
    /// JSON file for the thresholds; - is stdout.
    #[arg(long, short, value_name = "FILE")]
    pub output: PathBuf,
    /// Pressures.
    #[command(flatten)]
    pub pressures: QuantityArguments<CommissionQuantities>,
    /// Climates, gone through in turn as all lists; a kind that is named twice comes twice as often.
    #[arg(long = "climate", value_name = "LIST", value_delimiter = ',', value_parser = kinds(Climate::ALL, Climate::key),
        default_value = listed(&Campaign::default().climates))]
    pub climates: Vec<Climate>,
    /// How gas and wall of the simulated cylinders are resolved.
    #[arg(long = "gas", value_name = "LIST", value_delimiter = ',', value_parser = kinds(GasKind::ALL, GasKind::key),
        default_value = listed(&Campaign::default().gases))]
    pub gases: Vec<GasKind>,
    /// Classes of sensors; every cylinder has a set of each.
    #[arg(long = "sensor-class", value_name = "LIST", value_delimiter = ',',
        value_parser = kinds(SensorClass::ALL, SensorClass::key), default_value = listed(&Campaign::default().sensors))]
    pub sensors: Vec<SensorClass>,
    /// How often rows come.
    #[arg(long = "row-interval", value_name = "LIST", value_delimiter = ',',
        value_parser = kinds(RowPattern::ALL, RowPattern::key), default_value = listed(&Campaign::default().rows))]
    pub rows: Vec<RowPattern>,
    /// Number of cylinders; the time goes with it.
    #[arg(long, value_name = "NUMBER", default_value_t = Campaign::default().cylinders, value_parser = at_least(1_usize))]
    pub cylinders: usize,
    /// Length of each log, in d; the slowest statistic makes use of whole months of it.
    #[arg(long, value_name = "NUMBER", default_value_t = Campaign::default().length_s / super::DAY_S, value_parser = above(0.0))]
    pub days: f64,
    #[command(flatten)]
    pub false_alarms: FalseAlarmArguments,
    /// Seed of cylinders and weather, a whole number of at least 0.
    #[arg(long, value_name = "NUMBER", default_value_t = Campaign::default().seed, value_parser = at_least(0_u64))]
    pub seed: u64,
    /// Shorten the stretches that largest values are taken of to an hour, to try the command out: the thresholds are of no use.
    #[arg(long, hide = true)]
    pub rehearsal: bool,
}

/// Kinds as they are given.
fn listed<T: ToString>(kinds: &[T]) -> String {
    kinds.iter().map(T::to_string).collect::<Vec<_>>().join(",")
}

/// A kind of an axis by its key.
fn kinds<T: FromStr + Copy + Send + Sync + 'static>(
    all: &'static [T],
    key: fn(T) -> &'static str,
) -> impl TypedValueParser<Value = T> {
    let keys = all.iter().map(|kind| key(*kind));
    PossibleValuesParser::new(keys).try_map(|word| word.parse::<T>().map_err(|_| "there is no such kind"))
}

const HELP: &str = "\
Simulates tight cylinders around the vessel, runs the monitor over them, and finds the thresholds
that its statistics exceed once in the stated time. The rate of false alarms that is stored with
them is that of one half of the cylinders at thresholds fitted to the other half.

A cylinder with another fill, another wall or other surroundings needs thresholds of its own. Some
100 cylinders of two months with two sets of sensors are the least that the slowest statistic can
be fitted to. Ctrl-C ends the run and leaves nothing.

Examples:
  cylwatch commission nitrogen-20l -o thresholds.json
  cylwatch commission my-cylinder.toml --fill-pressure-bar 300 -o thresholds.json
  cylwatch commission tank.toml --fill-pressure-bar 8 --climate parked,desert -o tank.json
  cylwatch monitor nitrogen-20l log.csv --commissioned thresholds.json";

//! Options of `identify` that have a unit: dead times, gaps, noises.
use crate::cli::unit_options::{self, Choice, Quantity};
use anyhow::bail;
use clap::{ArgMatches, Args, Command, FromArgMatches};
use cylwatch::report::identify::Signal;
use cylwatch::thermal::units::Dimension;

const QUANTITIES: &[Choice] = &[
    ("dead-time", Dimension::Time, "Known dead time [default: none]"),
    ("longest-dead-time", Dimension::Time, "Estimate a dead time up to this one"),
    (
        "longest-gap",
        Dimension::Time,
        "Longest gap of the input that is bridged [default: 20 usual intervals]",
    ),
    (
        "input-sd",
        Dimension::TemperatureDifference,
        "Standard deviation of the noise of an input that is a temperature, in k",
    ),
    (
        "input-sd",
        Dimension::PressureDifference,
        "Standard deviation of the noise of an input that is a pressure",
    ),
    (
        "output-sd",
        Dimension::TemperatureDifference,
        "Standard deviation of the noise of an output that is a temperature, in k",
    ),
    (
        "output-sd",
        Dimension::PressureDifference,
        "Standard deviation of the noise of an output that is a pressure",
    ),
];

const PASCAL_PER_BAR: f64 = 1e5;

/// Quantities as given.
#[derive(Clone, Debug, Default)]
pub struct Amounts {
    given: Vec<Quantity>,
}

impl Amounts {
    /// Known and longest dead time, s.
    pub fn dead_time(&self) -> anyhow::Result<(Option<f64>, Option<f64>)> {
        Ok((self.si("dead-time", Dimension::Time)?, self.si("longest-dead-time", Dimension::Time)?))
    }

    /// Longest gap that is bridged, s.
    pub fn longest_gap_s(&self) -> anyhow::Result<Option<f64>> {
        self.si("longest-gap", Dimension::Time)
    }

    /// Variance of a column's noise in its unit squared; `option` is `input-sd` or `output-sd`.
    pub fn variance(&self, option: &str, signal: &Signal) -> anyhow::Result<f64> {
        let (asked, other) = (Dimension::TemperatureDifference, Dimension::PressureDifference);
        let (asked, other, unit) =
            if signal.is_temperature() { (asked, other, 1.0) } else { (other, asked, PASCAL_PER_BAR) };
        let name = &signal.name;
        if let Some(wrong) = self.of(option, other).next() {
            bail!("{}: {name} is in {}, which is another quantity", wrong.name, signal.unit);
        }
        match self.si(option, asked)? {
            Some(sd) => Ok((sd / unit).powi(2)),
            None => bail!(
                "the method needs to know the noise of {name}: give --{option}-{}",
                signal.difference.to_lowercase()
            ),
        }
    }

    /// Whether any noise was given.
    pub fn has_noise(&self) -> bool {
        self.given.iter().any(|quantity| quantity.dimension != Dimension::Time)
    }

    fn of<'a>(&'a self, option: &'a str, dimension: Dimension) -> impl Iterator<Item = &'a Quantity> {
        let start = format!("--{option}-");
        self.given.iter().filter(move |given| given.dimension == dimension && given.name.starts_with(&start))
    }

    fn si(&self, option: &str, dimension: Dimension) -> anyhow::Result<Option<f64>> {
        let mut given = self.of(option, dimension);
        match (given.next(), given.next()) {
            (Some(first), Some(second)) => {
                bail!("{} says again what {} says: keep one", second.name, first.name)
            }
            (first, _) => first.map(Quantity::si).transpose(),
        }
    }
}

impl Args for Amounts {
    fn augment_args(command: Command) -> Command {
        unit_options::augment(command, QUANTITIES, |arg| arg)
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for Amounts {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        Ok(Self { given: unit_options::given(matches, QUANTITIES) })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

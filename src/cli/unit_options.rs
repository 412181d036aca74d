//! Options that are a quantity with its unit, as `--pressure-bar 200`: one for every unit of the quantity.
//!
//! The help shows the customary unit; the long help names the others.
use super::number::finite;
use super::options::EXPERT;
use crate::thermal::units::{self, Dimension, Unit};
use anyhow::bail;
use clap::parser::ValueSource;
use clap::{Arg, ArgMatches, Args, Command, FromArgMatches};
use std::marker::PhantomData;

/// A quantity that can be given: name, what it measures, words of its help, with the unit if it is the only one.
pub(super) type Choice = (&'static str, Dimension, &'static str);

/// A quantity with the name it was given by.
#[derive(Clone, Debug)]
pub(super) struct Quantity {
    /// Option or column.
    pub name: String,
    /// Unit of the value.
    pub unit: &'static Unit,
    /// What it measures.
    pub dimension: Dimension,
    /// Value as given.
    pub value: f64,
}

impl Quantity {
    /// SI value; above zero, as an absolute temperature, pressure or density is. A film may be 0: an insulated surface.
    pub(super) fn si(&self) -> anyhow::Result<f64> {
        let (name, value, unit) = (&self.name, self.value, self.unit);
        if !value.is_finite() {
            bail!("{name} = {value} must be a finite number");
        }
        let si = unit.to_si(value);
        if self.dimension == Dimension::Film && si == 0.0 {
            return Ok(si);
        }
        if si <= 0.0 {
            bail!("{name} = {value} must be above {}: check the number and its unit", unit.from_si(0.0));
        }
        Ok(si)
    }
}

/// Every option: its quantity, name, unit, and whether it is the first of its quantity.
fn options(known: &'static [Choice]) -> impl Iterator<Item = (&'static Choice, String, &'static Unit, bool)> {
    known.iter().flat_map(|quantity| {
        units::units_of(quantity.1).enumerate().map(move |(k, unit)| {
            (quantity, format!("{}-{}", quantity.0, unit.suffix.replace('_', "-")), unit, k == 0)
        })
    })
}

/// Adds the options to a command.
fn augment<C: Choices>(command: Command) -> Command {
    options(C::CHOICES).fold(command, |command, (&(quantity, dimension, words), name, unit, first)| {
        let others: Vec<&str> = units::units_of(dimension).skip(1).map(|unit| unit.suffix).collect();
        let absolute = if dimension == Dimension::Pressure { " absolute" } else { "" };
        let (words, default) = words.split_at(words.find(" [default").unwrap_or(words.len()));
        let [help, long_help] = match others.len() {
            0 => [format!("{words}{default}"), format!("{words}{default}")],
            _ => [
                format!("{words}, in {}{absolute}{default}", unit.suffix),
                format!(
                    "{words}, in {}{absolute} (other units: {}){default}",
                    unit.suffix,
                    others.join(", ")
                ),
            ],
        };
        let arg = Arg::new(name.clone())
            .long(name)
            .value_name("NUMBER")
            .value_parser(finite())
            .hide(!first)
            .help(help)
            .long_help(long_help);
        let arg = match C::EXPERT.contains(&quantity) {
            true => arg.help_heading(EXPERT),
            false => arg,
        };
        command.arg(C::finish(arg))
    })
}

/// The quantities that were given.
fn given(matches: &ArgMatches, known: &'static [Choice]) -> Vec<Quantity> {
    let given = options(known).filter_map(|(&(_, dimension, _), name, unit, _)| {
        if matches.value_source(&name) != Some(ValueSource::CommandLine) {
            return None;
        }
        let value = *matches.get_one::<f64>(&name)?;
        Some(Quantity { name: format!("--{name}"), unit, dimension, value })
    });
    given.collect()
}

/// The quantities of a command.
pub(super) trait Choices {
    /// Every quantity that can be given.
    const CHOICES: &'static [Choice];

    /// Those that few need; the short help leaves them out.
    const EXPERT: &'static [&'static str] = &[];

    /// May change each option.
    fn finish(option: Arg) -> Arg {
        option
    }
}

/// Quantities given as options, each in any unit of its dimension.
#[derive(Clone, Debug)]
pub(super) struct QuantityArguments<C> {
    /// In the order of the choices.
    pub quantities: Vec<Quantity>,
    choices: PhantomData<C>,
}

impl<C: Choices> QuantityArguments<C> {
    /// Quantities of an option's name that measure something of this kind.
    pub(super) fn of<'a>(&'a self, option: &str, dimension: Dimension) -> impl Iterator<Item = &'a Quantity> {
        let start = format!("--{option}-");
        self.quantities
            .iter()
            .filter(move |given| given.dimension == dimension && given.name.starts_with(&start))
    }

    /// What is given here, and what is not as in `defaults`.
    pub(super) fn or(mut self, defaults: &Self) -> Self {
        for (option, dimension, _) in C::CHOICES {
            if self.of(option, *dimension).next().is_none() {
                self.quantities.extend(defaults.of(option, *dimension).cloned());
            }
        }
        self
    }

    /// SI value of an option; given twice, in two units, it is refused.
    pub(super) fn si(&self, option: &str, dimension: Dimension) -> anyhow::Result<Option<f64>> {
        self.once(option, dimension)?.map(Quantity::si).transpose()
    }

    /// The same of a quantity that may be 0.
    pub(super) fn si_from_zero(&self, option: &str, dimension: Dimension) -> anyhow::Result<Option<f64>> {
        let given = self.once(option, dimension)?;
        given.map(|given| if given.value == 0.0 { Ok(0.0) } else { given.si() }).transpose()
    }

    fn once(&self, option: &str, dimension: Dimension) -> anyhow::Result<Option<&Quantity>> {
        let mut given = self.of(option, dimension);
        match (given.next(), given.next()) {
            (Some(first), Some(second)) => {
                bail!("{} and {} state the same quantity: keep one", first.name, second.name)
            }
            (first, _) => Ok(first),
        }
    }
}

impl<C: Choices> Args for QuantityArguments<C> {
    fn augment_args(command: Command) -> Command {
        augment::<C>(command)
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl<C: Choices> FromArgMatches for QuantityArguments<C> {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        Ok(Self { quantities: given(matches, C::CHOICES), choices: PhantomData })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

//! Options of `calibrate` that have a unit: film, wind, gaps.
use crate::cli::unit_options::{self, Choice, Quantity};
use anyhow::bail;
use clap::{ArgMatches, Args, Command, FromArgMatches};
use cylwatch::thermal::units::Dimension;

const QUANTITIES: &[Choice] = &[
    (
        "film",
        Dimension::Film,
        "Film coefficient outside with radiation, in w_m2_k, where the log is the scenario [default: still air and radiation]",
    ),
    ("wind", Dimension::Speed, "Wind across the axis, where the log is the scenario [default: none]"),
    (
        "longest-gap",
        Dimension::Time,
        "Longest gap of the air temperature that is bridged [default: 20 usual intervals]",
    ),
];

/// Quantities as given.
#[derive(Clone, Debug, Default)]
pub struct Amounts {
    given: Vec<Quantity>,
}

impl Amounts {
    /// Film coefficient, W/(m² K).
    pub fn film_w_m2_k(&self) -> anyhow::Result<Option<f64>> {
        self.si("film", Dimension::Film)
    }

    /// Wind, m/s.
    pub fn wind_m_s(&self) -> anyhow::Result<Option<f64>> {
        self.si("wind", Dimension::Speed)
    }

    /// Longest gap that is bridged, s.
    pub fn longest_gap_s(&self) -> anyhow::Result<Option<f64>> {
        self.si("longest-gap", Dimension::Time)
    }

    fn si(&self, option: &str, dimension: Dimension) -> anyhow::Result<Option<f64>> {
        let start = format!("--{option}-");
        let of = |given: &&Quantity| given.dimension == dimension && given.name.starts_with(&start);
        let mut given = self.given.iter().filter(of);
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

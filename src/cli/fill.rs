//! Options that say what is known of the cylinder at the first row of a log.
use super::unit_options::{self, Choice, Quantity};
use anyhow::bail;
use clap::{Arg, ArgAction, ArgMatches, Args, Command, FromArgMatches, value_parser};
use cylwatch::estimator::observer::Commissioning;
use cylwatch::thermal::scenario::Fill;
use cylwatch::thermal::units::Dimension;
use cylwatch::thermal::vessel::Vessel;

/// Quantities that fix the mass.
const QUANTITIES: &[Choice] = &[
    (
        "fill-pressure",
        Dimension::Pressure,
        "Pressure that the cylinder was filled to [default: the first pressure of the log]",
    ),
    (
        "fill-temperature",
        Dimension::Temperature,
        "Temperature at which it had that pressure, settled [default: that of the first row]",
    ),
    ("fill-mass", Dimension::Mass, "Gas mass, instead of pressure and temperature"),
];

const MASS_SD: &str = "fill-sd-percent";
const UNSETTLED: &str = "unsettled";

/// Standard deviation of the mass where nobody states it, %: 1.7 K and 1.7 bar together at 200 bar.
const MASS_SD_PERCENT: f64 = 1.0;

/// Fill as given.
#[derive(Clone, Debug, Default)]
pub struct GivenFill {
    given: Vec<Quantity>,
    mass_sd_percent: Option<f64>,
    unsettled: bool,
}

/// What fixes the mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FillSource {
    /// The options alone.
    Given(Fill),
    /// The first pressure of the log.
    FirstPressure,
}

impl GivenFill {
    /// What fixes the mass.
    pub fn source(&self) -> anyhow::Result<FillSource> {
        let si = |dimension| -> anyhow::Result<Option<f64>> {
            let mut given = self.given.iter().filter(|quantity| quantity.dimension == dimension);
            match (given.next(), given.next()) {
                (Some(first), Some(second)) => {
                    bail!("{} says again what {} says: keep one", second.name, first.name)
                }
                (first, _) => first.map(Quantity::si).transpose(),
            }
        };
        let pressure_pa = si(Dimension::Pressure)?;
        let temperature_k = si(Dimension::Temperature)?;
        let mass_kg = si(Dimension::Mass)?;
        Ok(match (mass_kg, pressure_pa, temperature_k) {
            (Some(mass_kg), None, None) => FillSource::Given(Fill::Mass { mass_kg }),
            (Some(_), _, _) => bail!("--fill-mass fixes the mass: leave out pressure and temperature"),
            (None, Some(pressure_pa), Some(temperature_k)) => {
                FillSource::Given(Fill::Settled { pressure_pa, temperature_k })
            }
            (None, Some(pressure_pa), None) => FillSource::Given(Fill::Pressure { pressure_pa }),
            (None, None, Some(_)) => {
                bail!("--fill-temperature needs the pressure at that temperature: add --fill-pressure-bar")
            }
            (None, None, None) => FillSource::FirstPressure,
        })
    }

    /// What is known at the first row. `first_k` is the temperature that stands for one that is not given, K.
    pub fn commissioning(&self, fill: Fill, vessel: &Vessel, first_k: f64) -> anyhow::Result<Commissioning> {
        let percent = self.mass_sd_percent.unwrap_or(MASS_SD_PERCENT);
        if !(percent > 0.0 && percent <= 100.0) {
            bail!("--{MASS_SD} = {percent} must be above 0 and at most 100");
        }
        let one = Commissioning { fill, mass_sd_kg: 1.0, settled: !self.unsettled };
        let mass_kg = one.mass_kg(vessel, first_k)?;
        Ok(Commissioning { mass_sd_kg: percent / 100.0 * mass_kg, ..one })
    }
}

impl Args for GivenFill {
    fn augment_args(command: Command) -> Command {
        let percent = Arg::new(MASS_SD)
            .long(MASS_SD)
            .value_name("NUMBER")
            .value_parser(value_parser!(f64))
            .help("Standard deviation of the gas mass that the fill stands for, in % of it [default: 1]");
        let unsettled = Arg::new(UNSETTLED)
            .long(UNSETTLED)
            .action(ArgAction::SetTrue)
            .help("Gas and wall may differ in temperature at the first row");
        unit_options::augment(command, QUANTITIES, |arg| arg).arg(percent).arg(unsettled)
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for GivenFill {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        Ok(Self {
            given: unit_options::given(matches, QUANTITIES),
            mass_sd_percent: matches.get_one(MASS_SD).copied(),
            unsettled: matches.get_flag(UNSETTLED),
        })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

//! Options that say what is known of the cylinder at the first row of a log.
use super::number::above;
use super::options::EXPERT;
use super::unit_options::{Choice, Choices, QuantityArguments};
use crate::estimator::observer::{Commissioning, ObserverSettings};
use crate::thermal::units::{Dimension, ZERO_CELSIUS_K};
use crate::thermal::vessel::Fill;
use crate::thermal::vessel::Vessel;
use anyhow::{anyhow, bail};
use clap::Args;

/// Quantities that fix the mass.
#[derive(Clone, Debug)]
pub(super) struct FillQuantities;

impl Choices for FillQuantities {
    const CHOICES: &'static [Choice] = &[
        ("fill-pressure", Dimension::Pressure, "Fill pressure [default: the first pressure of the log]"),
        (
            "fill-temperature",
            Dimension::Temperature,
            "Temperature of the fill at rest [default: that of the first row]",
        ),
        ("fill-mass", Dimension::Mass, "Gas mass, instead of pressure and temperature"),
    ];
}

/// Standard deviation of the mass of a fill of known pressure and temperature, %: 1.7 K and 1.7 bar together at 200 bar.
const MASS_SD_PERCENT: f64 = 1.0;
/// Standard deviation of the gas temperature where the first row's readings stand for it and the cylinder is at rest, K.
const SETTLED_SD_K: f64 = 1.0;

/// A fill that is the transmitter's own first reading is off by what the transmitter is. The observer takes that reading once more: the prior
/// is so much wider that it does not count twice.
const DOUBLE_USE_FACTOR: f64 = 3.0;

/// Fill as given.
#[derive(Clone, Debug, Args)]
pub(super) struct GivenFill {
    #[command(flatten)]
    given: QuantityArguments<FillQuantities>,

    /// Standard deviation of the gas mass of the fill, in % [default: 1; where the temperature is that of the first row, the
    /// effect of 10 K is added, of 1 K with --settled].
    #[arg(long = "fill-sd-percent", value_name = "NUMBER", value_parser = above(0.0).at_most(100.0), help_heading = EXPERT)]
    mass_sd_percent: Option<f64>,

    /// Gas, wall and air have one temperature at the first row, within 1 K.
    #[arg(long)]
    settled: bool,
}

/// What fixes the mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum FillSource {
    /// The options alone.
    Given(Fill),
    /// The first pressure of the log.
    FirstPressure,
}

impl GivenFill {
    /// What is given here, and what is not as in `defaults`: a fill goes as a whole.
    pub(super) fn or(self, defaults: &Self) -> Self {
        Self {
            given: if self.given.quantities.is_empty() { defaults.given.clone() } else { self.given },
            mass_sd_percent: self.mass_sd_percent.or(defaults.mass_sd_percent),
            settled: self.settled || defaults.settled,
        }
    }

    /// What fixes the mass.
    pub(super) fn source(&self) -> anyhow::Result<FillSource> {
        let pressure_pa = self.given.si("fill-pressure", Dimension::Pressure)?;
        let temperature_k = self.given.si("fill-temperature", Dimension::Temperature)?;
        let mass_kg = self.given.si("fill-mass", Dimension::Mass)?;
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

    /// The options as they were given, to tell another fill from the same; `None`: none was.
    pub(super) fn text(&self) -> Option<String> {
        let quantities = self.given.quantities.iter().map(|given| format!("{} {}", given.name, given.value));
        let percent = self.mass_sd_percent.map(|percent| format!("--fill-sd-percent {percent}"));
        let settled = self.settled.then(|| "--settled".to_owned());
        let words: Vec<String> = quantities.chain(percent).chain(settled).collect();
        (!words.is_empty()).then(|| words.join(" "))
    }

    /// What is known at the first row. `first_k` is the temperature that stands for one that is not given, K.
    /// `read_sd_pa` is the standard deviation of what a transmitter is off by all the time, Pa, where the fill is what it read first.
    pub(super) fn commissioning(
        &self,
        fill: Fill,
        vessel: &Vessel,
        first_k: f64,
        read_sd_pa: f64,
    ) -> anyhow::Result<Commissioning> {
        let percent = self.mass_sd_percent.unwrap_or(MASS_SD_PERCENT);
        let one = Commissioning { fill, mass_sd: percent / 100.0, settled: self.settled };
        let mass_kg = one.mass_kg(vessel, first_k)?;
        let of_temperature_kg = match (fill, self.mass_sd_percent) {
            (Fill::Pressure { .. }, None) => {
                let sd_k = if self.settled { SETTLED_SD_K } else { Commissioning::UNSETTLED_SD_K };
                0.5 * (one.mass_kg(vessel, first_k - sd_k)? - one.mass_kg(vessel, first_k + sd_k)?)
            }
            _ => 0.0,
        };
        let of_reading_kg = match (fill, self.mass_sd_percent) {
            (Fill::Pressure { pressure_pa }, None) if read_sd_pa > 0.0 => {
                let more =
                    Commissioning { fill: Fill::Pressure { pressure_pa: pressure_pa + read_sd_pa }, ..one };
                DOUBLE_USE_FACTOR * (more.mass_kg(vessel, first_k)? - mass_kg)
            }
            _ => 0.0,
        };
        let of_first_row_kg = of_temperature_kg.hypot(of_reading_kg);
        Ok(Commissioning { mass_sd: one.mass_sd.hypot(of_first_row_kg / mass_kg), ..one })
    }

    /// Whether all is said to be at rest at the first row.
    pub(super) fn is_settled(&self) -> bool {
        self.settled
    }
}

/// Settings of an observer for the start of a log: unless it is stated to be at rest, the air may have any temperature.
pub(super) fn settings(settings: ObserverSettings, settled: bool) -> ObserverSettings {
    let mut settings = settings;
    if !settled {
        settings.air.prior_sd = Commissioning::UNSETTLED_AIR_SD_K;
    }
    settings
}

/// How a fill contradicts the first pressure of the log (`read_pa`, Pa; NaN: none): an error where they are a factor of
/// three apart, words for a caution from a quarter on. `fill_pa` is the pressure of `mass_kg` at `temperature_k`.
pub(super) fn misfit(
    mass_kg: f64,
    temperature_k: f64,
    fill_pa: f64,
    read_pa: f64,
) -> anyhow::Result<Option<String>> {
    let ratio = (fill_pa / read_pa).max(read_pa / fill_pa);
    if ratio.is_nan() || ratio < 1.25 {
        return Ok(None);
    }
    let [fill_bar, read_bar] = [fill_pa, read_pa].map(|pressure_pa| pressure_pa / 1e5);
    let degc = temperature_k - ZERO_CELSIUS_K;
    let words = format!(
        "the fill of {mass_kg:.3} kg makes {fill_bar:.1} bar at {degc:.0} °C in this vessel, and the log begins with \
         {read_bar:.1} bar: look at vessel, fill and unit of the pressure"
    );
    if ratio > 3.0 { Err(anyhow!(words)) } else { Ok(Some(words)) }
}

//! Options of `identify` that have a unit: dead times, gaps, noises.
use crate::cli::unit_options::{Choice, Choices, QuantityArguments};
use crate::report::identify::Signal;
use crate::thermal::units::{BAR_PA, Dimension};
use anyhow::bail;

/// What can be given.
#[derive(Clone, Debug)]
pub(crate) struct QuantityOptions;

impl Choices for QuantityOptions {
    const EXPERT: &'static [&'static str] =
        &["dead-time", "longest-dead-time", "longest-gap", "input-sd", "output-sd"];
    const CHOICES: &'static [Choice] = &[
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
}

/// Quantities as given.
pub(super) type Quantities = QuantityArguments<QuantityOptions>;

impl Quantities {
    /// Known and longest dead time, s.
    pub(crate) fn dead_time(&self) -> anyhow::Result<(Option<f64>, Option<f64>)> {
        Ok((self.si("dead-time", Dimension::Time)?, self.si("longest-dead-time", Dimension::Time)?))
    }

    /// Longest gap that is bridged, s.
    pub(crate) fn longest_gap_s(&self) -> anyhow::Result<Option<f64>> {
        self.si("longest-gap", Dimension::Time)
    }

    /// Variance of a column's noise in its unit squared; `option` is `input-sd` or `output-sd`.
    pub(crate) fn variance(&self, option: &str, signal: &Signal) -> anyhow::Result<f64> {
        let (asked, other) = (Dimension::TemperatureDifference, Dimension::PressureDifference);
        let (asked, other, unit) =
            if signal.is_temperature() { (asked, other, 1.0) } else { (other, asked, BAR_PA) };
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
    pub(crate) fn has_noise(&self) -> bool {
        self.quantities.iter().any(|quantity| quantity.dimension != Dimension::Time)
    }
}

//! Options of `calibrate` that have a unit: film, wind, gaps.
use crate::cli::unit_options::{Choice, Choices, QuantityArguments};
use crate::thermal::units::Dimension;

/// What can be given.
#[derive(Clone, Debug)]
pub(crate) struct QuantityOptions;

impl Choices for QuantityOptions {
    const EXPERT: &'static [&'static str] = &["film", "wind", "longest-gap"];
    const CHOICES: &'static [Choice] = &[
        (
            "film",
            Dimension::Film,
            "Film coefficient outside with radiation, in w_m2_k, without --scenario [default: still air and radiation]",
        ),
        ("wind", Dimension::Speed, "Wind across the axis, without --scenario [default: none]"),
        (
            "longest-gap",
            Dimension::Time,
            "Longest gap of the air temperature that is bridged [default: 20 usual intervals]",
        ),
    ];
}

/// Quantities as given.
pub(super) type Quantities = QuantityArguments<QuantityOptions>;

impl Quantities {
    /// Film coefficient, W/(m² K).
    pub(crate) fn film_w_m2_k(&self) -> anyhow::Result<Option<f64>> {
        self.si("film", Dimension::Film)
    }

    /// Wind, m/s.
    pub(crate) fn wind_m_s(&self) -> anyhow::Result<Option<f64>> {
        self.si("wind", Dimension::Speed)
    }

    /// Longest gap that is bridged, s.
    pub(crate) fn longest_gap_s(&self) -> anyhow::Result<Option<f64>> {
        self.si("longest-gap", Dimension::Time)
    }
}

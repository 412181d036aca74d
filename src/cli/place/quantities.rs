//! Options of `place` that have a unit: where the cylinder stands, what is to be found, how long is searched.
use crate::cli::unit_options::{Choice, Choices, QuantityArguments};
use crate::estimator::placement::Conditions;
use crate::thermal::units::Dimension;
use std::time::Duration;

/// What can be given.
#[derive(Clone, Debug)]
pub(crate) struct QuantityOptions;

impl Choices for QuantityOptions {
    const EXPERT: &'static [&'static str] =
        &["leak", "within", "fill-temperature", "body-temperature", "air-temperature", "time-limit"];
    const CHOICES: &'static [Choice] = &[
        ("leak", Dimension::MassFlow, "Leak whose delay is stated [default: 10 g/h]"),
        (
            "within",
            Dimension::Time,
            "Time within which the smallest leak and a fault must be found [default: 1 d]",
        ),
        ("sample-time", Dimension::Time, "Interval of the readings [default: 1 min]"),
        ("fill-pressure", Dimension::Pressure, "Pressure that the cylinder was filled to [default: 200 bar]"),
        (
            "fill-temperature",
            Dimension::Temperature,
            "Temperature at which it had that pressure [default: 15 degc]",
        ),
        (
            "body-temperature",
            Dimension::Temperature,
            "Temperature of wall and gas at rest [default: 15 degc]",
        ),
        (
            "air-temperature",
            Dimension::Temperature,
            "Temperature of the surroundings at rest [default: that of the body]",
        ),
        ("time-limit", Dimension::Time, "End the search after this time with what it has [default: none]"),
    ];
}

/// Quantities as given.
pub(super) type Quantities = QuantityArguments<QuantityOptions>;

impl Quantities {
    /// Where the cylinder rests and how often it is read.
    pub(crate) fn conditions(&self) -> anyhow::Result<Conditions> {
        let usual = Conditions::default();
        let temperature = |name| self.si(name, Dimension::Temperature);
        let (pressure_pa, temperature_k) = usual.filling;
        let body_k = temperature("body-temperature")?.unwrap_or(usual.body_k);
        Ok(Conditions {
            filling: (
                self.si("fill-pressure", Dimension::Pressure)?.unwrap_or(pressure_pa),
                temperature("fill-temperature")?.unwrap_or(temperature_k),
            ),
            body_k,
            air_k: temperature("air-temperature")?.unwrap_or(body_k),
            interval_s: self.si("sample-time", Dimension::Time)?.unwrap_or(usual.interval_s),
            ..usual
        })
    }

    /// Leak whose delay is stated, kg/s.
    pub(crate) fn leak_kg_s(&self) -> anyhow::Result<Option<f64>> {
        self.si("leak", Dimension::MassFlow)
    }

    /// Time that a leak is to be found in, s.
    pub(crate) fn within_s(&self) -> anyhow::Result<Option<f64>> {
        self.si("within", Dimension::Time)
    }

    /// How long is searched.
    pub(crate) fn time_limit(&self) -> anyhow::Result<Option<Duration>> {
        let limit_s = self.si("time-limit", Dimension::Time)?;
        // A limit beyond what a duration holds is none.
        Ok(limit_s.and_then(|limit_s| Duration::try_from_secs_f64(limit_s).ok()))
    }
}

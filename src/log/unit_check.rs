//! Whether the readings of a column can be in the unit that its name says, and which one fits.
//!
//! The wall of a cylinder is between -60 and 85 °C, its gas between 0.5 and 1000 bar. A column none of whose readings the sensor can show, while
//! all of them are such values in another unit, is in that one: the run ends before it makes something of them. Readings that a sensor can show
//! and a cylinder hardly has, as 104 °C or 200 Pa, cost a caution: so does an absolute pressure below zero.
use std::ops::RangeInclusive;

use crate::thermal::units::{self, ATMOSPHERE_PA, Dimension, Unit};

/// Temperatures of a cylinder's wall, K, and pressures of its gas, Pa.
pub(super) const WALL_K: RangeInclusive<f64> = 213.15..=358.15;
pub(super) const GAS_PA: RangeInclusive<f64> = 0.5e5..=1e8;
/// Readings after which a unit is judged.
const ENOUGH: u64 = 20;

/// The first of these units in which a column's lowest, typical and highest value are a cylinder's.
pub(super) fn fitting(dimension: Dimension, [low, typical, high]: [f64; 3]) -> Option<&'static Unit> {
    let (within, names): (_, &[&str]) = match dimension {
        Dimension::Temperature => (WALL_K, &["degc", "k", "degf"]),
        Dimension::Pressure => (GAS_PA, &["bar", "psi", "kpa", "mbar", "pa"]),
        _ => return None,
    };
    names.iter().filter_map(|name| units::find(name, dimension)).find(|unit| match dimension {
        // A pressure that begins or ends at nothing is one, too.
        Dimension::Pressure => within.contains(&unit.to_si(typical)) && unit.to_si(high) <= *within.end(),
        _ => [low, high].iter().all(|value| within.contains(&unit.to_si(*value))),
    })
}

/// The unit of a gauge beside one of absolute pressure, where there is one.
pub(super) fn gauge_of(unit: &Unit) -> Option<&'static Unit> {
    let is_gauge = |other: &&Unit| other.factor == unit.factor && other.offset == ATMOSPHERE_PA;
    let is_absolute = unit.dimension == Dimension::Pressure && unit.offset == 0.0;
    is_absolute.then(|| units::units_of(Dimension::Pressure).find(is_gauge)).flatten()
}

/// What the unit of a column turned out to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Doubt {
    /// None of the values can be read by the sensor; in this unit all of them are a cylinder's.
    Impossible(&'static Unit),
    /// Most are none of a cylinder; in this unit all of them are.
    Unusual(&'static Unit),
    /// An absolute pressure was below zero: it counts from the air.
    Gauge(&'static Unit),
}

/// Counts the values of a column, in its own unit.
#[derive(Clone, Debug)]
pub(super) struct UnitCheck {
    unit: &'static Unit,
    count: u64,
    usable: u64,
    unusual: u64,
    sum: f64,
    low: f64,
    high: f64,
}

impl UnitCheck {
    /// Of a column in this unit.
    pub(super) fn new(unit: &'static Unit) -> Self {
        let (low, high) = (f64::INFINITY, f64::NEG_INFINITY);
        Self { unit, count: 0, usable: 0, unusual: 0, sum: 0.0, low, high }
    }

    /// Take in a reading, SI, and whether the sensor can show it; the unit that all are in as soon as enough cannot be in this one.
    pub(super) fn push(&mut self, si: f64, is_usable: bool) -> Option<&'static Unit> {
        let value = self.unit.from_si(si);
        self.count += 1;
        self.usable += u64::from(is_usable);
        let is_unusual = match self.unit.dimension {
            Dimension::Temperature => si > *WALL_K.end(),
            _ => si > 0.0 && si < *GAS_PA.start(),
        };
        self.unusual += u64::from(is_unusual);
        self.sum += value;
        (self.low, self.high) = (self.low.min(value), self.high.max(value));
        (self.count == ENOUGH).then(|| self.impossible()).flatten()
    }

    /// What is in doubt of all of them.
    pub(super) fn judge(&self) -> Option<Doubt> {
        let mostly = 2 * self.unusual > self.count;
        let unusual = || self.other().filter(|_| mostly).map(Doubt::Unusual);
        let gauge = || gauge_of(self.unit).filter(|_| self.is_below_zero()).map(Doubt::Gauge);
        self.impossible().map(Doubt::Impossible).or_else(unusual).or_else(gauge)
    }

    /// Lowest and highest value, in the column's unit.
    pub(super) fn range(&self) -> (f64, f64) {
        (self.low, self.high)
    }

    /// Whether none of the readings so far was usable.
    pub(super) fn is_silent(&self) -> bool {
        self.usable == 0
    }

    fn impossible(&self) -> Option<&'static Unit> {
        self.other().filter(|_| self.is_silent())
    }

    fn other(&self) -> Option<&'static Unit> {
        let fitting = fitting(self.unit.dimension, [self.low, self.sum / self.count as f64, self.high]);
        fitting.filter(|other| other.suffix != self.unit.suffix)
    }

    /// Whether a pressure was below zero, and would not be if it counted from the air.
    fn is_below_zero(&self) -> bool {
        let lowest_pa = self.unit.to_si(self.low);
        lowest_pa < 0.0 && lowest_pa > -ATMOSPHERE_PA
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(
        suffix: &str,
        dimension: Dimension,
        readings: impl Iterator<Item = f64>,
    ) -> (Option<&'static str>, UnitCheck) {
        let unit = units::find(suffix, dimension).unwrap();
        let mut check = UnitCheck::new(unit);
        let usual = if dimension == Dimension::Pressure { (-3e5, 260e5) } else { (183.0, 423.0) };
        let mut early = None;
        for value in readings {
            let si = unit.to_si(value);
            early = early.or(check.push(si, si >= usual.0 && si <= usual.1));
        }
        (early.map(|unit| unit.suffix), check)
    }

    fn suffix(doubt: Option<Doubt>) -> Option<&'static str> {
        doubt.map(|(Doubt::Impossible(unit) | Doubt::Unusual(unit) | Doubt::Gauge(unit))| unit.suffix)
    }

    #[test]
    fn kelvin_is_known_from_celsius_after_twenty_readings_and_fahrenheit_at_the_end() {
        let readings = |of: fn(f64) -> f64| (0..60).map(move |k| of(f64::from(k) - 15.0));
        let (early, check) = after("degc", Dimension::Temperature, readings(|degc| degc + 273.15));
        assert_eq!((early, suffix(check.judge())), (Some("k"), Some("k")));
        assert!(matches!(check.judge(), Some(Doubt::Impossible(_))));
        let warm = (0..60).map(|k| 1.8 * (30.0 + 0.1 * f64::from(k)) + 32.0);
        let (early, check) = after("degc", Dimension::Temperature, warm);
        assert!(
            early.is_none() && matches!(check.judge(), Some(Doubt::Unusual(unit)) if unit.suffix == "degf")
        );
        let (_, check) = after("degc", Dimension::Temperature, readings(|degc| degc));
        assert!(check.judge().is_none());
    }

    #[test]
    fn a_pressure_is_known_in_each_unit() {
        for (truly, written) in [("pa", "bar"), ("kpa", "bar"), ("psi", "bar"), ("bar", "pa")] {
            let unit = units::find(truly, Dimension::Pressure).unwrap();
            let readings = (0..30).map(|k| unit.from_si(200e5 + 1e4 * f64::from(k)));
            let (_, check) = after(written, Dimension::Pressure, readings);
            assert_eq!(suffix(check.judge()), Some(truly), "{truly} written as {written}");
        }
    }

    #[test]
    fn less_than_nothing_is_gauge_pressure() {
        let (early, check) = after("bar", Dimension::Pressure, (0..30).map(|k| f64::from(k) - 0.02));
        assert!(early.is_none());
        assert_eq!(suffix(check.judge()), Some("barg"));
        let (_, check) = after("barg", Dimension::Pressure, (0..30).map(|k| f64::from(k) - 0.02));
        assert!(check.judge().is_none());
    }

    #[test]
    fn what_a_broken_sensor_shows_is_in_no_other_unit() {
        for broken in [850.0, -127.0, 999.0] {
            let (early, check) = after("degc", Dimension::Temperature, (0..30).map(|_| broken));
            assert!(early.is_none() && check.judge().is_none(), "{broken}");
        }
        let (early, _) = after("bar", Dimension::Pressure, (0..30).map(|_| -62.5));
        assert!(early.is_none());
    }
}

//! Whether the readings fit the filling that was stated: units mixed up, another bottle, gas gone before the first row.
//!
//! The mass that pressure and thermometers stand for, `m = rho(p, T) V(T, p)`, averaged over the first six hours so that the gas, some
//! kelvin beside the wall in a tunnel, averages out, against that of the filling. A degree Fahrenheit read as one Celsius is off by 7 to
//! 12 % in a winter, a bar by a unit of pressure by much more, a filling that is known as well as is assumed by 1 %.
use serde::{Deserialize, Serialize};

use crate::DetectorError;
use crate::monitor::restored;

/// Time over which the mass is averaged, s, and fewest rows.
const LOOK_S: f64 = 6.0 * 3600.0;
const FEWEST: u32 = 30;
/// Rows that count as the first ones.
const FIRST: u32 = 3;
/// Difference that is believed, in standard deviations of the filling.
const DEVIATIONS: f64 = 5.0;

/// Watches the first hours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(in crate::monitor) struct FillingCheck {
    begun_s: Option<f64>,
    /// Mean of the first rows and of all, kg.
    first_kg: f64,
    mean_kg: f64,
    rows: u32,
    done: bool,
    wrong: bool,
}

impl FillingCheck {
    /// Checks one that was saved.
    pub(crate) fn validate(&self) -> Result<(), DetectorError> {
        restored::count("filling.rows", self.rows.into())
    }

    /// Whether it is still looking.
    pub(crate) fn is_open(&self) -> bool {
        !self.done
    }

    /// Whether the readings do not fit.
    pub(crate) fn is_wrong(&self) -> bool {
        self.wrong
    }

    /// A leak has been found: the mean mass, kg, if it is none because the readings do not fit the filling from the first row on.
    pub(crate) fn explains_leak(&mut self, (filled_kg, sd_kg): (f64, f64)) -> Option<f64> {
        if !self.done {
            (self.done, self.wrong) = (true, self.is_off(filled_kg, sd_kg));
        }
        self.wrong.then_some(self.mean_kg)
    }

    fn is_off(&self, filled_kg: f64, sd_kg: f64) -> bool {
        // Readings of another unit or bottle are off from the first row on; gas that is lost afterwards is no matter of the filling.
        let off = |kg: f64| (kg - filled_kg).abs() > DEVIATIONS * sd_kg;
        self.rows > 0 && off(self.mean_kg) && off(self.first_kg)
    }

    /// It has been explained otherwise: an exchange of gas, somebody who knows.
    pub(crate) fn settle(&mut self) {
        (self.done, self.wrong) = (true, false);
    }

    /// Take in the mass that the readings of a row stand for, kg, against that of the filling and its standard deviation, kg; the mean
    /// mass once it is known not to fit.
    pub(crate) fn take(&mut self, time_s: f64, mass_kg: f64, (filled_kg, sd_kg): (f64, f64)) -> Option<f64> {
        if self.done || !mass_kg.is_finite() {
            return None;
        }
        let begun_s = *self.begun_s.get_or_insert(time_s);
        self.rows += 1;
        self.mean_kg += (mass_kg - self.mean_kg) / f64::from(self.rows);
        if self.rows <= FIRST {
            self.first_kg = self.mean_kg;
        }
        if time_s - begun_s < LOOK_S || self.rows < FEWEST {
            return None;
        }
        self.done = true;
        self.wrong = self.is_off(filled_kg, sd_kg);
        self.wrong.then_some(self.mean_kg)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(mass_kg: impl Fn(u32) -> f64) -> FillingCheck {
        let mut check = FillingCheck::default();
        for minute in 0..600 {
            check.take(60.0 * f64::from(minute), mass_kg(minute), (4.48, 0.045));
        }
        check
    }

    #[test]
    fn a_tunnel_is_no_wrong_filling_and_fahrenheit_is_one() {
        let tunnel = |minute: u32| if minute % 180 < 30 { 0.9 * 4.48 } else { 4.48 };
        assert!(!after(tunnel).is_wrong() && !after(tunnel).is_open());
        assert!(after(|_| 0.93 * 4.48).is_wrong());
        assert!(after(|_| f64::NAN).is_open());
        let mut early = FillingCheck::default();
        early.take(0.0, 0.9 * 4.48, (4.48, 0.045));
        assert_eq!(early.explains_leak((4.48, 0.045)), Some(0.9 * 4.48));
        assert!(early.is_wrong());
        assert_eq!(after(|_| 4.48).explains_leak((4.48, 0.045)), None);
        // A loss from the first minute on.
        let mut lost = FillingCheck::default();
        (0..60).for_each(|minute| {
            lost.take(60.0 * f64::from(minute), 4.48 - 0.03 * f64::from(minute), (4.48, 0.045));
        });
        assert_eq!(lost.explains_leak((4.48, 0.045)), None);
        let mut settled = after(|_| 4.0);
        settled.settle();
        assert!(!settled.is_wrong() && !settled.is_open());
    }
}

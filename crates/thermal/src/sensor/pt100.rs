//! Tolerance classes of platinum resistance thermometers.
//!
//! IEC 60751:2008, tolerance classes of thermometers: the deviation from the reference function at a temperature
//! `t` in °C is at most `a + b |t|` kelvins.
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Tolerance class after IEC 60751:2008.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
pub enum Pt100Class {
    /// ±(0.1 + 0.0017 |t|) K.
    AA,
    /// ±(0.15 + 0.002 |t|) K.
    A,
    /// ±(0.3 + 0.005 |t|) K.
    B,
    /// ±(0.6 + 0.01 |t|) K.
    C,
}

impl Pt100Class {
    /// Temperature at which a tolerance stands for a sensor's constant error, K: 20 °C, the middle of what a
    /// cylinder meets. To -20 and 60 °C the tolerance of class B changes by 0 and 0.2 K.
    pub(crate) const MIDDLE_K: f64 = 293.15;

    /// Largest deviation that the class allows at a temperature, K.
    ///
    /// # References
    /// IEC 60751:2008, tolerance classes of thermometers.
    pub(crate) fn tolerance_k(self, temperature_k: f64) -> f64 {
        let (constant_k, slope) = match self {
            Self::AA => (0.1, 0.0017),
            Self::A => (0.15, 0.002),
            Self::B => (0.3, 0.005),
            Self::C => (0.6, 0.01),
        };
        constant_k + slope * (temperature_k - crate::units::ZERO_CELSIUS_K).abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As makers of sensors print them for their classes at single temperatures.
    #[test]
    fn tolerances_are_those_of_the_standard() {
        let printed = [
            (Pt100Class::AA, 0.0, 0.1),
            (Pt100Class::AA, 100.0, 0.27),
            (Pt100Class::A, 0.0, 0.15),
            (Pt100Class::A, 100.0, 0.35),
            (Pt100Class::A, -200.0, 0.55),
            (Pt100Class::B, 0.0, 0.3),
            (Pt100Class::B, 100.0, 0.8),
            (Pt100Class::B, -200.0, 1.3),
            (Pt100Class::C, 0.0, 0.6),
            (Pt100Class::C, 100.0, 1.6),
        ];
        for (class, t_degc, tolerance_k) in printed {
            let found = class.tolerance_k(t_degc + 273.15);
            assert!((found - tolerance_k).abs() < 1e-12, "{class:?} at {t_degc}: {found}");
        }
    }
}

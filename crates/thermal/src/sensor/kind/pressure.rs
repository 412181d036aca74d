//! Pressure transmitter at the valve: `y = (1 + s) (p - p_0) + b + c (T_el - 15 degC) + p_r`.
//!
//! With span error `s` and temperature coefficient `c`; `T_el` is the temperature of the electronics, which is that of the
//! valve. An absolute transmitter has `p_0 = p_r = 0`. A gauge one counts from the air's pressure `p_0`, and whoever
//! records its reading as absolute adds the standard atmosphere `p_r`.
//!
//! Typical: absolute, 250 bar full scale, accuracy 0.25 % of it, temperature coefficient 0 ± 0.1 % of it per 10 K, noise
//! 10 mbar.
use super::{Bound, Kind, ParameterKind, Prediction, Quantity, SensorKind};
use crate::units::ATMOSPHERE_PA;
use serde::{Deserialize, Serialize};
#[cfg(feature = "files")]
use {
    super::{StatedKind, Table},
    crate::ThermalError,
    crate::document::check,
};

/// Temperature of the electronics at which a pressure transmitter has no temperature error, K: 15 °C.
pub const ELECTRONICS_REFERENCE_K: f64 = 288.15;

/// Range of a transmitter's signal as parts of its full scale: 3.8 to 20.5 mA of 4 to 20 mA (NAMUR NE 43).
#[cfg(feature = "files")]
const SIGNAL_RANGE: (f64, f64) = (-0.0125, 1.03125);

/// Full scale of the typical transmitter, Pa.
#[cfg(feature = "files")]
const FULL_SCALE_PA: f64 = 250e5;

/// What a pressure transmitter counts from.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum PressureReference {
    /// Vacuum.
    Absolute,
    /// The air around it. Whoever records a gauge reading adds the standard atmosphere, as the unit `_barg` does,
    /// so that at another altitude the record is off by the difference.
    Gauge {
        /// Real pressure of the air, Pa.
        atmosphere_pa: f64,
    },
}

impl PressureReference {
    /// What a reading of zero is recorded as, Pa absolute: logs hold a gauge pressure with the standard atmosphere added.
    pub fn zero_pa(self) -> f64 {
        match self {
            Self::Absolute => 0.0,
            Self::Gauge { .. } => ATMOSPHERE_PA,
        }
    }
}

pub(super) const KIND: Kind = Kind {
    quantity: Quantity::Pressure,
    predict: |kind, exposure, parameters| {
        let (zero_pa, recorded_zero_pa) = match *kind {
            SensorKind::Pressure { reference: PressureReference::Gauge { atmosphere_pa }, .. } => {
                (atmosphere_pa, ATMOSPHERE_PA)
            }
            _ => (0.0, 0.0),
        };
        let (b, c, s) = (parameters[0], parameters[1], parameters[2]);
        let warmer_k = exposure.electronics_k - ELECTRONICS_REFERENCE_K;
        let counted_pa = exposure.pressure_pa - zero_pa;
        Prediction {
            value: (1.0 + s) * counted_pa + b + c * warmer_k + recorded_zero_pa,
            per_pressure: 1.0 + s,
            per_electronics: c,
            per_parameter: [1.0, warmer_k, counted_pa],
            ..Prediction::default()
        }
    },
    parameters: &[
        (
            ParameterKind::TemperatureCoefficient,
            [Bound::any("temperature_coefficient_pa_k"), Bound::size("temperature_coefficient_sd_pa_k")],
        ),
        (
            ParameterKind::Span,
            [
                Bound {
                    key: "span_ratio",
                    range: (-0.5, 0.5),
                    bound: "between -50 and 50 %",
                    remedy: "a reading of 0.1 % too much is span_percent = 0.1",
                },
                Bound::size("span_sd_ratio"),
            ],
        ),
    ],
    #[cfg(feature = "files")]
    stated: StatedKind {
        name: "pressure",
        keys: &[],
        is_named: |name| name == "pressure",
        columns: &["pressure"],
        build,
        parameters: |spec| {
            vec![
                [spec.temperature_coefficient_pa_k, spec.temperature_coefficient_sd_pa_k],
                [spec.span_ratio, spec.span_sd_ratio],
            ]
        },
        coupling: None,
        plausible: |kind| match *kind {
            SensorKind::Pressure { reference, full_scale_pa: Some(scale_pa) } => {
                let zero_pa = reference.zero_pa();
                (zero_pa + SIGNAL_RANGE.0 * scale_pa, zero_pa + SIGNAL_RANGE.1 * scale_pa)
            }
            _ => (-ATMOSPHERE_PA, check::PRESSURE_RANGE_PA.1),
        },
        typical: |spec| {
            let full_scale_pa = *spec.full_scale_pa.get_or_insert(FULL_SCALE_PA);
            spec.noise_pa.get_or_insert(1e3);
            spec.temperature_coefficient_sd_pa_k.get_or_insert(1e-3 * full_scale_pa / 10.0);
            if !spec.says_offset() {
                spec.offset_tolerance_pa = Some(2.5e-3 * full_scale_pa);
            }
        },
    },
};

#[cfg(feature = "files")]
fn build(table: &Table<'_>) -> Result<SensorKind, ThermalError> {
    let spec = table.spec;
    let reference = if spec.gauge == Some(true) {
        let range = (-500.0, 11_000.0);
        let (bound, remedy) = ("between -500 m and 11 km", "it gives the air's pressure after ISO 2533");
        let altitude_m = spec.altitude_m.unwrap_or(0.0);
        let altitude_m = check::within(&table.at("altitude_m"), altitude_m, range, bound, remedy)?;
        PressureReference::Gauge { atmosphere_pa: atmosphere_pa(altitude_m) }
    } else if spec.altitude_m.is_some() {
        let remedy =
            "an absolute transmitter reads the same at every altitude; for another one say gauge = true";
        return Err(check::conflict(&table.at("altitude_m"), "an absolute transmitter", remedy));
    } else {
        PressureReference::Absolute
    };
    Ok(SensorKind::Pressure { reference, full_scale_pa: spec.full_scale_pa })
}

/// Pressure of the standard atmosphere at an altitude up to 11 km, Pa: `p_0 (1 - L h / T_0)^(g / (R L))`.
///
/// # References
/// ISO 2533:1975, Standard atmosphere.
#[cfg(feature = "files")]
fn atmosphere_pa(altitude_m: f64) -> f64 {
    let (lapse_k_m, zero_k, gravity_m_s2, gas_constant_j_kg_k) = (0.0065, 288.15, 9.806_65, 287.052_87);
    ATMOSPHERE_PA
        * libm::pow(1.0 - lapse_k_m * altitude_m / zero_k, gravity_m_s2 / (gas_constant_j_kg_k * lapse_k_m))
}

#[cfg(all(test, feature = "files"))]
mod tests {
    use super::atmosphere_pa;

    /// As ISO 2533 tabulates it against geopotential altitude.
    #[test]
    fn the_air_pressure_is_that_of_the_standard_atmosphere() {
        for (altitude_m, printed_pa) in
            [(0.0, 101_325.0), (1e3, 89_874.6), (2e3, 79_495.2), (5e3, 54_019.9), (11e3, 22_632.0)]
        {
            let found = atmosphere_pa(altitude_m);
            assert!((found - printed_pa).abs() < 0.1, "{altitude_m} m: {found}");
        }
    }
}

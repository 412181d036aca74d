//! Typical sensors, for a log of which nothing but its columns is known.
//!
//! * Surface: Pt100 class B, noise 0.05 K, coupling to the air 0.1 ± 0.04.
//! * Air: as a surface sensor without coupling; its offset is 0 ± 0.6 K, because the air at the sensor is not the air
//!   at the cylinder.
//! * Gas: thermocouple type T class 1 (IEC 60584-1: ±0.5 K), noise 0.1 K.
//! * Pressure: absolute transmitter of 250 bar full scale, accuracy 0.25 % of it, temperature coefficient
//!   0 ± 0.1 % of it per 10 K, noise 10 mbar.
use super::Sensor;
use crate::EstimatorError;
use cylwatch_thermal::sensor::{KindChoice, Pt100Class, SensorSpec};

/// Full scale of the typical transmitter, Pa.
const FULL_SCALE_PA: f64 = 250e5;

impl Sensor {
    /// The typical sensor of a log's column: `shoulder`, `valve`, `wall_<place>`, `ambient`, `pressure`, `gas_<k>`.
    ///
    /// # Errors
    /// [`EstimatorError::Thermal`] for a name that says no place.
    pub fn typical(name: &str) -> Result<Self, EstimatorError> {
        let spec = SensorSpec { name: name.to_owned(), ..SensorSpec::default() };
        Self::try_from(&completed(&spec))
    }

    /// The typical thermometer on the wall at a height above the outer bottom, m: `wall_<height in mm>mm`.
    ///
    /// # Errors
    /// As [`Sensor::typical`].
    pub fn typical_at_height(height_m: f64) -> Result<Self, EstimatorError> {
        let name = format!("wall_{:.0}mm", 1e3 * height_m);
        let spec = SensorSpec { name, height_m: Some(height_m), ..SensorSpec::default() };
        Self::try_from(&completed(&spec))
    }
}

/// The specification with the typical numbers wherever it says nothing.
pub(super) fn completed(spec: &SensorSpec) -> SensorSpec {
    let mut full = spec.clone();
    let offset_is_stated = spec.class.is_some()
        || spec.offset_sd_k.is_some()
        || spec.offset_tolerance_k.is_some()
        || spec.offset_sd_pa.is_some()
        || spec.offset_tolerance_pa.is_some();
    let default = |stated: &mut Option<f64>, typical: f64| {
        stated.get_or_insert(typical);
    };
    match spec.kind_or_default() {
        KindChoice::Surface => {
            default(&mut full.noise_k, 0.05);
            default(&mut full.air_coupling, 0.1);
            default(&mut full.air_coupling_sd, 0.04);
            if !offset_is_stated {
                full.class = Some(Pt100Class::B);
            }
        }
        KindChoice::Ambient => {
            default(&mut full.noise_k, 0.05);
            if !offset_is_stated {
                full.offset_sd_k = Some(0.6);
            }
        }
        KindChoice::Gas => {
            default(&mut full.noise_k, 0.1);
            if !offset_is_stated {
                full.offset_tolerance_k = Some(0.5);
            }
        }
        KindChoice::Pressure => {
            let full_scale_pa = *full.full_scale_pa.get_or_insert(FULL_SCALE_PA);
            default(&mut full.noise_pa, 1e3);
            default(&mut full.temperature_coefficient_sd_pa_k, 1e-3 * full_scale_pa / 10.0);
            if !offset_is_stated {
                full.offset_tolerance_pa = Some(2.5e-3 * full_scale_pa);
            }
        }
    }
    full
}

//! Everything that can go wrong in this crate.
use alloc::borrow::Cow;
use alloc::boxed::Box;
use cylwatch_estimator::thermal::shown;

/// What went wrong, with the offending value, the bound and the remedy.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DetectorError {
    /// A setting is out of its bounds.
    #[error("setting `{setting}` = {} must be {bound}", shown(*.value))]
    Setting {
        /// Name of the setting.
        setting: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        bound: &'static str,
    },
    /// A setting of an alarm is out of its bounds.
    #[error("alarm `{alarm}`: {source}")]
    Alarm {
        /// Name of the alarm.
        alarm: &'static str,
        /// What is wrong with it.
        source: Box<DetectorError>,
    },
    /// A saved state holds what no monitor can have come to.
    #[error("`{what}` = {} of the saved state must be {bound}: begin without it", shown(*.value))]
    Restored {
        /// Name of the value.
        what: &'static str,
        /// Its value; of a list the number of its elements.
        value: f64,
        /// What it must be.
        bound: Cow<'static, str>,
    },
    /// The gas has no such state.
    #[error(transparent)]
    Gas(#[from] cylwatch_estimator::thermal::ThermalError),
    /// A mass has no pressure in the vessel at a temperature.
    #[error(
        "{mass_kg} kg have no pressure at {temperature_k} K in {volume_m3} m3: give a mass that fits the vessel"
    )]
    NoPressure {
        /// Mass, kg.
        mass_kg: f64,
        /// Temperature, K.
        temperature_k: f64,
        /// Volume, m³.
        volume_m3: f64,
    },
    /// A row has another number of readings than there are sensors.
    #[error(
        "a row of {found} readings does not fit {expected} sensors: give one each, NaN where it is missing"
    )]
    RowLength {
        /// Number of sensors.
        expected: usize,
        /// Number of readings.
        found: usize,
    },
    /// An alarm is in a state in which something cannot be done to it.
    #[error("the alarm cannot be {act}: {reason}")]
    AlarmState {
        /// What was to be done.
        act: &'static str,
        /// What stands against it.
        reason: &'static str,
    },
    /// Bytes that cannot be used.
    #[error(transparent)]
    Sealed(#[from] crate::sealed::SealError),
    /// The observer could not go on.
    #[error(transparent)]
    Observer(#[from] cylwatch_estimator::EstimatorError),
}

/// `value` if it is positive and finite.
pub(crate) fn positive(setting: &'static str, value: f64) -> Result<f64, DetectorError> {
    if value > 0.0 && value.is_finite() {
        return Ok(value);
    }
    Err(DetectorError::Setting { setting, value, bound: "positive and finite" })
}

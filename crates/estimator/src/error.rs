//! Everything that can go wrong in this crate.

/// What went wrong, with the offending value, the bound and the remedy.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EstimatorError {
    /// The thermal model refused.
    #[error(transparent)]
    Thermal(#[from] cylwatch_thermal::ThermalError),
    /// A setting of the generator of truths is out of range.
    #[error("truth setting {setting} = {value} must be between {low} and {high}")]
    TruthSetting {
        /// Name of the setting.
        setting: &'static str,
        /// Its value.
        value: f64,
        /// Smallest allowed value.
        low: f64,
        /// Largest allowed value.
        high: f64,
    },
    /// The vessel has no such place for a sensor.
    #[error("the vessel has no {place} for a sensor: take one with shoulder and valve")]
    NoSuchPlace {
        /// Name of the place.
        place: &'static str,
    },
    /// A file of a truth cannot be read.
    #[error("line {line} of the truth file: {reason}: write the file anew")]
    TruthFile {
        /// Line, from 1.
        line: usize,
        /// What is wrong with it.
        reason: String,
    },
    /// Reading or writing failed.
    #[error(transparent)]
    Io(#[from] std::io::Error),
}

//! What can be wrong with a request for a world.
use cylwatch_estimator::EstimatorError;
use cylwatch_thermal::ThermalError;

use crate::EvaluationError;

/// A world that cannot be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WorldError {
    /// A text that names no kind of an axis.
    #[error("{text:?} is no {axis}; known are {known}")]
    UnknownKey {
        /// Axis.
        axis: &'static str,
        /// What was given.
        text: String,
        /// Keys of the axis.
        known: String,
    },
    /// A text that is no key of a family.
    #[error(
        "{text:?} is no family: write vessel/climate/gas/sensors/rows, e.g. nitrogen-20l/railway/mixed/class-b/120s"
    )]
    FamilyKey {
        /// What was given.
        text: String,
    },
    /// A number of a request outside its range.
    #[error("{what} of {value} must be between {low} and {high}")]
    Number {
        /// What.
        what: &'static str,
        /// Its value.
        value: f64,
        /// Smallest allowed value.
        low: f64,
        /// Largest allowed value.
        high: f64,
    },
    /// A simulation that another request needs.
    #[error("this simulation is {simulated}, the request needs {needed}")]
    OtherSimulation {
        /// What was simulated.
        simulated: String,
        /// What is needed.
        needed: String,
    },
    /// The thermal model refuses.
    #[error(transparent)]
    Thermal(#[from] ThermalError),
    /// A sensor or a reading is refused.
    #[error(transparent)]
    Estimator(#[from] EstimatorError),
    /// A fault cannot be laid over the rows.
    #[error(transparent)]
    Fault(#[from] EvaluationError),
}

//! Everything that can go wrong in this crate.
use cylwatch_detector::DetectorError;
use cylwatch_detector::sealed::SealError;
use cylwatch_estimator::EstimatorError;
use cylwatch_thermal::ThermalError;

/// What went wrong, with the value, the bound and the remedy.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CosimulationError {
    /// A value reference that no variable has.
    #[error("there is no variable {reference} of type {wanted}: see the model description")]
    NoVariable {
        /// Value reference.
        reference: u32,
        /// Type that was asked for.
        wanted: &'static str,
    },
    /// A variable that cannot be set, or not now.
    #[error("{name} cannot be set: {reason}")]
    NotSettable {
        /// Name of the variable.
        name: String,
        /// Why.
        reason: &'static str,
    },
    /// A value out of its bounds.
    #[error("{name} = {value} must lie between {low} and {high}")]
    OutOfBounds {
        /// Name of the variable.
        name: String,
        /// Its value.
        value: f64,
        /// Lowest value.
        low: f64,
        /// Highest value.
        high: f64,
    },
    /// A call that does not belong here.
    #[error("{call} does not belong {place}")]
    OutOfOrder {
        /// What was called.
        call: &'static str,
        /// Where the instance is.
        place: &'static str,
    },
    /// A step of no length, or from another time.
    #[error(
        "a step of {step_s} s from {from_s} s, and the instance is at {time_s} s: give a positive step from there"
    )]
    Step {
        /// Where it is to begin, s.
        from_s: f64,
        /// How long it is to be, s.
        step_s: f64,
        /// Where the instance is, s.
        time_s: f64,
    },
    /// A step that failed.
    #[error("step from {from_s} s: {cause}")]
    During {
        /// Where it began, s.
        from_s: f64,
        /// What went wrong.
        #[source]
        cause: Box<CosimulationError>,
    },
    /// Bytes that cannot be used.
    #[error(transparent)]
    Sealed(#[from] SealError),
    /// The monitor refused.
    #[error(transparent)]
    Monitor(#[from] DetectorError),
    /// A sensor does not fit.
    #[error(transparent)]
    Sensor(#[from] EstimatorError),
    /// The simulation refused.
    #[error(transparent)]
    Plant(#[from] ThermalError),
}

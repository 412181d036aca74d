//! Everything that can go wrong in this crate.

/// What went wrong, with the offending value, the bound and the remedy.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EstimatorError {
    /// The thermal model refused.
    #[error(transparent)]
    Thermal(#[from] cylwatch_thermal::ThermalError),
    /// A covariance holds NaN or an infinity.
    #[error("covariance element ({row}, {column}) is not a finite number")]
    CovarianceNotFinite {
        /// Row, from 0.
        row: usize,
        /// Column, from 0.
        column: usize,
    },
    /// A covariance is not symmetric.
    #[error("covariance elements ({row}, {column}) = {upper} and ({column}, {row}) = {lower} must be equal")]
    CovarianceNotSymmetric {
        /// Row, from 0.
        row: usize,
        /// Column, from 0.
        column: usize,
        /// Element above the diagonal.
        upper: f64,
        /// Its mirror image.
        lower: f64,
    },
    /// A covariance is not positive semi-definite.
    #[error(
        "covariance is not positive semi-definite: of the variance {variance} of state {state} the later states \
         leave {left}; lower its covariances or raise its variance"
    )]
    CovarianceIndefinite {
        /// State, from 0.
        state: usize,
        /// Its variance.
        variance: f64,
        /// What is left of it when the later states are known.
        left: f64,
    },
    /// Two sensors of one name.
    #[error("two sensors are called {name}: channels tell sensors apart by their names")]
    SensorTwice {
        /// The name.
        name: String,
    },
    /// A sensor on a place that the vessel does not have.
    #[error(
        "sensor {name} needs {missing}, which vessel {vessel} does not have: give it another place or leave it out"
    )]
    SensorPlace {
        /// Name of the sensor.
        name: String,
        /// Name of the vessel.
        vessel: String,
        /// What is missing.
        missing: String,
    },
    /// A time that cannot be sampled.
    #[error(
        "sampling time {number}, {time_s} s, must be later than the one before and lie within the trajectory, \
         {from_s} s to {to_s} s"
    )]
    SampleTime {
        /// Which one, from 1.
        number: usize,
        /// The time, s.
        time_s: f64,
        /// Start of the trajectory, s.
        from_s: f64,
        /// End of the trajectory, s.
        to_s: f64,
    },
    /// A trajectory without samples.
    #[error("the trajectory has no samples: simulate at least one")]
    EmptyTrajectory,
}

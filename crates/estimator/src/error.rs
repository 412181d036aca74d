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
    /// A setting of a moving-horizon estimator is out of its range.
    #[error("moving-horizon setting {name} = {value} must be {bound}")]
    HorizonSetting {
        /// Setting by its field name.
        name: &'static str,
        /// As given.
        value: f64,
        /// Its range.
        bound: &'static str,
    },
    /// A prior is not of the process's size.
    #[error(
        "a process of {states} states needs a prior mean of as many, not {mean}, and a square covariance, not {rows} x {columns}"
    )]
    HorizonPrior {
        /// States of the process.
        states: usize,
        /// Length of the mean.
        mean: usize,
        /// Rows of the covariance.
        rows: usize,
        /// Columns of the covariance.
        columns: usize,
    },
    /// A prior mean holds NaN or an infinity.
    #[error("prior mean {value} of state {state} must be finite")]
    HorizonPriorNotFinite {
        /// State, from 0.
        state: usize,
        /// Its mean.
        value: f64,
    },
    /// A constraint names a state that is not there.
    #[error("constraint {row} names state {state}, but states run from 0 to {} only", .states - 1)]
    ConstraintState {
        /// Constraint, from 0.
        row: usize,
        /// State that it names.
        state: usize,
        /// Number of states.
        states: usize,
    },
    /// A constraint is no inequality.
    #[error("constraint {row}: {reason}")]
    ConstraintRow {
        /// Constraint, from 0.
        row: usize,
        /// What it must be.
        reason: &'static str,
    },
}

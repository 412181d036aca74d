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
}

//! What a step of a moving-horizon estimator says.
use nalgebra::{DMatrix, DVector};

/// Estimate at the newest sample.
#[derive(Clone, Debug, PartialEq)]
pub struct HorizonEstimate {
    /// State `x`: (n). Inside the constraints unless `status` is [`HorizonStatus::Fallback`].
    pub x: DVector<f64>,
    /// Covariance `P` of the posterior without the constraints, with outliers weighted down: (n, n). It is what the
    /// data say; a state on its bound is known better.
    pub covariance: DMatrix<f64>,
    /// Where constraints are active: `P` given that the active rows hold with equality, which is the covariance
    /// projected on the null space of the active set over the whole window: (n, n). A state on its bound at the
    /// newest sample has no variance here. The truth lies between the two, since a row is active only by the data.
    pub projected: Option<DMatrix<f64>>,
    /// Constraints that hold with equality and push.
    pub active: Vec<ActiveConstraint>,
    /// Measurements in the linear part of the loss.
    pub outliers: Vec<Outlier>,
    /// How the estimate came about.
    pub status: HorizonStatus,
    /// Whether the last Gauss-Newton step was smaller than the tolerance, or met a problem that is linear there.
    pub converged: bool,
    /// Gauss-Newton iterations.
    pub iterations: usize,
    /// Quadratic programs solved; none where the constraints are slack and no measurement is an outlier.
    pub qp_solves: usize,
    /// Interior-point iterations over all of them.
    pub qp_iterations: usize,
    /// Cost of the window's trajectory: half a sum of squares in standard deviations, at its linearisation.
    pub cost: f64,
}

/// How an estimate came about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HorizonStatus {
    /// The optimum without constraints and outliers lies inside: no quadratic program was needed.
    Unconstrained,
    /// Constrained (or robust) optimum.
    Solved,
    /// The same, to the reduced accuracy of a solver that ended early: a caution.
    AlmostSolved,
    /// No constrained optimum was found: the estimate is the one without constraints, which may lie outside.
    Fallback(FallbackReason),
}

/// Why the constraints were given up at a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FallbackReason {
    /// No trajectory of the window satisfies the constraints.
    Infeasible,
    /// The solver of the quadratic program ended without a solution.
    Solver,
}

/// A constraint that holds with equality and pushes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActiveConstraint {
    /// Index of the constraint as given.
    pub row: usize,
    /// How many samples ago, 0 at the newest. A row on constants counts as at the newest; one on a step as at
    /// its later sample.
    pub age: usize,
    /// Multiplier: decrease of the cost per unit by which the bound is relaxed, positive.
    pub multiplier: f64,
}

/// A measurement in the linear part of the loss.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outlier {
    /// Output.
    pub output: usize,
    /// How many samples ago, 0 at the newest.
    pub age: usize,
    /// Residual `(z - h(x)) / sqrt(R)`, standard deviations.
    pub residual: f64,
}

/// What a step cannot take. The window is then as it was without the sample; its oldest one may have left it.
#[derive(Clone, Debug, thiserror::Error, PartialEq)]
#[non_exhaustive]
pub enum HorizonError<E> {
    /// The process or an output could not be evaluated.
    #[error("the process or an output could not be evaluated in the window")]
    Model(#[source] E),
    /// Time runs backwards or is not a number.
    #[error(
        "time since the previous sample {dt_s} s must be finite and not negative: sort the samples by time"
    )]
    Interval {
        /// As given, s.
        dt_s: f64,
    },
    /// Wrong number of readings.
    #[error("{given} readings for {outputs} outputs: give one each, NaN where there is none")]
    Readings {
        /// As given.
        given: usize,
        /// Outputs of the process.
        outputs: usize,
    },
    /// A reading is infinite.
    #[error("reading {value} of output {output} must be finite, or NaN where there is none")]
    ReadingNotFinite {
        /// Output.
        output: usize,
        /// Its reading.
        value: f64,
    },
    /// A variance of the measurement noise is not positive.
    #[error("noise variance {variance} of output {output} must be positive and finite")]
    NoiseVariance {
        /// Output.
        output: usize,
        /// Its variance.
        variance: f64,
    },
    /// The process gave NaN or an infinity.
    #[error("the process gave a value that is not finite: bound the states that it depends on")]
    NotFinite,
}

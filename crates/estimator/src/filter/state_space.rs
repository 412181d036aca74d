//! A nonlinear, time-continuous process seen at discrete times:
//!
//! `x(t + dt) = f(x(t), dt) + w`, `z_j = h_j(x) + v_j`, `w ~ N(0, G diag(q) G^T)`, `v_j ~ N(0, R_j(x))`.
//!
//! Only the leading states move (or are driven by noise); the trailing ones are constants, such as sensor offsets:
//! their rows of the transition are those of the identity and no noise acts on them. Linear algebra that knows this
//! saves most of its work. A process without constants sets `leading = n`.
use nalgebra::{DMatrix, DVector};

/// Transition of the state over one interval, linearised at the state it started from.
///
/// # Shapes
/// `n` states, of which the first `leading` move; `k` noise sources. The covariance moves as
/// `P <- F P F^T + G diag(q) G^T` with `F = [phi; 0 I]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Linearisation {
    /// Leading rows of the transition matrix: (leading, n).
    pub phi: DMatrix<f64>,
    /// Noise input: (leading, k).
    pub g: DMatrix<f64>,
    /// Variances of the noise sources: (k).
    pub q: DVector<f64>,
}

impl Linearisation {
    /// Zeros for `n` states of which `leading` move, with `k` noise sources.
    pub fn zeros(n: usize, leading: usize, k: usize) -> Self {
        Self { phi: DMatrix::zeros(leading, n), g: DMatrix::zeros(leading, k), q: DVector::zeros(k) }
    }
}

/// How many of each there are in a process.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dimensions {
    /// States `n`.
    pub states: usize,
    /// Leading states that move or are driven by noise.
    pub leading: usize,
    /// Noise sources `k` of a transition.
    pub noises: usize,
    /// Outputs.
    pub outputs: usize,
}

/// Process and outputs of an estimation problem. Implementations reuse their own memory: nothing is allocated in a step.
pub trait StateSpace {
    /// What can go wrong, e.g. a state outside the domain of the equations.
    type Error: core::error::Error;

    /// How many states, noises and outputs there are: the same in every call.
    fn dimensions(&self) -> Dimensions;

    /// [`Dimensions::states`].
    fn states(&self) -> usize {
        self.dimensions().states
    }

    /// [`Dimensions::leading`].
    fn leading(&self) -> usize {
        self.dimensions().leading
    }

    /// [`Dimensions::noises`].
    fn noises(&self) -> usize {
        self.dimensions().noises
    }

    /// [`Dimensions::outputs`].
    fn outputs(&self) -> usize {
        self.dimensions().outputs
    }

    /// Advance `x` by `dt_s`, s; where `linear` is given, also write the transition's linearisation.
    ///
    /// # Errors
    /// The state cannot be advanced; `x` and `linear` are then of no use.
    fn propagate(
        &mut self,
        x: &mut [f64],
        dt_s: f64,
        linear: Option<&mut Linearisation>,
    ) -> Result<(), Self::Error>;

    /// Output `j` at `x` and, where `h` (length n) is given, its gradient.
    ///
    /// # Errors
    /// The output has no value at this state.
    fn output(&mut self, j: usize, x: &[f64], h: Option<&mut [f64]>) -> Result<f64, Self::Error>;

    /// Variance of the noise of output `j`; it may depend on the state.
    fn noise_variance(&self, j: usize, x: &[f64]) -> f64;
}

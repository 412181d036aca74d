//! What the nonlinear least-squares searches of this crate share: the damped normal equations and the damping's course.
//!
//! Source: Levenberg 1944, Marquardt 1963.
use nalgebra::{DMatrix, DVector};

/// First damping, the one below which there is none, and how many times the first one leaves no hope.
const INITIAL_DAMPING: f64 = 1e-3;
const MIN_DAMPING: f64 = 1e-9;
const MAX_DAMPING: f64 = 1e12;

/// Share of the diagonal that is added to the normal equations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Damping {
    share: f64,
    last: f64,
}

impl Damping {
    pub(crate) fn first() -> Self {
        Self::starting_at(INITIAL_DAMPING)
    }

    /// Another first damping.
    pub(crate) fn starting_at(share: f64) -> Self {
        Self { share, last: MAX_DAMPING * share.max(INITIAL_DAMPING) }
    }

    pub(crate) fn share(self) -> f64 {
        self.share
    }

    /// After a step that helped.
    pub(crate) fn relax(&mut self) {
        self.share = if self.share < MIN_DAMPING { 0.0 } else { 0.1 * self.share };
    }

    /// After a step that did not.
    pub(crate) fn tighten(&mut self) {
        self.share = (10.0 * self.share).max(INITIAL_DAMPING);
    }

    pub(crate) fn is_hopeless(self) -> bool {
        self.share > self.last
    }

    /// Step `(A + damping diag A)^-1 g`, Marquardt's, which is free of the parameters' units; `None` if there is no finite one.
    pub(crate) fn step(self, matrix: &DMatrix<f64>, rhs: &DVector<f64>) -> Option<DVector<f64>> {
        self.scaled_step(matrix, rhs, &matrix.diagonal())
    }

    /// Step `(A + damping diag d)^-1 g`, Levenberg's: where parameters have widths of their own, `d` are those to the
    /// power -2, and a badly determined combination moves by no more than its width.
    pub(crate) fn scaled_step(
        self,
        matrix: &DMatrix<f64>,
        rhs: &DVector<f64>,
        scale: &DVector<f64>,
    ) -> Option<DVector<f64>> {
        let mut damped = matrix.clone();
        for i in 0..damped.nrows() {
            damped[(i, i)] += self.share * scale[i];
        }
        solve(&damped, rhs)
    }
}

/// Solve `matrix x = rhs` after scaling rows and columns by the matrix' diagonal; `None` if there is no finite solution.
pub(crate) fn solve(matrix: &DMatrix<f64>, rhs: &DVector<f64>) -> Option<DVector<f64>> {
    let scale = scales(matrix);
    let scaled = matrix.map_with_location(|i, j, value| value / (scale[i] * scale[j]));
    let solution = scaled.lu().solve(&rhs.component_div(&scale))?.component_div(&scale);
    solution.iter().all(|value| value.is_finite()).then_some(solution)
}

/// Inverse by the same scaling.
pub(crate) fn invert(matrix: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let scale = scales(matrix);
    let scaled = matrix.map_with_location(|i, j, value| value / (scale[i] * scale[j]));
    let inverse = scaled.try_inverse()?.map_with_location(|i, j, value| value / (scale[i] * scale[j]));
    inverse.iter().all(|value| value.is_finite()).then_some(inverse)
}

fn scales(matrix: &DMatrix<f64>) -> DVector<f64> {
    matrix.diagonal().map(|d| if d == 0.0 { 1.0 } else { d.abs().sqrt() })
}

//! What the nonlinear least-squares searches of this crate share: the damped normal equations and the damping's course.
//!
//! Source: Levenberg 1944, Marquardt 1963.
use nalgebra::{DMatrix, DVector};

/// First damping, and the ones from which on there is none, or no hope.
const FIRST: f64 = 1e-3;
const NONE: f64 = 1e-9;
const LAST: f64 = 1e9;

/// Share of the diagonal that is added to the normal equations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Damping(f64);

impl Damping {
    pub fn first() -> Self {
        Self(FIRST)
    }

    /// Another first damping.
    pub fn starting_at(share: f64) -> Self {
        Self(share)
    }

    pub fn share(self) -> f64 {
        self.0
    }

    /// After a step that helped.
    pub fn relax(&mut self) {
        self.0 = if self.0 < NONE { 0.0 } else { 0.1 * self.0 };
    }

    /// After a step that did not.
    pub fn tighten(&mut self) {
        self.0 = (10.0 * self.0).max(FIRST);
    }

    pub fn is_hopeless(self) -> bool {
        self.0 > LAST
    }

    /// Step `(A + damping diag A)^-1 g`, Marquardt's, which is free of the parameters' units; `None` if there is no finite one.
    pub fn step(self, matrix: &DMatrix<f64>, rhs: &DVector<f64>) -> Option<DVector<f64>> {
        self.scaled_step(matrix, rhs, &matrix.diagonal())
    }

    /// Step `(A + damping diag d)^-1 g`, Levenberg's: where parameters have widths of their own, `d` are those to the
    /// power -2, and a badly determined combination moves by no more than its width.
    pub fn scaled_step(
        self,
        matrix: &DMatrix<f64>,
        rhs: &DVector<f64>,
        scale: &DVector<f64>,
    ) -> Option<DVector<f64>> {
        let mut damped = matrix.clone();
        for i in 0..damped.nrows() {
            damped[(i, i)] += self.0 * scale[i];
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

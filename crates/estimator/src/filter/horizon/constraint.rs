//! Linear inequalities on the states of a window.
use crate::EstimatorError;

/// A row `a^T x_i <= b` on the state at every sample of the window, or `a^T (x_{i+1} - x_i) <= b` on every two
/// consecutive states.
#[derive(Clone, Debug, PartialEq)]
pub struct Constraint {
    /// State index and coefficient of the entries of `a` that are not zero.
    terms: Vec<(usize, f64)>,
    bound: f64,
    span: Span,
}

/// What a row acts on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Span {
    /// One state.
    State,
    /// The change from one sample to the next.
    Step,
}

impl Constraint {
    /// `x[state] <= bound`.
    pub fn at_most(state: usize, bound: f64) -> Self {
        Self::row(&[(state, 1.0)], bound)
    }

    /// `x[state] >= bound`.
    pub fn at_least(state: usize, bound: f64) -> Self {
        Self::row(&[(state, -1.0)], -bound)
    }

    /// `sum coefficient x[state] <= bound` over the pairs (state, coefficient).
    pub fn row(terms: &[(usize, f64)], bound: f64) -> Self {
        Self { terms: terms.to_vec(), bound, span: Span::State }
    }

    /// `sum coefficient (x_{i+1} - x_i)[state] <= bound` over the pairs (state, coefficient), from each sample to
    /// the next, however far apart in time they are.
    pub fn step(terms: &[(usize, f64)], bound: f64) -> Self {
        Self { terms: terms.to_vec(), bound, span: Span::Step }
    }

    /// How far `x` is outside this row, in units of the row; not positive inside.
    ///
    /// # Shapes
    /// `previous`, `x`: (n), the states at two consecutive samples; `previous` matters only to rows on steps.
    pub fn excess(&self, previous: &[f64], x: &[f64]) -> f64 {
        let value: f64 = match self.span {
            Span::State => self.terms.iter().map(|&(k, a)| a * x[k]).sum(),
            Span::Step => self.terms.iter().map(|&(k, a)| a * (x[k] - previous[k])).sum(),
        };
        value - self.bound
    }

    /// Sum of the magnitudes whose difference [`excess`](Self::excess) is: its rounding error is relative to this.
    pub(super) fn magnitude(&self, x: &[f64]) -> f64 {
        self.terms.iter().map(|&(k, a)| (a * x[k]).abs()).sum::<f64>() + self.bound.abs()
    }

    pub(super) fn terms(&self) -> &[(usize, f64)] {
        &self.terms
    }

    pub(super) fn span(&self) -> Span {
        self.span
    }

    /// Whether every sample of a window has the same value of this row: it names constants alone.
    pub(super) fn is_on_constants(&self, leading: usize) -> bool {
        self.span == Span::State && self.terms.iter().all(|&(k, _)| k >= leading)
    }

    /// Take the last rounding error off a simple bound, so that `x >= 0` holds to the last digit.
    pub(super) fn snap(&self, x: &mut [f64]) {
        if let (Span::State, &[(k, a)]) = (self.span, self.terms.as_slice()) {
            let bound = self.bound / a;
            x[k] = if a > 0.0 { x[k].min(bound) } else { x[k].max(bound) };
        }
    }

    /// Check against a problem of `states` states, of which `leading` move.
    pub(super) fn validate(&self, row: usize, states: usize, leading: usize) -> Result<(), EstimatorError> {
        let refuse = |reason| Err(EstimatorError::ConstraintRow { row, reason });
        if let Some(&(state, _)) = self.terms.iter().find(|&&(k, _)| k >= states) {
            return Err(EstimatorError::ConstraintState { row, state, states });
        }
        if !self.bound.is_finite() || self.terms.iter().any(|(_, a)| !a.is_finite()) {
            return refuse("bound and coefficients must be finite: leave the row out instead");
        }
        if self.terms.iter().all(|&(_, a)| a == 0.0) {
            return refuse("at least one coefficient must differ from zero");
        }
        if self.span == Span::Step && self.terms.iter().all(|&(k, _)| k >= leading) {
            return refuse("a row on steps must name a state that moves");
        }
        Ok(())
    }
}

/// One row at one place of the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct StageRow {
    /// Index into the constraints.
    pub row: usize,
    /// The (later) state that it acts on, from 0 at the window's start.
    pub stage: usize,
}

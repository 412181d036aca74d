//! What a layout is worth.

/// A number for each layout that is to be small and never grows with a sensor more.
pub trait Objective: Sync {
    /// Number of candidates.
    fn candidates(&self) -> usize;

    /// Value of a layout, infinite where it cannot see what it should. The indices are sorted, each is there once.
    fn value(&self, layout: &[usize]) -> f64;

    /// A convex function of weights between 0 and 1, one for each candidate, which at 0 and 1 is the value, with its gradient; `None` where
    /// it is infinite.
    fn relaxed(&self, weights: &[f64]) -> Option<Relaxed>;
}

/// Value and gradient at weights.
#[derive(Clone, Debug, PartialEq)]
pub struct Relaxed {
    /// Value.
    pub value: f64,
    /// Derivative by each weight; none is positive.
    pub gradient: Vec<f64>,
}

impl Relaxed {
    /// What the tangent at `at` says of the function at other weights: no convex function is below it.
    pub(crate) fn tangent(&self, at: &[f64], other: &[f64]) -> f64 {
        let steps = self.gradient.iter().zip(at.iter().zip(other));
        self.value + steps.map(|(slope, (at, other))| slope * (other - at)).sum::<f64>()
    }
}

//! Searches for the best layout.
mod branch;
mod exhaustive;
mod greedy;

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use serde::{Deserialize, Serialize};

use super::constraints::Constraints;
use super::objective::Objective;
use crate::EstimatorError;

/// How a layout was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Every layout that is allowed.
    Exhaustive,
    /// Branch and bound.
    BranchAndBound,
    /// Greedy, then swaps as long as one is better.
    Greedy,
}

/// A layout and what it is worth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Layout {
    /// Indices of its candidates, increasing.
    pub sensors: Vec<usize>,
    /// Its value.
    pub value: f64,
}

/// Result of a search.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SearchResult {
    /// The layouts within the tolerance of the best, the best first; those that were looked at.
    pub layouts: Vec<Layout>,
    /// What no allowed layout falls below, if the search itself proves one.
    pub bound: Option<f64>,
    /// How it was found.
    pub method: Method,
    /// Layouts whose value was computed.
    pub evaluated: u64,
    /// The search was stopped before its end.
    pub partial: bool,
}

impl SearchResult {
    /// The best one; `None` where no layout is allowed, or none sees what it should.
    pub fn best(&self) -> Option<&Layout> {
        self.layouts.first()
    }
}

/// Progress of a search, and the means to stop it.
#[derive(Debug, Default)]
pub struct SearchControl {
    /// Layouts evaluated so far.
    pub evaluated: AtomicU64,
    /// Set it to end the search with what it has.
    pub stop: AtomicBool,
}

impl SearchControl {
    fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    fn evaluate(&self, objective: &impl Objective, layout: &[usize]) -> f64 {
        self.evaluated.fetch_add(1, Ordering::Relaxed);
        objective.value(layout)
    }
}

/// Search for the layouts within a part of the best (0.02: 2 %).
///
/// # Errors
/// The constraints contradict each other.
pub fn search(
    objective: &impl Objective,
    constraints: &Constraints,
    method: Method,
    within: f64,
    control: &SearchControl,
) -> Result<SearchResult, EstimatorError> {
    constraints.validate(objective.candidates())?;
    let begun = control.evaluated.load(Ordering::Relaxed);
    let (layouts, proven) = match method {
        Method::Exhaustive => (exhaustive::search(objective, constraints, within, control), true),
        Method::BranchAndBound => (branch::search(objective, constraints, within, control), true),
        Method::Greedy => (greedy::search(objective, constraints, control), false),
    };
    let partial = control.is_stopped();
    let bound = layouts.first().map(|best| best.value).filter(|_| proven && !partial);
    let evaluated = control.evaluated.load(Ordering::Relaxed) - begun;
    Ok(SearchResult { layouts, bound, method, evaluated, partial })
}

/// The best layouts so far: those within a part of the best.
#[derive(Clone, Debug)]
struct Shortlist {
    within: f64,
    best: f64,
    layouts: Vec<Layout>,
}

impl Shortlist {
    /// Longest list before those that have fallen behind are dropped.
    const MAX_LIST: usize = 4096;

    fn new(within: f64) -> Self {
        Self { within, best: f64::INFINITY, layouts: Vec::new() }
    }

    /// Largest value that still counts.
    fn limit(&self) -> f64 {
        self.best + self.within * self.best.abs()
    }

    fn offer(&mut self, sensors: &[usize], value: f64) {
        if !value.is_finite() {
            return;
        }
        self.best = self.best.min(value);
        if value <= self.limit() {
            self.layouts.push(Layout { sensors: sensors.to_vec(), value });
            if self.layouts.len() >= Self::MAX_LIST {
                self.prune();
            }
        }
    }

    fn prune(&mut self) {
        let limit = self.limit();
        self.layouts.retain(|layout| layout.value <= limit);
    }

    fn merge(mut self, other: Self) -> Self {
        self.best = self.best.min(other.best);
        self.layouts.extend(other.layouts);
        self.prune();
        self
    }

    /// The best first; equal ones by their candidates.
    fn sorted(mut self) -> Vec<Layout> {
        self.prune();
        self.layouts.sort_by(|a, b| a.value.total_cmp(&b.value).then_with(|| a.sensors.cmp(&b.sensors)));
        self.layouts
    }
}

/// The cost of a layout as what is searched for: whether any is allowed.
pub(super) struct Costs<'a>(pub &'a [f64]);

impl Objective for Costs<'_> {
    fn candidates(&self) -> usize {
        self.0.len()
    }

    fn value(&self, layout: &[usize]) -> f64 {
        layout.iter().map(|index| self.0[*index]).sum()
    }

    fn relaxed(&self, _: &[f64]) -> Option<super::objective::Relaxed> {
        None
    }
}

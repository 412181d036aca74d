//! A problem in which every candidate brings states of its own, such as its offset: they count only where it is read.
//!
//! A weight `z` between 0 and 1 makes all errors of a candidate larger by `1 / sqrt(z)`, those of its own states too: were they left as
//! they are, a little of many candidates would average their offsets out, and the bound would be far too low. The same is read by
//!
//! `y = sqrt(z) h^T x + h_o^T o + v`, `o <- F_o o + sqrt(z) F_ox x + w_o`
//!
//! with the shared states `x` and its own `o`. The information of a record is then linear in `z`, whatever the spectrum of the errors, and the value
//! convex. Its derivative has, beside that of the outputs, a part from the transition, with `A = I - K H`, `W = A^T Y A`:
//!
//! `dV/dz = -(h + h_o / sqrt(z))^T P Y P h / sigma^2 + sum F_ox,is (P F^T W)_si / sqrt(z)`.
//!
//! Candidates that are alike, such as thermometers on one cell of the mesh, are one candidate with the sum of their weights: information adds.
use std::collections::HashMap;
use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use super::objective::{Objective, Relaxed};
use super::problem::{CandidateOutput, LinearProblem, remembered};
use crate::EstimatorError;

/// A linear problem whose states are shared by all candidates or belong to one of them.
///
/// The states of a candidate that is not read move by themselves and are seen by nobody, so a layout has the value of the problem
/// without them, which is much smaller.
#[derive(Clone, Debug)]
pub struct GroupedProblem {
    whole: LinearProblem,
    shared: Vec<usize>,
    /// States of each candidate.
    own: Vec<Vec<usize>>,
    /// One of each kind, and which kind each candidate is.
    kinds: Vec<usize>,
    kind_of: Vec<usize>,
}

/// Least weight: what is read with it says nothing, but its derivative is there.
const LEAST_WEIGHT: f64 = 1e-8;

impl GroupedProblem {
    /// The whole problem, and the candidate that each of its states belongs to, if any (n).
    ///
    /// # Errors
    /// The owners are not as many as the states, or one is no candidate.
    pub(crate) fn new(whole: LinearProblem, owners: &[Option<usize>]) -> Result<Self, EstimatorError> {
        let (states, candidates) = (whole.transition().nrows(), whole.outputs().len());
        if owners.len() != states {
            return Err(EstimatorError::StateLength { length: owners.len(), states });
        }
        let mut own = vec![Vec::new(); candidates];
        let mut shared = Vec::new();
        for (state, owner) in owners.iter().enumerate() {
            match owner {
                None => shared.push(state),
                Some(candidate) => own
                    .get_mut(*candidate)
                    .ok_or(EstimatorError::ReadingsLength { readings: *candidate, outputs: candidates })?
                    .push(state),
            }
        }
        let mut problem = Self { whole, shared, own, kinds: Vec::new(), kind_of: Vec::new() };
        problem.tell_kinds();
        Ok(problem)
    }

    /// Those that are read alike and have errors alike.
    fn tell_kinds(&mut self) {
        let mut known = HashMap::new();
        for candidate in 0..self.own.len() {
            let alone = self.of_layout(&[candidate]);
            let shared = self.shared.len();
            let own = self.own[candidate].len();
            // What the shared states do among each other is the same for all.
            let moves = alone.transition().rows(shared, own);
            let walks = alone.process_noise().rows(shared, own);
            let CandidateOutput { gradient, variance } = &alone.outputs()[0];
            let numbers = moves.iter().chain(walks.iter()).chain(gradient.iter()).chain([variance]);
            let key: Vec<u64> = numbers.map(|value| value.to_bits()).collect();
            let kind = *known.entry(key).or_insert(self.kinds.len());
            if kind == self.kinds.len() {
                self.kinds.push(candidate);
            }
            self.kind_of.push(kind);
        }
    }

    /// The problem with the states of all candidates.
    pub fn whole(&self) -> &LinearProblem {
        &self.whole
    }

    /// The problem of one of each kind, which reads the shared states times a root of its weight; its first states are the shared ones.
    fn weighed(&self, roots: &[f64]) -> LinearProblem {
        let whole = self.of_layout(&self.kinds);
        let mut transition = whole.transition().clone();
        let mut outputs = whole.outputs().to_vec();
        let shared = self.shared.len();
        for ((root, own), output) in roots.iter().zip(self.own_of_kinds()).zip(&mut outputs) {
            output.gradient.rows_mut(0, shared).scale_mut(*root);
            transition.view_mut((own.start, 0), (own.len(), shared)).scale_mut(*root);
        }
        let noise = whole.process_noise().clone();
        LinearProblem::of_parts(transition, noise, whole.functional().clone(), outputs)
    }

    /// Where the own states of each kind are in their problem.
    fn own_of_kinds(&self) -> impl Iterator<Item = Range<usize>> {
        let mut next = self.shared.len();
        self.kinds.iter().map(move |candidate| {
            let begun = next;
            next += self.own[*candidate].len();
            begun..next
        })
    }

    /// States that a layout has to do with: those that are shared, then its candidates' own.
    pub fn states_of(&self, layout: &[usize]) -> Vec<usize> {
        let own = layout.iter().flat_map(|candidate| &self.own[*candidate]);
        self.shared.iter().chain(own).copied().collect()
    }

    /// The problem of a layout alone: its candidates in their order, without the states of all others.
    pub fn of_layout(&self, layout: &[usize]) -> LinearProblem {
        let states = self.states_of(layout);
        // Not by whole rows: those of a thousand candidates are long.
        let square = |of: &DMatrix<f64>| {
            DMatrix::from_fn(states.len(), states.len(), |i, j| of[(states[i], states[j])])
        };
        let part = |of: &DVector<f64>| of.select_rows(&states);
        let output = |candidate: &usize| {
            let CandidateOutput { gradient, variance } = &self.whole.outputs()[*candidate];
            CandidateOutput { gradient: part(gradient), variance: *variance }
        };
        LinearProblem::of_parts(
            square(self.whole.transition()),
            square(self.whole.process_noise()),
            part(self.whole.functional()),
            layout.iter().map(output).collect(),
        )
    }
}

impl Objective for GroupedProblem {
    fn candidates(&self) -> usize {
        self.whole.candidates()
    }

    fn value(&self, layout: &[usize]) -> f64 {
        let all: Vec<usize> = (0..layout.len()).collect();
        self.of_layout(layout).value(&all)
    }

    fn relaxed(&self, weights: &[f64]) -> Option<Relaxed> {
        let mut of_kind = vec![0.0; self.kinds.len()];
        weights.iter().zip(&self.kind_of).for_each(|(weight, kind)| of_kind[*kind] += weight);
        let roots: Vec<f64> = of_kind.iter().map(|weight: &f64| weight.max(LEAST_WEIGHT).sqrt()).collect();
        let weighed = self.weighed(&roots);
        let steady = weighed.steady(&weighed.information_of_all())?;
        let counted = remembered(&steady.error, weighed.functional())?;
        let per_information = &steady.updated * &counted * &steady.updated;
        let per_transition = &steady.updated
            * weighed.transition().transpose()
            * steady.left.transpose()
            * counted
            * &steady.left;
        let shared = self.shared.len();
        let slope = |((root, own), output): ((&f64, Range<usize>), &CandidateOutput)| {
            let by_output =
                (&per_information * &output.gradient).rows(0, shared).dot(&output.gradient.rows(0, shared))
                    / output.variance;
            let rows = weighed.transition().view((own.start, 0), (own.len(), shared));
            let by_transition =
                rows.transpose().dot(&per_transition.view((0, own.start), (shared, own.len())));
            // Both have the root in them once already.
            (by_transition - by_output) / (root * root)
        };
        let slopes: Vec<f64> =
            roots.iter().zip(self.own_of_kinds()).zip(weighed.outputs()).map(slope).collect();
        Some(Relaxed {
            value: weighed.variance(&steady),
            gradient: self.kind_of.iter().map(|kind| slopes[*kind]).collect(),
        })
    }
}

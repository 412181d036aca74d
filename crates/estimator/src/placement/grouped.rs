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
}

/// Least weight: what is read with it says nothing, but its derivative is there.
const LEAST_WEIGHT: f64 = 1e-8;

impl GroupedProblem {
    /// The whole problem, and the candidate that each of its states belongs to, if any (n).
    ///
    /// # Errors
    /// The owners are not as many as the states, or one is no candidate.
    pub fn new(whole: LinearProblem, owners: &[Option<usize>]) -> Result<Self, EstimatorError> {
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
        Ok(Self { whole, shared, own })
    }

    /// The problem with the states of all candidates.
    pub fn whole(&self) -> &LinearProblem {
        &self.whole
    }

    /// The problem in which each candidate reads the shared states times a root of its weight.
    fn weighed(&self, roots: &[f64]) -> LinearProblem {
        let mut transition = self.whole.transition().clone();
        let mut outputs = self.whole.outputs().to_vec();
        for ((root, own), output) in roots.iter().zip(&self.own).zip(&mut outputs) {
            for &state in &self.shared {
                output.gradient[state] *= root;
                own.iter().for_each(|&own| transition[(own, state)] *= root);
            }
        }
        let noise = self.whole.process_noise().clone();
        LinearProblem::of_parts(transition, noise, self.whole.functional().clone(), outputs)
    }

    /// States that a layout has to do with: those that are shared, then its candidates' own.
    pub fn states_of(&self, layout: &[usize]) -> Vec<usize> {
        let own = layout.iter().flat_map(|candidate| &self.own[*candidate]);
        self.shared.iter().chain(own).copied().collect()
    }

    /// The problem of a layout alone: its candidates in their order, without the states of all others.
    pub fn of_layout(&self, layout: &[usize]) -> LinearProblem {
        let states = self.states_of(layout);
        let square = |of: &DMatrix<f64>| of.select_rows(&states).select_columns(&states);
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
        let roots: Vec<f64> = weights.iter().map(|weight| weight.max(LEAST_WEIGHT).sqrt()).collect();
        let weighed = self.weighed(&roots);
        let all = weighed.information((0..roots.len()).map(|index| (index, 1.0)));
        let steady = weighed.steady(&all)?;
        let counted = remembered(&steady.error, weighed.functional())?;
        let per_information = &steady.updated * &counted * &steady.updated;
        let per_transition = &steady.updated
            * weighed.transition().transpose()
            * steady.left.transpose()
            * counted
            * &steady.left;
        let slope = |(candidate, root): (usize, &f64)| {
            let CandidateOutput { gradient, variance } = &weighed.outputs()[candidate];
            let of_shared = |matrix: &DVector<f64>| -> f64 {
                self.shared
                    .iter()
                    .map(|&state| matrix[state] * self.whole.outputs()[candidate].gradient[state])
                    .sum()
            };
            let by_output = -of_shared(&(&per_information * gradient)) / (variance * root);
            let by_transition: f64 = self.own[candidate]
                .iter()
                .flat_map(|&own| self.shared.iter().map(move |&state| (own, state)))
                .map(|(own, state)| self.whole.transition()[(own, state)] * per_transition[(state, own)])
                .sum();
            by_output + by_transition / root
        };
        Some(Relaxed {
            value: weighed.variance(&steady),
            gradient: roots.iter().enumerate().map(slope).collect(),
        })
    }
}

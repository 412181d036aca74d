//! The polytope of weights, and the least of tangents over it.
use super::super::constraints::Constraints;
use super::super::objective::Relaxed;
use super::program::{ConeProgram, Row};
use crate::EstimatorError;

/// Tangents over the polytope of weights.
pub(super) struct Cuts {
    candidates: usize,
    /// `a^T z = b` and `a^T z <= b`.
    equal: Vec<Row>,
    at_most: Vec<Row>,
    /// `slope^T z - t <= -offset`, in units of `scale`.
    tangents: Vec<(Vec<f64>, f64)>,
    scale: f64,
}

impl Cuts {
    pub(super) fn new(constraints: &Constraints, candidates: usize) -> Self {
        let all = |value: f64| (0..candidates).map(|index| (index, value)).collect();
        let mut equal = vec![Row::new(all(1.0), constraints.sensors as f64)];
        let fixed = |index: &usize, value: f64| Row::new(vec![(*index, 1.0)], value);
        equal.extend(constraints.must.iter().map(|index| fixed(index, 1.0)));
        equal.extend(constraints.forbidden.iter().map(|index| fixed(index, 0.0)));
        let mut at_most: Vec<Row> = (0..candidates)
            .flat_map(|index| [Row::new(vec![(index, -1.0)], 0.0), Row::new(vec![(index, 1.0)], 1.0)])
            .collect();
        for group in &constraints.groups {
            let members = |value: f64| group.members.iter().map(|member| (*member, value)).collect();
            at_most.push(Row::new(members(1.0), group.most as f64));
            at_most.push(Row::new(members(-1.0), -(group.fewest as f64)));
        }
        let too_close = |&(a, b): &(usize, usize)| Row::new(vec![(a, 1.0), (b, 1.0)], 1.0);
        at_most.extend(constraints.apart.iter().map(too_close));
        if !constraints.costs.is_empty() && constraints.budget.is_finite() {
            let largest = constraints.costs.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
            let costs = constraints.costs.iter().map(|cost| cost / largest).enumerate().collect();
            at_most.push(Row::new(costs, constraints.budget / largest));
        }
        Self { candidates, equal, at_most, tangents: Vec::new(), scale: 1.0 }
    }

    /// Weights inside: as far from its faces as the solver's interior is.
    pub(super) fn inside(&self) -> Result<Vec<f64>, EstimatorError> {
        self.least_of(&vec![0.0; self.candidates])
    }

    /// Weights at which a linear function is least.
    pub(super) fn least_of(&self, slope: &[f64]) -> Result<Vec<f64>, EstimatorError> {
        let largest = slope.iter().fold(0.0, |of: f64, by| of.max(by.abs())).max(f64::MIN_POSITIVE);
        let mut program = ConeProgram::new(self.candidates);
        program.linear = slope.iter().map(|by| by / largest).collect();
        self.constrain(&mut program);
        Ok(self.within(program.solve()?.x))
    }

    /// Take in a tangent.
    pub(super) fn add(&mut self, relaxed: &Relaxed, at: &[f64]) {
        if self.tangents.is_empty() {
            self.scale = relaxed.value.abs().max(f64::MIN_POSITIVE);
        }
        let offset = relaxed.tangent(at, &vec![0.0; at.len()]) / self.scale;
        self.tangents.push((relaxed.gradient.iter().map(|by| by / self.scale).collect(), offset));
    }

    /// The least of the largest tangent, and where.
    pub(super) fn least(&self) -> Result<(f64, Vec<f64>), EstimatorError> {
        let level = self.candidates;
        let mut program = ConeProgram::new(self.candidates + 1);
        program.linear[level] = 1.0;
        self.constrain(&mut program);
        for (slope, offset) in &self.tangents {
            let mut row: Vec<(usize, f64)> = slope.iter().copied().enumerate().collect();
            row.push((level, -1.0));
            program.at_most.push(Row::new(row, -offset));
        }
        let solved = program.solve()?;
        // The dual objective is below the optimum whatever is left of the gap.
        let bound = solved.dual * self.scale;
        let weights = solved.x[..level].to_vec();
        Ok((bound, self.within(weights)))
    }

    /// Add the polytope to a program whose first variables are the weights.
    pub(super) fn constrain(&self, program: &mut ConeProgram) {
        program.equal.extend(self.equal.iter().cloned());
        program.at_most.extend(self.at_most.iter().cloned());
    }

    fn within(&self, weights: Vec<f64>) -> Vec<f64> {
        weights.into_iter().map(|weight| weight.clamp(0.0, 1.0)).collect()
    }
}

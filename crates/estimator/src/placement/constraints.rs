//! Which layouts are allowed.
use serde::{Deserialize, Serialize};

use crate::EstimatorError;

/// Candidates of which at least and at most so many are taken.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Group {
    /// Indices of the candidates.
    pub members: Vec<usize>,
    /// Fewest of them.
    pub fewest: usize,
    /// Most of them.
    pub most: usize,
}

/// Which layouts are allowed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Constraints {
    /// Number of sensors.
    pub sensors: usize,
    /// Candidates that every layout has.
    pub must: Vec<usize>,
    /// Candidates that none has.
    pub forbidden: Vec<usize>,
    /// Groups.
    pub groups: Vec<Group>,
    /// Pairs that are too close to each other.
    pub apart: Vec<(usize, usize)>,
    /// Cost of each candidate; empty: none is counted.
    pub costs: Vec<f64>,
    /// Largest cost of a layout.
    pub budget: f64,
}

impl Constraints {
    /// So many sensors, and nothing else.
    pub fn of(sensors: usize) -> Self {
        Self {
            sensors,
            must: Vec::new(),
            forbidden: Vec::new(),
            groups: Vec::new(),
            apart: Vec::new(),
            costs: Vec::new(),
            budget: f64::INFINITY,
        }
    }

    /// Cost of a layout.
    pub(crate) fn cost(&self, layout: &[usize]) -> f64 {
        layout.iter().filter_map(|index| self.costs.get(*index)).sum()
    }

    /// Whether a layout of the right number is allowed.
    pub fn allow(&self, layout: &[usize]) -> bool {
        let has = |index: &usize| layout.binary_search(index).is_ok();
        let within = |group: &Group| {
            let taken = group.members.iter().filter(|member| has(member)).count();
            (group.fewest..=group.most).contains(&taken)
        };
        layout.len() == self.sensors
            && self.must.iter().all(has)
            && !self.forbidden.iter().any(has)
            && self.groups.iter().all(within)
            && !self.apart.iter().any(|(a, b)| has(a) && has(b))
            && self.cost(layout) <= self.budget
    }

    /// Whether a part of a layout may still become one that is allowed, if others are added to it.
    pub(crate) fn may_grow(&self, part: &[usize]) -> bool {
        let has = |index: &usize| part.contains(index);
        let not_full =
            |group: &Group| group.members.iter().filter(|member| has(member)).count() <= group.most;
        part.len() <= self.sensors
            && !self.forbidden.iter().any(has)
            && self.groups.iter().all(not_full)
            && !self.apart.iter().any(|(a, b)| has(a) && has(b))
            && self.cost(part) <= self.budget
    }

    /// Candidates that may be in a layout beside those that must.
    pub(crate) fn free(&self, candidates: usize) -> Vec<usize> {
        let free = |index: &usize| !self.must.contains(index) && !self.forbidden.contains(index);
        (0..candidates).filter(free).collect()
    }

    /// Check that they do not contradict each other as far as can be seen without a search.
    ///
    /// # Errors
    /// Names the contradiction.
    pub(crate) fn validate(&self, candidates: usize) -> Result<(), EstimatorError> {
        let refuse = |what: String| Err(EstimatorError::PlacementConstraints { what });
        let mut named =
            self.must.iter().chain(&self.forbidden).chain(self.groups.iter().flat_map(|of| &of.members));
        if let Some(index) = named.find(|index| **index >= candidates) {
            return refuse(format!("candidate {index} is named, but there are only {candidates}"));
        }
        if self.sensors == 0 || self.sensors > candidates {
            return refuse(format!("{} sensors are asked for out of {candidates} candidates", self.sensors));
        }
        if let Some(both) = self.must.iter().find(|index| self.forbidden.contains(index)) {
            return refuse(format!("candidate {both} is required and forbidden"));
        }
        if self.must.len() > self.sensors {
            return refuse(format!(
                "{} sensors are required, but only {} asked for",
                self.must.len(),
                self.sensors
            ));
        }
        if let Some((a, b)) = self.apart.iter().find(|(a, b)| self.must.contains(a) && self.must.contains(b))
        {
            return refuse(format!("candidates {a} and {b} are required, but too close to each other"));
        }
        let open = self.free(candidates).len() + self.must.len();
        if open < self.sensors {
            return refuse(format!(
                "{} sensors are asked for, but only {open} candidates are not forbidden",
                self.sensors
            ));
        }
        for group in &self.groups {
            if group.fewest > group.most || group.fewest > group.members.len() || group.fewest > self.sensors
            {
                return refuse(format!(
                    "a group of {} needs {} to {} sensors out of {}",
                    group.members.len(),
                    group.fewest,
                    group.most,
                    self.sensors
                ));
            }
        }
        if !self.costs.is_empty() && self.costs.len() != candidates {
            return refuse(format!("{} costs are given for {candidates} candidates", self.costs.len()));
        }
        if let Some(cost) = self.costs.iter().find(|cost| !(cost.is_finite() && **cost >= 0.0)) {
            return refuse(format!("a cost of {cost} is given; costs are finite and at least 0"));
        }
        let cheapest = self.cheapest(candidates);
        if cheapest > self.budget {
            return refuse(format!(
                "{} sensors cost at least {cheapest}, but the budget is {}",
                self.sensors, self.budget
            ));
        }
        Ok(())
    }

    /// Cost of the cheapest layout by number and cost alone.
    fn cheapest(&self, candidates: usize) -> f64 {
        let mut costs: Vec<f64> =
            self.free(candidates).into_iter().filter_map(|index| self.costs.get(index).copied()).collect();
        costs.sort_by(f64::total_cmp);
        self.cost(&self.must) + costs.iter().take(self.sensors - self.must.len()).sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_allowed_is_allowed_and_nothing_else() {
        let constraints = Constraints {
            must: vec![1],
            forbidden: vec![4],
            groups: vec![Group { members: vec![2, 3], fewest: 1, most: 1 }],
            apart: vec![(0, 2)],
            costs: vec![1.0, 1.0, 1.0, 3.0, 0.0, 1.0],
            budget: 4.5,
            ..Constraints::of(3)
        };
        constraints.validate(6).unwrap();
        for (layout, allowed) in [
            ([1, 2, 5], true),
            ([1, 2, 3], false),
            ([0, 1, 2], false),
            ([0, 1, 5], false),
            ([0, 2, 5], false),
            ([1, 2, 4], false),
            ([0, 1, 3], false),
        ] {
            assert_eq!(constraints.allow(&layout), allowed, "{layout:?}");
        }
        assert!(!constraints.allow(&[1, 2]));
        assert!(
            constraints.may_grow(&[1]) && !constraints.may_grow(&[0, 2]) && !constraints.may_grow(&[2, 3])
        );
    }

    #[test]
    fn contradictions_are_named() {
        let of = Constraints::of;
        for (constraints, part) in [
            (of(0), "0 sensors"),
            (of(7), "7 sensors"),
            (Constraints { must: vec![9], ..of(2) }, "candidate 9"),
            (Constraints { must: vec![1], forbidden: vec![1], ..of(2) }, "required and forbidden"),
            (Constraints { must: vec![1, 2], ..of(1) }, "2 sensors are required"),
            (Constraints { must: vec![1, 2], apart: vec![(1, 2)], ..of(3) }, "too close"),
            (Constraints { forbidden: vec![0, 1, 2, 3, 4], ..of(2) }, "only 1 candidates"),
            (
                Constraints { groups: vec![Group { members: vec![0], fewest: 2, most: 3 }], ..of(3) },
                "a group of 1",
            ),
            (Constraints { costs: vec![2.0; 6], budget: 3.0, ..of(2) }, "cost at least 4"),
            (Constraints { costs: vec![2.0; 5], ..of(2) }, "5 costs"),
            (Constraints { costs: vec![f64::NAN; 6], ..of(2) }, "NaN"),
        ] {
            let message = constraints.validate(6).unwrap_err().to_string();
            assert!(message.contains(part), "{message}");
        }
    }
}

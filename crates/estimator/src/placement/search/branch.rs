//! Branch and bound: layouts are left out together where their bound shows that none of them can be among the best.
//!
//! A node has sensors that are in and others that are open, of which some more are taken. Two bounds hold for all layouts
//! below it: the value with every open sensor in (a sensor more never harms), and the least of the tangent at equal weights of the open
//! ones, which the steepest of them reach. The larger one counts. Sensors are tried in the order of their slopes, so that good layouts come early.
use super::{Constraints, Layout, Objective, SearchControl, Shortlist, greedy};

/// The layouts within a part of the best.
pub(super) fn search(
    objective: &impl Objective,
    constraints: &Constraints,
    within: f64,
    control: &SearchControl,
) -> Vec<Layout> {
    let mut list = Shortlist::new(within);
    // A good layout from the start prunes; it is offered again when it comes by.
    if let Some(first) = greedy::search(objective, constraints, control).first() {
        list.best = first.value;
    }
    let mut tree = Tree { objective, constraints, control, list };
    let open = constraints.free(objective.candidates());
    tree.visit(&mut constraints.must.clone(), &open);
    tree.list.sorted()
}

struct Tree<'a, O> {
    objective: &'a O,
    constraints: &'a Constraints,
    control: &'a SearchControl,
    list: Shortlist,
}

impl<O: Objective> Tree<'_, O> {
    fn visit(&mut self, taken: &mut Vec<usize>, open: &[usize]) {
        let missing = self.constraints.sensors - taken.len();
        if self.control.is_stopped() || missing > open.len() || !self.constraints.may_grow(taken) {
            return;
        }
        if missing == 0 {
            let mut layout = taken.clone();
            layout.sort_unstable();
            if self.constraints.allow(&layout) {
                let value = self.control.evaluate(self.objective, &layout);
                self.list.offer(&layout, value);
            }
            return;
        }
        let Some((bound, slopes)) = self.bound(taken, open, missing) else { return };
        if bound > self.list.limit() {
            return;
        }
        let mut order: Vec<usize> = open.to_vec();
        order.sort_by(|a, b| slopes[*a].total_cmp(&slopes[*b]).then(a.cmp(b)));
        // Layouts with the first one, then those without it but with the second, ...
        for (at, index) in order.iter().enumerate() {
            taken.push(*index);
            self.visit(taken, &order[at + 1..]);
            taken.pop();
        }
    }

    /// What no layout below the node falls below, and the slopes there; `None` where none sees what it should.
    fn bound(&self, taken: &[usize], open: &[usize], missing: usize) -> Option<(f64, Vec<f64>)> {
        let share = missing as f64 / open.len() as f64;
        let mut all: Vec<usize> = taken.iter().chain(open).copied().collect();
        all.sort_unstable();
        let with_all = self.control.evaluate(self.objective, &all);
        if !with_all.is_finite() {
            return None;
        }
        let mut weights = vec![0.0; self.objective.candidates()];
        taken.iter().for_each(|index| weights[*index] = 1.0);
        open.iter().for_each(|index| weights[*index] = share);
        let relaxed = self.objective.relaxed(&weights)?;
        let mut steepest: Vec<f64> = open.iter().map(|index| relaxed.gradient[*index]).collect();
        steepest.sort_by(f64::total_cmp);
        let back: f64 = steepest.iter().map(|slope| slope * share).sum();
        let forth: f64 = steepest.iter().take(missing).sum();
        Some((with_all.max(relaxed.value - back + forth), relaxed.gradient))
    }
}

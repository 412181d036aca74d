//! Every layout that is allowed, in parallel.
use rayon::prelude::*;

use super::{Constraints, Layout, Objective, SearchControl, Shortlist};

/// The layouts within a part of the best.
pub(super) fn search(
    objective: &impl Objective,
    constraints: &Constraints,
    within: f64,
    control: &SearchControl,
) -> Vec<Layout> {
    let free = constraints.free(objective.candidates());
    let wanted = constraints.sensors - constraints.must.len();
    // One job for the first two free sensors.
    let depth = wanted.min(2);
    let mut prefixes = Vec::new();
    combine(&free, 0, depth, &mut Vec::new(), &mut |prefix| prefixes.push(prefix.to_vec()));
    let of_prefix = |prefix: &Vec<usize>| {
        let mut list = Shortlist::new(within);
        let next = prefix.last().map_or(0, |last| last + 1);
        let mut chosen = prefix.clone();
        combine(&free, next, wanted - depth, &mut chosen, &mut |positions| {
            let mut layout: Vec<usize> = positions.iter().map(|at| free[*at]).collect();
            layout.extend(&constraints.must);
            layout.sort_unstable();
            if !control.is_stopped() && constraints.allow(&layout) {
                list.offer(&layout, control.evaluate(objective, &layout));
            }
        });
        list
    };
    prefixes.par_iter().map(of_prefix).reduce(|| Shortlist::new(within), Shortlist::merge).sorted()
}

/// All increasing positions in `free` from `next` on, `more` of them behind those that are chosen.
fn combine(
    free: &[usize],
    next: usize,
    more: usize,
    chosen: &mut Vec<usize>,
    take: &mut impl FnMut(&[usize]),
) {
    if more == 0 {
        return take(chosen);
    }
    for position in next..=free.len().saturating_sub(more) {
        if position >= free.len() {
            break;
        }
        chosen.push(position);
        combine(free, position + 1, more - 1, chosen, take);
        chosen.pop();
    }
}

//! Greedy search, then swaps of one sensor for another as long as one is better.
//!
//! As long as no layout sees what it should, the gradient of the relaxed value at equal weights says what to take.
use rayon::prelude::*;

use super::{Constraints, Layout, Objective, SearchControl};

/// The layout that no swap betters; empty where none was found.
pub(super) fn search(
    objective: &impl Objective,
    constraints: &Constraints,
    control: &SearchControl,
) -> Vec<Layout> {
    let Some(mut layout) = begin(objective, constraints, control) else { return Vec::new() };
    let mut value = control.evaluate(objective, &layout);
    while !control.is_stopped() {
        let Some(better) = best_swap(objective, constraints, &layout, value, control) else { break };
        (layout, value) = (better.sensors, better.value);
    }
    if value.is_finite() { vec![Layout { sensors: layout, value }] } else { Vec::new() }
}

/// One sensor after the other, each the one that helps most.
fn begin(
    objective: &impl Objective,
    constraints: &Constraints,
    control: &SearchControl,
) -> Option<Vec<usize>> {
    let candidates = objective.candidates();
    let share = constraints.sensors as f64 / candidates as f64;
    let slope = objective.relaxed(&vec![share; candidates]).map(|relaxed| relaxed.gradient);
    let mut layout = constraints.must.clone();
    layout.sort_unstable();
    while layout.len() < constraints.sensors {
        let missing = constraints.sensors - layout.len();
        let next = constraints.free(candidates).into_par_iter().filter(|index| !layout.contains(index));
        let next = next.filter_map(|index| {
            let grown = with(&layout, index);
            let last = missing == 1;
            let open = if last {
                constraints.allow(&grown)
            } else {
                can_be_completed(constraints, &grown, candidates)
            };
            open.then(|| {
                (control.evaluate(objective, &grown), slope.as_ref().map_or(0.0, |of| of[index]), index)
            })
        });
        let by_value = |a: &(f64, f64, usize), b: &(f64, f64, usize)| {
            a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2))
        };
        layout = with(&layout, next.min_by(by_value)?.2);
    }
    constraints.allow(&layout).then_some(layout)
}

/// Whether the part can grow, the budget leaves enough for the cheapest others, and the groups can still be filled.
fn can_be_completed(constraints: &Constraints, part: &[usize], candidates: usize) -> bool {
    if !constraints.may_grow(part) {
        return false;
    }
    let missing = constraints.sensors - part.len();
    let short = |group: &super::super::Group| {
        let taken = group.members.iter().filter(|member| part.contains(member)).count();
        group.fewest.saturating_sub(taken)
    };
    // Groups may share members: the largest need of one is what is certain.
    let needed = constraints.groups.iter().map(short).max().unwrap_or(0);
    let others = constraints.free(candidates).into_iter().filter(|index| !part.contains(index));
    let mut costs: Vec<f64> =
        others.map(|index| constraints.costs.get(index).copied().unwrap_or(0.0)).collect();
    costs.sort_by(f64::total_cmp);
    let rest: f64 = costs.iter().take(missing).sum();
    needed <= missing && constraints.cost(part) + rest <= constraints.budget
}

/// The best layout that differs by one sensor and is better.
fn best_swap(
    objective: &impl Objective,
    constraints: &Constraints,
    layout: &[usize],
    value: f64,
    control: &SearchControl,
) -> Option<Layout> {
    let free = constraints.free(objective.candidates());
    let out = layout.iter().copied().filter(|index| !constraints.must.contains(index));
    let swaps: Vec<(usize, usize)> = out
        .flat_map(|out| free.iter().filter(|index| !layout.contains(index)).map(move |into| (out, *into)))
        .collect();
    let tried = swaps.into_par_iter().filter_map(|(out, into)| {
        let others: Vec<usize> = layout.iter().copied().filter(|index| *index != out).collect();
        let sensors = with(&others, into);
        let allowed = !control.is_stopped() && constraints.allow(&sensors);
        allowed.then(|| Layout { value: control.evaluate(objective, &sensors), sensors })
    });
    let best = tried.min_by(|a, b| a.value.total_cmp(&b.value).then_with(|| a.sensors.cmp(&b.sensors)))?;
    (best.value < value).then_some(best)
}

fn with(layout: &[usize], index: usize) -> Vec<usize> {
    let mut grown = layout.to_vec();
    grown.push(index);
    grown.sort_unstable();
    grown
}

//! Which member of the bank gives what.
use super::settings::LeakHypothesis;

/// The middle one of the members that have a leak rate.
pub(crate) fn middle_slow(bank: &[LeakHypothesis]) -> Option<usize> {
    let slow = || (0..bank.len()).filter(|&index| bank[index].is_slow());
    slow().nth(slow().count() / 2)
}

/// The one that gives the gas temperature: the same, if it trusts the pressure, or the first.
pub(super) fn thermometer(bank: &[LeakHypothesis]) -> usize {
    middle_slow(bank).filter(|&index| bank[index].caution_pa_k == 0.0).unwrap_or(0)
}

/// The first of those whose mass walks farthest.
pub(super) fn freest(bank: &[LeakHypothesis]) -> usize {
    let walk = |index: &usize| bank[*index].mass_walk_kg_per_sqrt_s;
    (0..bank.len()).rev().max_by(|a, b| walk(a).total_cmp(&walk(b))).unwrap_or(0)
}

/// The one that holds the mass, beside the first: no leak rate, and a mass that walks less than the freest one's.
pub(super) fn held(bank: &[LeakHypothesis]) -> Option<usize> {
    let freest = freest(bank);
    let holds = |&index: &usize| {
        let walk = bank[index].mass_walk_kg_per_sqrt_s;
        bank[index].rate.is_known() && walk < bank[freest].mass_walk_kg_per_sqrt_s
    };
    (1..bank.len()).find(holds)
}

/// The one whose gas may flow: the last, if it does.
pub(super) fn flowing(bank: &[LeakHypothesis]) -> Option<usize> {
    bank.last().filter(|last| last.is_flowing()).map(|_| bank.len() - 1)
}

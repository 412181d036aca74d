//! Which member of the bank gives what.
use super::settings::LeakHypothesis;

/// Members of a bank by what they give.
#[derive(Clone, Copy, Debug)]
pub(super) struct Roles {
    /// Number of members.
    pub members: usize,
    /// The middle one of the members that have a leak rate, in the order of the bank; without any, the one that holds the mass.
    pub slow: Option<usize>,
    /// The member that holds the mass.
    pub held: Option<usize>,
    /// The member that gives the gas temperature: the same, if it trusts the pressure, or the first.
    pub thermometer: usize,
    /// The member whose mass walks most freely: it judges the others.
    pub freest: usize,
    /// The member whose gas may flow.
    pub flowing: Option<usize>,
}

impl Roles {
    pub(super) fn of(bank: &[LeakHypothesis]) -> Self {
        let held = held(bank);
        Self {
            members: bank.len(),
            slow: middle_slow(bank).or(held),
            held,
            thermometer: thermometer(bank),
            freest: freest(bank),
            flowing: flowing(bank),
        }
    }
}

/// The middle one of the members that have a leak rate.
pub(crate) fn middle_slow(bank: &[LeakHypothesis]) -> Option<usize> {
    let slow = || (0..bank.len()).filter(|&index| bank[index].is_slow());
    slow().nth(slow().count() / 2)
}

/// The one that gives the gas temperature: the same, if it trusts the pressure, or the first.
fn thermometer(bank: &[LeakHypothesis]) -> usize {
    middle_slow(bank).filter(|&index| bank[index].caution_pa_k == 0.0).unwrap_or(0)
}

/// The first of those whose mass walks farthest.
fn freest(bank: &[LeakHypothesis]) -> usize {
    let walk = |index: &usize| bank[*index].mass_walk_kg_per_sqrt_s;
    (0..bank.len()).rev().max_by(|a, b| walk(a).total_cmp(&walk(b))).unwrap_or(0)
}

/// The one that holds the mass, beside the first: no leak rate, and a mass that walks less than the freest one's.
fn held(bank: &[LeakHypothesis]) -> Option<usize> {
    let freest = freest(bank);
    let holds = |&index: &usize| {
        let walk = bank[index].mass_walk_kg_per_sqrt_s;
        bank[index].rate.is_known() && walk < bank[freest].mass_walk_kg_per_sqrt_s
    };
    (1..bank.len()).find(holds)
}

/// The one whose gas may flow: the last, if it does.
fn flowing(bank: &[LeakHypothesis]) -> Option<usize> {
    bank.last().filter(|last| last.is_flowing()).map(|_| bank.len() - 1)
}

//! The table as numbers: what is written as JSON, and what the table for people is made from.
mod build;

use std::collections::BTreeMap;

use serde::Serialize;

pub(super) use self::build::noise_of;
use super::clustered::{Rate, Share};
use super::threshold::Tuned;
use crate::judge::measures::{Delay, SmallestLeak};
use crate::judge::plan::Role;
use crate::judge::score::coverage::Quantity;
use crate::world::Regime;

/// One candidate.
#[derive(Clone, Debug, Serialize)]
pub struct CandidateReport {
    /// Name.
    pub name: String,
    /// Its threshold, if it needs one and there is one.
    pub threshold: Option<Tuned>,
    /// Worlds in which it failed, and why: the first ones; or why it has no threshold.
    pub failures: Vec<String>,
    /// Worlds in which it contradicts itself, and how: the first ones.
    pub contradictions: Vec<String>,
    /// By group.
    pub groups: Vec<GroupReport>,
}

impl CandidateReport {
    /// All worlds that judge; `None`: none is finished.
    pub fn judged(&self) -> Option<&GroupReport> {
        self.groups.iter().find(|of| of.role == Role::Judge && of.is_all)
    }
}

/// One candidate in one group.
#[derive(Clone, Debug, Serialize)]
pub struct GroupReport {
    /// What the families of the group are for.
    pub role: Role,
    /// What the worlds have in common.
    pub group: String,
    /// Whether it is of all worlds of its role.
    #[serde(skip)]
    pub is_all: bool,
    /// Whether it is of one axis, or of all of them.
    #[serde(skip)]
    pub is_of_one_axis: bool,
    /// Whether it is a single family.
    #[serde(skip)]
    pub is_family: bool,
    /// Worlds.
    pub worlds: u64,
    /// Worlds without a score.
    pub failed: u64,
    /// Independent simulations.
    pub simulations: u64,
    /// Cylinder-years of all worlds.
    pub cylinder_years: f64,
    /// Of tight worlds.
    pub tight: Tight,
    /// Share of the time by verdict since gas was lost: first day, later.
    pub lost_shares: [Option<BTreeMap<String, f64>>; 2],
    /// Leaks.
    pub leaks: Option<Leaks>,
    /// Noise of its own freest mass without a leak: part of the gas, and correlation time, s.
    pub free_mass_noise: Option<(f64, f64)>,
    /// Coverage of 95 % intervals.
    pub coverage: Vec<CoverageRow>,
    /// Innovations of the pressure by regime.
    pub innovations: Vec<InnovationRow>,
    /// Fast losses.
    pub fast: Vec<FastRow>,
    /// Discharges that were called discharge, refills that were called refill, within 3 h.
    pub recognised_exchanges: [Option<Share>; 2],
    /// Fault table.
    pub faults: Vec<FaultRowReport>,
    /// Contradictions; `None`: it decides nothing.
    pub disagreements: Option<DisagreementReport>,
}

/// What is said of tight cylinders.
#[derive(Clone, Debug, Serialize)]
pub struct Tight {
    /// Share of the time by verdict: first day, later.
    pub shares: [Option<BTreeMap<String, f64>>; 2],
    /// Share of the time with the verdict unknown, after the first day.
    pub unknown_later: Option<Share>,
    /// Worlds.
    pub worlds: u64,
    /// False losses, whatever they are called.
    pub losses: Option<Rate>,
    /// False leaks.
    pub leaks: Option<Rate>,
    /// Of those, in the first day.
    pub leaks_in_first_day: u64,
    /// False exchanges of gas.
    pub exchanges: Option<Rate>,
    /// False sensor faults.
    pub sensor_faults: Option<Rate>,
}

/// What is found of leaks.
#[derive(Clone, Debug, Serialize)]
pub struct Leaks {
    /// Runs.
    pub runs: u64,
    /// Independent simulations.
    pub simulations: u64,
    /// Loss of pressure at 15 °C that goes with a part of the gas per hour, bar/h for 1 %/h, on average.
    pub bar_per_percent: f64,
    /// Smallest leak found with 95 %, % of the gas per hour, by horizon.
    pub smallest_percent_h: BTreeMap<String, Option<SmallestLeak>>,
    /// Noise of the freest mass behind the bound, the smallest of all candidates; part of the gas and s.
    pub noise: Option<(f64, f64)>,
    /// By rate.
    pub by_rate: Vec<LeakRow>,
}

/// Leaks of one rate.
#[derive(Clone, Debug, Serialize)]
pub struct LeakRow {
    /// Rate, % of the gas per hour.
    pub percent_h: f64,
    /// Found within 1 h, 24 h, 7 d: hits and trials.
    pub found: Vec<(u64, u64)>,
    /// Delays.
    pub delay: Delay,
    /// Shortest mean delay of any detector, s.
    pub bound_s: Option<f64>,
    /// Bound over mean delay, where all were found.
    pub efficiency: Option<f64>,
}

/// Coverage of one quantity.
#[derive(Clone, Debug, Serialize)]
pub struct CoverageRow {
    /// Quantity.
    pub quantity: Quantity,
    /// Gas: tight, lost, exchanged.
    pub gas: &'static str,
    /// `first day` or `later`.
    pub period: &'static str,
    /// Share of the intervals that hold the truth.
    pub held: Option<Share>,
    /// Root mean square error in the quantity's unit.
    pub rms: Option<f64>,
}

/// Innovations in one regime.
#[derive(Clone, Debug, Serialize)]
pub struct InnovationRow {
    /// Regime.
    pub regime: Regime,
    /// Innovations.
    pub count: u64,
    /// Mean of `nu^2/S`.
    pub nis: Option<f64>,
    /// Autocorrelation at 1 min and at 10 min.
    pub autocorrelation: [Option<f64>; 2],
}

/// Fast losses of one kind.
#[derive(Clone, Debug, Serialize)]
pub struct FastRow {
    /// What they are.
    pub kind: &'static str,
    /// OperatorData with exit code 1 in time.
    pub in_time: Option<Share>,
    /// OperatorData with exit code 1 at all.
    pub told: Option<Share>,
    /// Worlds in which exit code 1 came before.
    pub before: u64,
    /// Median time from 3 % being lost to exit code 1 of those that were told, s.
    pub median_delay_s: Option<f64>,
}

/// One row of the fault table.
#[derive(Clone, Debug, Serialize)]
pub struct FaultRowReport {
    /// Row.
    pub row: String,
    /// Recognised.
    pub recognised: Option<Share>,
    /// Worlds with a false loss.
    pub false_losses: u64,
    /// Worlds with a false exchange of gas.
    pub false_exchanges: u64,
    /// Worlds in which a sensor was named.
    pub named: u64,
}

/// Contradictions.
#[derive(Clone, Debug, Serialize)]
pub struct DisagreementReport {
    /// Rows.
    pub rows: u64,
    /// Rows with a contradiction.
    pub disagreeing: u64,
    /// By rule, those that occur.
    pub by_rule: BTreeMap<&'static str, u64>,
}

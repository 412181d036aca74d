//! The table as numbers: what is written as JSON, and what the table for people is made from.
use std::collections::BTreeMap;

use serde::Serialize;

use super::clustered::{Rate, Share};
use super::group::Group;
use super::tally::{FastTally, Tally};
use super::threshold::Tuned;
use crate::detector::calibrate::Change;
use crate::detector::statistic::Noise;
use crate::judge::measures::{Class, Delay, Detection, Horizon, SmallestLeak, YEAR_S, by_rate};
use crate::judge::plan::Role;
use crate::judge::score::agreement::Rule;
use crate::judge::score::coverage::Quantity;
use crate::judge::score::innovation::RegimeSums;
use crate::judge::score::noise::SETTLED_S;
use crate::world::Regime;

/// Part of the leaks that must be found for the smallest leak.
const FOUND: f64 = 0.95;
const HOUR_S: f64 = 3600.0;
/// Horizons of the smallest leak.
const HORIZONS: [Horizon; 3] = [Horizon::Hour, Horizon::Day, Horizon::Week];

/// One candidate.
#[derive(Clone, Debug, Serialize)]
pub struct CandidateReport {
    /// Name.
    pub name: String,
    /// Its threshold, if it needs one and there is one.
    pub threshold: Option<Tuned>,
    /// Worlds in which it failed, and why: the first ones.
    pub failures: Vec<String>,
    /// By group.
    pub groups: Vec<GroupReport>,
}

/// One candidate in one group.
#[derive(Clone, Debug, Serialize)]
pub struct GroupReport {
    /// What the families of the group are for.
    pub role: Role,
    /// What the worlds have in common.
    pub group: String,
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
    /// Told with exit code 1 in time.
    pub in_time: Option<Share>,
    /// Told with exit code 1 at all.
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
    /// Worlds with a false leak.
    pub false_leaks: u64,
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

/// The noise of the freest mass of a group, part of the gas: root mean square over worlds, median correlation time.
pub fn noise_of(tally: &Tally) -> Option<Noise> {
    let n = tally.noise.len() as f64;
    let variance = tally.noise.iter().map(|noise| noise.sd * noise.sd).sum::<f64>() / n;
    let mut times: Vec<f64> = tally.noise.iter().map(|noise| noise.correlation_time_s).collect();
    times.sort_by(f64::total_cmp);
    let correlation_time_s = *times.get(times.len() / 2)?;
    Some(Noise { sd: variance.sqrt(), correlation_time_s })
}

impl GroupReport {
    /// From the sums of a group; `noise` is the smallest of all candidates.
    pub fn of(group: &Group, tally: &Tally, noise: Option<Noise>, between_alarms_s: f64) -> Self {
        let decides = tally.disagreements.rows > 0;
        Self {
            role: group.role,
            group: group.of.to_string(),
            is_of_one_axis: group.is_of_one_axis(),
            is_family: matches!(group.of, super::group::Of::Family(_)),
            worlds: tally.worlds,
            failed: tally.failed,
            simulations: tally.simulations.len() as u64,
            cylinder_years: tally.cylinder_s / YEAR_S,
            tight: Tight {
                shares: [0, 1].map(|period| shares(&tally.shares.tight_s[period])),
                unknown_later: tally.unknown.share(),
                worlds: tally.quiet,
                losses: tally.episodes[0].rate(),
                leaks: tally.episodes[1].rate(),
                leaks_in_first_day: tally.first_day_leaks,
                exchanges: tally.episodes[2].rate(),
                sensor_faults: tally.episodes[3].rate(),
            },
            lost_shares: [0, 1].map(|period| shares(&tally.shares.lost_s[period])),
            leaks: leaks(tally, noise, between_alarms_s),
            free_mass_noise: noise_of(tally).map(|noise| (noise.sd, noise.correlation_time_s)),
            coverage: coverage(tally),
            innovations: Regime::ALL.into_iter().zip(&tally.innovations).filter_map(innovation).collect(),
            fast: fast(tally),
            recognised_exchanges: [0, 1].map(|direction| tally.exchanges[direction].share()),
            faults: faults(tally),
            disagreements: decides.then(|| disagreements(tally)),
        }
    }
}

/// Shares of the time by verdict; `None` without time.
fn shares(seconds: &[f64; 6]) -> Option<BTreeMap<String, f64>> {
    let all: f64 = seconds.iter().sum();
    let share = |(class, seconds): (Class, &f64)| (class.to_string(), seconds / all);
    (all > 0.0).then(|| Class::ALL.into_iter().zip(seconds).map(share).collect())
}

fn leaks(tally: &Tally, noise: Option<Noise>, between_alarms_s: f64) -> Option<Leaks> {
    let groups = by_rate(&tally.runs);
    let (pa_s, part_h) = tally.pressure_per_part;
    if groups.is_empty() {
        return None;
    }
    let within = |horizon: Horizon| Detection::against_rate(&groups, horizon.seconds());
    let percent = |mut leak: SmallestLeak| {
        leak.rate = scaled(leak.rate);
        leak.interval = (scaled(leak.interval.0), scaled(leak.interval.1));
        leak
    };
    let smallest = |horizon: Horizon| SmallestLeak::of(&within(horizon), FOUND).map(percent);
    let row = |(index, (part_per_h, runs)): (usize, &(f64, Vec<_>))| {
        let delay = Delay::of(runs);
        let ramp = Change::Ramp(part_per_h / HOUR_S);
        let bound_s = noise.map(|noise| ramp.delay_bound(noise, SETTLED_S, between_alarms_s));
        let found = HORIZONS.map(|horizon| within(horizon)[index].found);
        LeakRow {
            percent_h: 100.0 * part_per_h,
            found: found.map(|found| (found.hits, found.trials)).to_vec(),
            efficiency: bound_s.and_then(|bound_s| delay.efficiency(bound_s)),
            delay,
            bound_s,
        }
    };
    Some(Leaks {
        runs: tally.runs.len() as u64,
        simulations: tally.leak_simulations.len() as u64,
        bar_per_percent: 1e-5 * HOUR_S * pa_s / (100.0 * part_h),
        smallest_percent_h: HORIZONS.into_iter().map(|of| (of.to_string(), smallest(of))).collect(),
        noise: noise.map(|noise| (noise.sd, noise.correlation_time_s)),
        by_rate: groups.iter().enumerate().map(row).collect(),
    })
}

/// Parts as percent.
fn scaled(reached: crate::judge::measures::Reached) -> crate::judge::measures::Reached {
    use crate::judge::measures::Reached::{Above, At, AtMost};
    match reached {
        AtMost(part) => AtMost(100.0 * part),
        At(part) => At(100.0 * part),
        Above(part) => Above(100.0 * part),
    }
}

fn coverage(tally: &Tally) -> Vec<CoverageRow> {
    let mut rows = Vec::new();
    for (quantity, periods) in Quantity::ALL.into_iter().zip(&tally.coverage) {
        for (gas_index, gas) in ["tight", "lost", "exchanged"].into_iter().enumerate() {
            for (period, cells) in ["first day", "later"].into_iter().zip(periods) {
                let cell = &cells[gas_index];
                let rms = (cell.sums.values > 0).then(|| (cell.sums.squares / cell.sums.values as f64).sqrt());
                let held = cell.inside.share();
                if held.is_some() || rms.is_some() {
                    rows.push(CoverageRow { quantity, gas, period, held, rms });
                }
            }
        }
    }
    rows
}

fn innovation((regime, sums): (Regime, &RegimeSums)) -> Option<InnovationRow> {
    let autocorrelation = [0, 1].map(|lag| sums.lags[lag].correlation());
    (sums.count > 0).then(|| InnovationRow { regime, count: sums.count, nis: sums.mean_nis(), autocorrelation })
}

fn fast(tally: &Tally) -> Vec<FastRow> {
    let kinds = ["fast loss", "discharge, not announced", "discharge, announced"];
    let row = |(kind, of): (&'static str, &FastTally)| {
        let mut delays_s = of.delays_s.clone();
        delays_s.sort_by(f64::total_cmp);
        let (in_time, told) = (of.in_time.share(), of.told.share());
        let any = told.is_some() || of.before > 0;
        let median_delay_s = delays_s.get(delays_s.len() / 2).copied();
        any.then_some(FastRow { kind, in_time, told, before: of.before, median_delay_s })
    };
    kinds.into_iter().zip(&tally.fast).filter_map(row).collect()
}

fn faults(tally: &Tally) -> Vec<FaultRowReport> {
    let row = |(row, of): (&crate::world::FaultRow, &super::tally::FaultTally)| FaultRowReport {
        row: row.name(),
        recognised: of.recognised.share(),
        false_leaks: of.false_leaks,
        named: of.named,
    };
    tally.faults.iter().map(row).collect()
}

fn disagreements(tally: &Tally) -> DisagreementReport {
    let of = &tally.disagreements;
    let named = Rule::ALL.into_iter().zip(of.by_rule).filter(|(_, count)| *count > 0);
    DisagreementReport {
        rows: of.rows,
        disagreeing: of.disagreeing,
        by_rule: named.map(|(rule, count)| (rule.words(), count)).collect(),
    }
}

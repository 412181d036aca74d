//! From sums to the numbers of the table.
use cylwatch_thermal::units::HOUR_S;
use cylwatch_thermal::units::YEAR_S;
use std::collections::BTreeMap;

use super::{
    CoverageRow, DisagreementReport, FastRow, FaultRowReport, GroupReport, InnovationRow, LeakRow, Leaks,
    Tight,
};
use crate::judge::measures::{Class, Delay, Detection, Horizon, SmallestLeak, by_rate};
use crate::judge::score::agreement::Rule;
use crate::judge::score::coverage::Quantity;
use crate::judge::score::innovation::RegimeSums;
use crate::judge::score::noise::SETTLED_S;
use crate::judge::table::group::{Group, Grouping};
use crate::judge::table::tally::{FastTally, FaultTally, Tally};
use crate::noise::Noise;
use crate::world::{FaultRow, Regime};

/// Percent of all.
const PERCENT: f64 = 100.0;
/// Part of the leaks that must be found for the smallest leak.
const REQUIRED_DETECTION: f64 = 0.95;
/// Horizons of the smallest leak.
const HORIZONS: [Horizon; 3] = [Horizon::Hour, Horizon::Day, Horizon::Week];

/// The noise of the freest mass of a group, part of the gas: root mean square over worlds, median correlation time.
pub(crate) fn noise_of(tally: &Tally) -> Option<Noise> {
    let n = tally.noise.len() as f64;
    let variance = tally.noise.iter().map(|noise| noise.sd * noise.sd).sum::<f64>() / n;
    let mut times: Vec<f64> = tally.noise.iter().map(|noise| noise.correlation_time_s).collect();
    times.sort_by(f64::total_cmp);
    let correlation_time_s = *times.get(times.len() / 2)?;
    Some(Noise { sd: variance.sqrt(), correlation_time_s })
}

impl GroupReport {
    /// From the sums of a group; `noise` is the smallest of all candidates.
    pub(crate) fn of(group: &Group, tally: &Tally, noise: Option<Noise>, between_alarms_s: f64) -> Self {
        let decides = tally.disagreements.rows > 0;
        Self {
            role: group.role,
            group: group.by.to_string(),
            is_all: group.by == Grouping::All,
            is_of_one_axis: group.is_of_one_axis(),
            is_family: matches!(group.by, Grouping::Family(_)),
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
    let smallest = |horizon: Horizon| {
        SmallestLeak::of(&within(horizon), REQUIRED_DETECTION).map(|leak| leak.times(PERCENT))
    };
    let row = |(index, (part_per_h, runs)): (usize, &(f64, Vec<_>))| {
        let delay = Delay::of(runs);
        let bound_s =
            noise.map(|noise| noise.shortest_delay_s(part_per_h / HOUR_S, SETTLED_S, between_alarms_s));
        let found = HORIZONS.map(|horizon| within(horizon)[index].found);
        LeakRow {
            percent_h: PERCENT * part_per_h,
            found: found.map(|found| (found.hits, found.trials)).to_vec(),
            efficiency: bound_s.and_then(|bound_s| delay.efficiency(bound_s)),
            delay,
            bound_s,
        }
    };
    Some(Leaks {
        runs: tally.runs.len() as u64,
        simulations: tally.leak_simulations.len() as u64,
        bar_per_percent: 1e-5 * HOUR_S * pa_s / (PERCENT * part_h),
        smallest_percent_h: HORIZONS.into_iter().map(|of| (of.to_string(), smallest(of))).collect(),
        noise: noise.map(|noise| (noise.sd, noise.correlation_time_s)),
        by_rate: groups.iter().enumerate().map(row).collect(),
    })
}

fn coverage(tally: &Tally) -> Vec<CoverageRow> {
    let mut rows = Vec::new();
    for (quantity, periods) in Quantity::ALL.into_iter().zip(&tally.coverage) {
        for (gas_index, gas) in ["tight", "lost", "exchanged"].into_iter().enumerate() {
            for (period, cells) in ["first day", "later"].into_iter().zip(periods) {
                let cell = &cells[gas_index];
                let rms =
                    (cell.sums.values > 0).then(|| (cell.sums.squares / cell.sums.values as f64).sqrt());
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
    (sums.count > 0).then(|| InnovationRow {
        regime,
        count: sums.count,
        nis: sums.mean_nis(),
        autocorrelation,
    })
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
    let row = |(row, of): (&FaultRow, &FaultTally)| FaultRowReport {
        row: row.name(),
        recognised: of.recognised.share(),
        false_losses: of.false_losses,
        false_exchanges: of.false_exchanges,
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
        by_rule: named.map(|(rule, count)| (rule.description(), count)).collect(),
    }
}

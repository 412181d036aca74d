//! Sums of one candidate over the worlds of one group.
use std::collections::{BTreeMap, BTreeSet};

use super::clustered::Clustered;
use crate::judge::entry::Facts;
use crate::judge::measures::Run;
use crate::judge::plan::Task;
use crate::judge::score::Score;
use crate::judge::score::agreement::Disagreements;
use crate::judge::score::coverage::Cell;
use crate::judge::score::detection::FastLoss;
use crate::judge::score::innovation::Innovations;
use crate::judge::score::verdict::{Episode, Shares};
use crate::noise::Noise;
use crate::world::{FaultRow, Overlay, SimulationKey};

/// Shares whose intervals go by simulation, and sums of squares.
#[derive(Clone, Debug, Default)]
pub(crate) struct CoverageTally {
    /// Intervals that held the truth, of those stated.
    pub inside: Clustered,
    /// Sum over worlds.
    pub sums: Cell,
}

/// What came of the faults of one row.
#[derive(Clone, Debug, Default)]
pub(crate) struct FaultTally {
    /// Recognised, of worlds.
    pub recognised: Clustered,
    /// Worlds with a false loss.
    pub false_losses: u64,
    /// Worlds with a false exchange of gas.
    pub false_exchanges: u64,
    /// Worlds in which a sensor was named.
    pub named: u64,
}

/// What came of fast losses of one kind.
#[derive(Clone, Debug, Default)]
pub(crate) struct FastTally {
    /// OperatorData in time, of worlds in which nothing was told before.
    pub in_time: Clustered,
    /// OperatorData at all after the onset.
    pub told: Clustered,
    /// Worlds in which exit code 1 came before the onset.
    pub before: u64,
    /// Time from 3 % being lost to exit code 1, s.
    pub delays_s: Vec<f64>,
}

/// Sums of a candidate over a group.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tally {
    /// Worlds.
    pub worlds: u64,
    /// Worlds without a score.
    pub failed: u64,
    /// Simulations.
    pub simulations: BTreeSet<SimulationKey>,
    /// Time of all logs, s.
    pub cylinder_s: f64,
    /// Time by verdict.
    pub shares: Shares,
    /// Time with the verdict unknown after the first day.
    pub unknown: Clustered,
    /// Worlds with nothing laid over.
    pub quiet: u64,
    /// False losses, leaks, exchanges of gas, sensors at fault.
    pub episodes: [Clustered; 4],
    /// False leaks of the first day.
    pub first_day_leaks: u64,
    /// Runs with a leak.
    pub runs: Vec<Run>,
    /// Sums of loss of pressure at 15 °C, Pa/s, and of parts per hour over the leaks.
    pub pressure_per_part: (f64, f64),
    /// Simulations with a leak.
    pub leak_simulations: BTreeSet<SimulationKey>,
    /// Intervals: quantity, period, gas.
    pub coverage: [[[CoverageTally; 3]; 2]; 4],
    /// Innovations.
    pub innovations: Innovations,
    /// Noise of the freest mass.
    pub noise: Vec<Noise>,
    /// Fast losses: unannounced fast losses, unannounced discharges, announced discharges.
    pub fast: [FastTally; 3],
    /// Exchanges of gas that were recognised: out, in.
    pub exchanges: [Clustered; 2],
    /// Faults.
    pub faults: BTreeMap<FaultRow, FaultTally>,
    /// Contradictions.
    pub disagreements: Disagreements,
}

impl Tally {
    /// Add a world that has no score.
    pub(crate) fn add_failed(&mut self, task: &Task) {
        self.worlds += 1;
        self.failed += 1;
        self.simulations.insert(SimulationKey::of(&task.request));
    }

    /// Add a world.
    pub(crate) fn add(&mut self, task: &Task, facts: &Facts, score: &Score) {
        let simulation = SimulationKey::of(&task.request);
        self.worlds += 1;
        self.simulations.insert(simulation);
        self.cylinder_s += facts.length_s;
        if task.request.overlay == Overlay::Nothing {
            self.add_quiet(simulation, score);
        } else if let Some(shares) = &score.shares {
            self.shares.lost_s.iter_mut().zip(&shares.lost_s).for_each(add_times);
        }
        if let (Some(leak), Some(detected)) = (&facts.leak, &score.detected) {
            self.leak_simulations.insert(simulation);
            self.runs.push(Run {
                part_per_h: leak.part_per_h,
                onset_s: leak.onset_s,
                until_s: leak.until_s,
                alarm_s: detected.alarm_s,
            });
            self.pressure_per_part.0 += leak.rate_pa_s;
            self.pressure_per_part.1 += leak.part_per_h;
        }
        self.add_coverage(simulation, score);
        self.innovations.iter_mut().zip(&score.innovations).for_each(|(sum, of)| sum.add(of));
        self.noise.extend(score.noise);
        if let Some(fast) = &score.fast_loss {
            let kind = match task.request.overlay {
                Overlay::FastLoss { .. } => 0,
                _ => 1 + usize::from(fast.announced),
            };
            self.fast[kind].add(simulation, fast);
        }
        if let Some(exchanged) = &score.exchanged {
            let recognised = f64::from(u8::from(exchanged.recognised));
            self.exchanges[usize::from(!exchanged.out)].add(simulation, recognised, 1.0);
        }
        if let Some(fault) = &score.fault {
            let of = self.faults.entry(fault.row).or_default();
            of.recognised.add(simulation, f64::from(u8::from(fault.recognised)), 1.0);
            of.false_losses += u64::from(fault.false_loss);
            of.false_exchanges += u64::from(fault.false_exchange);
            of.named += u64::from(fault.named);
        }
        if let Some(disagreements) = &score.disagreements {
            self.disagreements += disagreements;
        }
    }

    /// A world with nothing laid over.
    fn add_quiet(&mut self, simulation: SimulationKey, score: &Score) {
        if let Some(shares) = &score.shares {
            self.shares.tight_s.iter_mut().zip(&shares.tight_s).for_each(add_times);
            let later = &shares.tight_s[1];
            self.unknown.add(
                simulation,
                later[crate::judge::measures::Class::Unknown as usize],
                later.iter().sum(),
            );
        }
        if let Some(episodes) = &score.episodes {
            self.quiet += 1;
            let all = [&episodes.loss, &episodes.leak, &episodes.exchange, &episodes.sensor_fault];
            for (sum, Episode { count, at_risk_s }) in self.episodes.iter_mut().zip(all) {
                sum.add(simulation, count.iter().sum::<u64>() as f64, at_risk_s.iter().sum());
            }
            self.first_day_leaks += episodes.leak.count[0];
        }
    }

    fn add_coverage(&mut self, simulation: SimulationKey, score: &Score) {
        let sums = self.coverage.iter_mut().flatten().flatten();
        for (sum, cell) in sums.zip(score.coverage.cells.iter().flatten().flatten()) {
            if cell.stated > 0 {
                sum.inside.add(simulation, cell.inside as f64, cell.stated as f64);
            }
            sum.sums.values += cell.values;
            sum.sums.squares += cell.squares;
        }
    }
}

impl FastTally {
    fn add(&mut self, simulation: SimulationKey, fast: &FastLoss) {
        let Some(matters_s) = fast.matters_s else { return };
        if fast.told_s.is_some_and(|told_s| told_s < 0.0) {
            self.before += 1;
            return;
        }
        let of = |is: bool| f64::from(u8::from(is));
        self.in_time.add(simulation, of(fast.in_time), 1.0);
        self.told.add(simulation, of(fast.told_s.is_some()), 1.0);
        self.delays_s.extend(fast.told_s.map(|told_s| told_s - matters_s));
    }
}

fn add_times((sums, times): (&mut [f64; 6], &[f64; 6])) {
    sums.iter_mut().zip(times).for_each(|(sum, time)| *sum += time);
}

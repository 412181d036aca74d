//! Rows in which verdict, probability of a leak, alarm, reaction and exit code contradict each other.
use std::ops::AddAssign;

use serde::{Deserialize, Serialize};

use super::Moment;
use crate::detector::prognosis::Reaction;
use crate::judge::measures::Class;
use crate::judge::statement::Decision;
use crate::world::World;

/// Ways to contradict oneself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Rule {
    /// The probability is no number between 0 and 1.
    NoProbability,
    /// The verdict is tight, and the probability of a leak is at or above the decision's level.
    TightButProbable,
    /// The probability is at or above the level, and the verdict is that of a sensor at fault. That it cannot be told is no contradiction.
    SensorFaultButProbable,
    /// A loss is said, and its probability is below the level.
    LossButImprobable,
    /// The verdict is tight, and a leak is stated.
    TightButLeak,
    /// The verdict is a leak, and none is stated.
    LeakNotStated,
    /// A loss is said, and the alarm is not active.
    LossWithoutAlarm,
    /// A loss is said, and no reaction is due.
    LossWithoutReaction,
    /// A loss is said, and the exit code is not 1.
    LossButExitCode,
    /// Gas goes out at once, unannounced, and no loss is said.
    DischargeButNoLoss,
    /// The exit code is 1, and no loss has been said so far.
    ExitCodeWithoutLoss,
    /// It cannot be told, and the exit code says that it is tight.
    UnknownButExitCode,
    /// The verdict is tight, and the exit code says that it cannot be told.
    TightButInconclusive,
}

impl Rule {
    /// All of them.
    pub(crate) const ALL: [Self; 13] = [
        Self::NoProbability,
        Self::TightButProbable,
        Self::SensorFaultButProbable,
        Self::LossButImprobable,
        Self::TightButLeak,
        Self::LeakNotStated,
        Self::LossWithoutAlarm,
        Self::LossWithoutReaction,
        Self::LossButExitCode,
        Self::DischargeButNoLoss,
        Self::ExitCodeWithoutLoss,
        Self::UnknownButExitCode,
        Self::TightButInconclusive,
    ];

    /// Words for a table.
    pub(crate) const fn description(self) -> &'static str {
        match self {
            Self::NoProbability => "probability is none",
            Self::TightButProbable => "tight, but a leak is probable",
            Self::SensorFaultButProbable => "sensor fault, but a leak is probable",
            Self::LossButImprobable => "loss, but improbable",
            Self::TightButLeak => "tight, but a leak is stated",
            Self::LeakNotStated => "verdict leak, none stated",
            Self::LossWithoutAlarm => "loss without alarm",
            Self::LossWithoutReaction => "loss without reaction",
            Self::LossButExitCode => "loss, exit code not 1",
            Self::DischargeButNoLoss => "unannounced discharge, no loss said",
            Self::ExitCodeWithoutLoss => "exit code 1, no loss said",
            Self::UnknownButExitCode => "unknown, exit code 0",
            Self::TightButInconclusive => "tight, exit code 3",
        }
    }
}

/// Counts of contradictions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Disagreements {
    /// Rows.
    pub rows: u64,
    /// Rows with at least one contradiction.
    pub disagreeing: u64,
    /// By rule, in the order of `Rule::ALL`.
    pub by_rule: [u64; 13],
}

impl Disagreements {
    /// Which rules are broken, and in how many rows.
    pub(crate) fn description(&self) -> String {
        let broken = Rule::ALL.into_iter().zip(self.by_rule).filter(|(_, count)| *count > 0);
        let words: Vec<String> =
            broken.map(|(rule, count)| format!("{} ({count})", rule.description())).collect();
        words.join("; ")
    }
}

impl AddAssign<&Self> for Disagreements {
    fn add_assign(&mut self, other: &Self) {
        self.rows += other.rows;
        self.disagreeing += other.disagreeing;
        self.by_rule.iter_mut().zip(other.by_rule).for_each(|(sum, other)| *sum += other);
    }
}

/// Counts them.
#[derive(Clone, Debug)]
pub(crate) struct Agreement {
    level: f64,
    /// Announced discharges by the log's clock, s.
    announced: Vec<(f64, f64)>,
    loss_said: bool,
    counts: Disagreements,
}

impl Agreement {
    /// Of a candidate that decides for a leak from a probability of `level` on.
    pub(crate) fn new(world: &World, level: f64) -> Self {
        let announced = world.operator_data.announced.clone();
        Self { level, announced, loss_said: false, counts: Disagreements::default() }
    }

    /// Take a decision.
    pub(crate) fn take(&mut self, moment: &Moment<'_>, decision: &Decision) {
        let stamp_s = moment.statement.stamp_s;
        // An announced discharge may be seen a while after its end.
        let announced = self
            .announced
            .iter()
            .any(|(from_s, to_s)| (from_s - 600.0..=to_s + 3.0 * 3600.0).contains(&stamp_s));
        self.loss_said |= decision.loss || decision.says_leak();
        let mut any = false;
        for (count, rule) in self.counts.by_rule.iter_mut().zip(Rule::ALL) {
            let broken = is_broken(rule, decision, self.level, announced, self.loss_said);
            *count += u64::from(broken);
            any |= broken;
        }
        self.counts.rows += 1;
        self.counts.disagreeing += u64::from(any);
    }

    /// After the last decision.
    pub(crate) fn finish(self) -> Disagreements {
        self.counts
    }
}

pub(super) fn is_broken(
    rule: Rule,
    decision: &Decision,
    level: f64,
    announced: bool,
    loss_said: bool,
) -> bool {
    let Decision { class, leak, leak_probability, alarm, reaction, exit_code, .. } = *decision;
    let lost = decision.loss || decision.says_leak();
    let probable = leak_probability.is_some_and(|probability| probability >= level);
    match rule {
        Rule::NoProbability => leak_probability.is_some_and(|p| !(0.0..=1.0).contains(&p)),
        Rule::TightButProbable => class == Class::Tight && probable,
        Rule::SensorFaultButProbable => class == Class::SensorFault && probable && !lost,
        Rule::LossButImprobable => lost && leak_probability.is_some_and(|probability| probability < level),
        Rule::TightButLeak => class == Class::Tight && (leak || decision.loss),
        Rule::LeakNotStated => class == Class::Leak && !leak,
        Rule::LossWithoutAlarm => lost && alarm == Some(false),
        Rule::LossWithoutReaction => lost && reaction == Some(Reaction::None),
        Rule::LossButExitCode => lost && exit_code != 1,
        Rule::DischargeButNoLoss => class == Class::Discharge && !announced && !lost,
        Rule::ExitCodeWithoutLoss => exit_code == 1 && !loss_said,
        Rule::UnknownButExitCode => class == Class::Unknown && exit_code == 0,
        Rule::TightButInconclusive => class == Class::Tight && exit_code == 3,
    }
}

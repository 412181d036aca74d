//! What one candidate achieved in one world: sums that the table adds up.
//!
//! | file | question |
//! |---|---|
//! | [`verdict`] | which verdicts, how often a leak, an exchange of gas, a sensor at fault without cause |
//! | [`detection`] | a leak that was laid over: found, and when; a fast loss: told with exit code 1, and when |
//! | [`coverage`] | whether stated intervals hold the truth |
//! | [`innovation`] | whether innovations are as large as stated, and white, by what the surroundings do |
//! | [`agreement`] | rows in which the statements contradict each other |
//! | [`fault`] | a row of the fault table: recognised, or not |
//! | [`noise`] | what the freest mass does without a leak: behind the shortest possible delay |
pub(crate) mod agreement;
pub(crate) mod coverage;
pub(crate) mod detection;
pub(super) mod fault;
pub(crate) mod innovation;
pub(crate) mod noise;
pub(crate) mod verdict;

use serde::{Deserialize, Serialize};

use self::agreement::{Agreement, Disagreements};
use self::coverage::Coverage;
use self::detection::{Detected, ExchangeWatch, Exchanged, FastLoss, FastLossWatch, LeakWatch};
use self::fault::{FaultOutcome, FaultWatch};
use self::innovation::{Innovations, Whiteness};
use self::noise::FreeMass;
use self::verdict::{Episodes, Shares, Verdicts};
use super::measures::Trace;
use super::statement::Statement;
use crate::noise::Noise;
use crate::world::{Overlay, World};

/// The first day, in which candidates learn, is reported apart.
pub(super) const FIRST_DAY_S: f64 = 86_400.0;
/// Longest time for which a statement counts when no row follows, s.
const LONGEST_STEP_S: f64 = 3600.0;

/// What one candidate achieved in one world.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Score {
    /// Statements that were judged.
    pub said: u64,
    /// Time by verdict.
    pub shares: Option<Shares>,
    /// False statements, where nothing was laid over.
    pub episodes: Option<Episodes>,
    /// A leak that was laid over.
    pub detected: Option<Detected>,
    /// A fast loss or a discharge.
    pub fast_loss: Option<FastLoss>,
    /// A discharge or a refill.
    pub exchanged: Option<Exchanged>,
    /// A fault.
    pub fault: Option<FaultOutcome>,
    /// Intervals.
    pub coverage: Coverage,
    /// Innovations by regime, in the order of [`Regime::ALL`](crate::world::Regime::ALL).
    pub innovations: Innovations,
    /// Contradictions.
    pub disagreements: Option<Disagreements>,
    /// Noise of the freest mass, as a part of the gas.
    pub noise: Option<Noise>,
    /// Rising record of a statistic that needs a threshold, and when it could tell first, s.
    pub trace: Option<(Trace, Option<f64>)>,
}

/// What has happened to the gas at a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Gas {
    /// Nothing yet.
    Tight,
    /// Gas is or was being lost.
    Lost,
    /// Gas was exchanged on purpose.
    Exchanged,
}

/// A statement, and what is true at its row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moment<'a> {
    /// What is said.
    pub statement: &'a Statement,
    /// True time at which it is said, s.
    pub now_s: f64,
    /// Time since the statement before, s, at most an hour.
    pub step_s: f64,
    /// Index of its row.
    pub row: usize,
    /// 0 in the first day, 1 later.
    pub period: usize,
    /// What has happened to the gas.
    pub gas: Gas,
}

/// Scores the statements of one candidate in one world.
pub(super) struct Scorer<'a> {
    world: &'a World,
    last_s: Option<f64>,
    score: Score,
    verdicts: Verdicts,
    detecting: Option<LeakWatch>,
    fast_loss: Option<FastLossWatch>,
    exchange: Option<ExchangeWatch>,
    fault: Option<FaultWatch>,
    agreement: Agreement,
    free_mass: FreeMass,
    whiteness: Whiteness,
    first_told_s: Option<f64>,
    trace: Trace,
}

impl<'a> Scorer<'a> {
    /// Before the first statement; `level` is the probability from which on the candidate decides for a leak.
    pub(crate) fn new(world: &'a World, level: f64) -> Self {
        Self {
            world,
            last_s: None,
            score: Score::default(),
            verdicts: Verdicts::default(),
            detecting: LeakWatch::of(world),
            fast_loss: FastLossWatch::of(world),
            exchange: ExchangeWatch::of(world),
            fault: FaultWatch::of(world),
            agreement: Agreement::new(world, level),
            free_mass: FreeMass::default(),
            whiteness: Whiteness::default(),
            first_told_s: None,
            trace: Trace::default(),
        }
    }

    /// Take a statement that is said at the true time `now_s` about the row of an index.
    pub(crate) fn take(&mut self, now_s: f64, row: usize, statement: &Statement) {
        let truth = &self.world.truth;
        let step_s = self.last_s.map_or(0.0, |last_s| (now_s - last_s).clamp(0.0, LONGEST_STEP_S));
        self.last_s = Some(now_s);
        let time_s = truth.time_s[row];
        let moment = Moment {
            statement,
            now_s,
            step_s,
            row,
            period: usize::from(time_s >= FIRST_DAY_S),
            gas: gas_at(&self.world.request.overlay, time_s),
        };
        self.score.said += 1;
        if let Some(decision) = &statement.decision {
            self.verdicts.take(&moment, decision);
            self.agreement.take(&moment, decision);
            if let Some(detecting) = &mut self.detecting {
                detecting.take(&moment, decision);
            }
            if let Some(fast_loss) = &mut self.fast_loss {
                fast_loss.take(&moment, decision);
            }
            if let Some(exchange) = &mut self.exchange {
                exchange.take(&moment, decision);
            }
            if let Some(fault) = &mut self.fault {
                fault.take(&moment, decision);
            }
        }
        if let Some(statistic) = statement.statistic {
            if statistic.is_finite() {
                self.first_told_s.get_or_insert(now_s);
            }
            self.trace.push(now_s, statistic.min(f64::MAX));
        }
        self.score.coverage.take(&moment, self.world);
        // Spikes and exchanges of gas are no question of the noise.
        let steady = matches!(self.world.request.overlay, Overlay::Nothing | Overlay::Leak { .. });
        let innovation = statement.innovation.filter(|_| steady);
        self.whiteness.take(&mut self.score.innovations, time_s, truth.regime[row], innovation);
        self.free_mass.take(&moment, self.world);
    }

    /// After the last statement.
    pub(crate) fn finish(self) -> Score {
        let mut score = self.score;
        let quiet = self.world.request.overlay == Overlay::Nothing;
        if self.verdicts.any() {
            let (shares, episodes) = self.verdicts.finish();
            score.shares = Some(shares);
            score.episodes = quiet.then_some(episodes);
            score.disagreements = Some(self.agreement.finish());
            score.detected = self.detecting.map(|detecting| detecting.finish());
            score.fast_loss = self.fast_loss.map(FastLossWatch::finish);
            score.exchanged = self.exchange.map(ExchangeWatch::finish);
            score.fault = self.fault.map(FaultWatch::finish);
        }
        if self.trace.most() > f64::NEG_INFINITY || self.first_told_s.is_some() {
            score.trace = Some((self.trace, self.first_told_s));
        }
        score.noise = if quiet { self.free_mass.finish() } else { None };
        score
    }
}

/// What an overlay has done to the gas at a true time, s.
pub(super) fn gas_at(overlay: &Overlay, time_s: f64) -> Gas {
    match *overlay {
        Overlay::Leak { onset_s, .. } | Overlay::FastLoss { onset_s, .. } if time_s >= onset_s => Gas::Lost,
        Overlay::Discharge { onset_s, .. } | Overlay::Refill { onset_s, .. } if time_s >= onset_s => {
            Gas::Exchanged
        }
        _ => Gas::Tight,
    }
}

#[cfg(test)]
mod tests;

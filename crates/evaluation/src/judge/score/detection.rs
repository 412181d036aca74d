//! Leaks and fast losses that were laid over: whether and when they were told.
//!
//! A leak is told by a loss that is said, whatever it is called. One that is said at the onset was said before it: that run says nothing
//! about the leak. A fast loss is told in time if the exit
//! code is 1 within 5 min of 3 % of the gas being lost, or with the first statement after that where rows are farther apart. An announced
//! discharge must not be told.
use serde::{Deserialize, Serialize};

use super::{Gas, Moment};
use crate::judge::measures::Class;
use crate::judge::statement::Decision;
use crate::world::{Overlay, World};

/// Part of the gas after whose loss a fast loss must be told.
const FAST_LOSS_PART: f64 = 0.03;
/// Time within which it must be told, s.
const FAST_LOSS_DEADLINE_S: f64 = 300.0;
/// Time within which an exchange of gas must be recognised, s.
const RECOGNISED_S: f64 = 3.0 * 3600.0;

/// The truth of a leak that was laid over.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct LeakFacts {
    /// Part of the gas per hour.
    pub part_per_h: f64,
    /// The same as loss of the pressure at 15 °C, Pa/s, at the beginning.
    pub rate_pa_s: f64,
    /// Onset, s.
    pub onset_s: f64,
    /// End of the log, s.
    pub until_s: f64,
}

/// What was said of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Detected {
    /// First time at which it was said: before the onset only if it was being said then, s.
    pub alarm_s: Option<f64>,
}

/// A leak while it is watched.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LeakWatch {
    onset_s: f64,
    detected: Detected,
    /// Since when a loss is being said, s.
    since_s: Option<f64>,
}

impl LeakWatch {
    /// The truth of the leak of a world; `None`: it has none.
    pub(crate) fn facts(world: &World) -> Option<LeakFacts> {
        let Overlay::Leak { part_per_h, onset_s } = world.request.overlay else { return None };
        let until_s = *world.truth.time_s.last()?;
        let rate_pa_s = settled_pa_per_part(world)? * part_per_h / 3600.0;
        Some(LeakFacts { part_per_h, rate_pa_s, onset_s, until_s })
    }

    /// Before the first decision; `None`: the world has no leak.
    pub(crate) fn of(world: &World) -> Option<Self> {
        let Overlay::Leak { onset_s, .. } = world.request.overlay else { return None };
        Some(Self { onset_s, detected: Detected::default(), since_s: None })
    }

    /// Take a decision.
    pub(crate) fn take(&mut self, moment: &Moment<'_>, decision: &Decision) {
        if !(decision.loss || decision.says_leak()) {
            self.since_s = None;
            return;
        }
        let since_s = *self.since_s.get_or_insert(moment.now_s);
        if moment.now_s >= self.onset_s {
            self.detected.alarm_s.get_or_insert(since_s);
        }
    }

    /// After the last decision.
    pub(crate) fn finish(self) -> Detected {
        self.detected
    }
}

/// Pressure at 15 °C that goes with all of the gas at the slope of the first part that is lost, Pa; from the truth itself.
fn settled_pa_per_part(world: &World) -> Option<f64> {
    let truth = &world.truth;
    let (full_pa, full_kg) = (*truth.settled_pa.first()?, *truth.mass_kg.first()?);
    // Enough for the digits that are stored, and little enough to be the slope at the beginning.
    let lost = |kg: &f64| (1e-4..0.05).contains(&(1.0 - kg / full_kg));
    match truth.mass_kg.iter().rposition(lost) {
        Some(row) => Some((full_pa - truth.settled_pa[row]) / (1.0 - truth.mass_kg[row] / full_kg)),
        None => Some(full_pa),
    }
}

/// A fast loss or a discharge that was laid over.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FastLoss {
    /// Part of the gas.
    pub part: f64,
    /// Whether the candidate was told of it beforehand.
    pub announced: bool,
    /// When 3 % of the gas were lost, s after the onset; `None`: never.
    pub matters_s: Option<f64>,
    /// When the exit code became 1, s after the onset; negative: before it.
    pub told_s: Option<f64>,
    /// Whether the exit code became 1 in time.
    pub in_time: bool,
    /// What was said when the exit code became 1.
    pub told_as: Option<Class>,
}

/// Whether an exchange of gas was recognised as one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Exchanged {
    /// Whether gas went out.
    pub out: bool,
    /// Whether a discharge was said of gas that went out, and a refill of gas that came in, within 3 h.
    pub recognised: bool,
}

/// An exchange of gas while it is watched.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ExchangeWatch {
    outcome: Exchanged,
    onset_s: f64,
}

impl ExchangeWatch {
    /// The exchange of a world; `None`: it has none.
    pub(crate) fn of(world: &World) -> Option<Self> {
        let (out, onset_s) = match world.request.overlay {
            Overlay::Discharge { onset_s, .. } => (true, onset_s),
            Overlay::Refill { onset_s, .. } => (false, onset_s),
            _ => return None,
        };
        Some(Self { outcome: Exchanged { out, recognised: false }, onset_s })
    }

    /// Take a decision.
    pub(crate) fn take(&mut self, moment: &Moment<'_>, decision: &Decision) {
        let wanted = if self.outcome.out { Class::Discharge } else { Class::Refill };
        let since_s = moment.now_s - self.onset_s;
        self.outcome.recognised |= decision.class == wanted && (0.0..=RECOGNISED_S).contains(&since_s);
    }

    /// After the last decision.
    pub(crate) fn finish(self) -> Exchanged {
        self.outcome
    }
}

/// A fast loss while it is watched.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FastLossWatch {
    outcome: FastLoss,
    onset_s: f64,
    /// By then it must be told, s.
    deadline_s: Option<f64>,
    /// Whether a statement after the deadline was heard.
    is_late: bool,
}

impl FastLossWatch {
    /// The fast loss of a world; `None`: it has none.
    pub(crate) fn of(world: &World) -> Option<Self> {
        let (part, onset_s, announced) = match world.request.overlay {
            Overlay::FastLoss { part, onset_s, .. } => (part, onset_s, false),
            Overlay::Discharge { part, onset_s, announced, .. } => (part, onset_s, announced),
            _ => return None,
        };
        let truth = &world.truth;
        let first = truth.time_s.partition_point(|time_s| *time_s <= onset_s).saturating_sub(1);
        let whole_kg = *truth.mass_kg.get(first)?;
        let matters =
            (first..truth.mass_kg.len()).find(|row| truth.mass_kg[*row] <= (1.0 - FAST_LOSS_PART) * whole_kg);
        // Between two rows the loss is taken as even.
        let matters_s = matters.map(|row| {
            let before = row.saturating_sub(1).max(first);
            let (from_s, to_s) = (truth.time_s[before].max(onset_s), truth.time_s[row]);
            let fallen_kg = truth.mass_kg[before] - truth.mass_kg[row];
            let share = (truth.mass_kg[before] - (1.0 - FAST_LOSS_PART) * whole_kg)
                / fallen_kg.max(f64::MIN_POSITIVE);
            from_s + share.clamp(0.0, 1.0) * (to_s - from_s)
        });
        let outcome = FastLoss {
            part,
            announced,
            matters_s: matters_s.map(|at_s| at_s - onset_s),
            told_s: None,
            in_time: false,
            told_as: None,
        };
        Some(Self {
            outcome,
            onset_s,
            deadline_s: matters_s.map(|at_s| at_s + FAST_LOSS_DEADLINE_S),
            is_late: false,
        })
    }

    /// Take a decision.
    pub(crate) fn take(&mut self, moment: &Moment<'_>, decision: &Decision) {
        let lost = self.outcome.matters_s.map(|matters_s| self.onset_s + matters_s);
        if decision.exit_code == 1 && self.outcome.told_s.is_none() {
            self.outcome.told_s = Some(moment.now_s - self.onset_s);
            self.outcome.told_as = Some(decision.class);
            let begun = moment.gas != Gas::Tight;
            let soon = self.deadline_s.is_some_and(|deadline_s| moment.now_s <= deadline_s || !self.is_late);
            self.outcome.in_time = begun && soon;
        }
        self.is_late |= lost.is_some_and(|lost_s| moment.now_s >= lost_s);
    }

    /// After the last decision.
    pub(crate) fn finish(self) -> FastLoss {
        self.outcome
    }
}

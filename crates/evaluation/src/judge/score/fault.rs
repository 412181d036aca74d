//! A row of the fault table that was laid over: whether what is said is what the row requires.
//!
//! | requirement | recognised if, from the onset on |
//! |---|---|
//! | survived, not a leak, degraded, continued | no loss is said |
//! | flagged | the same, and a sensor is named, or it is said that it cannot be told, within a day or by the end |
//! | warned | the same, or the verdict is never tight |
//! | undecidable | always: a loss may be said |
//! | recognised | an exchange of gas is said within 3 h, and no leak where none is |
//! | found | a leak is said, or a discharge |
//!
//! A discharge that is not announced is a loss; a refill is not, and is counted apart, as every false exchange is.
//!
//! With a leak beside the fault it must be told, too, before the end; where the requirement is flagged, degraded, undecidable or warned,
//! the last verdict may be unknown instead. Where the row takes gas away, the leak and the exchange that it is do not count as false.
use cylwatch_thermal::units::DAY_S;
use serde::{Deserialize, Serialize};

use super::Moment;
use crate::fault::Requirement;
use crate::judge::measures::Class;
use crate::judge::statement::Decision;
use crate::world::{FaultRow, Overlay, World, WorldEventKind};

/// Time within which an exchange of gas must be recognised, s.
const RECOGNISED_S: f64 = 3.0 * 3600.0;

/// What came of a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FaultOutcome {
    /// Row of the table.
    pub row: FaultRow,
    /// Whether what was said is what is required.
    pub recognised: bool,
    /// Whether a leak, or a loss whatever it is called, was said although there was none.
    pub false_loss: bool,
    /// Whether an exchange of gas was said although there was none.
    pub false_exchange: bool,
    /// Whether a sensor was named.
    pub named: bool,
    /// Whether the leak beside it was told; `None`: there was none.
    pub leak_found: Option<bool>,
}

/// A fault while it is watched.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FaultWatch {
    row: FaultRow,
    onset_s: f64,
    leak_onset_s: Option<f64>,
    leak_found: bool,
    last_unknown: bool,
    loses: bool,
    exchanges: bool,
    leak: bool,
    loss: bool,
    exchange: bool,
    /// An exchange of gas was said soon after the onset.
    soon: bool,
    named: bool,
    named_soon: bool,
    unknown_soon: bool,
    tight: bool,
}

impl FaultWatch {
    /// The fault of a world; `None`: it has none.
    pub(crate) fn of(world: &World) -> Option<Self> {
        let Overlay::Fault { row, onset_s, leak } = world.request.overlay else { return None };
        let any = |is: fn(&WorldEventKind) -> bool| world.events.iter().any(|event| is(&event.kind));
        let requirement = row.requirement();
        let loses =
            leak.is_none() && any(|kind| matches!(kind, WorldEventKind::Leak | WorldEventKind::FastLoss));
        let exchanges = any(|kind| matches!(kind, WorldEventKind::Discharge | WorldEventKind::Refill));
        Some(Self {
            row,
            onset_s,
            leak_onset_s: leak.map(|leak| leak.onset_s),
            leak_found: false,
            last_unknown: false,
            loses: loses || requirement == Requirement::Found,
            exchanges: exchanges || requirement == Requirement::Recognised,
            leak: false,
            loss: false,
            exchange: false,
            soon: false,
            named: false,
            named_soon: false,
            unknown_soon: false,
            tight: false,
        })
    }

    /// Take a decision.
    pub(crate) fn take(&mut self, moment: &Moment<'_>, decision: &Decision) {
        let since_s = moment.now_s - self.onset_s;
        if since_s < 0.0 {
            return;
        }
        let leaks = self.leak_onset_s.is_some_and(|onset_s| moment.now_s >= onset_s);
        self.leak_found |= leaks && (decision.loss || decision.says_leak());
        self.last_unknown = decision.class == Class::Unknown;
        self.leak |= decision.says_leak() && !leaks;
        self.loss |= decision.loss && !leaks;
        // A leak that is fast enough may be called a discharge.
        self.exchange |= decision.exchange && !(leaks && decision.class != Class::Refill);
        self.soon |= decision.exchange && since_s <= RECOGNISED_S;
        self.named |= decision.sensor_named;
        self.named_soon |= decision.sensor_named && since_s <= DAY_S;
        self.unknown_soon |= decision.class == Class::Unknown && moment.period == 1 && since_s <= DAY_S;
        self.tight |= decision.class == Class::Tight;
    }

    /// After the last decision.
    pub(crate) fn finish(self) -> FaultOutcome {
        let false_leak = self.leak && !self.loses;
        // An exchange that the row makes is a loss if gas goes out.
        let false_loss = false_leak || self.loss && !self.loses && !self.exchanges;
        let false_exchange = self.exchange && !self.exchanges && !self.loses;
        let quiet = !false_loss;
        let recognised = match self.row.requirement() {
            Requirement::Survived
            | Requirement::NotALeak
            | Requirement::Degraded
            | Requirement::Continued => quiet,
            Requirement::Flagged => quiet && (self.named_soon || self.unknown_soon),
            Requirement::Warned => quiet && (self.named || !self.tight),
            Requirement::Undecidable => true,
            Requirement::Recognised => !false_leak && self.soon,
            Requirement::Found => self.leak || self.exchange || self.leak_found,
        };
        let may_be_unknown = matches!(
            self.row.requirement(),
            Requirement::Flagged | Requirement::Degraded | Requirement::Undecidable | Requirement::Warned
        );
        let leak_found = self.leak_onset_s.map(|_| self.leak_found);
        let told = leak_found.is_none_or(|found| found || may_be_unknown && self.last_unknown);
        FaultOutcome {
            row: self.row,
            recognised: recognised && told,
            false_loss,
            false_exchange,
            named: self.named,
            leak_found,
        }
    }
}

//! State of one alarm, and what a sample does to it.
use alloc::string::String;
use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

use super::{Alarm, Delayed, Trigger};

/// State of an alarm, by the names of OPC UA Part 9. Times are of the log, s.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Condition {
    /// EnabledState.
    pub enabled: bool,
    /// ActiveState.
    pub active: bool,
    /// LimitState, while it is active and has limits.
    pub limit: Option<LimitState>,
    /// AckedState.
    pub acked: bool,
    /// ConfirmedState.
    pub confirmed: bool,
    /// LatchedState.
    pub latched: bool,
    /// Severity of the level that it is at, or was at last; 1 to 1000.
    pub severity: u16,
    /// Since when it is active, or when it was last, s.
    pub active_since_s: Option<f64>,
    /// When it was raised last, by activation, a worse limit or again, s.
    pub alarmed_s: Option<f64>,
    /// ReAlarmRepeatCount: how often it was raised again since it became active.
    pub re_alarm_repeat_count: i16,
    /// Comment of whoever acknowledged, confirmed or reset it last; empty: none.
    pub comment: String,
    /// Time of the last sample, s.
    pub last_s: Option<f64>,
    /// The levels behind their delays.
    pub levels: [Delayed; 2],
}

/// Sub-states of an exclusive limit alarm.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum LimitState {
    /// At or below the first limit.
    Low,
    /// At or below the second.
    LowLow,
}

/// A change of a condition and the state after it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Transition {
    /// Time, s.
    pub time_s: f64,
    /// What changed.
    pub change: Change,
    /// The state then.
    pub condition: Condition,
}

/// Changes of a condition at one sample.
pub(crate) type Transitions = SmallVec<[Transition; 2]>;

/// What can change.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Change {
    /// It became active.
    Active,
    /// It is at another limit than before.
    LimitChanged,
    /// It is active still and was raised again.
    ReAlarm,
    /// It returned to normal.
    Inactive,
    /// Somebody has seen it.
    Acknowledged,
    /// Somebody has dealt with it.
    Confirmed,
    /// The latch was released.
    Reset,
    /// It is watched again.
    Enabled,
    /// It is not watched any more.
    Disabled,
}

impl Default for Condition {
    /// Enabled and normal, nothing to be done.
    fn default() -> Self {
        Self {
            enabled: true,
            active: false,
            limit: None,
            acked: true,
            confirmed: true,
            latched: false,
            severity: 1,
            active_since_s: None,
            alarmed_s: None,
            re_alarm_repeat_count: 0,
            comment: String::new(),
            last_s: None,
            levels: [Delayed::default(); 2],
        }
    }
}

impl Change {
    /// One word.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Active => "active",
            Self::LimitChanged => "limit-changed",
            Self::ReAlarm => "re-alarm",
            Self::Inactive => "inactive",
            Self::Acknowledged => "acknowledged",
            Self::Confirmed => "confirmed",
            Self::Reset => "reset",
            Self::Enabled => "enabled",
            Self::Disabled => "disabled",
        }
    }
}

impl LimitState {
    /// The name that OPC UA gives it.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Low => "Low",
            Self::LowLow => "LowLow",
        }
    }
}

impl Condition {
    /// Retain: whether it is worth showing.
    pub fn retain(&self) -> bool {
        self.enabled && (self.active || self.latched || !self.acked || !self.confirmed)
    }

    /// Remembers and reports a change.
    pub(super) fn changed(&self, time_s: f64, change: Change) -> Transition {
        Transition { time_s, change, condition: self.clone() }
    }

    /// It is raised: somebody must see it.
    fn raise(&mut self, time_s: f64) {
        (self.acked, self.alarmed_s) = (false, Some(time_s));
    }
}

impl<T: Trigger> Alarm<T> {
    /// The state after a sample, and what changed with it. A time that is no number is no sample.
    pub fn step(&self, condition: Condition, time_s: f64, signal: T::Signal) -> (Condition, Transitions) {
        let mut next = condition;
        if !time_s.is_finite() {
            return (next, Transitions::new());
        }
        let step_s = next.last_s.map_or(0.0, |last_s| time_s - last_s);
        next.last_s = Some(time_s);
        if !next.enabled {
            return (next, Transitions::new());
        }
        let on = next.levels.map(|level| level.on);
        let violated = self.trigger.violated(signal, on);
        for (number, level) in next.levels.iter_mut().enumerate() {
            let signal = violated.map(|violated| violated[number]);
            *level = level.step(step_s, signal, &self.timing);
        }
        let mut changes = Transitions::new();
        self.follow_levels(&mut next, time_s, &mut changes);
        self.raise_again(&mut next, time_s, &mut changes);
        (next, changes)
    }

    /// ActiveState and LimitState after the levels.
    fn follow_levels(&self, next: &mut Condition, time_s: f64, changes: &mut Transitions) {
        let [low, low_low] = next.levels.map(|level| level.on);
        let active = low || low_low;
        let limit = match (self.trigger.has_limits() && active, low_low) {
            (false, _) => None,
            (true, false) => Some(LimitState::Low),
            (true, true) => Some(LimitState::LowLow),
        };
        let was = (next.active, next.limit);
        if (active, limit) == was {
            return;
        }
        (next.active, next.limit) = (active, limit);
        if !active {
            next.re_alarm_repeat_count = 0;
            changes.push(next.changed(time_s, Change::Inactive));
            return;
        }
        next.severity = self.trigger.severities()[usize::from(low_low)];
        if !was.0 {
            next.latched |= self.timing.latching;
            next.active_since_s = Some(time_s);
            next.raise(time_s);
            changes.push(next.changed(time_s, Change::Active));
            return;
        }
        if limit > was.1 {
            next.raise(time_s);
        }
        changes.push(next.changed(time_s, Change::LimitChanged));
    }

    /// ReAlarmTime; a gap over several of them raises once.
    fn raise_again(&self, next: &mut Condition, time_s: f64, changes: &mut Transitions) {
        let (true, Some(after_s), Some(alarmed_s)) =
            (next.active, self.timing.re_alarm_time_s, next.alarmed_s)
        else {
            return;
        };
        if time_s < alarmed_s {
            // The clock was set back.
            next.alarmed_s = Some(time_s);
        } else if time_s - alarmed_s >= after_s {
            next.raise(time_s);
            next.re_alarm_repeat_count = next.re_alarm_repeat_count.saturating_add(1);
            changes.push(next.changed(time_s, Change::ReAlarm));
        }
    }
}

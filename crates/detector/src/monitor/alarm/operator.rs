//! What people do to a condition. A refusal says which state stands against it; the condition stays as it was.
use super::{Change, Condition, Transition};
use crate::DetectorError;
use alloc::borrow::ToOwned;

impl Condition {
    /// Somebody has seen it. Where the alarm is `confirming`, it waits for [`Condition::confirm`] then. An empty comment
    /// leaves the last one.
    ///
    /// # Errors
    /// There is nothing to acknowledge, or the condition is disabled.
    pub fn acknowledge(
        self,
        time_s: f64,
        confirming: bool,
        comment: &str,
    ) -> Result<(Self, Transition), DetectorError> {
        self.refuse("acknowledged", self.acked, "it has been acknowledged")?;
        let confirmed = !confirming;
        Ok(Self { acked: true, confirmed, ..self }.commented(time_s, Change::Acknowledged, comment))
    }

    /// Somebody has dealt with it.
    ///
    /// # Errors
    /// It is not acknowledged, there is nothing to confirm, or the condition is disabled.
    pub fn confirm(self, time_s: f64, comment: &str) -> Result<(Self, Transition), DetectorError> {
        self.refuse("confirmed", !self.acked, "it must be acknowledged first")?;
        self.refuse("confirmed", self.confirmed, "there is nothing to confirm")?;
        Ok(Self { confirmed: true, ..self }.commented(time_s, Change::Confirmed, comment))
    }

    /// Releases the latch.
    ///
    /// # Errors
    /// It is not latched, still active, not acknowledged or not confirmed, or the condition is disabled.
    pub fn reset(self, time_s: f64, comment: &str) -> Result<(Self, Transition), DetectorError> {
        self.refuse("reset", !self.latched, "it is not latched")?;
        self.refuse("reset", self.active, "it is still active")?;
        self.refuse("reset", !self.acked, "it must be acknowledged first")?;
        self.refuse("reset", !self.confirmed, "it must be confirmed first")?;
        Ok(Self { latched: false, ..self }.commented(time_s, Change::Reset, comment))
    }

    /// Watches it, or does not. What is not watched is not active; what was left to be done stays and is worth showing
    /// again when it is enabled. `None`: it is so already.
    pub fn set_enabled(self, time_s: f64, enabled: bool) -> (Self, Option<Transition>) {
        if enabled == self.enabled {
            return (self, None);
        }
        let change = if enabled { Change::Enabled } else { Change::Disabled };
        let mut next = Self { enabled, active: false, limit: None, re_alarm_repeat_count: 0, ..self };
        next.levels = Default::default();
        let transition = next.changed(time_s, change);
        (next, Some(transition))
    }

    fn refuse(&self, act: &'static str, stands: bool, reason: &'static str) -> Result<(), DetectorError> {
        if !self.enabled {
            return Err(DetectorError::AlarmState { act, reason: "it is disabled" });
        }
        if stands { Err(DetectorError::AlarmState { act, reason }) } else { Ok(()) }
    }

    fn commented(mut self, time_s: f64, change: Change, comment: &str) -> (Self, Transition) {
        if !comment.is_empty() {
            self.comment = comment.to_owned();
        }
        let transition = self.changed(time_s, change);
        (self, transition)
    }
}

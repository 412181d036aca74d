//! The rules of one alarm: what raises it, how long that must last, who must be told again.
use serde::{Deserialize, Serialize};

use crate::DetectorError;

/// Delays and duties of an alarm.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Timing {
    /// OnDelay: how long the signal must last, s.
    pub on_delay_s: f64,
    /// OffDelay: how long it must be away, s.
    pub off_delay_s: f64,
    /// With how much an interval between two samples counts for a delay at most, s.
    pub longest_step_s: f64,
    /// Whether it stays latched until it is reset.
    pub latching: bool,
    /// Whether it must be confirmed after it was acknowledged.
    pub confirming: bool,
    /// ReAlarmTime: when an alarm that is still active is raised again, s; `None`: never.
    pub re_alarm_time_s: Option<f64>,
}

impl Default for Timing {
    /// At once, not latching, without confirmation, again every day; a step counts for a quarter of an hour at the most.
    fn default() -> Self {
        Self {
            on_delay_s: 0.0,
            off_delay_s: 0.0,
            longest_step_s: 900.0,
            latching: false,
            confirming: false,
            re_alarm_time_s: Some(86_400.0),
        }
    }
}

impl Timing {
    /// # Errors
    /// A delay is negative, or the longest step or the re-alarm time not positive.
    pub fn validate(&self) -> Result<(), DetectorError> {
        for (setting, value) in [("on_delay_s", self.on_delay_s), ("off_delay_s", self.off_delay_s)] {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(DetectorError::Setting { setting, value, bound: "finite and at least 0" });
            }
        }
        crate::error::positive("longest_step_s", self.longest_step_s)?;
        if let Some(re_alarm_time_s) = self.re_alarm_time_s {
            crate::error::positive("re_alarm_time_s", re_alarm_time_s)?;
        }
        Ok(())
    }
}

/// What raises an alarm: up to two levels, the second within the first.
pub trait Trigger {
    /// What it looks at.
    type Signal: Copy;

    /// Which levels the signal violates, given those that are on; `None` where it is unknown.
    fn violated(&self, signal: Self::Signal, on: [bool; 2]) -> Option<[bool; 2]>;

    /// Severity of the first level and of the second, 1 to 1000.
    fn severities(&self) -> [u16; 2];

    /// Whether the levels are named Low and LowLow.
    fn has_limits(&self) -> bool;

    /// # Errors
    /// A severity is out of its range, or limits contradict each other.
    fn validate(&self) -> Result<(), DetectorError>;
}

/// OffNormalAlarmType: something is as it should be, or is not.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OffNormal {
    /// Severity, 1 to 1000.
    pub severity: u16,
}

/// ExclusiveLimitAlarmType for a value that must not fall: Low, and below it LowLow.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExclusiveLimit {
    /// LowLimit.
    pub low: Limit,
    /// LowLowLimit.
    pub low_low: Option<Limit>,
}

/// A limit that is violated by a value at or below it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Limit {
    /// In the unit of the value.
    pub limit: f64,
    /// How far above the limit the value must rise to leave it.
    pub deadband: f64,
    /// Severity, 1 to 1000.
    pub severity: u16,
}

/// An alarm: what raises it, and its delays and duties.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Alarm<T> {
    /// What raises it.
    pub trigger: T,
    /// Delays and duties.
    pub timing: Timing,
}

impl<T: Trigger> Alarm<T> {
    /// # Errors
    /// Names the setting, its value and the bound.
    pub fn validate(&self) -> Result<(), DetectorError> {
        self.timing.validate()?;
        self.trigger.validate()
    }
}

impl Trigger for OffNormal {
    type Signal = Option<bool>;

    fn violated(&self, signal: Option<bool>, _: [bool; 2]) -> Option<[bool; 2]> {
        signal.map(|signal| [signal, false])
    }

    fn severities(&self) -> [u16; 2] {
        [self.severity; 2]
    }

    fn has_limits(&self) -> bool {
        false
    }

    fn validate(&self) -> Result<(), DetectorError> {
        check_severity(self.severity)
    }
}

impl Limit {
    fn is_violated(&self, value: f64, on: bool) -> bool {
        value <= self.limit + if on { self.deadband } else { 0.0 }
    }

    fn validate(&self) -> Result<(), DetectorError> {
        if !self.limit.is_finite() {
            let (setting, value) = ("limit", self.limit);
            return Err(DetectorError::Setting { setting, value, bound: "finite" });
        }
        if !(self.deadband >= 0.0 && self.deadband.is_finite()) {
            let (setting, value) = ("deadband", self.deadband);
            return Err(DetectorError::Setting { setting, value, bound: "finite and at least 0" });
        }
        check_severity(self.severity)
    }
}

impl Trigger for ExclusiveLimit {
    type Signal = f64;

    fn violated(&self, value: f64, on: [bool; 2]) -> Option<[bool; 2]> {
        let low_low = self.low_low.is_some_and(|limit| limit.is_violated(value, on[1]));
        (!value.is_nan()).then(|| [self.low.is_violated(value, on[0]), low_low])
    }

    fn severities(&self) -> [u16; 2] {
        [self.low.severity, self.low_low.map_or(self.low.severity, |limit| limit.severity)]
    }

    fn has_limits(&self) -> bool {
        true
    }

    fn validate(&self) -> Result<(), DetectorError> {
        self.low.validate()?;
        let Some(low_low) = self.low_low else { return Ok(()) };
        low_low.validate()?;
        if low_low.limit > self.low.limit {
            let (setting, value) = ("low_low.limit", low_low.limit);
            return Err(DetectorError::Setting { setting, value, bound: "at most low.limit" });
        }
        // Else LowLow could still be on when Low is not.
        if low_low.limit + low_low.deadband > self.low.limit + self.low.deadband {
            let (setting, value) = ("low_low.deadband", low_low.deadband);
            let bound = "so small that LowLow ends at or below the end of Low";
            return Err(DetectorError::Setting { setting, value, bound });
        }
        Ok(())
    }
}

fn check_severity(severity: u16) -> Result<(), DetectorError> {
    if (1..=1000).contains(&severity) {
        return Ok(());
    }
    let (setting, value) = ("severity", f64::from(severity));
    Err(DetectorError::Setting { setting, value, bound: "between 1 and 1000" })
}

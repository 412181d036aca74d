//! The six alarms of a cylinder.
use alloc::vec::Vec;
use core::fmt;
use serde::{Deserialize, Serialize};

use super::{Alarm, AlarmSettings, Change, Condition, Transition, Trigger};
use crate::monitor::event::Id;
use crate::monitor::{Health, Output, Reason, Verdict};

/// Names of the alarms.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum AlarmName {
    /// Gas is being lost.
    Leak,
    /// The pressure at 15 °C is at the operational limit or near it.
    OperationalLimit,
    /// So much pressure is lost that the cylinder must be refilled.
    MaintenanceLimit,
    /// A sensor is not as it should be.
    SensorFault,
    /// Nothing can be said of the gas.
    Unknown,
    /// The pressure will be below the limit on the coldest night.
    ColdNight,
}

/// State of all alarms.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct AlarmPanel {
    /// In the order of [`AlarmName::ALL`].
    conditions: [Condition; 6],
}

/// What the alarms look at after a sample. NaN and `None`: unknown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AlarmInputs {
    /// Whether gas is being lost.
    pub leak: Option<bool>,
    /// Pressure at 15 °C, Pa.
    pub p15_pa: f64,
    /// The same over that of the full cylinder.
    pub filling: f64,
    /// Whether a sensor is at fault.
    pub sensor_fault: Option<bool>,
    /// Whether nothing can be said of the gas.
    pub unknown: Option<bool>,
    /// Raw pressure on the coldest night, Pa.
    pub cold_pressure_pa: f64,
}

/// A change of an alarm, with a name that stays the same wherever the log is replayed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AlarmEvent {
    /// Which alarm.
    pub alarm: AlarmName,
    /// What changed, when, and the state after it.
    pub transition: Transition,
}

impl AlarmName {
    /// All alarms.
    pub const ALL: [Self; 6] = [
        Self::Leak,
        Self::OperationalLimit,
        Self::MaintenanceLimit,
        Self::SensorFault,
        Self::Unknown,
        Self::ColdNight,
    ];

    /// One word.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Leak => "leak",
            Self::OperationalLimit => "operational-limit",
            Self::MaintenanceLimit => "maintenance-limit",
            Self::SensorFault => "sensor-fault",
            Self::Unknown => "unknown",
            Self::ColdNight => "cold-night",
        }
    }
}

impl AlarmInputs {
    /// What a monitor's output says; `full_pa` is the pressure at 15 °C of the full cylinder, Pa.
    pub fn of(output: &Output, full_pa: f64) -> Self {
        let verdict = output.decision.verdict;
        let p15_pa = output.estimate.p15_pa;
        let at_fault =
            |health: &Health| !matches!(health, Health::Good | Health::Spikes | Health::Deviates(_));
        // The first days and the hours after a refill are no loss of sight.
        let expected =
            matches!(verdict.reason(), Some(Reason::Learning | Reason::Settling | Reason::Disturbed));
        Self {
            leak: output.decision.leak_alarm(),
            p15_pa,
            filling: p15_pa / full_pa,
            sensor_fault: Some(verdict == Verdict::SensorFault || output.health.iter().any(at_fault)),
            unknown: Some(verdict.reason().is_some() && !expected),
            cold_pressure_pa: output.cold_pressure_pa,
        }
    }
}

impl AlarmEvent {
    /// The same for the same change: `alarm-<name>-<change>-<time, ms>`.
    pub fn id(&self) -> impl fmt::Display + use<> {
        let words = ["alarm", self.alarm.as_str(), self.transition.change.as_str()];
        Id { words, ms: libm::round(self.transition.time_s * 1e3) }
    }
}

impl AlarmPanel {
    /// State of an alarm.
    pub fn condition(&self, alarm: AlarmName) -> &Condition {
        &self.conditions[alarm as usize]
    }

    /// Alarms that are worth showing, the most severe first.
    pub fn retained(&self) -> Vec<(AlarmName, &Condition)> {
        let all = AlarmName::ALL.into_iter().zip(&self.conditions);
        let mut retained: Vec<_> = all.filter(|(_, condition)| condition.retain()).collect();
        retained.sort_by_key(|(_, condition)| core::cmp::Reverse(condition.severity));
        retained
    }

    /// Take in a sample; what changes is added to the events.
    pub fn step(
        &mut self,
        settings: &AlarmSettings,
        time_s: f64,
        inputs: &AlarmInputs,
        events: &mut Vec<AlarmEvent>,
    ) {
        let AlarmInputs { leak, p15_pa, filling, sensor_fault, unknown, cold_pressure_pa } = *inputs;
        self.advance(AlarmName::Leak, &settings.leak, (time_s, leak), events);
        let operational = (time_s, p15_pa);
        self.advance(AlarmName::OperationalLimit, &settings.operational_limit, operational, events);
        let maintenance = (time_s, filling);
        self.advance(AlarmName::MaintenanceLimit, &settings.maintenance_limit, maintenance, events);
        self.advance(AlarmName::SensorFault, &settings.sensor_fault, (time_s, sensor_fault), events);
        self.advance(AlarmName::Unknown, &settings.unknown, (time_s, unknown), events);
        self.advance(AlarmName::ColdNight, &settings.cold_night, (time_s, cold_pressure_pa), events);
    }

    /// Somebody has seen and dealt with all there is: acknowledges, confirms, and resets what has returned to normal.
    pub fn acknowledge_all(
        &mut self,
        settings: &AlarmSettings,
        time_s: f64,
        comment: &str,
    ) -> Vec<AlarmEvent> {
        let mut events = Vec::new();
        for name in AlarmName::ALL {
            let confirming = settings.is_confirming(name);
            for act in [Change::Acknowledged, Change::Confirmed, Change::Reset] {
                let condition = self.conditions[name as usize].clone();
                let outcome = match act {
                    Change::Acknowledged => condition.acknowledge(time_s, confirming, comment),
                    Change::Confirmed => condition.confirm(time_s, comment),
                    _ => condition.reset(time_s, comment),
                };
                // What cannot be done now needs not be done, or waits for the return to normal.
                let Ok((condition, transition)) = outcome else { continue };
                self.conditions[name as usize] = condition;
                events.push(AlarmEvent { alarm: name, transition });
            }
        }
        events
    }

    fn advance<T: Trigger>(
        &mut self,
        name: AlarmName,
        alarm: &Alarm<T>,
        (time_s, signal): (f64, T::Signal),
        events: &mut Vec<AlarmEvent>,
    ) {
        let condition = core::mem::take(&mut self.conditions[name as usize]);
        let (condition, transitions) = alarm.step(condition, time_s, signal);
        self.conditions[name as usize] = condition;
        events.extend(transitions.into_iter().map(|transition| AlarmEvent { alarm: name, transition }));
    }
}

impl AlarmSettings {
    /// Whether an alarm must be confirmed.
    fn is_confirming(&self, name: AlarmName) -> bool {
        let timing = match name {
            AlarmName::Leak => &self.leak.timing,
            AlarmName::OperationalLimit => &self.operational_limit.timing,
            AlarmName::MaintenanceLimit => &self.maintenance_limit.timing,
            AlarmName::SensorFault => &self.sensor_fault.timing,
            AlarmName::Unknown => &self.unknown.timing,
            AlarmName::ColdNight => &self.cold_night.timing,
        };
        timing.confirming
    }
}

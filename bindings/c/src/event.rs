//! What has happened, in plain structs. NaN, and -1 for the index of a sensor: nothing of the kind.
use crate::output::{cw_health, cw_interval, cw_reason, cw_verdict};
use core::ffi::c_char;

/// Room for the name of an event, with its end.
pub const CW_ID_SIZE: usize = 64;
/// Room for a comment and for the words of an error, with its end.
pub const CW_TEXT_SIZE: usize = 512;

/// Kinds of events.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum cw_event_kind {
    /// The verdict changed: `verdict_from`, `verdict_to` and their reasons.
    Verdict = 0,
    /// A leak was found: `leak_rate_kg_s`.
    LeakFound = 1,
    /// A leak is over, or was none.
    LeakEnded = 2,
    /// Gas went out at once: `mass_kg`.
    Discharge = 3,
    /// Gas was put in: `mass_kg`.
    Refill = 4,
    /// The health of `sensor` changed: `health`.
    Sensor = 5,
    /// The raw pressure, `pressure_pa`, will be below the limit at the coldest temperature expected.
    ColdNight = 6,
    /// The first readings stand for `mass_kg` where `filled_kg` was stated.
    FillingDoubted = 7,
    /// Two thermometers, `sensor` and `other_sensor`, were in each other's place.
    Swapped = 8,
    /// The channel of `sensor` is late by `duration_s`.
    Late = 9,
    /// `sensor` and `other_sensor` have been apart by `difference_k` for an hour.
    Disturbed = 10,
    /// The clock jumped by `duration_s`.
    ClockJump = 11,
    /// Rows came after a gap of `duration_s`.
    Gap = 12,
    /// A row came too late to be used.
    TooLate = 13,
    /// The estimate began again from its prior.
    Restarted = 14,
}

/// Something that happened.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct cw_event {
    /// What it was.
    pub kind: cw_event_kind,
    /// Index of the sensor, or -1.
    pub sensor: i32,
    /// Index of the other sensor, or -1.
    pub other_sensor: i32,
    /// Verdict before.
    pub verdict_from: cw_verdict,
    /// Its reason.
    pub reason_from: cw_reason,
    /// Verdict now.
    pub verdict_to: cw_verdict,
    /// Its reason.
    pub reason_to: cw_reason,
    /// Health of the sensor.
    pub health: cw_health,
    /// Time of the row at which it was noticed, s.
    pub time_s: f64,
    /// When it began, s.
    pub onset_s: f64,
    /// Leak rate, kg/s.
    pub leak_rate_kg_s: cw_interval,
    /// Mass, kg.
    pub mass_kg: f64,
    /// Mass that was stated, kg.
    pub filled_kg: f64,
    /// Pressure, Pa.
    pub pressure_pa: f64,
    /// Time, s.
    pub duration_s: f64,
    /// Difference of two thermometers, K.
    pub difference_k: f64,
    /// The same for the same happening however often the rows are replayed; ends with 0.
    pub id: [c_char; CW_ID_SIZE],
}

/// Alarms of a cylinder.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum cw_alarm_name {
    /// Gas is being lost.
    Leak = 0,
    /// The pressure at 15 degrees Celsius is at the operational limit or near it.
    OperationalLimit = 1,
    /// So much pressure is lost that the cylinder must be refilled.
    MaintenanceLimit = 2,
    /// A sensor is not as it should be.
    SensorFault = 3,
    /// Nothing can be said of the gas.
    Unknown = 4,
    /// The pressure will be below the limit on the coldest night.
    ColdNight = 5,
}

/// What changed about an alarm, by OPC UA Part 9.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum cw_alarm_change {
    /// It became active.
    Active = 0,
    /// It is at another limit than before.
    LimitChanged = 1,
    /// It is active still and was raised again.
    ReAlarm = 2,
    /// It returned to normal.
    Inactive = 3,
    /// It was acknowledged.
    Acknowledged = 4,
    /// It was confirmed.
    Confirmed = 5,
    /// The latch was released.
    Reset = 6,
    /// It is watched again.
    Enabled = 7,
    /// It is not watched any more.
    Disabled = 8,
}

/// Limit at which an alarm is.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum cw_alarm_limit {
    /// It has none, or is at none.
    None = 0,
    /// At or below the first.
    Low = 1,
    /// At or below the second.
    LowLow = 2,
}

/// A change of an alarm, and its state after it.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct cw_alarm {
    /// Which alarm.
    pub name: cw_alarm_name,
    /// What changed.
    pub change: cw_alarm_change,
    /// Limit at which it is.
    pub limit: cw_alarm_limit,
    /// 1 to 1000.
    pub severity: u32,
    /// How often it was raised again since it became active.
    pub re_alarm_repeat_count: i32,
    /// ActiveState.
    pub active: bool,
    /// AckedState.
    pub acked: bool,
    /// ConfirmedState.
    pub confirmed: bool,
    /// LatchedState.
    pub latched: bool,
    /// Time of the change, s.
    pub time_s: f64,
    /// Since when it is active, or was last, s.
    pub active_since_s: f64,
    /// The same for the same change however often the rows are replayed; ends with 0.
    pub id: [c_char; CW_ID_SIZE],
}

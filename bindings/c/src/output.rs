//! What the monitor says of a row, in plain structs. SI; NaN: not known.

/// Most sensors of a cylinder.
pub const CW_MOST_SENSORS: usize = 8;

/// What is happening to the gas.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum cw_verdict {
    /// No gas is being lost that could be seen.
    Tight = 0,
    /// Gas is being lost steadily.
    Leak = 1,
    /// Gas was let out fast, or is being.
    Discharge = 2,
    /// Gas was put in, or is being.
    Refill = 3,
    /// A sensor is at fault; what is said of the gas rests on the others.
    SensorFault = 4,
    /// It cannot be told, and never counts as tight.
    Unknown = 5,
}

/// Why it cannot be told.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum cw_reason {
    /// It can be told.
    None = 0,
    /// Still learning the sensors.
    Learning = 1,
    /// The readings do not fit the filling that was stated.
    Filling = 2,
    /// No usable pressure.
    NoPressure = 3,
    /// No usable temperature.
    NoTemperature = 4,
    /// No rows for too long.
    Gap = 5,
    /// The pressure jumped: gas or transmitter.
    Jump = 6,
    /// Gas was exchanged and has not settled.
    Settling = 7,
    /// One end of the cylinder is warmed or cooled by itself.
    Disturbed = 8,
    /// A reading stands still.
    Stuck = 9,
    /// The clock jumped.
    Clock = 10,
    /// The estimate had to begin again.
    Restarted = 11,
    /// A leak is likely, but not certain yet.
    Suspected = 12,
    /// The cylinder is nearly empty: no leak would show.
    Empty = 13,
}

/// Whether gas is being lost.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum cw_outcome {
    /// No gas is being lost.
    NoLoss = 0,
    /// Gas is being lost.
    Loss = 1,
    /// It cannot be told.
    Unknown = 2,
}

/// What to do, the least urgent first.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum cw_reaction {
    /// It is not known.
    Unknown = -1,
    /// Nothing.
    None = 0,
    /// Refill or replace at the next service.
    NextInterval = 1,
    /// Maintenance before the next service.
    AsSoonAsPossible = 2,
    /// Stop using the vehicle.
    Shutdown = 3,
}

/// How far to rely on an estimate.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum cw_quality {
    /// Every sensor was heard.
    Good = 0,
    /// A sensor had no reading, or its reading was rejected.
    Degraded = 1,
    /// No reading at all: the model alone.
    Predicted = 2,
    /// Gas is or was just exchanged: mass and gas temperature are free.
    Open = 3,
    /// The estimate began again from its prior.
    Restarted = 4,
}

/// How a sensor is doing.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum cw_health_state {
    /// As it should.
    Good = 0,
    /// No readings.
    Missing = 1,
    /// Readings outside what it can read.
    Implausible = 2,
    /// Readings that stand still.
    Stuck = 3,
    /// Single readings far off.
    Spikes = 4,
    /// Its offset jumped, which is taken into account.
    Shifted = 5,
    /// Off for half an hour, while the other thermometer agrees with the pressure.
    Deviates = 6,
    /// It follows the air instead of the surface.
    Detached = 7,
    /// There is no such sensor.
    NoSensor = 8,
}

/// Health of a sensor.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct cw_health {
    /// How it is doing.
    pub state: cw_health_state,
    /// Off by so much, K or Pa; NaN where that is not said.
    pub off_k_or_pa: f64,
}

/// A value with its 95 % interval.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct cw_interval {
    /// Estimate.
    pub value: f64,
    /// Lower bound.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
}

/// Time until a limit is reached: before `p5_s` with 5 %. 0: it has been reached; infinite: not within the horizon; NaN: not known.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct cw_time_left {
    /// 5 %, s.
    pub p5_s: f64,
    /// Median, s.
    pub p50_s: f64,
    /// 95 %, s.
    pub p95_s: f64,
    /// The horizon, s.
    pub horizon_s: f64,
}

/// What is said of a row.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct cw_output {
    /// Time as the row was stamped, s.
    pub stamp_s: f64,
    /// The same without jumps of the clock, s.
    pub time_s: f64,
    /// What is happening to the gas.
    pub verdict: cw_verdict,
    /// Why it cannot be told.
    pub reason: cw_reason,
    /// Whether gas is being lost.
    pub outcome: cw_outcome,
    /// What is due now.
    pub reaction: cw_reaction,
    /// How far to rely on the estimate.
    pub quality: cw_quality,
    /// Sensors of the cylinder.
    pub sensor_count: u32,
    /// Events at this row: cw_event_at gives them.
    pub event_count: u32,
    /// Changes of alarms at this row: cw_alarm_at gives them.
    pub alarm_count: u32,
    /// Probability that gas is being lost.
    pub leak_probability: f64,
    /// Mean gas temperature, K.
    pub gas_mean_k: f64,
    /// Its standard deviation, K.
    pub gas_mean_sd_k: f64,
    /// Gas mass, kg.
    pub mass_kg: f64,
    /// Its standard deviation, kg.
    pub mass_sd_kg: f64,
    /// Leak rate as the observer estimates it, kg/s.
    pub estimated_leak_kg_s: f64,
    /// Its standard deviation, kg/s.
    pub estimated_leak_sd_kg_s: f64,
    /// Pressure as read, Pa.
    pub pressure_pa: f64,
    /// Pressure that the transmitter would show with the mass of the reference, Pa.
    pub pressure_expected_pa: f64,
    /// Pressure of the mass at 15 degrees Celsius, Pa.
    pub pressure_at_15_degc_pa: f64,
    /// Raw pressure at the coldest temperature expected, Pa.
    pub cold_pressure_pa: f64,
    /// Leak rate, kg/s: of the leak that is found, else from 0 to what a leak is below with 97.5 %.
    pub leak_rate_kg_s: cw_interval,
    /// Whether a leak is found; else the three below are NaN.
    pub leak_found: bool,
    /// Loss of the pressure at 15 degrees Celsius, Pa/s.
    pub leak_rate_pa_s: cw_interval,
    /// When the leak began, s.
    pub leak_onset_s: cw_interval,
    /// Mass lost since, kg.
    pub lost_kg: cw_interval,
    /// Whether there is an outlook; else what is below is NaN or unknown.
    pub outlook_known: bool,
    /// Whether it rests on a leak; else on limits that are reached alone.
    pub outlook_of_leak: bool,
    /// Until the pressure at 15 degrees Celsius is at the operational limit.
    pub operational_limit: cw_time_left,
    /// Until the raw pressure at the coldest temperature expected is at the operational limit.
    pub cold_limit: cw_time_left,
    /// Until the maintenance limit.
    pub maintenance_limit: cw_time_left,
    /// What is due by the time that is left.
    pub advice: cw_reaction,
    /// Probability that the operational limit is reached before a safe state.
    pub before_safe_state_probability: f64,
    /// Probability that it is reached before the next service.
    pub before_next_service_probability: f64,
    /// Probability that the maintenance limit is reached before the service after the next.
    pub before_following_service_probability: f64,
    /// Health of each sensor, in the order of the readings.
    pub health: [cw_health; CW_MOST_SENSORS],
}

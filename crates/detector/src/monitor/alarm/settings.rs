//! Settings of the six alarms of a cylinder.
use alloc::boxed::Box;
use serde::{Deserialize, Serialize};

use super::{Alarm, AlarmName, ExclusiveLimit, Limit, OffNormal, Timing};
use crate::DetectorError;
use crate::prognosis::ISO_14520_LOSS;
use crate::units::{BAR_PA, DAY_S, HOUR_S, MINUTE_S};

/// Warning above the operational limit, and deadbands, as parts of it: 5 bar and 1 bar at 160 bar.
const WARNING: f64 = 5.0 / 160.0;
const DEADBAND: f64 = 1.0 / 160.0;

/// Rules of the alarms of a cylinder.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct AlarmSettings {
    /// Gas is being lost. At once, because the monitor has weighed it already; stays latched.
    pub leak: Alarm<OffNormal>,
    /// Pressure at 15 °C, Pa: LowLow is the operational limit, Low a warning above it.
    pub operational_limit: Alarm<ExclusiveLimit>,
    /// Pressure at 15 °C over that of the full cylinder.
    pub maintenance_limit: Alarm<ExclusiveLimit>,
    /// A sensor is not as it should be.
    pub sensor_fault: Alarm<OffNormal>,
    /// Nothing can be said of the gas.
    pub unknown: Alarm<OffNormal>,
    /// Raw pressure on the coldest night, Pa; a deadband below the operational limit, since a full cylinder is right at it.
    pub cold_night: Alarm<ExclusiveLimit>,
}

impl Default for AlarmSettings {
    /// For 160 bar.
    fn default() -> Self {
        Self::with_limit(160.0 * BAR_PA)
    }
}

impl AlarmSettings {
    /// The defaults for an operational limit, Pa.
    ///
    /// A warning 3 % above it, 5 bar at 160 bar; deadbands of 1 bar there and 0.5 %, several times the noise of the estimate. Delays are short where the monitor
    /// has waited already, and an hour where weather could pass. Severities: 900 out of operation, 800 gas is being lost, 600 and
    /// 500 somebody must come, 400 and 300 at the next occasion.
    pub fn with_limit(limit_pa: f64) -> Self {
        let timing = |on_delay_s: f64, off_delay_s: f64, re_alarm_time_s: f64| Timing {
            on_delay_s,
            off_delay_s,
            re_alarm_time_s: Some(re_alarm_time_s),
            ..Timing::default()
        };
        let low = |limit, deadband, severity| Limit { limit, deadband, severity };
        let below = |limit| ExclusiveLimit { low: limit, low_low: None };
        let latching = Timing { latching: true, confirming: true, ..timing(0.0, HOUR_S, DAY_S) };
        Self {
            leak: Alarm { trigger: OffNormal { severity: 800 }, timing: latching },
            operational_limit: Alarm {
                trigger: ExclusiveLimit {
                    low: low((1.0 + WARNING) * limit_pa, DEADBAND * limit_pa, 600),
                    low_low: Some(low(limit_pa, DEADBAND * limit_pa, 900)),
                },
                timing: Timing { confirming: true, ..timing(10.0 * MINUTE_S, 10.0 * MINUTE_S, DAY_S) },
            },
            maintenance_limit: Alarm {
                trigger: below(low(1.0 - ISO_14520_LOSS, 0.005, 400)),
                timing: timing(HOUR_S, HOUR_S, 7.0 * DAY_S),
            },
            sensor_fault: Alarm {
                trigger: OffNormal { severity: 500 },
                timing: timing(10.0 * MINUTE_S, 10.0 * MINUTE_S, DAY_S),
            },
            unknown: Alarm {
                trigger: OffNormal { severity: 500 },
                timing: timing(HOUR_S, 10.0 * MINUTE_S, DAY_S),
            },
            cold_night: Alarm {
                trigger: below(low((1.0 - DEADBAND) * limit_pa, DEADBAND * limit_pa, 300)),
                timing: timing(HOUR_S, HOUR_S, 7.0 * DAY_S),
            },
        }
    }

    /// # Errors
    /// Names the alarm, the setting, its value and the bound.
    pub fn validate(&self) -> Result<(), DetectorError> {
        for (alarm, checked) in [
            (AlarmName::Leak, self.leak.validate()),
            (AlarmName::OperationalLimit, self.operational_limit.validate()),
            (AlarmName::MaintenanceLimit, self.maintenance_limit.validate()),
            (AlarmName::SensorFault, self.sensor_fault.validate()),
            (AlarmName::Unknown, self.unknown.validate()),
            (AlarmName::ColdNight, self.cold_night.validate()),
        ] {
            let of_alarm = |source| DetectorError::Alarm { alarm: alarm.as_str(), source: Box::new(source) };
            checked.map_err(of_alarm)?;
        }
        Ok(())
    }
}

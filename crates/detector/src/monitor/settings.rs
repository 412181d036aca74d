//! What the monitor is told: limits, how rare a false alarm is to be, when something counts.
use crate::units::YEAR_S;
use serde::{Deserialize, Serialize};

use super::alarm::AlarmSettings;
use super::intake::IntakeSettings;
use crate::DetectorError;
use crate::error::positive;
use crate::estimator::observer::ObserverSettings;
use crate::evidence::Tails;
use crate::prognosis::{ISO_14520_LOSS, LossLaw, ReactionSettings};
use crate::units::HOUR_S;

/// Limits of the pressure.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Limits {
    /// Pressure below which the system is not operational, Pa.
    pub operational_pa: f64,
    /// Coldest temperature expected, K: the raw pressure there is compared with the operational limit.
    pub coldest_k: f64,
    /// Whether the operational limit counts at the coldest temperature too. A full cylinder reads 160 bar at -25 °C: there, it would stop
    /// the vehicle at every second one.
    pub cold_is_operational: bool,
    /// Loss of pressure, corrected for temperature, as a part of the filling, from which maintenance is due.
    pub maintenance_loss: f64,
}

impl Default for Limits {
    /// 160 bar, -25 °C, 5 % (ISO 14520).
    fn default() -> Self {
        Self {
            operational_pa: 160e5,
            coldest_k: 248.15,
            cold_is_operational: false,
            maintenance_loss: ISO_14520_LOSS,
        }
    }
}

/// Settings of a monitor. SI.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct MonitorSettings {
    /// The observer inside.
    pub observer: ObserverSettings,
    /// How rows are taken in.
    pub intake: IntakeSettings,
    /// Mean time between false leak alarms, s.
    pub false_alarm_interval_s: f64,
    /// What the statistics of the evidence reach without a leak: thresholds follow from them and from that time. `None`: what is known of the
    /// vessel, [`Tails::of`].
    pub tails: Option<Tails>,
    /// Limits of the pressure.
    pub limits: Limits,
    /// How a leak goes on.
    pub loss: LossLaw,
    /// When a reaction is due.
    pub reaction: ReactionSettings,
    /// Alarms.
    pub alarms: AlarmSettings,
    /// Time from the first sample on in which the sensors are being learnt, s.
    pub learning_s: f64,
    /// Time without a usable pressure, or without a usable temperature, after which nothing can be told, s.
    pub blind_after_s: f64,
    /// Time for which nothing has been heard after which a look is needed before anything is told, s.
    pub gap_s: f64,
    /// Time for which a leak is not seen any more after which it is over, s.
    pub leak_over_after_s: f64,
}

impl Default for MonitorSettings {
    /// A false alarm in ten years; a day of learning; blind after half an hour; a gap from six hours on; a leak over after a day.
    fn default() -> Self {
        Self {
            observer: crate::evidence::observer_settings(),
            intake: IntakeSettings::default(),
            false_alarm_interval_s: 10.0 * YEAR_S,
            tails: None,
            limits: Limits::default(),
            loss: LossLaw::default(),
            reaction: ReactionSettings::default(),
            alarms: AlarmSettings::default(),
            learning_s: 24.0 * HOUR_S,
            blind_after_s: 0.5 * HOUR_S,
            gap_s: 6.0 * HOUR_S,
            leak_over_after_s: 24.0 * HOUR_S,
        }
    }
}

impl MonitorSettings {
    /// Check every value.
    ///
    /// # Errors
    /// Names the setting, its value and the bound.
    pub fn validate(&self) -> Result<(), DetectorError> {
        self.observer.validate()?;
        self.intake.validate()?;
        self.reaction.validate()?;
        self.alarms.validate()?;
        self.tails.as_ref().map_or(Ok(()), Tails::validate)?;
        for (setting, value) in [
            ("false_alarm_interval_s", self.false_alarm_interval_s),
            ("limits.operational_pa", self.limits.operational_pa),
            ("limits.coldest_k", self.limits.coldest_k),
            ("blind_after_s", self.blind_after_s),
            ("gap_s", self.gap_s),
            ("leak_over_after_s", self.leak_over_after_s),
        ] {
            positive(setting, value)?;
        }
        let Limits { maintenance_loss, .. } = self.limits;
        if !(maintenance_loss > 0.0 && maintenance_loss < 1.0) {
            let bound = "between 0 and 1";
            return Err(DetectorError::Setting {
                setting: "limits.maintenance_loss",
                value: maintenance_loss,
                bound,
            });
        }
        if !(self.learning_s >= 0.0 && self.learning_s.is_finite()) {
            let bound = "finite and at least 0";
            return Err(DetectorError::Setting { setting: "learning_s", value: self.learning_s, bound });
        }
        Ok(())
    }
}

//! What the monitor puts out with every sample. SI; an interval is one of 95 %.
use alloc::vec::Vec;
use cylwatch_estimator::observer::Estimate;
use serde::{Deserialize, Serialize};

use super::alarm::AlarmEvent;
use super::{Decision, Event};
use crate::prognosis::{Advice, Quantiles};

/// A value with its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Interval {
    /// Estimate.
    pub value: f64,
    /// Lower bound.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
}

impl Interval {
    /// The same times a factor.
    pub fn scaled(self, factor: f64) -> Self {
        let (a, b) = (self.low * factor, self.high * factor);
        Self { value: self.value * factor, low: a.min(b), high: a.max(b) }
    }

    /// Whether a value lies within.
    pub fn holds(&self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }
}

/// The leak that explains the masses of the last weeks best.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LeakFinding {
    /// Leak rate, kg/s.
    pub rate_kg_s: Interval,
    /// The same as loss of the pressure at 15 °C, Pa/s.
    pub rate_pa_s: Interval,
    /// When it began, s. An onset before all that is remembered has the oldest sample as its lower bound.
    pub onset_s: Interval,
    /// Mass lost since, kg.
    pub lost_kg: Interval,
}

/// How a sensor is doing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum Health {
    /// As it should.
    #[default]
    Good,
    /// No readings, for three rows or more.
    Missing,
    /// Readings outside what it can read, such as a broken wire.
    Implausible,
    /// Readings that stand still.
    Stuck,
    /// Single readings far off.
    Spikes,
    /// Its offset jumped by so much, K or Pa, and was taken into account.
    Shifted(f64),
    /// For half an hour it has been off by so much, K, while the other thermometer agrees with the pressure: warmed by itself, or shifted.
    Deviates(f64),
    /// It follows the air instead of the surface that it should sit on.
    Detached,
}

/// What is said after a sample.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Output {
    /// Time as the row was stamped, s; that of the estimate has no jumps of the clock in it.
    pub stamp_s: f64,
    /// The observer's estimate; in a leak with the mass of its freest member, since its own mass walks little and lags behind a
    /// slow leak by days.
    pub estimate: Estimate,
    /// What is decided: verdict, outcome, probability of a leak, reaction.
    pub decision: Decision,
    /// The leak, while there is one.
    pub leak: Option<LeakFinding>,
    /// Leak rate, kg/s: that of the leak that is found, else from 0 to what a leak is below with 97.5 %.
    pub leak_rate_kg_s: Interval,
    /// Raw pressure that the transmitter would show at the coldest temperature expected, Pa.
    pub cold_pressure_pa: f64,
    /// Health of each sensor, in the order of the readings.
    pub health: Vec<Health>,
    /// Time left and the reaction that is due; new with each day (hour, in a leak) and each change of the verdict.
    pub outlook: Option<Outlook>,
    /// What has happened at this sample.
    pub events: Vec<Event>,
    /// What has changed about the alarms at this sample.
    pub alarms: Vec<AlarmEvent>,
}

/// Time that is left and what to do.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outlook {
    /// Until the pressure at 15 °C is at the operational limit.
    pub operational: Quantiles,
    /// Until the raw pressure at the coldest temperature expected is at the operational limit.
    pub cold: Quantiles,
    /// Until the maintenance limit: loss of pressure, corrected for temperature.
    pub maintenance: Quantiles,
    /// What is due.
    pub advice: Advice,
    /// Whether anything is known of a leak; else what is due rests on limits that are reached alone.
    pub known: bool,
}

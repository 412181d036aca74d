//! The error against a threshold, with all that the paper asks for: brief violations ignored, noise filtered, the loss
//! in bar per hour, the time until the limit.
//!
//! `e = p_expected(T_gas) - p`; low-pass `y += (1 - exp(-dt/tau)) (e - y)`; the statistic is the smallest `y` of the last
//! `hold_s` ([`Sustained`](super::Sustained)), so an alarm at `statistic >= threshold` means that the threshold has been exceeded
//! for so long. Loss rate is the slope of `e` ([`Trend`](super::Trend)), time to the limit `(p - p_limit)/slope`.
//!
//! The paper says neither threshold nor times: 10 min and no filter are the defaults here, and a threshold comes from
//! [`crate::calibrate`].
use serde::{Deserialize, Serialize};

use super::{Expectation, Filling, GasModel, Law, PressureError, Reading, Sustained, Trend};
use crate::DetectorError;
use crate::statistic::Statistic;

/// What is done with the error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ThresholdSettings {
    /// Time constant of the low-pass, s; 0: none.
    pub low_pass_s: f64,
    /// How long the threshold must be exceeded, s.
    pub hold_s: f64,
    /// A gap longer than this starts that time anew, s; longer than the interval of the readings.
    pub longest_gap_s: f64,
    /// Memory of the slope, s: in white noise as precise as a straight line through 3.6 times as long.
    pub slope_memory_s: f64,
    /// The mean error of so much time from the first reading on is taken off, s; 0: none, as published. Until then there is no statistic.
    pub zero_s: f64,
}

impl Default for ThresholdSettings {
    /// No filter, 10 min of violation, gaps to an hour, slope as precise as over an hour, no zero.
    fn default() -> Self {
        Self { low_pass_s: 0.0, hold_s: 600.0, longest_gap_s: 3600.0, slope_memory_s: 1000.0, zero_s: 0.0 }
    }
}

impl ThresholdSettings {
    /// Every reading for itself.
    pub const AT_ONCE: Self =
        Self { low_pass_s: 0.0, hold_s: 0.0, longest_gap_s: 3600.0, slope_memory_s: 1000.0, zero_s: 0.0 };
}

/// What the error says about the loss.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Loss {
    /// Error, Pa, as read.
    pub error_pa: f64,
    /// Rate of loss, Pa/s; negative: pressure is gained.
    pub rate_pa_s: f64,
    /// Time until the limit at this rate, s; 0: already there, `None`: nothing is being lost.
    pub time_to_limit_s: Option<f64>,
}

/// A detector by threshold; the statistic is in Pa.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Threshold {
    error: PressureError,
    settings: ThresholdSettings,
    sustained: Sustained,
    trend: Trend,
    zero: Zero,
    last: Option<Last>,
    value: Option<f64>,
}

/// The last reading that had an error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Last {
    time_s: f64,
    pressure_pa: f64,
    error_pa: f64,
    filtered_pa: f64,
}

/// Mean error while the zero is being learnt.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Zero {
    start_s: Option<f64>,
    count: u64,
    mean_pa: f64,
}

impl Threshold {
    /// Of any error.
    ///
    /// # Errors
    /// A setting is out of its bounds.
    pub fn try_new(error: PressureError, settings: ThresholdSettings) -> Result<Self, DetectorError> {
        for (setting, value) in [("low_pass_s", settings.low_pass_s), ("zero_s", settings.zero_s)] {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(DetectorError::Setting { setting, value, bound: "finite and not negative" });
            }
        }
        Ok(Self {
            error,
            settings,
            sustained: Sustained::try_new(settings.hold_s, settings.longest_gap_s)?,
            trend: Trend::try_new(settings.slope_memory_s)?,
            zero: Zero::default(),
            last: None,
            value: None,
        })
    }

    /// The paper's detector: published function of the shoulder, published slope of the pressure, default settings.
    ///
    /// # Errors
    /// The filling is not positive.
    pub fn published(filling: Filling) -> Result<Self, DetectorError> {
        Self::try_new(PressureError::published(filling)?, ThresholdSettings::default())
    }

    /// A pressure switch: `limit - p`, every reading for itself; its threshold is 0.
    ///
    /// # Errors
    /// The limit is not positive.
    pub fn raw_switch(limit_pa: f64) -> Result<Self, DetectorError> {
        // The law is constant: any temperature does.
        let filling = Filling { pressure_pa: limit_pa, temperature_k: 288.15 };
        let expectation = Expectation::try_new(Law::Constant, filling)?;
        Self::try_new(PressureError::try_new(expectation, GasModel::Shoulder)?, ThresholdSettings::AT_ONCE)
    }

    /// Pressure over temperature as of an ideal gas, at the shoulder's temperature, default settings.
    ///
    /// # Errors
    /// The filling is not positive.
    pub fn ideal_gas(filling: Filling) -> Result<Self, DetectorError> {
        let expectation = Expectation::try_new(Law::IdealGas, filling)?;
        Self::try_new(PressureError::try_new(expectation, GasModel::Shoulder)?, ThresholdSettings::default())
    }

    /// What the error says about the loss; `None` before the second error.
    pub fn loss(&self, limit_pa: f64) -> Option<Loss> {
        let last = self.last?;
        let rate_pa_s = self.trend.slope()?;
        let above_pa = last.pressure_pa - limit_pa;
        let time_to_limit_s = match rate_pa_s {
            _ if above_pa <= 0.0 => Some(0.0),
            rate if rate > 0.0 => Some(above_pa / rate),
            _ => None,
        };
        Some(Loss { error_pa: last.error_pa, rate_pa_s, time_to_limit_s })
    }

    /// Take an error in; its filtered value less the zero, `None` while the zero is learnt.
    fn filter(&mut self, reading: Reading, error_pa: f64) -> Option<f64> {
        let Reading { time_s, pressure_pa, .. } = reading;
        let filtered_pa = match self.last {
            Some(last) if self.settings.low_pass_s > 0.0 => {
                let gained = -(-(time_s - last.time_s) / self.settings.low_pass_s).exp_m1();
                last.filtered_pa + gained * (error_pa - last.filtered_pa)
            }
            _ => error_pa,
        };
        self.last = Some(Last { time_s, pressure_pa, error_pa, filtered_pa });
        self.trend.update(time_s, error_pa);
        if self.settings.zero_s > 0.0 {
            let start_s = *self.zero.start_s.get_or_insert(time_s);
            if time_s - start_s < self.settings.zero_s {
                self.zero.count += 1;
                self.zero.mean_pa += (error_pa - self.zero.mean_pa) / self.zero.count as f64;
                return None;
            }
        }
        Some(filtered_pa - self.zero.mean_pa)
    }
}

impl Statistic for Threshold {
    type Sample = Reading;

    fn update(&mut self, reading: Reading) -> f64 {
        let error_pa = self.error.step(reading);
        if let Some(filtered_pa) = error_pa.and_then(|error_pa| self.filter(reading, error_pa)) {
            self.value = self.sustained.update(reading.time_s, filtered_pa);
        }
        self.value()
    }

    /// Minus infinity as long as the holding time has not passed.
    fn value(&self) -> f64 {
        self.value.unwrap_or(f64::NEG_INFINITY)
    }

    fn reset(&mut self) {
        self.error.reset();
        self.sustained.reset();
        self.trend.reset();
        self.zero = Zero::default();
        self.last = None;
        self.value = None;
    }
}

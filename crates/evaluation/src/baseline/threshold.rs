//! The error against a threshold, as the paper asks for: brief violations ignored, the loss in bar per hour, the time until the limit.
//!
//! The statistic is the smallest `e` of the holding time ([`Sustained`]), so an alarm at `statistic >= threshold` means
//! that the threshold has been exceeded for so long. Loss rate is the slope of `e` ([`Trend`]), time to the
//! limit `(p - p_limit)/slope`.
//!
//! The paper says neither threshold nor times: the holding time is 10 min here, and the threshold is found on cylinders without a leak.
use super::{Expectation, Filling, GasTemperature, PressureError, Reading, Sustained, Trend};

/// How long the threshold must be exceeded where nothing else is said, s.
pub const HOLD_S: f64 = 600.0;

/// What the error says about the loss.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loss {
    /// Error, Pa, as read.
    pub error_pa: f64,
    /// Rate of loss, Pa/s; negative: pressure is gained.
    pub rate_pa_s: f64,
    /// Time until the limit at this rate, s; 0: already there, `None`: nothing is being lost.
    pub time_to_limit_s: Option<f64>,
}

/// A detector by threshold; the statistic is in Pa.
#[derive(Clone, Debug)]
pub struct Threshold {
    error: PressureError,
    zero_s: f64,
    sustained: Sustained,
    trend: Trend,
    zero: Zero,
    last: Option<Last>,
    value: f64,
}

/// The last reading that had an error.
#[derive(Clone, Copy, Debug)]
struct Last {
    pressure_pa: f64,
    error_pa: f64,
}

/// Mean error while the zero is being learnt.
#[derive(Clone, Copy, Debug, Default)]
struct Zero {
    start_s: Option<f64>,
    count: u64,
    mean_pa: f64,
}

impl Threshold {
    /// Of any error, to be exceeded for [`HOLD_S`].
    pub fn new(error: PressureError) -> Self {
        Self {
            error,
            zero_s: 0.0,
            sustained: Sustained::new(HOLD_S),
            trend: Trend::default(),
            zero: Zero::default(),
            last: None,
            value: f64::NEG_INFINITY,
        }
    }

    /// To be exceeded for another time, s; 0: by a single reading. To be set before the first one.
    pub fn held_for(self, hold_s: f64) -> Self {
        Self { sustained: Sustained::new(hold_s), ..self }
    }

    /// The mean error of so much time, s, from the first reading on is taken off. Until then there is no statistic.
    pub fn zeroed_over(self, zero_s: f64) -> Self {
        Self { zero_s, ..self }
    }

    /// The paper's detector: published function of the shoulder, published slope of the pressure.
    pub fn published(filling: Filling) -> Self {
        Self::new(PressureError::published(filling))
    }

    /// A pressure switch: `limit - p`, every reading for itself; its threshold is 0.
    pub fn raw_switch(limit_pa: f64) -> Self {
        let error = PressureError::new(Expectation::Constant(limit_pa), GasTemperature::SHOULDER);
        Self::new(error).held_for(0.0)
    }

    /// Pressure over temperature as of an ideal gas, at the shoulder's temperature.
    pub fn ideal_gas(filling: Filling) -> Self {
        Self::new(PressureError::new(Expectation::IdealGas(filling), GasTemperature::SHOULDER))
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

    /// Take a reading; the statistic after it, minus infinity as long as the holding time has not passed.
    pub fn update(&mut self, reading: Reading) -> f64 {
        let error_pa = self.error.step(reading);
        if let Some(error_pa) = error_pa.and_then(|error_pa| self.above_zero(reading, error_pa)) {
            self.value = self.sustained.update(reading.time_s, error_pa).unwrap_or(f64::NEG_INFINITY);
        }
        self.value
    }

    /// Take an error in; what it is above the zero, `None` while that is learnt.
    fn above_zero(&mut self, reading: Reading, error_pa: f64) -> Option<f64> {
        let Reading { time_s, pressure_pa, .. } = reading;
        self.last = Some(Last { pressure_pa, error_pa });
        self.trend.update(time_s, error_pa);
        if self.zero_s > 0.0 {
            let start_s = *self.zero.start_s.get_or_insert(time_s);
            if time_s - start_s < self.zero_s {
                self.zero.count += 1;
                self.zero.mean_pa += (error_pa - self.zero.mean_pa) / self.zero.count as f64;
                return None;
            }
        }
        Some(error_pa - self.zero.mean_pa)
    }
}

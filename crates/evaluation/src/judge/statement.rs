//! What a candidate says after a row.
use crate::detector::monitor::Interval;
use crate::detector::prognosis::Reaction;

use super::measures::Class;

/// Half width of a 95 % interval in standard deviations.
pub(crate) const BAND_95: f64 = 1.959_963_984_540_054;

/// All that a candidate says. What it does not know it leaves out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Statement {
    /// Stamp of the row that it is about, s: a candidate may hold rows back.
    pub stamp_s: f64,
    /// What it decides; `None`: it decides nothing, and is judged as an estimator.
    pub decision: Option<Decision>,
    /// What it estimates.
    pub estimates: Estimates,
    /// Innovation of the pressure; `None`: no reading, or it has none.
    pub innovation: Option<Innovation>,
    /// Mass as free of a leak hypothesis as it has, kg: what it does without a leak is the noise behind the shortest delay.
    pub free_mass_kg: Option<f64>,
    /// Value of a detector without a verdict of its own, which alarms from a threshold on; minus infinity: it cannot tell yet.
    pub statistic: Option<f64>,
}

/// What is decided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decision {
    /// Verdict.
    pub class: Class,
    /// Whether a leak is stated.
    pub leak: bool,
    /// Whether it is said that gas is being lost, whatever it is called: what raises the leak alarm.
    pub loss: bool,
    /// Probability of a leak; `None`: not known.
    pub leak_probability: Option<f64>,
    /// Whether the alarm for a leak is active; `None`: it has no alarms.
    pub alarm: Option<bool>,
    /// Reaction that is due; `None`: it has none, or not yet.
    pub reaction: Option<Reaction>,
    /// Exit code if the log ended here: 0 tight, 1 gas is or was being lost, 3 inconclusive.
    pub exit_code: u8,
    /// Whether a sensor is said to be at fault.
    pub sensor_named: bool,
    /// Whether an exchange of gas is said, by the verdict or by an event.
    pub exchange: bool,
}

impl Decision {
    /// Whether a leak is said, by verdict or by finding.
    pub(crate) fn says_leak(&self) -> bool {
        self.leak || self.class == Class::Leak
    }
}

/// What is estimated, in the volume that the vessel file states; intervals of 95 %.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimates {
    /// Gas mass, kg.
    pub mass_kg: Option<Estimated>,
    /// Mean gas temperature, K.
    pub gas_mean_k: Option<Estimated>,
    /// Mass flow out, kg/s.
    pub leak_kg_s: Option<Estimated>,
    /// Onset of the leak by the log's clock, s; `None`: no leak is stated.
    pub onset_s: Option<Estimated>,
}

/// A quantity as it is stated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimated {
    /// The value.
    pub value: f64,
    /// Its 95 % interval; `None`: none is stated.
    pub interval: Option<(f64, f64)>,
}

impl From<Interval> for Estimated {
    fn from(interval: Interval) -> Self {
        Self { value: interval.value, interval: Some((interval.low, interval.high)) }
    }
}

/// Innovation of a reading, before its gate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Innovation {
    /// Reading minus prediction.
    pub nu: f64,
    /// Its predicted variance.
    pub s: f64,
}

/// A value with a normal interval.
pub(crate) fn normal(value: f64, sd: f64) -> Estimated {
    let half = BAND_95 * sd;
    Estimated { value, interval: sd.is_finite().then_some((value - half, value + half)) }
}

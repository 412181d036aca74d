//! What a statistic reached for the first time, and when.
use serde::{Deserialize, Serialize};

/// A value above all before it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Highest {
    /// When, s.
    pub time_s: f64,
    /// The value.
    pub value: f64,
}

/// The rising record of a statistic over one cylinder: enough for the first alarm at any threshold.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Trace {
    highest: Vec<Highest>,
}

impl Trace {
    /// Take a value.
    pub(crate) fn push(&mut self, time_s: f64, value: f64) {
        if value > self.most() {
            self.highest.push(Highest { time_s, value });
        }
    }

    /// The largest value; minus infinity without any.
    pub(crate) fn most(&self) -> f64 {
        self.highest.last().map_or(f64::NEG_INFINITY, |highest| highest.value)
    }

    /// First time at which a threshold was reached.
    pub(crate) fn alarm(&self, threshold: f64) -> Option<&Highest> {
        self.highest.get(self.highest.partition_point(|highest| highest.value < threshold))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_record_tells_the_first_alarm_of_every_threshold() {
        let values = [0.0, 2.0, 1.0, 2.0, 5.0, f64::NAN, 4.0];
        let mut trace = Trace::default();
        for (n, value) in values.into_iter().enumerate() {
            trace.push(n as f64, value);
        }
        let first = |threshold: f64| trace.alarm(threshold).map(|highest| highest.time_s);
        assert_eq!(
            [-1.0, 0.5, 2.0, 2.1, 5.0, 5.1].map(first),
            [Some(0.0), Some(1.0), Some(1.0), Some(4.0), Some(4.0), None]
        );
        assert_eq!((trace.most(), Trace::default().most()), (5.0, f64::NEG_INFINITY));
    }
}

//! What is done with a statistic: compare it with a threshold, and say what follows an alarm.
use serde::{Deserialize, Serialize};

use super::Statistic;
use crate::DetectorError;

/// What becomes of the statistic when it alarms.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum AfterAlarm {
    /// It starts anew: each alarm is one event, as the mean time between alarms counts them.
    #[default]
    Restart,
    /// It goes on; the alarm lasts as long as it is above the threshold.
    Continue,
    /// It goes on; the alarm lasts until it is acknowledged.
    Latch,
}

/// What a threshold says about one value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Judgement {
    /// There is an alarm.
    pub active: bool,
    /// It began with this value.
    pub raised: bool,
}

/// Threshold and memory of an alarm.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Alarm {
    threshold: f64,
    after: AfterAlarm,
    active: bool,
    alarms: u64,
}

impl Alarm {
    /// Alarm at `value >= threshold`.
    ///
    /// # Errors
    /// `threshold` is not finite.
    pub fn try_new(threshold: f64, after: AfterAlarm) -> Result<Self, DetectorError> {
        if !threshold.is_finite() {
            return Err(DetectorError::Setting { setting: "threshold", value: threshold, bound: "finite" });
        }
        Ok(Self { threshold, after, active: false, alarms: 0 })
    }

    /// Judge the next value of the statistic.
    pub fn judge(&mut self, value: f64) -> Judgement {
        let above = value >= self.threshold;
        let raised = above && !self.active;
        self.alarms += u64::from(raised);
        let active = above || (self.active && self.after == AfterAlarm::Latch);
        // A restarted statistic is below its threshold again: its next alarm is a new one.
        self.active = active && self.after != AfterAlarm::Restart;
        Judgement { active, raised }
    }

    /// End a latched alarm.
    pub fn acknowledge(&mut self) {
        self.active = false;
    }

    /// Number of alarms so far.
    pub fn alarms(&self) -> u64 {
        self.alarms
    }

    /// The threshold.
    pub fn threshold(&self) -> f64 {
        self.threshold
    }
}

/// A statistic under an alarm.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Watch<S> {
    /// The statistic.
    pub statistic: S,
    /// Its alarm.
    pub alarm: Alarm,
}

impl<S: Statistic> Watch<S> {
    /// The statistic under the alarm.
    pub fn new(statistic: S, alarm: Alarm) -> Self {
        Self { statistic, alarm }
    }

    /// Take a sample; with [`AfterAlarm::Restart`] the statistic starts anew after an alarm.
    pub fn update(&mut self, sample: S::Sample) -> Judgement {
        let judgement = self.alarm.judge(self.statistic.update(sample));
        if judgement.raised && self.alarm.after == AfterAlarm::Restart {
            self.statistic.reset();
        }
        judgement
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistic::{Shewhart, Side};

    fn course(after: AfterAlarm) -> (Vec<bool>, Vec<bool>, u64) {
        let mut watch = Watch::new(Shewhart::new(Side::Above), Alarm::try_new(2.0, after).unwrap());
        let judged: Vec<Judgement> = [1.0, 2.0, 3.0, 1.0, 2.5].map(|value| watch.update(value)).to_vec();
        let active = judged.iter().map(|judgement| judgement.active).collect();
        (active, judged.iter().map(|judgement| judgement.raised).collect(), watch.alarm.alarms())
    }

    #[test]
    fn policies_differ_in_what_follows_an_alarm() {
        let (t, f) = (true, false);
        assert_eq!(course(AfterAlarm::Restart), (vec![f, t, t, f, t], vec![f, t, t, f, t], 3));
        assert_eq!(course(AfterAlarm::Continue), (vec![f, t, t, f, t], vec![f, t, f, f, t], 2));
        assert_eq!(course(AfterAlarm::Latch), (vec![f, t, t, t, t], vec![f, t, f, f, f], 1));
    }
}

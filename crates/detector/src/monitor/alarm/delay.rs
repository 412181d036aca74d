//! A signal that must last before it counts.
use serde::{Deserialize, Serialize};

use super::Timing;

/// A signal behind an on-delay and an off-delay.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Delayed {
    /// What has lasted long enough.
    pub on: bool,
    /// How long the signal has been seen to contradict it, s.
    pub served_s: Option<f64>,
}

impl Delayed {
    /// After a sample `step_s` after the last one; `None` is a signal that is unknown.
    pub(crate) fn step(self, step_s: f64, signal: Option<bool>, timing: &Timing) -> Self {
        match signal {
            Some(signal) if signal == self.on => Self { served_s: None, ..self },
            Some(signal) => {
                let counted_s = step_s.clamp(0.0, timing.longest_step_s);
                let served_s = self.served_s.map_or(0.0, |served_s| served_s + counted_s);
                let delay_s = if signal { timing.on_delay_s } else { timing.off_delay_s };
                if served_s >= delay_s {
                    Self { on: signal, served_s: None }
                } else {
                    Self { served_s: Some(served_s), ..self }
                }
            }
            None if self.on => Self { served_s: None, ..self },
            None => self,
        }
    }
}

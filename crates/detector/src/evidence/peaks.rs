//! The largest statistics of leak-free operation, stretch by stretch: what thresholds are learnt from.
use serde::{Deserialize, Serialize};

use super::{Scale, Statistics};

/// Largest value of each stretch of operation, scale by scale. A stretch is as long as the statistic remembers
/// ([`Scale::memory_s`]), so that an excursion counts once, or twice where it crosses from one stretch to the next.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Peaks {
    /// Largest values of whole stretches.
    largest: [Vec<f64>; Scale::ALL.len()],
    /// Number and largest value of the stretch that is not over.
    running: [Option<(u64, f64)>; Scale::ALL.len()],
    first_s: Option<f64>,
}

impl Peaks {
    /// Take the statistics of a sample.
    pub fn update(&mut self, time_s: f64, statistics: &Statistics) {
        let since_s = time_s - *self.first_s.get_or_insert(time_s);
        for (index, scale) in Scale::ALL.into_iter().enumerate() {
            let stretch = (since_s / scale.memory_s()) as u64;
            let value = statistics[index];
            self.running[index] = Some(match self.running[index] {
                Some((number, largest)) if number == stretch => (number, largest.max(value)),
                Some((_, largest)) => {
                    self.largest[index].push(largest);
                    (stretch, value)
                }
                None => (stretch, value),
            });
        }
    }

    /// What was kept elsewhere: largest values of whole stretches, in the order of [`Scale::ALL`].
    pub fn from_largest(largest: [Vec<f64>; Scale::ALL.len()]) -> Self {
        Self { largest, ..Self::default() }
    }

    /// Largest values of the whole stretches of a scale.
    pub fn of(&self, scale: Scale) -> &[f64] {
        &self.largest[scale as usize]
    }
}

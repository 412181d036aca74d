//! The masses of the last weeks in bounded memory: fine lately, coarse long ago.
//!
//! Masses are averaged over bins of ten minutes; bins older than two days are merged into hours, hours older than sixty days fall out.
use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

/// Length of a fresh bin, s.
pub(in crate::monitor) const FINE_S: f64 = 600.0;
/// Fresh bins that make an old one.
const PER_COARSE: usize = 6;
/// Fresh bins kept, and old ones.
const FINE_BINS: usize = 288;
const COARSE_BINS: usize = 1440;

/// Mean mass over a bin.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bin {
    /// Mean time of its samples, s.
    pub time_s: f64,
    /// Mean mass, kg.
    pub mass_kg: f64,
    /// Number of samples.
    pub samples: u32,
}

/// Masses over time since gas was last exchanged.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MassTrace {
    coarse: VecDeque<Bin>,
    fine: VecDeque<Bin>,
    open: Option<Bin>,
    opened_s: f64,
}

impl MassTrace {
    /// Take in a mass, kg, at a time, s, not before the last one; whether a bin was completed.
    pub fn push(&mut self, time_s: f64, mass_kg: f64) -> bool {
        if !(time_s.is_finite() && mass_kg.is_finite()) {
            return false;
        }
        let completed = self.open.filter(|_| time_s - self.opened_s >= FINE_S);
        match (&mut self.open, completed) {
            (Some(bin), None) => bin.add(time_s, mass_kg),
            (open, _) => {
                *open = Some(Bin { time_s, mass_kg, samples: 1 });
                self.opened_s = time_s;
            }
        }
        if let Some(bin) = completed {
            self.fine.push_back(bin);
            self.thin_out();
        }
        completed.is_some()
    }

    fn thin_out(&mut self) {
        if self.fine.len() < FINE_BINS + PER_COARSE {
            return;
        }
        let mut merged = Bin { time_s: 0.0, mass_kg: 0.0, samples: 0 };
        self.fine.drain(..PER_COARSE).for_each(|bin| merged.merge(&bin));
        self.coarse.push_back(merged);
        if self.coarse.len() > COARSE_BINS {
            self.coarse.pop_front();
        }
    }

    /// The bins, oldest first, with the one that is being filled.
    pub fn bins(&self) -> impl Iterator<Item = &Bin> {
        self.coarse.iter().chain(&self.fine).chain(&self.open)
    }

    /// Time of the oldest bin, s.
    pub fn oldest_s(&self) -> Option<f64> {
        self.bins().next().map(|bin| bin.time_s)
    }

    /// Forget all masses: other gas is in the cylinder.
    pub fn clear(&mut self) {
        *self = Self::default();
    }
}

impl Bin {
    fn add(&mut self, time_s: f64, mass_kg: f64) {
        self.merge(&Self { time_s, mass_kg, samples: 1 });
    }

    fn merge(&mut self, other: &Self) {
        self.samples += other.samples;
        let share = f64::from(other.samples) / f64::from(self.samples);
        self.time_s += share * (other.time_s - self.time_s);
        self.mass_kg += share * (other.mass_kg - self.mass_kg);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn a_year_of_minutes_stays_small_and_keeps_the_mass_of_a_straight_line() {
        let mut trace = MassTrace::default();
        let mass = |time_s: f64| 4.5 - 1e-9 * time_s;
        for minute in 0..525_600 {
            let time_s = 60.0 * f64::from(minute);
            trace.push(time_s, mass(time_s));
        }
        let bins: Vec<&Bin> = trace.bins().collect();
        assert!(bins.len() <= FINE_BINS + PER_COARSE + COARSE_BINS + 1, "{}", bins.len());
        for bin in &bins {
            assert_relative_eq!(bin.mass_kg, mass(bin.time_s), max_relative = 1e-12);
        }
        assert!(bins.windows(2).all(|pair| pair[0].time_s < pair[1].time_s));
        let span_d = (bins[bins.len() - 1].time_s - bins[0].time_s) / 86_400.0;
        assert!((61.0..63.0).contains(&span_d), "{span_d} d");
    }

    #[test]
    fn a_gap_ends_a_bin_and_numbers_that_are_none_are_left_out() {
        let mut trace = MassTrace::default();
        assert!(!trace.push(0.0, 4.5) && !trace.push(60.0, f64::NAN) && !trace.push(60.0, 4.3));
        assert!(trace.push(86_400.0, 4.0));
        let bins: Vec<Bin> = trace.bins().copied().collect();
        assert_eq!(bins.len(), 2);
        assert_relative_eq!(bins[0].mass_kg, 4.4, max_relative = 1e-12);
        assert_eq!((bins[0].time_s, bins[0].samples, bins[1].samples), (30.0, 2, 1));
    }
}

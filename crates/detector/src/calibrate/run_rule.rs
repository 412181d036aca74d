//! Run length of Shewhart's chart with a run rule, exactly.
//!
//! A sample exceeds the limit with probability `q`. `m` in a row: `a = (1 - q^m)/(q^m (1 - q))`. `m` of `n`: the chain
//! of which of the last `n - 1` samples exceeded it.
//!
//! Assumes independent samples; exceedances of correlated ones come in clusters.
//!
//! Source: W. Feller, An Introduction to Probability Theory, vol. 1, 1968, section XIII.7; C. W. Champ and W. H. Woodall,
//! Technometrics 29 (1987) 393.
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use super::normal_probability;
use super::solve::threshold_for;
use crate::DetectorError;
use crate::statistic::Side;

/// Longest span of the general rule: its chain has `2^(of - 1)` states.
const LONGEST_SPAN: usize = 10;

/// A limit that `count` of the last `of` samples must exceed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunRule {
    /// Limit, standard deviations.
    pub threshold: f64,
    /// Which exceedances count.
    pub side: Side,
    /// How many must exceed it.
    pub count: usize,
    /// Among how many.
    pub of: usize,
}

impl RunRule {
    /// The rule with so many samples between false alarms on average.
    ///
    /// # Errors
    /// `count` is not between 1 and `of`, `of` is above 10 with another `count`, or the run length is out of reach.
    pub fn for_arl(side: Side, count: usize, of: usize, arl: f64) -> Result<Self, DetectorError> {
        if count == 0 || count > of {
            let value = count as f64;
            return Err(DetectorError::Setting { setting: "count", value, bound: "between 1 and `of`" });
        }
        if count != of && of > LONGEST_SPAN {
            let bound = "at most 10, unless all must exceed the limit";
            return Err(DetectorError::Setting { setting: "of", value: of as f64, bound });
        }
        let rule = |threshold: f64| Self { threshold, side, count, of };
        let lowest = if side == Side::Both { 1e-6 } else { -8.0 };
        let threshold = threshold_for(arl, lowest, 8.0, |threshold| rule(threshold).arl(0.0))?;
        Ok(rule(threshold))
    }

    /// Mean number of samples to an alarm when all have the mean `mean`, in standard deviations.
    pub fn arl(&self, mean: f64) -> f64 {
        let (above, below) =
            (normal_probability(mean - self.threshold), normal_probability(-mean - self.threshold));
        self.arl_of_exceedances(match self.side {
            Side::Above => above,
            Side::Below => below,
            Side::Both => above + below,
        })
    }

    /// Mean number of samples to an alarm when each exceeds the limit with probability `q`.
    pub fn arl_of_exceedances(&self, q: f64) -> f64 {
        if q >= 1.0 {
            return self.count as f64;
        }
        if self.count == self.of {
            let in_a_row = q.powi(self.count as i32);
            return (1.0 - in_a_row) / (in_a_row * (1.0 - q));
        }
        let states = 1_usize << (self.of - 1);
        let mut system = DMatrix::identity(states, states);
        for state in 0..states {
            // Bits are exceedances, the newest lowest; the sample that leaves the span is masked away.
            system[(state, (state << 1) & (states - 1))] -= 1.0 - q;
            if state.count_ones() as usize + 1 < self.count {
                system[(state, ((state << 1) | 1) & (states - 1))] -= q;
            }
        }
        let lengths = system.lu().solve(&DVector::from_element(states, 1.0));
        lengths.map_or(f64::INFINITY, |lengths| lengths[0])
    }
}

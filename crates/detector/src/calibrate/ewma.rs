//! Run length of the exponentially weighted moving average, exactly.
//!
//! With asymptotic limits, `z` between `-c` and `c` (or below `c`), `c = L sqrt(w/(2 - w))`:
//! `a(z) = 1 + int a(y) phi[(y - (1 - w) z)/w - mu]/w dy`. With exact limits the bounds `c_n` widen from sample to sample:
//! the same equation, carried backwards from the time when they have settled to the first sample.
//!
//! Assumes independent normal samples of unit variance at even intervals.
//!
//! Source: S. V. Crowder, Technometrics 29 (1987) 401; S. H. Steiner, J. Qual. Technol. 31 (1999) 75.
use serde::{Deserialize, Serialize};

use super::normal_density;
use super::quadrature::{Node, RunLength, enough_nodes, gauss_legendre, one_sample};
use super::solve::threshold_for;
use crate::DetectorError;
use crate::statistic::{EwmaLimits, Side};

/// How far down a one-sided average is followed, in its standard deviations.
const DEEPEST: f64 = 9.0;
/// Relative distance to the asymptotic variance at which the limits have settled.
const SETTLED: f64 = 1e-8;

/// A moving average with its threshold.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct EwmaChart {
    /// Weight of the newest sample.
    pub weight: f64,
    /// Threshold `L`, in standard deviations of the average.
    pub threshold: f64,
    /// Which changes count.
    pub side: Side,
    /// What the average is divided by.
    pub limits: EwmaLimits,
}

impl EwmaChart {
    /// The chart with so many samples between false alarms on average.
    ///
    /// # Errors
    /// The weight is not above 0 and at most 1, or the run length out of reach.
    pub fn for_arl(weight: f64, side: Side, limits: EwmaLimits, arl: f64) -> Result<Self, DetectorError> {
        if !(weight > 0.0 && weight <= 1.0) {
            let bound = "above 0 and at most 1";
            return Err(DetectorError::Setting { setting: "weight", value: weight, bound });
        }
        let chart = |threshold: f64| Self { weight, threshold, side, limits };
        let threshold = threshold_for(arl, 0.05, 7.5, |threshold| chart(threshold).arl(0.0))?;
        Ok(chart(threshold))
    }

    /// Mean number of samples to an alarm when all have the mean `mean`, in standard deviations.
    pub fn arl(&self, mean: f64) -> f64 {
        let mean = if self.side == Side::Below { -mean } else { mean };
        let kept = 1.0 - self.weight;
        let settled = (self.weight / (2.0 - self.weight)).sqrt();
        let kernel = |z: f64, y: f64| normal_density((y - kept * z) / self.weight - mean) / self.weight;
        let run = RunLength::solve(self.nodes(settled), kernel, (0.0, |_| 0.0), one_sample);
        if self.limits == EwmaLimits::Asymptotic || kept == 0.0 {
            return run.starting_at(0.0);
        }
        // Run lengths at the nodes of sample n, from the settled ones back to the first sample.
        let samples = (0.5 * SETTLED.ln() / kept.ln()).ceil() as i32;
        let sd = |n: i32| settled * (1.0 - kept.powi(2 * n)).sqrt();
        let mut next = self.nodes(sd(samples));
        let mut lengths: Vec<f64> = next.iter().map(|node| run.starting_at(node.x)).collect();
        let one_more = |z: f64, next: &[Node], lengths: &[f64]| {
            let on = next.iter().zip(lengths).map(|(node, length)| node.weight * kernel(z, node.x) * length);
            1.0 + on.sum::<f64>()
        };
        for n in (1..samples).rev() {
            let now = self.nodes(sd(n));
            lengths = now.iter().map(|node| one_more(node.x, &next, &lengths)).collect();
            next = now;
        }
        one_more(0.0, &next, &lengths)
    }

    /// Nodes between the limits of an average of standard deviation `sd`.
    fn nodes(&self, sd: f64) -> Vec<Node> {
        let high = self.threshold * sd;
        let low = if self.side == Side::Both { -high } else { -DEEPEST * sd };
        gauss_legendre(enough_nodes(high - low, self.weight), low, high)
    }
}

//! Generalised likelihood ratio of a step or a ramp of unknown size and onset.
//!
//! Residuals are `e(t) = theta s(t; nu) + noise`, with `s = 1` (step) or `s = t - nu` (ramp) from the onset `nu` on. After
//! whitening ([`super::Whitener`]) the signature of onset `nu` is `g_n = (s_n - phi_n s_{n-1})/sd(w_n)`, and with
//! `A = sum g^2`, `B = sum g w`:
//!
//! `theta = B/A`, `Var theta = 1/A` for known onset, `log-likelihood ratio = B^2/(2A)`, maximised over the onsets.
//!
//! Onset and size of a ramp are refined together by one Gauss-Newton step from the best grid point: with
//! `c = dg/dnu`, `C = sum g c`, `D = sum c^2`, `E = sum c w`, `[[A, C], [C, D]] (theta, theta dnu)' = (B, E)'`,
//! `Var theta = 1/(A - C^2/D)` and `Var nu = 1/(theta^2 (D - C^2/A))`. The onset of a step is not a regular parameter:
//! its uncertainty is the set of onsets that explain the data nearly as well ([`Glr::onsets_within`]).
//!
//! Onsets lie on a grid that thins out with age ([`OnsetGrid`]): a hypothesis costs two sums for a step and five for a ramp, a sample `O(log window)`.
//! A ramp begins at a sample, a step just before one.
//!
//! Assumes Gaussian noise, white or Ornstein-Uhlenbeck, of known parameters, and a known mean before the change.
//!
//! Source: D. Siegmund and E. S. Venkatraman, Ann. Stat. 23 (1995) 255; window: T. L. Lai, IEEE Trans. Inf. Theory
//! 44 (1998) 2917, which is asymptotically optimal for windows longer than `ln(ARL)/I` samples of information `I`.
mod grid;
mod hypothesis;
#[cfg(test)]
mod tests;

use serde::{Deserialize, Serialize};

use self::hypothesis::Onset;
use super::{Noise, Residual, Side, Statistic, Whitener};
use crate::DetectorError;

pub use grid::{OnsetGrid, OnsetHypothesis};

/// Course of the mean after the onset.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Shape {
    /// A constant; its size has the unit of the residual.
    Step,
    /// Proportional to the time since the onset; its size is a rate, in the unit of the residual per second.
    Ramp,
}

/// What is looked for, in which noise, how far back and how finely.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct GlrSettings {
    /// Course of the change.
    pub shape: Shape,
    /// Sign of the change.
    pub side: Side,
    /// Noise of the residuals.
    pub noise: Noise,
    /// Oldest onset that must still be considered, in samples; up to about twice as old ones are.
    pub window: usize,
    /// Onsets kept per doubling of age; see [`OnsetGrid`] for what a coarse grid loses.
    pub per_octave: usize,
}

impl GlrSettings {
    /// Either sign, a window of 4096 samples, 8 onsets per doubling of age.
    pub fn new(shape: Shape, noise: Noise) -> Self {
        Self { shape, side: Side::Both, noise, window: 4096, per_octave: 8 }
    }

    fn validate(&self) -> Result<(), DetectorError> {
        self.noise.validate()?;
        if self.window == 0 {
            return Err(DetectorError::Setting { setting: "window", value: 0.0, bound: "at least 1 sample" });
        }
        if !(2..=4096).contains(&self.per_octave) {
            let value = self.per_octave as f64;
            return Err(DetectorError::Setting { setting: "per_octave", value, bound: "2 to 4096" });
        }
        Ok(())
    }
}

/// The change that explains the residuals best.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Finding {
    /// Onset on the grid, s: for a step the first sample after it.
    pub onset_s: f64,
    /// Size: the step in the unit of the residual, the ramp in that unit per second.
    pub size: f64,
    /// Standard deviation of the size, if the onset were known.
    pub size_sd: f64,
    /// Onset and size estimated together; of a ramp of more than one sample only.
    pub refined: Option<Refined>,
    /// Logarithm of the likelihood ratio against no change.
    pub log_likelihood_ratio: f64,
}

/// Onset and size of a ramp, estimated together, off the grid.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Refined {
    /// Onset, s.
    pub onset_s: f64,
    /// Its standard deviation, s.
    pub onset_sd_s: f64,
    /// Rate, in the unit of the residual per second.
    pub size: f64,
    /// Its standard deviation, that of the onset included.
    pub size_sd: f64,
}

/// Window-limited generalised likelihood ratio; the statistic is the maximal log-likelihood ratio.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Glr {
    settings: GlrSettings,
    whitener: Whitener,
    onsets: OnsetGrid<Onset>,
    value: f64,
}

impl Glr {
    /// No samples yet.
    ///
    /// # Errors
    /// A setting is out of its bounds.
    pub fn try_new(settings: GlrSettings) -> Result<Self, DetectorError> {
        settings.validate()?;
        let onsets = OnsetGrid::new(settings.window, settings.per_octave);
        Ok(Self { settings, whitener: Whitener::try_new(settings.noise)?, onsets, value: 0.0 })
    }

    /// The settings it was built with.
    pub fn settings(&self) -> &GlrSettings {
        &self.settings
    }

    /// The most likely change on the grid; `None` as long as nothing speaks for one.
    pub fn finding(&self) -> Option<Finding> {
        let best = self.onsets.best()?;
        (best.log_likelihood_ratio > 0.0).then(|| best.finding(self.settings.shape))
    }

    /// Oldest and newest onset whose log-likelihood ratio is within `drop` of the largest, one grid point wider to
    /// either side. Half the quantile of chi-square with one degree of freedom (1.92 for 95 %) gives a confidence
    /// interval of the onset of a ramp and, in large samples, of a step many standard deviations high.
    pub fn onsets_within(&self, drop: f64) -> Option<(f64, f64)> {
        let limit = self.finding()?.log_likelihood_ratio - drop;
        let mut bounds = None;
        let mut before = None;
        let mut inside_before = false;
        for onset in self.onsets.iter() {
            let inside = onset.log_likelihood_ratio >= limit;
            if inside || inside_before {
                let oldest = bounds.map_or(before.unwrap_or(onset.onset_s), |(oldest, _)| oldest);
                bounds = Some((oldest, onset.onset_s));
            }
            inside_before = inside;
            before = Some(onset.onset_s);
        }
        bounds
    }

    /// Number of onsets considered now.
    pub fn hypotheses(&self) -> usize {
        self.onsets.iter().count()
    }
}

impl Statistic for Glr {
    type Sample = Residual;

    fn update(&mut self, sample: Residual) -> f64 {
        let Some(whitened) = self.whitener.whiten(sample) else { return self.value };
        let GlrSettings { shape, side, .. } = self.settings;
        // A ramp may have begun at the sample before, a step just before this one.
        let fresh = match (shape, whitened.interval_s) {
            (Shape::Step, _) => Some(Onset::at(sample.time_s)),
            (Shape::Ramp, Some(interval_s)) => Some(Onset::at(sample.time_s - interval_s)),
            (Shape::Ramp, None) => None,
        };
        if let Some(fresh) = fresh {
            self.onsets.push(fresh, drop);
        }
        let mut value = 0.0_f64;
        for onset in self.onsets.iter_mut() {
            onset.add(shape, side, sample.time_s, &whitened);
            value = value.max(onset.log_likelihood_ratio);
        }
        self.value = value;
        value
    }

    fn value(&self) -> f64 {
        self.value
    }

    fn reset(&mut self) {
        self.whitener.reset();
        self.onsets.clear();
        self.value = 0.0;
    }
}

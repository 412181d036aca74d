//! Noise of leak-free residuals: standard deviation and correlation time by maximum likelihood.
//!
//! For a correlation time `tau` the whitened residuals `w_n = (e_n - phi_n e_{n-1})/sqrt(1 - phi_n^2)` give `sigma^2 = mean(w^2)`, and
//! what is left to minimise over `ln tau` is `ln sigma^2 + mean ln(1 - phi_n^2)`. Intervals may be uneven. The mean is taken
//! off first.
//!
//! Assumes a stationary Ornstein-Uhlenbeck process, seen without a noise of its own for each sample.
//!
//! Source: P. J. Brockwell and R. A. Davis, Time Series: Theory and Methods, 1991.
use std::convert::Infallible;

use cylwatch_estimator::minimum::golden_section;
use serde::{Deserialize, Serialize};

use super::blocks::check;
use crate::DetectorError;
use crate::statistic::{Noise, Residual};

/// Correlation time below which residuals are white, in median intervals: neighbours correlate by `e^-5`.
const WHITE: f64 = 0.2;
/// Points of the first search over the correlation time.
const SEARCH_POINTS: i32 = 60;
/// Width of the logarithm of the correlation time at which the search ends.
const WIDTH: f64 = 1e-6;

/// Noise that fits residuals best.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct NoiseFit {
    /// The noise about the mean.
    pub noise: Noise,
    /// The mean, in the unit of the residuals.
    pub mean: f64,
    /// Standard deviation of the logarithm of the correlation time; 0 for white noise.
    pub log_correlation_time_sd: f64,
}

/// Fit the noise of residuals.
///
/// # Errors
/// There are fewer than 50 residuals, one is not finite, times do not increase, or they do not vary.
pub fn fit_noise(residuals: &[Residual]) -> Result<NoiseFit, DetectorError> {
    check(residuals)?;
    let mean = residuals.iter().map(|residual| residual.value).sum::<f64>() / residuals.len() as f64;
    let mut intervals: Vec<f64> = residuals.windows(2).map(|pair| pair[1].time_s - pair[0].time_s).collect();
    intervals.sort_by(f64::total_cmp);
    let profile = Profile { residuals, mean };
    let low = (WHITE * intervals[intervals.len() / 2]).ln();
    let high = (residuals[residuals.len() - 1].time_s - residuals[0].time_s).ln();
    let step = (high - low) / f64::from(SEARCH_POINTS);
    let points: Vec<f64> = (0..=SEARCH_POINTS).map(|i| low + step * f64::from(i)).collect();
    let value = |log_tau: &f64| profile.at(*log_tau).0;
    let coarse = points.iter().copied().min_by(|a, b| value(a).total_cmp(&value(b))).unwrap_or(low);
    let Ok(best) = golden_section((coarse - step, coarse + step), WIDTH, |log_tau| {
        Ok::<_, Infallible>(profile.at(log_tau).0)
    });
    if best <= low {
        let (_, variance) = profile.at(f64::NEG_INFINITY);
        return Ok(NoiseFit { noise: Noise::white(variance.sqrt()), mean, log_correlation_time_sd: 0.0 });
    }
    let (middle, variance) = profile.at(best);
    let aside = 0.05;
    let curvature =
        (profile.at(best + aside).0 - 2.0 * middle + profile.at(best - aside).0) / (aside * aside);
    // The profile is twice the negative log-likelihood per residual.
    let log_correlation_time_sd = (2.0 / (curvature.max(1e-12) * residuals.len() as f64)).sqrt();
    let noise = Noise::ornstein_uhlenbeck(variance.sqrt(), best.exp());
    Ok(NoiseFit { noise, mean, log_correlation_time_sd })
}

/// Profile likelihood of the correlation time.
struct Profile<'a> {
    residuals: &'a [Residual],
    mean: f64,
}

impl Profile<'_> {
    /// `ln sigma^2 + mean ln(1 - phi^2)` and `sigma^2`.
    fn at(&self, log_tau: f64) -> (f64, f64) {
        let (tau_s, n) = (log_tau.exp(), self.residuals.len() as f64);
        let (mut squares, mut logs) = ((self.residuals[0].value - self.mean).powi(2), 0.0);
        for pair in self.residuals.windows(2) {
            let apart = (pair[1].time_s - pair[0].time_s) / tau_s;
            let (phi, left) = ((-apart).exp(), -(-2.0 * apart).exp_m1());
            squares += (pair[1].value - self.mean - phi * (pair[0].value - self.mean)).powi(2) / left;
            logs += left.ln();
        }
        ((squares / n).ln() + logs / n, squares / n)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibrate::{ResidualSource, SimulatedNoise};
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn correlation_times_are_found_within_their_standard_error_at_uneven_intervals() {
        let mut random = ChaCha8Rng::seed_from_u64(2);
        let noise = Noise::ornstein_uhlenbeck(0.3, 10_800.0);
        let mut squares = 0.0;
        for run in 0..30 {
            let mut source = SimulatedNoise::try_new(noise, 600.0, 5).unwrap();
            source.begin(run);
            // Every third sample on average is kept: intervals are uneven.
            let all: Vec<Residual> = (0..6000).map(|_| source.next_residual()).collect();
            let kept: Vec<Residual> = all.into_iter().filter(|_| random.random::<f64>() < 0.33).collect();
            let fit = fit_noise(&kept).unwrap();
            let miss = (fit.noise.correlation_time_s / 10_800.0).ln() / fit.log_correlation_time_sd;
            squares += miss * miss;
            assert!((fit.noise.sd / 0.3 - 1.0).abs() < 0.25, "{fit:?}");
        }
        assert!((0.5..1.7).contains(&(squares / 30.0)), "{squares}");
    }

    #[test]
    fn white_residuals_are_found_white_about_their_mean() {
        let mut source = SimulatedNoise::try_new(Noise::white(2.0), 60.0, 5).unwrap();
        let residuals: Vec<Residual> = (0..5000)
            .map(|_| source.next_residual())
            .map(|residual| Residual { value: residual.value + 7.0, ..residual })
            .collect();
        let fit = fit_noise(&residuals).unwrap();
        assert!(fit.noise.correlation(60.0) < 0.03, "{fit:?}");
        assert!((fit.noise.sd - 2.0).abs() < 0.06 && (fit.mean - 7.0).abs() < 0.1, "{fit:?}");
    }
}

//! Noise of a series without a leak, and the shortest delay at which a leak can be found in it.
//!
//! An Ornstein-Uhlenbeck process of standard deviation `sigma` and correlation time `tau` is `e_n = phi e_{n-1} + w_n` with `phi = exp(-dt/tau)` and
//! `Var w_n = sigma^2 (1 - phi^2)`; white noise is `tau = 0`. Fitted by maximum likelihood: for a `tau` it is `sigma^2 = mean(w^2/(1 - phi^2))`, and
//! what is left to minimise over `ln tau` is `ln sigma^2 + mean ln(1 - phi^2)`. Intervals may be uneven. The mean is taken off first.
//!
//! A ramp brings the information (Kullback-Leibler divergence) `J(T)` in the time `T`; a detector can alarm when `J(T) = ln gamma`, with
//! `gamma` the mean time between false alarms in units of the time after which the series is a new one, `2 tau`, or the interval `dt` for
//! white noise:
//!
//! | white | Ornstein-Uhlenbeck |
//! |---|---|
//! | `T = (6 sigma^2 dt ln gamma / r^2)^(1/3)` | `T = tau {[1 + 12 sigma^2 ln gamma/(r tau)^2]^(1/3) - 1}` |
//!
//! The bound assumes that the detector knows the rate, and continuous observation. It is asymptotic for large `gamma`: at finite `gamma` a
//! procedure can be a little faster.
//!
//! Source: P. J. Brockwell and R. A. Davis, Time Series: Theory and Methods, 1991; G. Lorden, Ann. Math. Stat. 42 (1971) 1897;
//! T. L. Lai, IEEE Trans. Inf. Theory 44 (1998) 2917.
use std::convert::Infallible;

use serde::{Deserialize, Serialize};

use crate::estimator::minimum::golden_section;

/// Fewest values that tell their noise.
const MIN_SAMPLES: usize = 50;
/// Correlation time below which a series is white, in median intervals: neighbours correlate by `e^-5`.
const WHITE: f64 = 0.2;
/// Points of the first search over the correlation time.
const SEARCH_POINTS: i32 = 60;
/// Width of the logarithm of the correlation time at which the search ends.
const WIDTH: f64 = 1e-6;

/// A value of a series and its time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Residual {
    /// Time, s.
    pub time_s: f64,
    /// Value in its own unit.
    pub value: f64,
}

/// Stationary noise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Noise {
    /// Standard deviation, in the unit of the series.
    pub sd: f64,
    /// Correlation time, s; 0: white.
    pub correlation_time_s: f64,
}

impl Noise {
    /// The noise about the mean of a series. `None` if there are fewer than 50 values, one is not finite, times do not increase, or the
    /// values do not vary.
    pub(crate) fn fit(series: &[Residual]) -> Option<Self> {
        if !is_series(series) {
            return None;
        }
        let mean = series.iter().map(|residual| residual.value).sum::<f64>() / series.len() as f64;
        let mut intervals: Vec<f64> = series.windows(2).map(|pair| pair[1].time_s - pair[0].time_s).collect();
        intervals.sort_by(f64::total_cmp);
        let profile = Profile { series, mean };
        let low = (WHITE * intervals[intervals.len() / 2]).ln();
        let high = (series[series.len() - 1].time_s - series[0].time_s).ln();
        let step = (high - low) / f64::from(SEARCH_POINTS);
        let points: Vec<f64> = (0..=SEARCH_POINTS).map(|i| low + step * f64::from(i)).collect();
        let value = |log_tau: &f64| profile.at(*log_tau).0;
        let coarse = points.iter().copied().min_by(|a, b| value(a).total_cmp(&value(b))).unwrap_or(low);
        let Ok(best) = golden_section((coarse - step, coarse + step), WIDTH, |log_tau| {
            Ok::<_, Infallible>(profile.at(log_tau).0)
        });
        let (log_tau, correlation_time_s) =
            if best <= low { (f64::NEG_INFINITY, 0.0) } else { (best, best.exp()) };
        let (_, variance) = profile.at(log_tau);
        Some(Self { sd: variance.sqrt(), correlation_time_s })
    }

    /// Smallest mean delay, s, at which any detector finds a loss of `rate`, per second in the unit of the series, with
    /// `between_alarms_s` between false alarms, fed every `interval_s`.
    pub(crate) fn shortest_delay_s(self, rate: f64, interval_s: f64, between_alarms_s: f64) -> f64 {
        let (variance, tau_s) = (self.sd * self.sd, self.correlation_time_s);
        let renewal_s = interval_s.max(2.0 * tau_s);
        let needed = (between_alarms_s / renewal_s).ln().max(0.0);
        if tau_s > 0.0 {
            let cube = 12.0 * variance * needed / (rate * tau_s).powi(2);
            // (1 + c)^(1/3) - 1 without cancellation.
            return tau_s * (cube.ln_1p() / 3.0).exp_m1();
        }
        (6.0 * variance * interval_s * needed / (rate * rate)).cbrt()
    }
}

/// Whether values are enough, finite, in order, and vary.
fn is_series(series: &[Residual]) -> bool {
    let finite = |residual: &Residual| residual.value.is_finite() && residual.time_s.is_finite();
    series.len() >= MIN_SAMPLES
        && series.iter().all(finite)
        && series.windows(2).all(|pair| pair[1].time_s > pair[0].time_s)
        && series.iter().any(|residual| residual.value != series[0].value)
}

/// Profile likelihood of the correlation time.
struct Profile<'a> {
    series: &'a [Residual],
    mean: f64,
}

impl Profile<'_> {
    /// `ln sigma^2 + mean ln(1 - phi^2)` and `sigma^2`.
    fn at(&self, log_tau: f64) -> (f64, f64) {
        let (tau_s, n) = (log_tau.exp(), self.series.len() as f64);
        let (mut squares, mut logs) = ((self.series[0].value - self.mean).powi(2), 0.0);
        for pair in self.series.windows(2) {
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
    use approx::assert_relative_eq;
    use cylwatch_thermal::units::HOUR_S;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use rand_distr::StandardNormal;

    /// Drawn at even intervals, about a mean of 7.
    fn drawn(noise: Noise, interval_s: f64, count: u32, random: &mut ChaCha8Rng) -> Vec<Residual> {
        let phi = (-interval_s / noise.correlation_time_s).exp();
        let mut e: f64 = random.sample(StandardNormal);
        let value = |n: u32| {
            let now = Residual { time_s: interval_s * f64::from(n), value: 7.0 + noise.sd * e };
            e = phi * e + (1.0 - phi * phi).sqrt() * random.sample::<f64, _>(StandardNormal);
            now
        };
        (0..count).map(value).collect()
    }

    #[test]
    fn correlation_times_are_found_within_their_standard_error_at_uneven_intervals() {
        let mut random = ChaCha8Rng::seed_from_u64(2);
        let noise = Noise { sd: 0.3, correlation_time_s: 3.0 * HOUR_S };
        let mut squares = 0.0;
        for _ in 0..30 {
            let all = drawn(noise, 600.0, 6000, &mut random);
            // Every third sample on average is kept: intervals are uneven.
            let kept: Vec<Residual> = all.into_iter().filter(|_| random.random::<f64>() < 0.33).collect();
            let fit = Noise::fit(&kept).unwrap();
            assert!((fit.sd / 0.3 - 1.0).abs() < 0.25, "{fit:?}");
            squares += (fit.correlation_time_s / noise.correlation_time_s).ln().powi(2);
        }
        // Cramer-Rao of a process seen for 1000 h, 333 correlation times: sqrt(2/333) = 0.078.
        let error = (squares / 30.0_f64).sqrt();
        assert!((0.05..0.11).contains(&error), "{error}");
    }

    #[test]
    fn white_series_are_found_white_about_their_mean() {
        let white = Noise { sd: 2.0, correlation_time_s: 0.0 };
        let fit = Noise::fit(&drawn(white, 60.0, 5000, &mut ChaCha8Rng::seed_from_u64(5))).unwrap();
        assert!(fit.correlation_time_s < 20.0 && (fit.sd - 2.0).abs() < 0.06, "{fit:?}");
    }

    #[test]
    fn series_that_tell_no_noise_are_refused() {
        let noise = Noise { sd: 1.0, correlation_time_s: 60.0 };
        let good = drawn(noise, 60.0, 50, &mut ChaCha8Rng::seed_from_u64(1));
        assert!(Noise::fit(&good).is_some() && Noise::fit(&good[1..]).is_none());
        let with = |changed: Residual| {
            let mut series = good.clone();
            series[7] = changed;
            Noise::fit(&series)
        };
        assert_eq!(with(Residual { value: f64::NAN, ..good[7] }), None);
        assert_eq!(with(Residual { time_s: good[6].time_s, ..good[7] }), None);
        let still: Vec<Residual> = good.iter().map(|one| Residual { value: 1.0, ..*one }).collect();
        assert_eq!(Noise::fit(&still), None);
    }

    #[test]
    fn ramps_in_coloured_noise_have_the_published_bounds() {
        let noise = Noise { sd: 0.3, correlation_time_s: 3.0 * HOUR_S };
        // Rate in bar/h, bound in h, half a unit of its last printed digit.
        let published = [
            (0.001, 313.0, 0.5),
            (0.002, 196.0, 0.5),
            (0.005, 105.0, 0.5),
            (0.01, 65.0, 0.5),
            (0.03, 30.0, 0.5),
            (0.1, 11.7, 0.05),
            (0.3, 4.2, 0.05),
            (1.0, 0.9, 0.05),
        ];
        for (rate, bound_h, rounding_h) in published {
            let bound_s = noise.shortest_delay_s(rate / HOUR_S, HOUR_S, 1e5 * HOUR_S);
            assert!((bound_s / HOUR_S - bound_h).abs() < rounding_h, "{rate}: {}", bound_s / HOUR_S);
        }
    }

    #[test]
    fn white_series_have_the_published_floor() {
        let years_s = 10.0 * 365.25 * 24.0 * HOUR_S;
        let white = Noise { sd: 0.01, correlation_time_s: 0.0 };
        for (rate_h, bound_s) in [(0.01, 1.2 * HOUR_S), (0.1, 900.0), (1.0, 192.0)] {
            let found = white.shortest_delay_s(rate_h / HOUR_S, 60.0, years_s);
            assert_relative_eq!(found, bound_s, max_relative = 0.06);
        }
    }

    #[test]
    fn short_correlation_times_lead_to_white_noise_of_the_same_spectrum() {
        // White noise of the interval dt has the spectrum sigma^2 dt, this one 2 sigma^2 tau; both renew after dt.
        let of = |correlation_time_s| Noise { sd: 1.0, correlation_time_s };
        let coloured = of(1e-3).shortest_delay_s(0.01, 2e-3, 10.0);
        assert_relative_eq!(coloured, of(0.0).shortest_delay_s(0.01, 2e-3, 10.0), max_relative = 1e-3);
    }
}

//! The shortest mean delay of any detector with a given mean time between false alarms.
//!
//! The change brings the information (Kullback-Leibler divergence) `J(T)` in the time `T`; a detector can alarm when
//! `J(T) = ln gamma`, with `gamma` the mean time between false alarms in units of the time after which residuals are new:
//! `2 tau` for a correlation time `tau`, the interval `dt` for white noise. At the standard deviation `sigma`:
//!
//! | | white | Ornstein-Uhlenbeck |
//! |---|---|---|
//! | step `d` | `T = 2 sigma^2 dt ln gamma / d^2` | first sample `d^2/[2 sigma^2 (1 - phi^2)]`, each later one `(1 - phi)/(1 + phi) d^2/(2 sigma^2)` |
//! | ramp `r` | `T = (6 sigma^2 dt ln gamma / r^2)^(1/3)` | `T = tau {[1 + 12 sigma^2 ln gamma/(r tau)^2]^(1/3) - 1}` |
//!
//! Assumes size and shape of the change known to the detector, and continuous observation for the ramp. The bound is
//! asymptotic for large `gamma`: at finite `gamma` a procedure can be a little faster, as it saves the overshoot.
//!
//! Source: G. Lorden, Ann. Math. Stat. 42 (1971) 1897; T. L. Lai, IEEE Trans. Inf. Theory 44 (1998) 2917.
use serde::{Deserialize, Serialize};

use crate::statistic::Noise;

/// A change of the mean of residuals.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Change {
    /// From one sample to the next, in the unit of the residual.
    Step(f64),
    /// Steady, in the unit of the residual per second.
    Ramp(f64),
}

impl Change {
    /// Smallest mean delay, s, of a detector with `between_alarms_s` between false alarms, fed every `interval_s`.
    pub fn delay_bound(&self, noise: Noise, interval_s: f64, between_alarms_s: f64) -> f64 {
        let renewal_s = interval_s.max(2.0 * noise.correlation_time_s);
        let needed = (between_alarms_s / renewal_s).ln().max(0.0);
        self.time_to_information(noise, interval_s, needed)
    }

    /// Time, s, after which the change has brought so much information.
    pub fn time_to_information(&self, noise: Noise, interval_s: f64, needed: f64) -> f64 {
        let (variance, tau_s) = (noise.sd * noise.sd, noise.correlation_time_s);
        match *self {
            Self::Ramp(rate) if tau_s > 0.0 => {
                let cube = 12.0 * variance * needed / (rate * tau_s).powi(2);
                // (1 + c)^(1/3) - 1 without cancellation.
                tau_s * (cube.ln_1p() / 3.0).exp_m1()
            }
            Self::Ramp(rate) => (6.0 * variance * interval_s * needed / (rate * rate)).cbrt(),
            Self::Step(size) => {
                let phi = noise.correlation(interval_s);
                let signal = size * size / (2.0 * variance);
                let (first, later) = (signal / (1.0 - phi * phi), signal * (1.0 - phi) / (1.0 + phi));
                interval_s * if needed <= first { needed / first } else { 1.0 + (needed - first) / later }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const HOUR_S: f64 = 3600.0;

    #[test]
    fn ramps_in_coloured_noise_have_the_published_bounds() {
        let noise = Noise::ornstein_uhlenbeck(0.3, 3.0 * HOUR_S);
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
            let bound_s = Change::Ramp(rate / HOUR_S).delay_bound(noise, HOUR_S, 1e5 * HOUR_S);
            assert!((bound_s / HOUR_S - bound_h).abs() < rounding_h, "{rate}: {}", bound_s / HOUR_S);
        }
    }

    #[test]
    fn white_residuals_have_the_published_floor() {
        let years_s = 10.0 * 365.25 * 24.0 * HOUR_S;
        for (rate_h, bound_s) in [(0.01, 1.2 * HOUR_S), (0.1, 900.0), (1.0, 192.0)] {
            let found = Change::Ramp(rate_h / HOUR_S).delay_bound(Noise::white(0.01), 60.0, years_s);
            assert_relative_eq!(found, bound_s, max_relative = 0.06);
        }
    }

    #[test]
    fn lordens_bound_of_a_step_in_white_noise() {
        let found = Change::Step(1.0).delay_bound(Noise::white(1.0), 1.0, 930.9);
        assert_relative_eq!(found, 13.7, max_relative = 3e-3);
    }

    #[test]
    fn short_correlation_times_lead_to_white_noise_of_the_same_spectrum() {
        // White noise of the interval dt has the spectrum sigma^2 dt, this one 2 sigma^2 tau.
        let (tau_s, rate) = (1e-3, 0.01);
        let coloured =
            Change::Ramp(rate).time_to_information(Noise::ornstein_uhlenbeck(1.0, tau_s), 1.0, 9.0);
        let white = Change::Ramp(rate).time_to_information(Noise::white(1.0), 2.0 * tau_s, 9.0);
        assert_relative_eq!(coloured, white, max_relative = 1e-3);
        let step = |phi| Change::Step(0.2).time_to_information(Noise::ar1(1.0, phi, 1.0), 1.0, 9.0);
        assert_relative_eq!(step(1e-9), step(0.0), max_relative = 1e-6);
    }
}

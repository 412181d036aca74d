//! Run lengths in closed form, for a first look and to check the exact ones against.
//!
//! All rest on the mean overshoot of a normal random walk over a far barrier, `-zeta(1/2)/sqrt(2 pi) = 0.5826` standard
//! deviations: a walk in discrete time behaves like Brownian motion with a barrier that much farther away.
//!
//! Source: D. Siegmund, Sequential Analysis, 1985; M. Pollak, Ann. Stat. 15 (1987) 749; D. Siegmund
//! and E. S. Venkatraman, Ann. Stat. 23 (1995) 255.
use super::solve::threshold_for;
use super::{normal_density, normal_probability};
use crate::DetectorError;

/// Mean overshoot of a standard normal random walk over a far barrier, `-zeta(1/2)/sqrt(2 pi)`.
pub const MEAN_OVERSHOOT: f64 = 0.582_597_157_939_010_6;

/// Mean run length of a one-sided cumulative sum: `[exp(-2 D b) + 2 D b - 1]/(2 D^2)`, `D = mean - reference`,
/// `b = threshold + 1.166`; `b^2` for `D = 0`.
pub fn siegmund_arl(reference: f64, threshold: f64, mean: f64) -> f64 {
    let drift = mean - reference;
    let barrier = threshold + 2.0 * MEAN_OVERSHOOT;
    let way = 2.0 * drift * barrier;
    if way.abs() < 1e-4 {
        return barrier * barrier * (1.0 - way / 3.0);
    }
    ((-way).exp_m1() + way) / (2.0 * drift * drift)
}

/// Mean number of samples between false alarms of Shiryaev-Roberts with threshold `A`: `A exp(0.583 |shift|)`.
pub fn shiryaev_roberts_arl(shift: f64, threshold: f64) -> f64 {
    threshold * (MEAN_OVERSHOOT * shift.abs()).exp()
}

/// Share of the clusters of exceedances of a normal random walk, drift `-x^2/2` and variance `x^2`, that its discrete
/// time leaves: `nu(x) = (2/x) [Phi(x/2) - 1/2]/[(x/2) Phi(x/2) + phi(x/2)]`, nearly `exp(-0.583 x)`.
///
/// Source: D. Siegmund and B. Yakir, The Statistics of Gene Mapping, 2007.
pub(super) fn discreteness(x: f64) -> f64 {
    if x < 1e-6 {
        return 1.0 - MEAN_OVERSHOOT * x;
    }
    let half = 0.5 * x;
    (normal_probability(half) - 0.5) / half / (half * normal_probability(half) + normal_density(half))
}

/// Mean number of samples between false alarms of the likelihood ratio for a step of unknown size, either sign:
/// `sqrt(2 pi) exp(b^2/2)/(b int_0^inf x nu(x)^2 dx)`, alarm at a log-likelihood ratio of `b^2/2`. Twice that for one sign.
///
/// # Validity
/// Long windows and `b` from about 3.5 on; 16 % too small there, exact to 1 % at 4.5.
pub fn siegmund_venkatraman_arl(log_likelihood_ratio: f64) -> f64 {
    /// `int_0^inf x nu(x)^2 dx` with `nu(x) = exp(-0.583 x)`: `1/(2 * 0.5826)^2`.
    const INTEGRAL: f64 = 1.0 / (4.0 * MEAN_OVERSHOOT * MEAN_OVERSHOOT);
    let b = (2.0 * log_likelihood_ratio).sqrt();
    1.0 / (b * normal_density(b) * INTEGRAL)
}

/// The log-likelihood ratio at which [`siegmund_venkatraman_arl`] is so large.
///
/// # Errors
/// The run length is below about 10 or not finite: the approximation does not grow with the threshold there.
pub fn siegmund_venkatraman_threshold(arl: f64) -> Result<f64, DetectorError> {
    threshold_for(arl, 0.51, 300.0, siegmund_venkatraman_arl)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn siegmunds_formula_gives_the_published_column() {
        for (k, h, arl) in [(0.5, 4.0, 338.1), (0.5, 5.0, 938.2), (0.5, 8.0, 19_110.0), (0.25, 8.0, 737.8)] {
            assert_relative_eq!(siegmund_arl(k, h, 0.0), arl, max_relative = 1e-3);
        }
        let b: f64 = 4.0 + 2.0 * MEAN_OVERSHOOT;
        assert_relative_eq!(siegmund_arl(0.5, 4.0, 0.5), b * b, max_relative = 1e-12);
        assert_relative_eq!(siegmund_arl(0.5, 4.0, 0.5 + 1e-5), b * b, max_relative = 1e-4);
    }

    #[test]
    fn the_likelihood_ratio_formula_gives_the_published_run_lengths() {
        for (b, arl) in [(3.5_f64, 445.0), (4.0, 2540.0), (4.5, 18_902.0)] {
            assert_relative_eq!(siegmund_venkatraman_arl(0.5 * b * b), arl, max_relative = 2e-3);
            let threshold = siegmund_venkatraman_threshold(siegmund_venkatraman_arl(0.5 * b * b)).unwrap();
            assert_relative_eq!(threshold, 0.5 * b * b, max_relative = 1e-6);
        }
    }

    #[test]
    fn shiryaev_roberts_thresholds_are_multiplied_by_the_overshoot() {
        // A = 100 with a unit shift, 1000 with one, 1000 with a half: the published column.
        for (shift, a, arl) in [(1.0, 100.0, 179.0), (1.0, 1000.0, 1791.0), (0.5, 1000.0, 1338.0)] {
            assert_relative_eq!(shiryaev_roberts_arl(shift, a), arl, max_relative = 3e-3);
        }
    }

    #[test]
    fn the_discreteness_is_the_exponential_of_the_overshoot_for_small_steps() {
        for x in [1e-7, 1e-3, 0.1, 0.5, 1.0] {
            assert_relative_eq!(discreteness(x), (-MEAN_OVERSHOOT * x).exp(), max_relative = 0.02);
        }
    }
}

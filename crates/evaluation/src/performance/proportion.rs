//! Part of runs in which something happened, with its interval.
//!
//! For `k` of `n` and the normal quantile `z`: Wilson's interval is
//! `[p + z^2/2n -+ z sqrt(p(1-p)/n + z^2/4n^2)]/(1 + z^2/n)`; its coverage is the level on average over `p`. Clopper and Pearson's, from
//! the quantiles of `Beta(k, n-k+1)` and `Beta(k+1, n-k)`, covers with the level at least.
//!
//! Source: E. B. Wilson, J. Am. Stat. Assoc. 22 (1927) 209; C. J. Clopper and E. S. Pearson, Biometrika 26 (1934) 404.
use serde::{Deserialize, Serialize};
use statrs::distribution::{Beta, ContinuousCDF};

use super::normal_quantile;

/// `hits` of `trials`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Proportion {
    /// How often it happened.
    pub hits: u64,
    /// How often it could have.
    pub trials: u64,
}

impl Proportion {
    /// Count those that are true.
    pub fn count(outcomes: impl IntoIterator<Item = bool>) -> Self {
        outcomes.into_iter().fold(Self::default(), |sum, hit| Self {
            hits: sum.hits + u64::from(hit),
            trials: sum.trials + 1,
        })
    }

    /// `hits/trials`; NaN without trials.
    pub fn value(&self) -> f64 {
        self.hits as f64 / self.trials as f64
    }

    /// Wilson's interval at a level such as 0.95; all of 0 to 1 without trials.
    pub fn wilson(&self, level: f64) -> (f64, f64) {
        if self.trials == 0 {
            return (0.0, 1.0);
        }
        let (n, p, z) = (self.trials as f64, self.value(), normal_quantile(level));
        let middle = p + z * z / (2.0 * n);
        let half = z * (p * (1.0 - p) / n + z * z / (4.0 * n * n)).sqrt();
        let all = 1.0 + z * z / n;
        (((middle - half) / all).max(0.0), ((middle + half) / all).min(1.0))
    }

    /// Clopper and Pearson's interval at a level such as 0.95; all of 0 to 1 without trials.
    pub fn clopper_pearson(&self, level: f64) -> (f64, f64) {
        let tail = 0.5 * (1.0 - level.clamp(0.0, 1.0 - 1e-12));
        let (hits, misses) = (self.hits as f64, (self.trials - self.hits) as f64);
        let quantile = |a: f64, b: f64, probability: f64| {
            Beta::new(a, b).expect("positive shapes").inverse_cdf(probability)
        };
        let low = if self.hits == 0 { 0.0 } else { quantile(hits, misses + 1.0, tail) };
        let high = if self.hits == self.trials { 1.0 } else { quantile(hits + 1.0, misses, 1.0 - tail) };
        (low, high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn intervals_are_those_of_the_tables() {
        // Newcombe, Stat. Med. 17 (1998) 857, table I: methods 3 (Wilson) and 5 (Clopper and Pearson).
        let published = [
            ((81, 263), (0.2553, 0.3662), (0.2527, 0.3676)),
            ((15, 148), (0.0624, 0.1605), (0.0578, 0.1617)),
            ((0, 20), (0.0, 0.1611), (0.0, 0.1684)),
            ((1, 29), (0.0061, 0.1718), (0.0009, 0.1776)),
        ];
        for ((hits, trials), wilson, clopper_pearson) in published {
            let proportion = Proportion { hits, trials };
            for (found, expected) in
                [(proportion.wilson(0.95), wilson), (proportion.clopper_pearson(0.95), clopper_pearson)]
            {
                assert_abs_diff_eq!(found.0, expected.0, epsilon = 6e-5);
                assert_abs_diff_eq!(found.1, expected.1, epsilon = 6e-5);
            }
        }
    }

    #[test]
    fn all_of_n_leaves_the_bound_of_the_binomial_distribution_in_closed_form() {
        // p^40 = 0.025.
        let (low, high) = Proportion { hits: 40, trials: 40 }.clopper_pearson(0.95);
        assert_abs_diff_eq!(low, 0.025_f64.powf(1.0 / 40.0), epsilon = 1e-9);
        assert_eq!(high, 1.0);
    }

    #[test]
    fn without_trials_nothing_is_known() {
        let none = Proportion::default();
        assert!(none.value().is_nan());
        assert_eq!((none.wilson(0.95), none.clopper_pearson(0.95)), ((0.0, 1.0), (0.0, 1.0)));
    }

    #[test]
    fn outcomes_are_counted() {
        assert_eq!(Proportion::count([true, false, true]), Proportion { hits: 2, trials: 3 });
    }
}

//! Autocorrelation of normalised innovations.
use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::{Finding, Significance};

/// Fewest pairs of samples that an autocorrelation is judged by: it is normal for many only.
const FEWEST_PAIRS: u64 = 30;

/// Autocorrelation of the innovations of one output, `nu/sqrt(S)`, at the lags 1 to `lags`:
///
/// `rho(l) = sum_k nu_k nu_{k+l} / sqrt(sum_k nu_k^2 sum_k nu_{k+l}^2)`, nearly `N(0, 1/K_l)` for `K_l` pairs of white ones.
///
/// The mean is not subtracted, since it should be zero. Lags count samples; pairs of which one is missing are left out.
#[derive(Clone, Debug, PartialEq)]
pub struct Whiteness {
    /// The last samples, a ring; NaN where one is missing.
    last: Vec<f64>,
    next: usize,
    lags: Vec<Lag>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Lag {
    products: f64,
    squares_before: f64,
    squares_after: f64,
    pairs: u64,
}

impl Whiteness {
    /// No samples yet, to be compared over up to `lags` samples.
    pub fn new(lags: usize) -> Self {
        Self { last: vec![f64::NAN; lags], next: 0, lags: vec![Lag::default(); lags] }
    }

    /// Add a normalised innovation; NaN where a sample has none.
    pub fn push(&mut self, nu: f64) {
        let length = self.last.len();
        for (index, lag) in self.lags.iter_mut().enumerate() {
            let before = self.last[(self.next + length - 1 - index) % length];
            if before.is_finite() && nu.is_finite() {
                lag.products += before * nu;
                lag.squares_before += before * before;
                lag.squares_after += nu * nu;
                lag.pairs += 1;
            }
        }
        if length > 0 {
            self.last[self.next] = nu;
            self.next = (self.next + 1) % length;
        }
    }

    /// Number of lags.
    pub(crate) fn lags(&self) -> usize {
        self.lags.len()
    }

    /// Autocorrelation at a lag from 1 on; `None` beyond the lags or without a pair.
    pub(crate) fn autocorrelation(&self, lag: usize) -> Option<f64> {
        let lag = self.lags.get(lag.checked_sub(1)?)?;
        let scale = (lag.squares_before * lag.squares_after).sqrt();
        (lag.pairs > 0 && scale > 0.0).then(|| lag.products / scale)
    }

    /// Bound on the size of one autocorrelation: the normal quantile over `sqrt(K_l)`.
    pub(crate) fn bound(&self, lag: usize, significance: Significance) -> Option<f64> {
        let pairs = self.lags.get(lag.checked_sub(1)?)?.pairs;
        (pairs > 0).then(|| significance.normal_quantile() / (pairs as f64).sqrt())
    }

    /// The lag of the largest autocorrelation by size, and that autocorrelation.
    pub(crate) fn largest(&self) -> Option<(usize, f64)> {
        (1..=self.lags())
            .filter_map(|lag| Some((lag, self.autocorrelation(lag)?)))
            .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
    }

    /// All lags together: probability that white innovations give a sum of `K_l rho(l)^2`, chi-square with as many
    /// degrees of freedom as lags, as large as this one (Box and Pierce 1970). `None` with too few samples.
    pub(crate) fn p_value(&self) -> Option<f64> {
        let judged: Vec<f64> = (1..=self.lags())
            .filter(|lag| self.lags[lag - 1].pairs >= FEWEST_PAIRS)
            .filter_map(|lag| Some(self.lags[lag - 1].pairs as f64 * self.autocorrelation(lag)?.powi(2)))
            .collect();
        let chi_square = ChiSquared::new(judged.len() as f64).ok()?;
        Some(chi_square.sf(judged.iter().sum()))
    }

    /// What the lags together say.
    pub fn finding(&self, significance: Significance) -> Finding {
        match self.p_value() {
            None => Finding::TooFew,
            Some(p) if p < significance.probability() => Finding::Correlated,
            Some(_) => Finding::Consistent,
        }
    }
}

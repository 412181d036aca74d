//! How well a model describes the data, and what its errors still hold.
//!
//! With the errors `e` of `N` samples, `V = sum e^2/N` and `d` estimated parameters, initial states included:
//!
//! | figure | definition |
//! |---|---|
//! | fit | `100 (1 - norm(e)/norm(y - mean y))` % |
//! | MSE | `V` |
//! | FPE | `V (1 + d/N)/(1 - d/N)` |
//! | AIC | `N ln V + 2 d + N (ln 2 pi + 1)`, normalised `ln V + 2 d/N` |
//! | AICc | `AIC + 2 d (d + 1)/(N - d - 1)` |
//! | BIC | `N ln V + N (ln 2 pi + 1) + d ln N` |
//!
//! These are the definitions of MATLAB's System Identification Toolbox (`Report.Fit`).
//!
//! Residual analysis: autocorrelation `r_e(l)/r_e(0)`, nearly `N(0, 1/N)` for white errors, and correlation with the input,
//! `r_eu(l)/sqrt(r_e(0) r_u(0))` with `r_eu(l) = sum e(k + l) u(k)/N`, nearly normal with the variance
//! `sum_j r_e(j) r_u(j)/(N r_e(0) r_u(0))` for errors independent of the input. Lags count samples. Correlation at negative lags, of errors with
//! later inputs, means feedback or an acausal record.
//!
//! Source: Ljung 1999 (sections 16.4 to 16.6), Box and Pierce 1970.
use serde::Serialize;
use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Quantile of the normal distribution for a 99 % band.
const BAND_99: f64 = 2.575_829_303_548_9;

/// Figures of merit of a model on its data.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Statistics {
    /// Samples `N`.
    pub samples: usize,
    /// Estimated parameters `d`, initial states included.
    pub parameters: usize,
    /// Fit by the normalised root mean square, %.
    pub fit_percent: f64,
    /// Mean of the squared errors.
    pub mse: f64,
    /// Final prediction error (Akaike); infinite with as many parameters as samples.
    pub fpe: f64,
    /// Akaike's information criterion.
    pub aic: f64,
    /// The same for small samples; infinite if there are too few.
    pub aicc: f64,
    /// The same per sample, without constants.
    pub aic_normalised: f64,
    /// Bayesian information criterion.
    pub bic: f64,
}

impl Statistics {
    /// Figures of a simulated or predicted output; `parameters` of the model were estimated.
    pub(crate) fn new(output: &[f64], errors: &[f64], parameters: usize) -> Self {
        let (n, d) = (errors.len() as f64, parameters as f64);
        let mse = errors.iter().map(|e| e * e).sum::<f64>() / n;
        let constant = n * ((2.0 * std::f64::consts::PI).ln() + 1.0);
        let aic = n * mse.ln() + 2.0 * d + constant;
        let left = n - d - 1.0;
        Self {
            samples: errors.len(),
            parameters,
            fit_percent: fit_percent(output, errors),
            mse,
            fpe: if d < n { mse * (1.0 + d / n) / (1.0 - d / n) } else { f64::INFINITY },
            aic,
            aicc: if left > 0.0 { aic + 2.0 * d * (d + 1.0) / left } else { f64::INFINITY },
            aic_normalised: mse.ln() + 2.0 * d / n,
            bic: n * mse.ln() + constant + d * n.ln(),
        }
    }
}

/// Fit by the normalised root mean square, %: 100 without errors, 0 for the mean of the output, negative for worse.
pub(crate) fn fit_percent(output: &[f64], errors: &[f64]) -> f64 {
    let mean = output.iter().sum::<f64>() / output.len() as f64;
    let spread: f64 = output.iter().map(|y| (y - mean).powi(2)).sum();
    100.0 * (1.0 - (errors.iter().map(|e| e * e).sum::<f64>() / spread).sqrt())
}

/// The errors of a model and what is left in them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Residuals {
    /// Times of the samples, s.
    pub time_s: Vec<f64>,
    /// Errors, measured less simulated output.
    pub values: Vec<f64>,
    /// Autocorrelation at the lags 0 to the largest.
    pub autocorrelation: Vec<f64>,
    /// 99 % bound on the size of one autocorrelation of white errors.
    pub autocorrelation_bound: f64,
    /// Probability that white errors have autocorrelations at all lags together as large as these (Box and Pierce).
    pub whiteness: f64,
    /// Correlation with the input at the lags from minus the largest to the largest.
    pub input_correlation: Vec<f64>,
    /// 99 % bound on the size of one correlation with an input that the errors are independent of.
    pub input_correlation_bound: f64,
}

impl Residuals {
    /// Analysis of errors with the input at the same times, for lags up to `lags` (fewer than samples).
    pub(crate) fn new(time_s: Vec<f64>, values: Vec<f64>, input: &[f64], lags: usize) -> Self {
        let n = values.len();
        let lags = lags.min(n.saturating_sub(1));
        let mean = input.iter().sum::<f64>() / n as f64;
        let u: Vec<f64> = input.iter().map(|u| u - mean).collect();
        let (re, ru) = (correlation(&values, &values, lags), correlation(&u, &u, lags));
        let scale = (re[0] * ru[0]).sqrt();
        let autocorrelation: Vec<f64> = re.iter().map(|r| r / re[0]).collect();
        let squares: f64 = autocorrelation[1..].iter().map(|r| n as f64 * r * r).sum();
        let whiteness = ChiSquared::new(lags as f64).map_or(f64::NAN, |chi_square| chi_square.sf(squares));
        let mut input_correlation: Vec<f64> =
            correlation(&u, &values, lags).iter().rev().map(|r| r / scale).collect();
        input_correlation.extend(correlation(&values, &u, lags)[1..].iter().map(|r| r / scale));
        let both: f64 =
            re[0] * ru[0] + 2.0 * re[1..].iter().zip(&ru[1..]).map(|(re, ru)| re * ru).sum::<f64>();
        Self {
            time_s,
            values,
            autocorrelation,
            autocorrelation_bound: BAND_99 / (n as f64).sqrt(),
            whiteness,
            input_correlation,
            input_correlation_bound: BAND_99 * (both.max(0.0) / n as f64).sqrt() / scale,
        }
    }

    /// Whether the errors may be white, at a significance of 1 %.
    pub fn is_white(&self) -> bool {
        self.whiteness >= 0.01
    }
}

/// `sum_k a(k + l) b(k)/N` at the lags 0 to `lags`.
fn correlation(a: &[f64], b: &[f64], lags: usize) -> Vec<f64> {
    let n = a.len() as f64;
    (0..=lags).map(|lag| a[lag..].iter().zip(b).map(|(a, b)| a * b).sum::<f64>() / n).collect()
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    #[test]
    fn figures_are_those_that_matlab_publishes() {
        // MATLAB documentation of `aic`: tfest(iddata1, np = 2) on 300 samples gives MSE 1.6575, FPE 1.7252,
        // AIC 1015.0, AICc 1015.3, nAIC 0.5453, BIC 1037.2. Four coefficients and two initial states: d = 6.
        let errors: Vec<f64> =
            (0..300).map(|k| if k % 2 == 0 { 1.6575_f64.sqrt() } else { -(1.6575_f64.sqrt()) }).collect();
        let s = Statistics::new(&errors, &errors, 6);
        assert_relative_eq!(s.mse, 1.6575, max_relative = 1e-12);
        assert!((s.fpe - 1.7252).abs() < 6e-5, "{}", s.fpe);
        assert!((s.aic - 1015.0).abs() < 0.06, "{}", s.aic);
        assert!((s.aicc - 1015.3).abs() < 0.06, "{}", s.aicc);
        assert!((s.aic_normalised - 0.5453).abs() < 6e-5, "{}", s.aic_normalised);
        assert!((s.bic - 1037.2).abs() < 0.06, "{}", s.bic);
    }

    #[test]
    fn final_prediction_error_of_two_parameters_and_a_hundred_samples() {
        let errors = vec![1.0; 100];
        assert_relative_eq!(Statistics::new(&errors, &errors, 2).fpe, 102.0 / 98.0, max_relative = 1e-14);
    }

    #[test]
    fn fit_is_100_for_the_output_0_for_its_mean_and_negative_for_worse() {
        let y = [1.0, 2.0, 6.0, -3.0];
        let mean = 1.5;
        assert_relative_eq!(fit_percent(&y, &[0.0; 4]), 100.0);
        assert_relative_eq!(fit_percent(&y, &y.map(|y| y - mean)), 0.0, epsilon = 1e-12);
        assert_relative_eq!(fit_percent(&y, &y.map(|y| 2.0 * (y - mean))), -100.0, epsilon = 1e-12);
    }

    #[test]
    fn a_delayed_input_in_the_errors_shows_at_its_lag() {
        // Pseudo-random signs: nearly white.
        let mut state = 12345_u64;
        let mut sign = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            if state >> 63 == 0 { 1.0 } else { -1.0 }
        };
        let u: Vec<f64> = (0..4000).map(|_| sign()).collect();
        let e: Vec<f64> = (0..4000).map(|k| sign() + if k >= 3 { 0.5 * u[k - 3] } else { 0.0 }).collect();
        let lags = 10;
        let residuals = Residuals::new((0..4000).map(f64::from).collect(), e, &u, lags);
        // corr(e, delayed u) = 0.5/sqrt(1.25).
        let at = |lag: i32| residuals.input_correlation[(lags as i32 + lag) as usize];
        assert_relative_eq!(at(3), 0.5 / 1.25_f64.sqrt(), epsilon = 0.05);
        for lag in (-10..=10).filter(|lag| *lag != 3) {
            assert!(at(lag).abs() < 1.3 * residuals.input_correlation_bound, "lag {lag}: {}", at(lag));
        }
        assert!(residuals.is_white());
        assert_relative_eq!(residuals.input_correlation_bound, 2.5758 / 4000_f64.sqrt(), max_relative = 0.05);
    }

    #[test]
    fn a_slow_error_is_not_white() {
        let wave: Vec<f64> = (0..400).map(|k| (f64::from(k) * 0.05).sin()).collect();
        let input: Vec<f64> = (0..400).map(|k| f64::from(k % 7)).collect();
        let residuals = Residuals::new((0..400).map(f64::from).collect(), wave, &input, 25);
        assert!(!residuals.is_white());
        assert!(residuals.autocorrelation[1] > 0.99 * (0.05_f64).cos());
    }
}

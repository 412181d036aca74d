//! What a fit leaves, channel by channel.
use super::CalibrateError;
use super::fit::{Evaluation, Fit};
use crate::consistency::Whiteness;

/// Lags that the test of whiteness looks at.
const LAGS: usize = 20;

/// Two-sided normal quantile below which an autocorrelation counts as none.
const CORRELATION_QUANTILE: f64 = 1.96;

/// A deviation of so many standard deviations of the noise is no chance.
pub(super) const SIGNIFICANT_SD: f64 = 5.0;

/// What is left of one channel.
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelResiduals {
    /// Source of the experiment.
    pub experiment: String,
    /// Name of the channel.
    pub channel: String,
    /// Times of the readings, s.
    pub time_s: Vec<f64>,
    /// Readings less those of the calibrated model, K or Pa.
    pub residuals: Vec<f64>,
    /// Their root mean square, K or Pa.
    pub rms: f64,
    /// That over the standard deviation of the sensor's noise: 1 for a model that fits to the noise.
    pub rms_over_noise: f64,
    /// Autocorrelation at the lags 1 to 20.
    pub autocorrelation: Vec<f64>,
    /// Probability that white residuals are as correlated (Box and Pierce); `None` with too few readings.
    pub whiteness_p_value: Option<f64>,
    /// Factor on the variance of the estimates, at least 1: mean weighted square times autocorrelation time.
    pub variance_factor: f64,
}

/// Residuals of every channel of every case, in the order of the readings.
pub(super) fn channel_residuals(fit: &Fit, evaluation: &Evaluation) -> Vec<ChannelResiduals> {
    let freedom = fit.samples() as f64 / (fit.samples().saturating_sub(fit.specs.len())).max(1) as f64;
    let mut rest = &evaluation.residuals[..];
    let mut channels = Vec::new();
    for case in &fit.cases {
        for (sensor, column) in case.base.sensors.iter().zip(&case.columns) {
            let (weighted, after) = rest.split_at(column.values.len());
            rest = after;
            let mean_square = weighted.iter().map(|r| r * r).sum::<f64>() / weighted.len() as f64;
            let mut whiteness = Whiteness::new(LAGS);
            weighted.iter().for_each(|&r| whiteness.push(r));
            channels.push(ChannelResiduals {
                experiment: case.source.clone(),
                channel: sensor.name.clone(),
                time_s: column.rows.iter().map(|&row| case.times_s[row]).collect(),
                residuals: weighted.iter().map(|r| r * column.sigma).collect(),
                rms: mean_square.sqrt() * column.sigma,
                rms_over_noise: mean_square.sqrt(),
                autocorrelation: (1..=LAGS).filter_map(|lag| whiteness.autocorrelation(lag)).collect(),
                whiteness_p_value: whiteness.p_value(),
                variance_factor: (freedom * mean_square * autocorrelation_time(weighted)).max(1.0),
            });
        }
    }
    channels
}

/// Integrated autocorrelation time in samples, `1 + 2 sum rho(l)` up to the first lag without correlation.
fn autocorrelation_time(r: &[f64]) -> f64 {
    let square: f64 = r.iter().map(|r| r * r).sum();
    let n = r.len();
    if square == 0.0 {
        return 1.0;
    }
    let correlation = |lag: usize| r[lag..].iter().zip(r).map(|(a, b)| a * b).sum::<f64>() / square;
    let least = CORRELATION_QUANTILE / (n as f64).sqrt();
    1.0 + 2.0 * (1..n / 2).map(correlation).take_while(|&rho| rho > least).sum::<f64>()
}

/// A model that explains less than a constant would is not of this log.
pub(super) fn check_misfit(fit: &Fit, channels: &[ChannelResiduals]) -> Result<(), CalibrateError> {
    let columns = fit.cases.iter().flat_map(|case| &case.columns);
    for (channel, column) in channels.iter().zip(columns) {
        let spread = column.moments().1;
        if channel.rms >= spread && channel.rms_over_noise > SIGNIFICANT_SD {
            let (experiment, channel_name) = (channel.experiment.clone(), channel.channel.clone());
            let deviation = channel.rms;
            return Err(CalibrateError::Misfit { experiment, channel: channel_name, deviation, spread });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    /// A first-order autoregression of coefficient `a` has the autocorrelation time `(1 + a) / (1 - a)`.
    #[test]
    fn autocorrelation_time_of_an_autoregression_is_the_closed_form() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
        let a = 0.8;
        let mut x = 0.0;
        let series: Vec<f64> = (0..40_000)
            .map(|_| {
                let noise: f64 = StandardNormal.sample(&mut rng);
                x = a * x + noise;
                x
            })
            .collect();
        let expected = (1.0 + a) / (1.0 - a);
        assert!((autocorrelation_time(&series) / expected - 1.0).abs() < 0.1);
    }

    #[test]
    fn white_residuals_have_an_autocorrelation_time_near_one() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(8);
        let series: Vec<f64> = (0..10_000).map(|_| StandardNormal.sample(&mut rng)).collect();
        assert!((autocorrelation_time(&series) - 1.0).abs() < 0.1);
    }
}

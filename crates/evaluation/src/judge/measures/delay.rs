//! Delay between onset and alarm, and how close it comes to the shortest possible.
use serde::{Deserialize, Serialize};

use super::{CONFIDENCE, Observed, Run, Survival};

/// Delays of the alarms to leaks of one rate, s. Quantiles count leaks that were not found as later than they were
/// watched; `None`: not seen to be reached.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Delay {
    /// Number of leaks.
    pub leaks: u64,
    /// Number that was found.
    pub found: u64,
    /// Half of them are found by then.
    pub median_s: Option<f64>,
    /// Bounds of the 95 % interval of the median.
    pub median_interval_s: (Option<f64>, Option<f64>),
    /// 95 % of them are found by then.
    pub p95_s: Option<f64>,
    /// Mean of those that were found: too short where others were not.
    pub mean_found_s: Option<f64>,
    /// Standard deviation of that mean; `None` for fewer than two.
    pub mean_found_sd_s: Option<f64>,
}

impl Delay {
    /// Of runs with leaks of one rate; alarms before the onset leave a run out.
    pub fn of(runs: &[Run]) -> Self {
        let observed = |run: &Run| {
            let watched_s = run.watched_s()?;
            Some(run.delay_s().map_or(Observed::NotUntil(watched_s), Observed::After))
        };
        let observations: Vec<Observed> = runs.iter().filter_map(observed).collect();
        let delays: Vec<f64> = runs.iter().filter_map(Run::delay_s).collect();
        let survival = Survival::of(&observations);
        let (mean_found_s, mean_found_sd_s) = mean_and_sd(&delays);
        Self {
            leaks: observations.len() as u64,
            found: delays.len() as u64,
            median_s: survival.quantile_s(0.5),
            median_interval_s: survival.quantile_interval_s(0.5, CONFIDENCE),
            p95_s: survival.quantile_s(0.95),
            mean_found_s,
            mean_found_sd_s,
        }
    }

    /// The shortest mean delay of any detector ([`crate::noise::Noise::shortest_delay_s`]) over the mean delay of this one, if it
    /// found all leaks: 1 is as good as can be.
    pub(crate) fn efficiency(&self, bound_s: f64) -> Option<f64> {
        let mean_s = self.mean_found_s.filter(|_| self.found == self.leaks)?;
        Some(bound_s / mean_s)
    }
}

/// Mean and its standard deviation.
fn mean_and_sd(values: &[f64]) -> (Option<f64>, Option<f64>) {
    if values.is_empty() {
        return (None, None);
    }
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (Some(mean), (n > 1.5).then(|| (squares / (n - 1.0) / n).sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn runs(alarms: &[Option<f64>]) -> Vec<Run> {
        let run = |alarm_s: &Option<f64>| Run {
            part_per_h: 1.0,
            onset_s: 100.0,
            until_s: 1000.0,
            alarm_s: *alarm_s,
        };
        alarms.iter().map(run).collect()
    }

    #[test]
    fn leaks_not_found_count_in_quantiles_and_not_in_the_mean() {
        let delay = Delay::of(&runs(&[Some(110.0), Some(120.0), Some(160.0), None, Some(50.0)]));
        assert_eq!((delay.leaks, delay.found), (4, 3));
        assert_eq!((delay.median_s, delay.p95_s), (Some(20.0), None));
        // 10, 20, 60: mean 30, variance 700, of the mean 700/3.
        assert_relative_eq!(delay.mean_found_s.unwrap(), 30.0, max_relative = 1e-12);
        assert_relative_eq!(delay.mean_found_sd_s.unwrap(), (700.0_f64 / 3.0).sqrt(), max_relative = 1e-12);
        assert_eq!(delay.efficiency(15.0), None);
    }

    #[test]
    fn efficiency_is_the_bound_over_the_mean_delay() {
        let delay = Delay::of(&runs(&[Some(110.0), Some(120.0), Some(160.0)]));
        assert_relative_eq!(delay.efficiency(15.0).unwrap(), 0.5, max_relative = 1e-12);
        let none = Delay::of(&[]);
        assert_eq!(
            (none.leaks, none.median_s, none.mean_found_s, none.mean_found_sd_s),
            (0, None, None, None)
        );
    }
}

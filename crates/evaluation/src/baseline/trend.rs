//! The slope of the error: a straight line through the recent past by least squares, the past forgotten exponentially.
//!
//! Weights `exp(-(t_n - t_i)/T)`; weighted means and centred moments are carried on, so that memory and time per sample
//! are constant and nothing cancels however long the record. Of a ramp it is the slope exactly, of white noise the
//! standard deviation is that of the weighted regression.

/// Memory `T`, s: in white noise as precise as a straight line through 3.6 times as long, an hour.
const MEMORY_S: f64 = 1000.0;

/// Weighted regression of a value over time.
#[derive(Clone, Copy, Debug, Default)]
pub struct Trend {
    last_s: Option<f64>,
    weight: f64,
    /// Mean time relative to the last sample, s.
    mean_s: f64,
    mean: f64,
    /// Weighted sum of squares of the time about its mean, s².
    spread: f64,
    /// Weighted sum of products of time and value about their means.
    product: f64,
}

impl Trend {
    /// Take a sample, later than the one before.
    pub fn update(&mut self, time_s: f64, value: f64) {
        let interval_s = self.last_s.map_or(0.0, |last_s| time_s - last_s);
        let kept = (-interval_s / MEMORY_S).exp();
        self.last_s = Some(time_s);
        self.weight *= kept;
        self.spread *= kept;
        self.product *= kept;
        let weight = self.weight + 1.0;
        let (ahead_s, above) = (interval_s - self.mean_s, value - self.mean);
        let share = self.weight / weight;
        self.spread += share * ahead_s * ahead_s;
        self.product += share * ahead_s * above;
        self.mean_s += ahead_s / weight - interval_s;
        self.mean += above / weight;
        self.weight = weight;
    }

    /// Slope, unit of the value per second; `None` before the second sample, also that after a gap that all is forgotten in.
    pub fn slope(&self) -> Option<f64> {
        (self.spread > 0.0).then(|| self.product / self.spread)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use nalgebra::{Matrix2, Vector2};

    #[test]
    fn the_slope_solves_the_weighted_normal_equations() {
        let samples: Vec<(f64, f64)> = (0..80)
            .map(|n| {
                (
                    1e9 + 60.0 * f64::from(n) + f64::from(n % 7),
                    (f64::from(n) * 0.37).sin() + 0.01 * f64::from(n),
                )
            })
            .collect();
        let mut trend = Trend::default();
        samples.iter().for_each(|(time_s, value)| trend.update(*time_s, *value));
        let now_s = samples[79].0;
        let (mut normal, mut right) = (Matrix2::zeros(), Vector2::zeros());
        for (time_s, value) in samples {
            let row = Vector2::new(1.0, time_s - now_s);
            let weight = ((time_s - now_s) / MEMORY_S).exp();
            normal += weight * row * row.transpose();
            right += weight * value * row;
        }
        let expected = normal.lu().solve(&right).unwrap()[1];
        assert_relative_eq!(trend.slope().unwrap(), expected, max_relative = 1e-9);
    }

    #[test]
    fn a_ramp_has_its_slope_and_one_sample_none() {
        let mut trend = Trend::default();
        trend.update(5.0, 3.0);
        assert_eq!(trend.slope(), None);
        for time_s in [8.0, 9.0, 40.0, 600.0, 601.0] {
            trend.update(time_s, 3.0 + 2e-3 * (time_s - 5.0));
            assert_relative_eq!(trend.slope().unwrap(), 2e-3, max_relative = 1e-9);
        }
    }
}

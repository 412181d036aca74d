//! Two ways to one number: a ramp in coloured residuals by whitening, and as a failure in a Kalman filter's innovations.
use approx::assert_relative_eq;
use cylwatch_detector::statistic::{
    Failure, FailureGlr, FilterStep, Glr, GlrSettings, Noise, Residual, Shape, Side, Statistic,
};
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

/// A filter that knows the level and estimates the Ornstein-Uhlenbeck error of its only reading, which is exact.
struct Filter {
    error: f64,
    variance: f64,
    last_s: Option<f64>,
}

impl Filter {
    fn step(&mut self, noise: Noise, sample: Residual, mut take: impl FnMut(&FilterStep)) {
        let interval_s = self.last_s.map_or(0.0, |last_s| sample.time_s - last_s);
        let phi = if self.last_s.is_some() { noise.correlation(interval_s) } else { 1.0 };
        self.last_s = Some(sample.time_s);
        self.error *= phi;
        self.variance = phi * phi * self.variance + noise.sd.powi(2) * (1.0 - phi * phi);
        take(&FilterStep {
            time_s: sample.time_s,
            interval_s,
            transition: &DMatrix::from_diagonal(&DVector::from_column_slice(&[phi, 1.0])),
            output: &DMatrix::from_row_slice(1, 2, &[1.0, 1.0]),
            gain: &DMatrix::from_column_slice(2, 1, &[1.0, 0.0]),
            innovation: &DVector::from_element(1, sample.value - self.error),
            innovation_covariance: &DMatrix::from_element(1, 1, self.variance),
            outputs: &[0],
        });
        self.error = sample.value;
        self.variance = 0.0;
    }
}

#[test]
fn a_ramp_in_coloured_residuals_is_a_state_ramp_of_a_filter_that_models_the_colour() {
    let noise = Noise::ornstein_uhlenbeck(0.3, 10_800.0);
    let settings = GlrSettings { side: Side::Above, window: 200, ..GlrSettings::new(Shape::Ramp, noise) };
    let mut glr = Glr::try_new(settings).unwrap();
    let ramp = Failure::StateRamp(vec![0.0, 1.0]);
    let mut failure = FailureGlr::try_new(ramp, 2, Side::Above, 200, 8).unwrap();
    let mut filter = Filter { error: 0.0, variance: 0.09, last_s: None };
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let (mut time_s, mut error) = (0.0, 0.3 * random.sample::<f64, _>(StandardNormal));
    for n in 0..400 {
        let sample = Residual { time_s, value: error + 2e-5 * (time_s - 5e5).max(0.0) };
        let by_whitening = glr.update(sample);
        filter.step(noise, sample, |step| {
            failure.update(step).unwrap();
        });
        assert_relative_eq!(by_whitening, failure.value(), max_relative = 1e-7, epsilon = 1e-9);
        if n > 10 && glr.finding().is_some() {
            let (a, b) = (glr.finding().unwrap(), failure.finding().unwrap());
            assert_relative_eq!(a.size, b.size, max_relative = 1e-7);
            assert_relative_eq!(a.size_sd.powi(2), b.size_variance, max_relative = 1e-7);
            assert_eq!(a.onset_s, b.onset_s);
        }
        // Intervals from minutes to hours.
        let interval_s = 60.0 * (1.0 + 100.0 * random.random::<f64>().powi(2));
        let phi = noise.correlation(interval_s);
        error = phi * error + 0.3 * (1.0 - phi * phi).sqrt() * random.sample::<f64, _>(StandardNormal);
        time_s += interval_s;
    }
    assert!(glr.value() > 20.0, "the ramp was found: {}", glr.value());
}

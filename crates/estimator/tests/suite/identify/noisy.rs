//! Six records with noise on input and output, on which a method that ignores the input's noise is biased more and more.
use cylwatch_estimator::consistency::Coverage;
use cylwatch_estimator::identify::{
    Data, Hold, Identified, IdentifyError, InputModel, Interval, Method, Parameter, Settings, Structure,
    identify,
};
use cylwatch_thermal::units::HOUR_S;
use rayon::prelude::*;

use super::system::{System, normal, random};

/// Course of the true input, °C.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Course {
    /// A new level about every half hour.
    Steps,
    /// Ornstein-Uhlenbeck process of this time constant, s, with a standard deviation of 10 K.
    Wander(f64),
    /// A day's wave of 10 K with one of two hours and 2 K.
    Day,
}

/// A record.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Case {
    pub name: &'static str,
    pub course: Course,
    pub interval_s: f64,
    pub duration_s: f64,
    /// Standard deviations of the sensors' noise, K.
    pub input_sd: f64,
    pub output_sd: f64,
}

/// The six records.
pub(crate) const CASES: [Case; 6] = [
    case("steps, 10 s, 0.5 K", Course::Steps, 10.0, 13.0, 0.5),
    case("wander, 10 s, 0.5 K", Course::Wander(1800.0), 10.0, 24.0, 0.5),
    case("wander, 60 s, 0.5 K", Course::Wander(1800.0), 60.0, 24.0, 0.5),
    case("wander, 60 s, 2 K", Course::Wander(1800.0), 60.0, 24.0, 2.0),
    case("wander, 300 s, 2 K", Course::Wander(1800.0), 300.0, 48.0, 2.0),
    case("day, 60 s, 0.5 K", Course::Day, 60.0, 24.0, 0.5),
];

const fn case(name: &'static str, course: Course, interval_s: f64, hours: f64, input_sd: f64) -> Case {
    Case { name, course, interval_s, duration_s: hours * HOUR_S, input_sd, output_sd: 0.3 }
}

impl Case {
    /// Times of the samples, s.
    pub(crate) fn times(&self) -> Vec<f64> {
        let samples = (self.duration_s / self.interval_s).round() as usize + 1;
        (0..samples).map(|k| k as f64 * self.interval_s).collect()
    }

    /// Variances of input and output noise.
    pub(crate) fn variances(&self) -> (f64, f64) {
        (self.input_sd.powi(2), self.output_sd.powi(2))
    }

    /// A record with fresh noise, and readings of a second sensor of the input, just as noisy.
    pub(crate) fn record(&self, seed: u64) -> (Data, Vec<f64>) {
        let mut random = random(seed);
        let time_s = self.times();
        let (mut wander, mut level) = (10.0 * normal(&mut random), 20.0);
        let truth: Vec<f64> = time_s
            .iter()
            .map(|t| match self.course {
                Course::Steps => {
                    if t % (0.5 * HOUR_S) < 0.5 * self.interval_s {
                        level = 20.0 + 15.0 * normal(&mut random);
                    }
                    level
                }
                Course::Wander(tau_s) => {
                    let kept = (-self.interval_s / tau_s).exp();
                    wander = kept * wander + 10.0 * (1.0 - kept * kept).sqrt() * normal(&mut random);
                    wander
                }
                Course::Day => {
                    let wave = |period_h: f64| (std::f64::consts::TAU * t / (period_h * HOUR_S)).sin();
                    10.0 * wave(24.0) + 2.0 * wave(2.0)
                }
            })
            .collect();
        let output = published_response(self.interval_s, &truth);
        let mut noisy = |values: &[f64], sd: f64| -> Vec<f64> {
            values.iter().map(|value| value + sd * normal(&mut random)).collect()
        };
        let (input, second) = (noisy(&truth, self.input_sd), noisy(&truth, self.input_sd));
        let output = noisy(&output, self.output_sd);
        (Data::try_new(time_s, input, output, Hold::First).unwrap(), second)
    }

    /// The method that knows this record's noise.
    pub(crate) fn compensated(&self) -> Method {
        let (input_variance, output_variance) = self.variances();
        Method::BiasCompensated { input_variance, output_variance }
    }

    /// The method that knows the input's kind as well.
    pub(crate) fn likely(&self, input_model: InputModel) -> Method {
        let (input_variance, output_variance) = self.variances();
        Method::MaximumLikelihood { input_variance, output_variance, input_model }
    }
}

/// Response of the published system from rest, by the recursion for straight inputs.
fn published_response(interval_s: f64, input: &[f64]) -> Vec<f64> {
    let System { poles, residues, .. } = System::published();
    let (a, b) = (-poles[0].re, residues[0].re);
    let alpha = (-a * interval_s).exp();
    let phi0 = (1.0 - alpha) / a;
    let phi1 = (1.0 - phi0 / interval_s) / a;
    let mut y = 0.0;
    let mut output = vec![0.0];
    for pair in input.windows(2) {
        y = alpha * y + b * ((phi0 - phi1) * pair[0] + phi1 * pair[1]);
        output.push(y);
    }
    output
}

/// Errors of one quantity over many runs.
#[derive(Clone, Debug, Default)]
pub(crate) struct Errors {
    pub relative: Vec<f64>,
    pub coverage: Coverage,
}

impl Errors {
    fn add(&mut self, interval: Interval, truth: f64) {
        self.relative.push(interval.value / truth - 1.0);
        self.coverage.samples += 1;
        self.coverage.inside += u64::from(interval.contains(truth));
    }

    /// Mean relative error with its standard deviation, and the standard deviation of one run.
    pub(crate) fn bias(&self) -> (f64, f64, f64) {
        let n = self.relative.len() as f64;
        let mean = self.relative.iter().sum::<f64>() / n;
        let variance = self.relative.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / (n - 1.0);
        (mean, (variance / n).sqrt(), variance.sqrt())
    }
}

/// Pole and gain over many runs, and how many runs failed.
#[derive(Clone, Debug, Default)]
pub(crate) struct Study {
    pub pole: Errors,
    pub gain: Errors,
    pub failures: Vec<IdentifyError>,
}

/// Identify many records of a case.
pub(crate) fn study(
    case: &Case,
    seeds: std::ops::Range<u64>,
    method: impl Fn(&[f64]) -> Method + Sync,
) -> Study {
    let one = |seed: u64| -> Result<Identified, IdentifyError> {
        let (data, second) = case.record(seed);
        identify(&data, &Structure::new(1, 0), &method(&second), &Settings::default())
    };
    let runs: Vec<_> = seeds.into_par_iter().map(one).collect();
    let (num, den) = System::published().coefficients(0);
    let mut study = Study::default();
    for run in runs {
        match run {
            Ok(found) => {
                study.pole.add(found.interval(Parameter::Denominator(0)).unwrap(), den[1]);
                study.gain.add(found.derived.gain, num[0] / den[1]);
            }
            Err(error) => study.failures.push(error),
        }
    }
    study
}

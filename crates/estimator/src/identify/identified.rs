//! What an identification returns.
use nalgebra::{Complex, DMatrix, DVector};
use serde::Serialize;
use statrs::distribution::{ContinuousCDF, StudentsT};

use super::model::{evaluate, poles};
use super::statistics::{Residuals, Statistics};
use super::{Model, Parameter};

/// A number with its standard deviation and 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Interval {
    /// Value.
    pub value: f64,
    /// Standard deviation.
    pub sd: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end of the interval.
    pub high: f64,
}

impl Interval {
    pub(super) fn new(value: f64, sd: f64, quantile: f64) -> Self {
        Self { value, sd, low: value - quantile * sd, high: value + quantile * sd }
    }

    /// Whether a value lies in the interval.
    pub fn contains(&self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }
}

/// Half width of a 95 % interval in standard deviations, by Student's distribution.
pub(super) fn quantile(degrees: usize) -> f64 {
    StudentsT::new(0.0, 1.0, degrees.max(1) as f64).map_or(f64::NAN, |student| student.inverse_cdf(0.975))
}

/// A free parameter with its interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// Which one.
    pub parameter: Parameter,
    /// Its value and interval.
    pub interval: Interval,
}

/// A pole with intervals.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Pole {
    /// Real part, 1/s.
    pub real_per_s: Interval,
    /// Imaginary part, 1/s; zero without uncertainty for a real pole.
    pub imaginary_per_s: Interval,
    /// Time constant `-1/Re`, s.
    pub time_constant_s: Interval,
}

/// Intervals of gain and poles by the delta method: exact to first order in the parameters' errors.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Derived {
    /// Steady-state gain.
    pub gain: Interval,
    /// Poles, slowest first.
    pub poles: Vec<Pole>,
}

/// Something to know before the result is used.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Caution {
    /// The errors are not white: their covariance was estimated together with their correlation.
    ColouredErrors {
        /// Probability of white errors to be as correlated.
        whiteness: f64,
    },
    /// The errors correlate with the input at lags of zero or more: the structure does not hold all of the dynamics.
    DynamicsLeft {
        /// Lag of the largest correlation, samples.
        lag: usize,
        /// That correlation.
        correlation: f64,
        /// Its 99 % bound.
        bound: f64,
    },
    /// The errors correlate with later inputs: feedback, or times that do not fit.
    Feedback {
        /// Lead of the input, samples.
        lead: usize,
        /// That correlation.
        correlation: f64,
        /// Its 99 % bound.
        bound: f64,
    },
    /// Samples of the output that were outside the input's record or missing.
    SamplesLeftOut {
        /// Number of rows without a usable output.
        rows: usize,
    },
}

/// An identified model.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Identified {
    /// The model.
    pub model: Model,
    /// Free parameters with their intervals, in SI units of the data.
    pub parameters: Vec<Estimate>,
    /// Their covariance, row by row: (parameters, parameters).
    pub covariance: Vec<Vec<f64>>,
    /// Gain and poles with their intervals.
    pub derived: Derived,
    /// Figures of merit of the simulation from the measured input.
    pub statistics: Statistics,
    /// Errors of that simulation.
    pub residuals: Residuals,
    /// Free response and its derivatives at the start, as estimated or assumed.
    pub initial: Vec<f64>,
    /// Iterations.
    pub iterations: usize,
    /// What to know.
    pub cautions: Vec<Caution>,
}

impl Identified {
    /// A parameter's value and interval; `None` if it was not free.
    pub fn interval(&self, parameter: Parameter) -> Option<Interval> {
        self.parameters.iter().find(|estimate| estimate.parameter == parameter).map(|e| e.interval)
    }
}

/// Intervals of gain and poles. `covariance` is of `parameters`; a fixed gain has no uncertainty.
pub(super) fn derive(
    model: &Model,
    parameters: &[Parameter],
    covariance: &DMatrix<f64>,
    quantile: f64,
) -> Derived {
    let a: Vec<f64> = model.den[1..].iter().rev().copied().collect();
    let sd = |gradient: &dyn Fn(Parameter) -> f64| {
        let g = DVector::from_iterator(parameters.len(), parameters.iter().map(|p| gradient(*p)));
        g.dot(&(covariance * &g)).max(0.0).sqrt()
    };
    let gain = model.gain();
    let fixed = !parameters.contains(&Parameter::Numerator(0));
    let gain_sd = sd(&|parameter| match parameter {
        Parameter::Numerator(0) => 1.0 / a[0],
        Parameter::Denominator(0) if !fixed => -gain / a[0],
        _ => 0.0,
    });
    let pole = |p: &Complex<f64>| {
        // d p/d a_i = -p^i / den'(p).
        let slope = evaluate(&a, *p).1;
        let by = |parameter: Parameter| match parameter {
            Parameter::Denominator(i) => -p.powi(i as i32) / slope,
            _ => Complex::new(0.0, 0.0),
        };
        let (re, im) = (sd(&|parameter| by(parameter).re), sd(&|parameter| by(parameter).im));
        Pole {
            real_per_s: Interval::new(p.re, re, quantile),
            imaginary_per_s: Interval::new(p.im, if p.im == 0.0 { 0.0 } else { im }, quantile),
            time_constant_s: Interval::new(-1.0 / p.re, re / (p.re * p.re), quantile),
        }
    };
    Derived {
        gain: Interval::new(gain, if fixed { 0.0 } else { gain_sd }, quantile),
        poles: poles(&a).iter().map(pole).collect(),
    }
}

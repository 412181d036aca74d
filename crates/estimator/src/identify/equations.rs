//! One linear system of equations for the next step of every iterative method:
//!
//! `(sum_k z_k phi_k^T - R) step = sum_k z_k e_k - r`,  `e_k = y_k - x_k`
//!
//! | method | instruments `z` | regressors `phi` | compensation `R, r` |
//! |---|---|---|---|
//! | output error (Gauss-Newton) | derivatives of `x` | derivatives of `x` | none |
//! | refined instrumental variables | derivatives of `x` | from the measured output | none |
//! | instruments from a second input | derivatives of `x` for the second input | from the measured output | none |
//! | bias-compensated least squares | from the measured output | from the measured output | moments of both noises |
//! | bias-compensated instruments | derivatives of `x` | from the measured output | moments of the input's noise |
//!
//! *From the measured output*: the derivative by `a_i` is `-s^i/a(s)` of the measured output. That output is known at its samples
//! only; between them it is taken as the model's response plus a straight line of what the model leaves,
//! `s^i/a(s) y = v_i + s^i/a(s) e`. With the usual straight line of `y` itself the filters would be wrong by the curvature of the
//! response within an interval, so that coarse sampling biases even noise-free data; here they are exact once the model is.
//! The equation error at the present parameters is then `e` itself, and refined instrumental variables settle where the derivatives
//! are orthogonal to the errors: at a minimum of the output error.
//!
//! Source: Young and Jakeman 1980, Garnier, Mensler and Richard 2003, Söderström 2007.
use nalgebra::{DMatrix, DVector};

use super::compensation::{Instruments, NoiseMoments, Variances, noise_moments};
use super::parametrisation::{Coefficients, Parametrisation};
use super::problem::Problem;
use super::response::{filter_output, respond};
use super::schedule::Schedule;

/// Which system of equations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Scheme {
    OutputError,
    RefinedInstruments,
    SecondInput,
    CompensatedSquares(Variances),
    /// The variance of the input's noise.
    CompensatedInstruments(f64),
}

/// The system at some parameters.
#[derive(Clone, Debug)]
pub(super) struct Equations {
    /// Left side: (parameters, parameters).
    pub matrix: DMatrix<f64>,
    /// Right side: (parameters).
    pub rhs: DVector<f64>,
    /// Instruments: (parameters, samples).
    pub instruments: DMatrix<f64>,
    /// Errors `e`, one per sample.
    pub errors: DVector<f64>,
    /// Sum of their squares.
    pub sse: f64,
}

impl Equations {
    pub(super) fn new(
        problem: &Problem,
        parametrisation: &Parametrisation,
        theta: &[f64],
        scheme: Scheme,
    ) -> Self {
        let k = parametrisation.expand(theta);
        let schedule = Schedule::new(problem, k.dead_time);
        let transform = parametrisation.jacobian(theta);
        let mut response = respond(problem, &schedule, &problem.u, &k);
        let errors = DVector::from_iterator(
            problem.samples(),
            problem.y.iter().zip(&response.y).map(|(y, model)| y - model),
        );
        let derivatives = |columns: &DMatrix<f64>| transform.tr_mul(columns);
        let ideal = derivatives(&response.columns);
        if scheme == Scheme::OutputError {
            return Self {
                matrix: &ideal * ideal.transpose(),
                rhs: &ideal * &errors,
                sse: errors.norm_squared(),
                instruments: ideal,
                errors,
            };
        }
        add_filtered_errors(problem, &k, &errors, &mut response.columns);
        let measured = derivatives(&response.columns);
        match scheme {
            Scheme::OutputError | Scheme::RefinedInstruments => Self::assemble(&measured, ideal, errors),
            Scheme::SecondInput => {
                let second = problem.second.as_deref().unwrap_or(&problem.u);
                let columns = respond(problem, &schedule, second, &k).columns;
                Self::assemble(&measured, derivatives(&columns), errors)
            }
            Scheme::CompensatedSquares(variances) => {
                let noise = noise_moments(problem, &schedule, &k, variances, Instruments::Regressors);
                Self::assemble(&measured, measured.clone(), errors).less(noise, &transform)
            }
            Scheme::CompensatedInstruments(input) => {
                let variances = Variances { input, output: 0.0 };
                let noise = noise_moments(problem, &schedule, &k, variances, Instruments::Model);
                Self::assemble(&measured, ideal, errors).less(noise, &transform)
            }
        }
    }

    /// Take the noise's part off.
    fn less(mut self, noise: NoiseMoments, transform: &DMatrix<f64>) -> Self {
        self.matrix -= transform.tr_mul(&(noise.square * transform));
        self.rhs -= transform.tr_mul(&noise.with_error);
        self
    }

    fn assemble(regressors: &DMatrix<f64>, instruments: DMatrix<f64>, errors: DVector<f64>) -> Self {
        Self {
            matrix: &instruments * regressors.transpose(),
            rhs: &instruments * &errors,
            sse: errors.norm_squared(),
            instruments,
            errors,
        }
    }
}

/// Turn the derivatives by the denominator into those from the measured output.
fn add_filtered_errors(
    problem: &Problem,
    k: &Coefficients,
    errors: &DVector<f64>,
    columns: &mut DMatrix<f64>,
) {
    let filtered = filter_output(problem, k, errors.as_slice());
    for (mut row, q) in columns.column_iter_mut().zip(filtered.column_iter()) {
        for i in 0..k.order {
            row[i] -= q[i];
        }
    }
}

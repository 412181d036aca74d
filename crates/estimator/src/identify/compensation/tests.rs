//! The recursion against the closed form for first-order filters, and against the noise sample by sample.
use approx::assert_relative_eq;

use super::*;
use crate::identify::Data;
use crate::identify::response::{filter_output, respond};

fn problem(hold: Hold, samples: usize, wobble: f64) -> Problem {
    let time = |k: usize| k as f64 + wobble * (k as f64 * 1.3).sin();
    let time_s = (0..samples).map(time).collect();
    let input = (0..samples).map(|k| (k as f64 * 0.7).sin()).collect();
    // Every seventh output is missing where the samples wobble.
    let missing = |k: usize| wobble > 0.0 && k % 7 == 3;
    let output = (0..samples).map(|k| if missing(k) { f64::NAN } else { (k as f64 * 0.2).cos() }).collect();
    let data = Data::try_new(time_s, input, output, hold).unwrap();
    let mut problem = Problem::new(&data, None, None, 0).unwrap();
    problem.rescale(1.0 / problem.units.time_s);
    problem
}

fn coefficients(a: &[f64], b: &[f64]) -> Coefficients {
    let mut k = Coefficients {
        order: a.len(),
        a: [0.0; 3],
        b: [0.0; 3],
        c: [0.0; 3],
        offset: 0.0,
        dead_time: 0.0,
        delay_free: false,
        settled: false,
    };
    k.a[..a.len()].copy_from_slice(a);
    k.b[..b.len()].copy_from_slice(b);
    k
}

#[test]
fn a_first_order_filter_has_its_closed_form() {
    // Through 1/(s + lambda) and straight between regular samples: p = e^(-lambda T), weights g0 and g1 of the older and
    // the newer sample, variance g1^2 + (g0 + p g1)^2/(1 - p^2).
    let (lambda, samples) = (0.31, 4000);
    let problem = problem(Hold::First, samples, 0.0);
    let schedule = Schedule::new(&problem, 0.0);
    let variances = Variances { input: 0.25, output: 0.09 };
    // Without a numerator the response is zero, and the errors are the output.
    let k = coefficients(&[lambda], &[0.0]);
    let moments = noise_moments(&problem, &schedule, &k, variances, Instruments::Regressors);
    let p = (-lambda).exp();
    let phi0 = (1.0 - p) / lambda;
    let g1 = (1.0 - phi0) / lambda;
    let g0 = phi0 - g1;
    let variance = g1 * g1 + (g0 + p * g1).powi(2) / (1.0 - p * p);
    let n = samples as f64;
    // The first samples are not yet stationary: some ten of four thousand.
    assert_relative_eq!(moments.square[(0, 0)] / n, variances.output * variance, max_relative = 2e-3);
    assert_relative_eq!(moments.square[(1, 1)] / n, variances.input * variance, max_relative = 2e-3);
    assert_relative_eq!(moments.with_error[0] / n, -g1 * variances.output, max_relative = 2e-3);
    assert_relative_eq!(moments.square[(0, 1)], 0.0, epsilon = 1e-9);
}

#[test]
fn the_recursion_is_the_sum_over_all_noise_samples() {
    let variances = Variances { input: 0.25, output: 0.09 };
    let models = [
        coefficients(&[0.4], &[0.5]),
        coefficients(&[0.3, 1.1], &[0.4, 0.2]),
        coefficients(&[0.1, 0.7, 1.2], &[0.2, -0.3, 0.1]),
    ];
    for hold in [Hold::First, Hold::Zero] {
        for (k, dead_time) in models.iter().flat_map(|k| [0.0, 0.4, 1.7].map(|dead_time| (k, dead_time))) {
            for instruments in [Instruments::Regressors, Instruments::Model] {
                let problem = problem(hold, 24, 0.2);
                let schedule = Schedule::new(&problem, dead_time);
                let found = noise_moments(&problem, &schedule, k, variances, instruments);
                let (square, with_error) = dense(&problem, &schedule, k, variances, instruments);
                assert_relative_eq!(found.square, square, epsilon = 1e-12);
                assert_relative_eq!(found.with_error, with_error, epsilon = 1e-12);
            }
        }
    }
}

/// One noise sample at a time through response and filter.
fn dense(
    problem: &Problem,
    schedule: &Schedule,
    k: &Coefficients,
    variances: Variances,
    instruments: Instruments,
) -> (DMatrix<f64>, DVector<f64>) {
    let n = k.order;
    let (mut square, mut with_error) = (DMatrix::zeros(k.width(), k.width()), DVector::zeros(k.width()));
    let mut add = |u: &[f64], y: &[f64], variance: f64| {
        let response = respond(problem, schedule, u, k);
        let errors: Vec<f64> = y.iter().zip(&response.y).map(|(y, model)| y - model).collect();
        let filtered = filter_output(problem, k, &errors);
        for sample in 0..y.len() {
            // What does not depend on the noise is no part of it.
            let mut model = response.columns.column(sample).into_owned();
            model.rows_mut(2 * n, n + 2).fill(0.0);
            let mut measured = model.clone();
            (0..n).for_each(|i| measured[i] -= filtered[(i, sample)]);
            let z = if instruments == Instruments::Model { &model } else { &measured };
            square += z * measured.transpose() * variance;
            with_error += z * (errors[sample] * variance);
        }
    };
    let (inputs, outputs) = (problem.u.len(), problem.y.len());
    let unit =
        |length: usize, at: usize| (0..length).map(|i| f64::from(u8::from(i == at))).collect::<Vec<_>>();
    for at in 0..inputs {
        add(&unit(inputs, at), &vec![0.0; outputs], variances.input);
    }
    for at in 0..outputs {
        add(&vec![0.0; inputs], &unit(outputs, at), variances.output);
    }
    (square, with_error)
}

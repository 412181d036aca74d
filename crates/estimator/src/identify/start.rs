//! A first model: least squares on signals through state-variable filters.
//!
//! With `E(s) = (s + lambda)^n`, `A(s)/E(s) y = B(s)/E(s) u + C(s)/E(s) + A(s)/E(s) d` is linear in the coefficients; the
//! signals through `s^i/E(s)` need no derivatives of the data. Bandwidths `lambda` over all that the record can show are tried, each
//! estimate is simulated, and the one with the least output error is taken. In the place of an unstable estimate stands the filter
//! itself with the best numerator, so that there always is a stable one.
//!
//! Source: Young 1981, Garnier, Mensler and Richard 2003.
use nalgebra::{DMatrix, DVector};

use super::parametrisation::{Coefficients, HIGHEST, Parametrisation};
use super::problem::Problem;
use super::response::{Response, filter_output, respond};
use super::schedule::Schedule;
use super::{DeadTime, Gain, IdentifyError, InitialState, Parameter};
use crate::least_squares::solve;

/// Bandwidths tried.
const BANDWIDTHS: usize = 6;
/// Dead times tried, the ends of the range included.
const DEAD_TIMES: usize = 25;
/// The slowest bandwidth has its time constant in the record, the fastest in the sampling interval, this many times.
const SLOWEST: f64 = 2.0;
const FASTEST: f64 = 0.7;
/// Share of the diagonal that keeps nearly dependent columns apart; it leaves a start a start.
const RIDGE: f64 = 1e-12;

/// A candidate in the record's units.
#[derive(Clone, Debug)]
pub(super) struct Start {
    pub theta: Vec<f64>,
    /// Bandwidth of its filter.
    pub bandwidth: f64,
    pub sse: f64,
}

/// The best start for a problem.
pub(super) fn best(problem: &Problem, parametrisation: &Parametrisation) -> Result<Start, IdentifyError> {
    let (slow, fast) = (SLOWEST / problem.duration(), FASTEST / problem.interval());
    let ratio = (fast / slow).max(1.0).powf(1.0 / (BANDWIDTHS - 1) as f64);
    let bandwidths: Vec<f64> = (0..BANDWIDTHS).map(|i| slow * ratio.powi(i as i32)).collect();
    let over = |bandwidths: &[f64], dead_time: f64| {
        let schedule = Schedule::new(problem, dead_time);
        let one = |&lambda: &f64| candidate(problem, parametrisation, &schedule, lambda, dead_time);
        least(bandwidths.iter().filter_map(one).collect())
    };
    let longest = match parametrisation.structure.dead_time {
        DeadTime::None => return over(&bandwidths, 0.0),
        DeadTime::Fixed(dead_time) => return over(&bandwidths, dead_time),
        DeadTime::Free(longest) => longest,
    };
    let delays: Vec<f64> = (0..DEAD_TIMES).map(|i| longest * i as f64 / (DEAD_TIMES - 1) as f64).collect();
    let rough = least(delays.iter().step_by(6).filter_map(|&d| over(&bandwidths, d).ok()).collect())?;
    let near = [rough.bandwidth];
    let fine = delays.iter().filter_map(|&d| over(&near, d).ok());
    least(fine.chain([rough.clone()]).collect())
}

fn least(candidates: Vec<Start>) -> Result<Start, IdentifyError> {
    let best = candidates.into_iter().filter(|c| c.sse.is_finite()).min_by(|a, b| a.sse.total_cmp(&b.sse));
    best.ok_or(IdentifyError::NotConverged {
        method: "state-variable filter",
        iterations: BANDWIDTHS,
        step: f64::INFINITY,
    })
}

/// The estimate through one filter.
fn candidate(
    problem: &Problem,
    parametrisation: &Parametrisation,
    schedule: &Schedule,
    bandwidth: f64,
    dead_time: f64,
) -> Option<Start> {
    let n = parametrisation.structure.order;
    let mut filter = [0.0; HIGHEST];
    let binomials: &[f64] = [&[1.0][..], &[1.0, 2.0], &[1.0, 3.0, 3.0]][n - 1];
    for (i, binomial) in binomials.iter().enumerate() {
        filter[i] = binomial * bandwidth.powi((n - i) as i32);
    }
    let a = denominator(problem, parametrisation, schedule, filter).unwrap_or(filter);
    let (theta, sse) = with_denominator(problem, parametrisation, schedule, a, dead_time)?;
    Some(Start { theta, bandwidth, sse })
}

/// Denominator by least squares through the filter.
fn denominator(
    problem: &Problem,
    parametrisation: &Parametrisation,
    schedule: &Schedule,
    filter: [f64; HIGHEST],
) -> Option<[f64; HIGHEST]> {
    let structure = &parametrisation.structure;
    let n = structure.order;
    let k = Coefficients {
        order: n,
        a: filter,
        b: [0.0; HIGHEST],
        c: [0.0; HIGHEST],
        offset: 0.0,
        dead_time: 0.0,
        delay_free: false,
        settled: false,
    };
    let signals = respond(problem, schedule, &problem.u, &k).columns;
    let output = filter_output(problem, &k, &problem.y);
    let step = filter_output(problem, &k, &vec![1.0; problem.samples()]);
    let w = |j: usize| signals.row(k.numerator_at() + j).transpose();
    let mut columns: Vec<DVector<f64>> = (0..n).map(|i| -output.row(i).transpose()).collect();
    let fixed = match structure.gain {
        Gain::Fixed(gain) => {
            columns[0] += w(0) * gain;
            1
        }
        Gain::Free => 0,
    };
    columns.extend((fixed..=structure.zeros).map(w));
    if structure.initial != InitialState::Zero || structure.offset {
        columns.extend((0..n).map(|i| signals.row(k.initial_at() + i).transpose()));
    }
    if structure.offset {
        columns.push(step.row(0).transpose());
    }
    let regressors = DMatrix::from_columns(&columns);
    let filtered = DVector::from_fn(problem.samples(), |sample, _| {
        problem.y[sample] - (0..n).map(|i| filter[i] * output[(i, sample)]).sum::<f64>()
    });
    let solution = least_squares(&regressors, &filtered)?;
    let mut a = [0.0; HIGHEST];
    a[..n].copy_from_slice(&solution.as_slice()[..n]);
    Coefficients { a, ..k }.is_stable().then_some(a)
}

/// All parameters, and the sum of squared errors, for a given denominator: the rest is linear.
pub(super) fn with_denominator(
    problem: &Problem,
    parametrisation: &Parametrisation,
    schedule: &Schedule,
    a: [f64; HIGHEST],
    dead_time: f64,
) -> Option<(Vec<f64>, f64)> {
    let parameters = &parametrisation.parameters;
    let mut theta: Vec<f64> = parameters
        .iter()
        .map(|parameter| match *parameter {
            Parameter::Denominator(i) => a[i],
            Parameter::DeadTime => dead_time,
            _ => 0.0,
        })
        .collect();
    let is_linear = |parameter: &Parameter| {
        matches!(parameter, Parameter::Numerator(_) | Parameter::Initial(_) | Parameter::Offset)
    };
    let linear: Vec<usize> = (0..parameters.len()).filter(|&i| is_linear(&parameters[i])).collect();
    let Response { y, columns } = respond(problem, schedule, &problem.u, &parametrisation.expand(&theta));
    let mut errors = DVector::from_iterator(y.len(), problem.y.iter().zip(&y).map(|(y, model)| y - model));
    if !linear.is_empty() {
        let transform = parametrisation.jacobian(&theta).select_columns(&linear);
        let regressors = columns.tr_mul(&transform);
        let solution = least_squares(&regressors, &errors)?;
        errors -= &regressors * &solution;
        for (&at, &value) in linear.iter().zip(solution.iter()) {
            theta[at] = value;
        }
    }
    let sse = errors.norm_squared();
    sse.is_finite().then_some((theta, sse))
}

fn least_squares(regressors: &DMatrix<f64>, values: &DVector<f64>) -> Option<DVector<f64>> {
    let mut square = regressors.tr_mul(regressors);
    for i in 0..square.nrows() {
        square[(i, i)] *= 1.0 + RIDGE;
    }
    solve(&square, &regressors.tr_mul(values))
}

/// Parameters with the free response at the start that fits best; without one to fit, as they were.
pub(super) fn with_initial_response(
    problem: &Problem,
    parametrisation: &Parametrisation,
    theta: &[f64],
) -> Option<Vec<f64>> {
    let mut theta = theta.to_vec();
    let free: Vec<usize> = (0..parametrisation.structure.order)
        .filter_map(|i| parametrisation.position(Parameter::Initial(i)))
        .collect();
    if free.is_empty() {
        return Some(theta);
    }
    free.iter().for_each(|&at| theta[at] = 0.0);
    let k = parametrisation.expand(&theta);
    let schedule = Schedule::new(problem, k.dead_time);
    let Response { y, columns } = respond(problem, &schedule, &problem.u, &k);
    let errors = DVector::from_iterator(y.len(), problem.y.iter().zip(&y).map(|(y, model)| y - model));
    let regressors = columns.tr_mul(&parametrisation.jacobian(&theta).select_columns(&free));
    let solution = least_squares(&regressors, &errors)?;
    for (&at, &value) in free.iter().zip(solution.iter()) {
        theta[at] = value;
    }
    Some(theta)
}

//! An estimate in the units of the data, with what there is to know about it.
use nalgebra::DMatrix;

use super::identified::{derive, quantile};
use super::parametrisation::Parametrisation;
use super::problem::Problem;
use super::schedule::Schedule;
use super::solve::{Search, Solution};
use super::statistics::{Residuals, Statistics};
use super::{Caution, Data, Estimate, Identified, InitialState, Interval, Model, Parameter};

/// Correlations are judged at all lags together: this many times the bound of one lag.
const ALL_LAGS: f64 = 1.5;

/// Parameters of the structure with their covariance, perhaps with one more parameter.
pub(super) struct Found {
    pub solution: Solution,
    pub covariance: DMatrix<f64>,
    pub residuals: Residuals,
    /// Logarithm of the intensity of the input's course.
    pub intensity: Option<f64>,
    pub coloured: bool,
}

/// Errors of the simulation in the units of the data, with the input at their times.
pub(super) fn residuals(search: &Search<'_>, solution: &Solution) -> Residuals {
    simulated_residuals(search.problem, solution.equations.errors.as_slice(), search.settings.lags)
}

/// The same of errors in the record's units.
pub(super) fn simulated_residuals(problem: &Problem, errors: &[f64], lags: usize) -> Residuals {
    let units = &problem.units;
    let mut input = vec![problem.u[0]; problem.samples()];
    for piece in &Schedule::new(problem, 0.0).pieces {
        if let Some(output) = piece.output {
            input[output] = piece.input(&problem.u).1;
        }
    }
    let time_s = problem.output_time.iter().map(|time| units.start_s + time * units.time_s).collect();
    let values = errors.iter().map(|error| error * units.output).collect();
    Residuals::new(time_s, values, &input, lags)
}

/// The result in the units of the data.
pub(super) fn report(data: &Data, search: &Search<'_>, found: Found) -> Identified {
    let (problem, parametrisation, solution) = (search.problem, search.parametrisation, &found.solution);
    let units = &problem.units;
    let t = quantile(problem.samples().saturating_sub(parametrisation.parameters.len()));
    let (parameters, covariance) = listed(search, &found, t);
    let model = model(search, &solution.theta);
    let kinds: Vec<Parameter> = parameters.iter().map(|estimate| estimate.parameter).collect();
    let residuals = &found.residuals;
    let output: Vec<f64> = problem.y.iter().map(|y| y * units.output).collect();
    Identified {
        derived: derive(&model, &kinds, &covariance, t),
        covariance: covariance.row_iter().map(|row| row.iter().copied().collect()).collect(),
        parameters,
        statistics: Statistics::new(&output, &residuals.values, parametrisation.parameters.len()),
        initial: initial(problem, parametrisation, &solution.theta),
        cautions: cautions(data, problem, residuals, found.coloured),
        model,
        iterations: solution.iterations,
        residuals: found.residuals,
    }
}

/// Free parameters with their intervals, and their covariance, in SI units.
fn listed(search: &Search<'_>, found: &Found, t: f64) -> (Vec<Estimate>, DMatrix<f64>) {
    let (parametrisation, units, theta) =
        (search.parametrisation, &search.problem.units, &found.solution.theta);
    // The initial response of the maximum likelihood is integrated out: it has no interval of its own.
    let integrated =
        |parameter: &Parameter| found.intensity.is_some() && matches!(parameter, Parameter::Initial(_));
    let mut listed: Vec<(Parameter, f64, usize)> = parametrisation
        .parameters
        .iter()
        .enumerate()
        .filter(|(_, parameter)| !integrated(parameter))
        .map(|(at, parameter)| (*parameter, theta[at], at))
        .collect();
    if let Some(logarithm) = found.intensity {
        listed.push((Parameter::LogIntensity, logarithm, theta.len()));
    }
    let unit: Vec<f64> = listed.iter().map(|(p, ..)| parametrisation.unit(*p, units)).collect();
    let covariance = DMatrix::from_fn(listed.len(), listed.len(), |i, j| {
        found.covariance[(listed[i].2, listed[j].2)] * unit[i] * unit[j]
    });
    let intensity_unit = units.input.powi(2) / units.time_s;
    let parameters = listed
        .iter()
        .enumerate()
        .map(|(i, &(parameter, value, _))| {
            let value = match parameter {
                Parameter::LogIntensity => value + intensity_unit.ln(),
                _ => value * unit[i],
            };
            Estimate { parameter, interval: Interval::new(value, covariance[(i, i)].sqrt(), t) }
        })
        .collect();
    (parameters, covariance)
}

fn model(search: &Search<'_>, theta: &[f64]) -> Model {
    let (parametrisation, units) = (search.parametrisation, &search.problem.units);
    let (k, structure) = (parametrisation.expand(theta), &parametrisation.structure);
    let si = |parameter: Parameter, value: f64| value * parametrisation.unit(parameter, units);
    let mut den = vec![1.0];
    den.extend((0..k.order).rev().map(|i| si(Parameter::Denominator(i), k.a[i])));
    Model {
        num: (0..=structure.zeros).rev().map(|j| si(Parameter::Numerator(j), k.b[j])).collect(),
        den,
        dead_time_s: si(Parameter::DeadTime, k.dead_time),
        offset: si(Parameter::Offset, k.offset),
    }
}

/// Free response and its derivatives at the start, in SI units.
pub(super) fn initial(problem: &Problem, parametrisation: &Parametrisation, theta: &[f64]) -> Vec<f64> {
    let units = &problem.units;
    let order = parametrisation.structure.order;
    let value = |i: usize| match &parametrisation.structure.initial {
        InitialState::Given(values) => values[i],
        InitialState::Estimated => {
            parametrisation.position(Parameter::Initial(i)).map_or(0.0, |at| theta[at])
        }
        InitialState::Zero => 0.0,
        InitialState::Settled if i == 0 => {
            let k = parametrisation.expand(theta);
            k.b[0] / k.a[0] * problem.u[0]
        }
        InitialState::Settled => 0.0,
    };
    (0..order).map(|i| value(i) * parametrisation.unit(Parameter::Initial(i), units)).collect()
}

fn cautions(data: &Data, problem: &Problem, residuals: &Residuals, coloured: bool) -> Vec<Caution> {
    let mut cautions = Vec::new();
    if coloured && !residuals.is_white() {
        cautions.push(Caution::ColouredErrors { whiteness: residuals.whiteness });
    }
    if coloured || !residuals.is_white() {
        cautions.extend(dynamics_left(residuals));
        cautions.extend(feedback(residuals));
    }
    let rows = data.time_s().len() - problem.samples();
    if rows > 0 {
        cautions.push(Caution::SamplesLeftOut { rows });
    }
    cautions
}

/// Largest correlation with the input over a range of positions, if it is beyond chance.
fn largest(residuals: &Residuals, range: std::ops::Range<usize>) -> Option<(usize, f64)> {
    range
        .map(|at| (at, residuals.input_correlation[at]))
        .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
        .filter(|(_, correlation)| correlation.abs() > ALL_LAGS * residuals.input_correlation_bound)
}

/// Whether the errors follow from the input.
fn dynamics_left(residuals: &Residuals) -> Option<Caution> {
    let (lags, bound) = (residuals.autocorrelation.len() - 1, residuals.input_correlation_bound);
    let (at, correlation) = largest(residuals, lags..2 * lags + 1)?;
    Some(Caution::DynamicsLeft { lag: at - lags, correlation, bound })
}

/// Whether the errors foretell the input.
pub(super) fn feedback(residuals: &Residuals) -> Option<Caution> {
    let (lags, bound) = (residuals.autocorrelation.len() - 1, residuals.input_correlation_bound);
    let (at, correlation) = largest(residuals, 0..lags)?;
    Some(Caution::Feedback { lead: lags - at, correlation, bound })
}

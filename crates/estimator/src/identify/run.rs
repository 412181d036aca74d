//! From data to a model: start, iterate, judge.
use std::sync::atomic::AtomicBool;

use super::checks::{check_derived, check_direction, check_parameters, check_poles};
use super::compensation::Variances;
use super::equations::{Equations, Scheme};
use super::likelihood::{Likelihood, without_intensity};
use super::model::poles;
use super::parametrisation::Parametrisation;
use super::problem::Problem;
use super::report::{Found, feedback, report, residuals};
use super::solve::{Search, Solution};
use super::start;
use super::statistics::Residuals;
use super::uncertainty::{coloured as coloured_covariance, white};
use super::{
    Data, DeadTime, ErrorModel, Identified, IdentifyError, Method, Settings, StartMethod, Structure,
};

/// Errors below this share of the output's spread are rounding.
const ROUNDING: f64 = 1e-9;

/// Identify a model of the given structure.
///
/// # Errors
/// The data, the structure or the method's numbers are unusable, or the data do not determine the model:
/// [`IdentifyError`] says which data would.
pub fn identify(
    data: &Data,
    structure: &Structure,
    method: &Method,
    settings: &Settings,
) -> Result<Identified, IdentifyError> {
    identify_until(data, structure, method, settings, &AtomicBool::new(false))
}

/// [`identify`] until `stop` is set, which each iteration looks at.
///
/// # Errors
/// Those of [`identify`]; [`IdentifyError::Stopped`].
pub fn identify_until(
    data: &Data,
    structure: &Structure,
    method: &Method,
    settings: &Settings,
    stop: &AtomicBool,
) -> Result<Identified, IdentifyError> {
    structure.validate()?;
    settings.validate()?;
    method.validate()?;
    check_support(structure, method)?;
    let parameters = structure.parameters().len();
    let mut problem = Problem::new(data, method.second(), settings.longest_gap_s, parameters)?;
    let start = first_model(&mut problem, structure)?;
    let parametrisation = Parametrisation::new(structure, &problem.units);
    let search = Search { problem: &problem, parametrisation: &parametrisation, settings, stop };
    let found = estimate(&search, start.theta, method).and_then(|found| {
        check_poles(&problem, &parametrisation.expand(&found.solution.theta))?;
        check_parameters(
            search.parametrisation,
            &search.problem.units,
            &found.solution.theta,
            &found.covariance,
        )?;
        Ok(found)
    });
    search.check_going()?;
    // A right direction leaves errors that do not foretell the input.
    let (sse, suspect) = match &found {
        Ok(found) => (found.solution.equations.sse, feedback(&found.residuals).is_some()),
        Err(_) => (start.sse, true),
    };
    if suspect {
        check_direction(data, structure, settings, (sse / problem.samples() as f64).sqrt())?;
    }
    let identified = report(data, &search, found?);
    check_derived(&identified.derived)?;
    Ok(identified)
}

fn check_support(structure: &Structure, method: &Method) -> Result<(), IdentifyError> {
    match (structure.dead_time, method) {
        (DeadTime::Free(_), Method::BiasCompensated { .. } | Method::CompensatedInstruments { .. }) => {
            Err(IdentifyError::Unsupported {
                method: "bias compensation",
                what: "a free dead time",
                remedy: "find it by output error, then fix it",
            })
        }
        _ => Ok(()),
    }
}

/// The best first model, in a unit of time that suits it.
fn first_model(problem: &mut Problem, structure: &Structure) -> Result<start::Start, IdentifyError> {
    let rough = Parametrisation::new(structure, &problem.units);
    let mut start = start::best(problem, &rough)?;
    let before = problem.units;
    problem.rescale(1.0 / start.bandwidth);
    for (value, parameter) in start.theta.iter_mut().zip(&rough.parameters) {
        *value *= rough.unit(*parameter, &before) / rough.unit(*parameter, &problem.units);
    }
    Ok(start)
}

fn estimate(search: &Search<'_>, start: Vec<f64>, method: &Method) -> Result<Found, IdentifyError> {
    let start = match search.settings.start {
        StartMethod::StateVariableFilter => start,
        StartMethod::InstrumentalVariables => search.improve_by_instruments(start),
    };
    let units = &search.problem.units;
    let scaled = |input: f64, output: f64| Variances {
        input: input / units.input.powi(2),
        output: output / units.output.powi(2),
    };
    match *method {
        Method::OutputError => judged(search, search.output_error(start)?),
        Method::RefinedInstruments => {
            let scheme = Scheme::RefinedInstruments;
            judged(search, search.fixed_point(start, scheme, "refined instrumental variables")?)
        }
        Method::SecondSensor { .. } => {
            let start = search.output_error(start)?.theta;
            correlated(search, search.fixed_point(start, Scheme::SecondInput, "second sensor")?)
        }
        Method::BiasCompensated { input_variance, output_variance } => {
            let scheme = Scheme::CompensatedSquares(scaled(input_variance, output_variance));
            correlated(search, compensated(search, start, scheme)?)
        }
        Method::CompensatedInstruments { input_variance } => {
            let scheme = Scheme::CompensatedInstruments(scaled(input_variance, 0.0).input);
            correlated(search, compensated(search, start, scheme)?)
        }
        Method::MaximumLikelihood { input_variance, output_variance, input_model } => {
            let variances = scaled(input_variance, output_variance);
            let first = match search.parametrisation.structure.dead_time {
                DeadTime::Free(_) => search.output_error(start)?,
                _ => compensated(search, start, Scheme::CompensatedInstruments(variances.input))?,
            };
            most_likely(search, &Likelihood { search: *search, variances, input_model }, &first)
        }
    }
}

/// Fixed point of compensated equations from the least output error.
fn compensated(search: &Search<'_>, start: Vec<f64>, scheme: Scheme) -> Result<Solution, IdentifyError> {
    let start = search.output_error(start)?.theta;
    // Where the stated noise is more than the data hold, what is left is no covariance.
    let left = |equations: &Equations| {
        let symmetric = (&equations.matrix + equations.matrix.transpose()) * 0.5;
        symmetric.cholesky().map(|_| ()).ok_or(IdentifyError::VarianceTooLarge)
    };
    left(&Equations::new(search.problem, search.parametrisation, &start, scheme))?;
    let solution = search.fixed_point(start, scheme, "bias compensation")?;
    left(&solution.equations)?;
    Ok(solution)
}

/// A least-squares result; its covariance depends on whether the errors are white.
fn judged(search: &Search<'_>, solution: Solution) -> Result<Found, IdentifyError> {
    let residuals = residuals(search, &solution);
    let exact = solution.equations.sse <= ROUNDING.powi(2) * search.problem.samples() as f64;
    let white_errors = match search.settings.errors {
        ErrorModel::White => true,
        ErrorModel::Coloured => false,
        ErrorModel::Judged => exact || residuals.is_white(),
    };
    if !white_errors {
        return coloured(search, solution, residuals);
    }
    let covariance = white(&solution.equations).ok_or_else(|| undetermined(search, &solution.theta))?;
    Ok(Found { solution, covariance, residuals, intensity: None, coloured: false })
}

/// A result whose errors are correlated whatever a test says.
fn correlated(search: &Search<'_>, solution: Solution) -> Result<Found, IdentifyError> {
    let residuals = residuals(search, &solution);
    coloured(search, solution, residuals)
}

/// A result whose errors are correlated over the slowest time constant.
fn coloured(search: &Search<'_>, solution: Solution, residuals: Residuals) -> Result<Found, IdentifyError> {
    let k = search.parametrisation.expand(&solution.theta);
    let slowest = poles(&k.a[..k.order])[0].norm();
    let interval = search.problem.duration() / search.problem.samples() as f64;
    let covariance = coloured_covariance(&solution.equations, 1.0 / (slowest * interval))
        .ok_or_else(|| undetermined(search, &solution.theta))?;
    Ok(Found { solution, covariance, residuals, intensity: None, coloured: true })
}

fn undetermined(search: &Search<'_>, theta: &[f64]) -> IdentifyError {
    let parameter = search.parametrisation.parameters[0];
    let value = theta[0] * search.parametrisation.unit(parameter, &search.problem.units);
    IdentifyError::NotDetermined { parameter, value, sd: f64::INFINITY }
}

/// The maximum of the likelihood, with the response at the start that fits it.
fn most_likely(
    search: &Search<'_>,
    likelihood: &Likelihood<'_>,
    first: &Solution,
) -> Result<Found, IdentifyError> {
    let maximum = likelihood.maximise(first)?;
    let theta = without_intensity(search.parametrisation, &maximum).to_vec();
    let theta = start::with_initial_response(search.problem, search.parametrisation, &theta)
        .ok_or_else(|| undetermined(search, &theta))?;
    let equations =
        super::equations::Equations::new(search.problem, search.parametrisation, &theta, Scheme::OutputError);
    let solution = Solution { theta, iterations: maximum.iterations, equations };
    Ok(Found {
        residuals: residuals(search, &solution),
        solution,
        covariance: maximum.covariance,
        intensity: maximum.theta.last().copied(),
        coloured: true,
    })
}

//! From data to a model: start, iterate, judge, report.
use nalgebra::DMatrix;

use super::checks::{check_derived, check_direction, check_parameters, check_poles};
use super::equations::{Equations, Scheme, Variances};
use super::identified::{derive, quantile};
use super::likelihood::{Likelihood, without_intensity};
use super::model::poles;
use super::parametrisation::Parametrisation;
use super::problem::Problem;
use super::schedule::Schedule;
use super::solve::{Search, Solution};
use super::start;
use super::statistics::{Residuals, Statistics};
use super::uncertainty::{coloured as coloured_covariance, white};
use super::{
    Caution, Data, DeadTime, ErrorModel, Estimate, Identified, IdentifyError, InitialState, Interval, Method,
    Model, Parameter, Settings, StartMethod, Structure,
};

/// Correlations are judged at all lags together: this many times the bound of one lag.
const ALL_LAGS: f64 = 1.5;
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
    structure.validate()?;
    settings.validate()?;
    method.validate()?;
    check_support(structure, method)?;
    let parameters = structure.parameters().len();
    let mut problem = Problem::new(data, method.second(), settings.longest_gap_s, parameters)?;
    let start = first_model(&mut problem, structure)?;
    let parametrisation = Parametrisation::new(structure, &problem.units);
    let search = Search { problem: &problem, parametrisation: &parametrisation, settings };
    let found = estimate(&search, start.theta, method).and_then(|found| {
        check_poles(&problem, &parametrisation.expand(&found.solution.theta))?;
        check_parameters(&search, &found.solution.theta, &found.covariance)?;
        Ok(found)
    });
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

/// Parameters of the structure with their covariance, perhaps with one more parameter.
struct Found {
    solution: Solution,
    covariance: DMatrix<f64>,
    residuals: Residuals,
    /// Logarithm of the intensity of the input's course.
    intensity: Option<f64>,
    coloured: bool,
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
        Method::MaximumLikelihood { input_variance, output_variance, course } => {
            let variances = scaled(input_variance, output_variance);
            let first = match search.parametrisation.structure.dead_time {
                DeadTime::Free(_) => search.output_error(start)?,
                _ => compensated(search, start, Scheme::CompensatedInstruments(variances.input))?,
            };
            most_likely(search, &Likelihood { search: *search, variances, course }, &first)
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

/// Errors of the simulation in the units of the data, with the input at their times.
fn residuals(search: &Search<'_>, solution: &Solution) -> Residuals {
    let problem = search.problem;
    let units = &problem.units;
    let mut input = vec![problem.u[0]; problem.samples()];
    for piece in &Schedule::new(problem, 0.0).pieces {
        if let Some(output) = piece.output {
            input[output] = piece.input(&problem.u).1;
        }
    }
    let time_s = problem.output_time.iter().map(|time| units.start_s + time * units.time_s).collect();
    let values = solution.equations.errors.iter().map(|error| error * units.output).collect();
    Residuals::new(time_s, values, &input, search.settings.lags)
}

fn report(data: &Data, search: &Search<'_>, found: Found) -> Identified {
    let (problem, parametrisation, solution) = (search.problem, search.parametrisation, &found.solution);
    let units = &problem.units;
    // The initial response of the maximum likelihood is integrated out: it has no interval of its own.
    let integrated =
        |parameter: &Parameter| found.intensity.is_some() && matches!(parameter, Parameter::Initial(_));
    let mut listed: Vec<(Parameter, f64, usize)> = parametrisation
        .parameters
        .iter()
        .enumerate()
        .filter(|(_, parameter)| !integrated(parameter))
        .map(|(at, parameter)| (*parameter, solution.theta[at], at))
        .collect();
    if let Some(logarithm) = found.intensity {
        listed.push((Parameter::LogIntensity, logarithm, solution.theta.len()));
    }
    let unit: Vec<f64> = listed.iter().map(|(p, ..)| parametrisation.unit(*p, units)).collect();
    let covariance = DMatrix::from_fn(listed.len(), listed.len(), |i, j| {
        found.covariance[(listed[i].2, listed[j].2)] * unit[i] * unit[j]
    });
    let t = quantile(problem.samples().saturating_sub(parametrisation.parameters.len()));
    let intensity_unit = units.input.powi(2) / units.time_s;
    let parameters: Vec<Estimate> = listed
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
    let model = model(search, &solution.theta);
    let kinds: Vec<Parameter> = listed.iter().map(|(parameter, ..)| *parameter).collect();
    let residuals = &found.residuals;
    let output: Vec<f64> = problem.y.iter().map(|y| y * units.output).collect();
    Identified {
        derived: derive(&model, &kinds, &covariance, t),
        covariance: covariance.row_iter().map(|row| row.iter().copied().collect()).collect(),
        parameters,
        statistics: Statistics::new(&output, &residuals.values, parametrisation.parameters.len()),
        initial: initial(search, &solution.theta),
        cautions: cautions(data, problem, residuals, found.coloured),
        model,
        iterations: solution.iterations,
        residuals: found.residuals,
    }
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
fn initial(search: &Search<'_>, theta: &[f64]) -> Vec<f64> {
    let (parametrisation, units) = (search.parametrisation, &search.problem.units);
    let order = parametrisation.structure.order;
    let value = |i: usize| match &parametrisation.structure.initial {
        InitialState::Given(values) => values[i],
        InitialState::Estimated => {
            parametrisation.position(Parameter::Initial(i)).map_or(0.0, |at| theta[at])
        }
        InitialState::Zero => 0.0,
        InitialState::Settled if i == 0 => {
            let k = parametrisation.expand(theta);
            k.b[0] / k.a[0] * search.problem.u[0]
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
fn feedback(residuals: &Residuals) -> Option<Caution> {
    let (lags, bound) = (residuals.autocorrelation.len() - 1, residuals.input_correlation_bound);
    let (at, correlation) = largest(residuals, 0..lags)?;
    Some(Caution::Feedback { lead: lags - at, correlation, bound })
}

//! What a result must pass before it is returned.
use nalgebra::DMatrix;

use super::model::poles;
use super::parametrisation::{Coefficients, Parametrisation};
use super::problem::{Problem, Units};
use super::start;
use super::{Data, DeadTime, Derived, IdentifyError, Parameter, Settings, Structure};

/// A pole faster than this many times the sampling rate has died out between two samples.
const FASTEST: f64 = 10.0;
/// A pole slower than this share of the record's rate is an integrator.
const SLOWEST: f64 = 0.02;
/// A relative error of the simulation below this leaves no doubt about the direction.
const NEGLIGIBLE_ERROR: f64 = 1e-3;
/// The model from output to input must be wrong by less than this share of the model asked for.
const REVERSE_ERROR_RATIO: f64 = 0.5;

/// Poles must be within what samples and record can show.
pub(super) fn check_poles(problem: &Problem, k: &Coefficients) -> Result<(), IdentifyError> {
    let sizes = poles(&k.a[..k.order]).into_iter().map(|pole| pole.norm() / problem.units.time_s);
    let slowest_per_s = SLOWEST / problem.duration() / problem.units.time_s;
    let fastest_per_s = FASTEST / problem.interval() / problem.units.time_s;
    for pole_per_s in sizes {
        if pole_per_s > fastest_per_s {
            return Err(IdentifyError::PoleTooFast { pole_per_s, bound_per_s: fastest_per_s });
        }
        if pole_per_s.is_nan() || pole_per_s < slowest_per_s {
            return Err(IdentifyError::PoleTooSlow { pole_per_s, bound_per_s: slowest_per_s });
        }
    }
    Ok(())
}

/// Every coefficient of the denominator must differ from zero, the dead time from the ends of its range.
pub(super) fn check_parameters(
    parametrisation: &Parametrisation,
    units: &Units,
    theta: &[f64],
    covariance: &DMatrix<f64>,
) -> Result<(), IdentifyError> {
    for (i, parameter) in parametrisation.parameters.iter().enumerate() {
        let unit = parametrisation.unit(*parameter, units);
        let (value, sd) = (theta[i] * unit, covariance[(i, i)].sqrt() * unit);
        let determined =
            sd.is_finite() && (!matches!(parameter, Parameter::Denominator(_)) || sd <= 0.5 * value.abs());
        if !determined {
            return Err(IdentifyError::NotDetermined { parameter: *parameter, value, sd });
        }
    }
    check_dead_time(parametrisation, theta, units.time_s)
}

/// Every pole must lie in the left half plane with its whole interval.
pub(super) fn check_derived(derived: &Derived) -> Result<(), IdentifyError> {
    match derived
        .poles
        .iter()
        .map(|pole| pole.real_per_s)
        .find(|real| real.sd.is_nan() || real.sd > -0.5 * real.value)
    {
        Some(real) => Err(IdentifyError::PoleNotDetermined { real_per_s: real.value, sd_per_s: real.sd }),
        None => Ok(()),
    }
}

fn check_dead_time(
    parametrisation: &Parametrisation,
    theta: &[f64],
    time_s: f64,
) -> Result<(), IdentifyError> {
    let (DeadTime::Free(longest), Some(at)) =
        (parametrisation.structure.dead_time, parametrisation.position(Parameter::DeadTime))
    else {
        return Ok(());
    };
    if theta[at] > 0.0 && theta[at] < longest {
        return Ok(());
    }
    Err(IdentifyError::DeadTimeAtBound { dead_time_s: theta[at] * time_s, longest_s: longest * time_s })
}

/// Whether the input follows from the output much better than the output from the input.
///
/// `error` is the relative error of the model asked for, root mean square over the output's spread. Where the direction is
/// right, the opposite model would have to be ahead of its input, and fits badly.
pub(super) fn check_direction(
    data: &Data,
    structure: &Structure,
    settings: &Settings,
    error: f64,
) -> Result<(), IdentifyError> {
    let backward = Structure::new(structure.order, structure.zeros).with_offset();
    let parameters = backward.parameters().len();
    if error < NEGLIGIBLE_ERROR {
        return Ok(());
    }
    let Ok(problem) = Problem::new(&data.swapped(), None, settings.longest_gap_s, parameters) else {
        return Ok(());
    };
    let Ok(best) = start::best(&problem, &Parametrisation::new(&backward, &problem.units)) else {
        return Ok(());
    };
    let opposite = (best.sse / problem.samples() as f64).sqrt();
    if opposite < REVERSE_ERROR_RATIO * error {
        let percent = |error: f64| 100.0 * (1.0 - error);
        return Err(IdentifyError::Acausal {
            forward_percent: percent(error),
            backward_percent: percent(opposite),
        });
    }
    Ok(())
}

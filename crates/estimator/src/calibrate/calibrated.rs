//! What a calibration finds.
use cylwatch_thermal::ThermalError;
use cylwatch_thermal::scenario::Scenario;
use cylwatch_thermal::vessel::Vessel;
use nalgebra::DMatrix;

use super::apparent_leak::apparent_leaks;
use super::fit::Fit;
use super::identifiability::{check_determined, identifiability};
use super::residuals::{channel_residuals, check_misfit};
use super::sensitivity::sensitivities;
use super::solution::Solution;
use super::solve::{SearchStep, search_watched};
use super::uncertainty::covariance;
use super::{CalibrateError, ChannelResiduals, Identifiability, ParameterKind, Scope};

/// A parameter as found, in its unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// What it is.
    pub parameter: ParameterKind,
    /// Experiments that share it.
    pub scope: Scope,
    /// Value.
    pub value: f64,
    /// Standard deviation.
    pub sd: f64,
    /// Interval of the settings' confidence; that of a positive parameter is symmetric in its logarithm.
    pub interval: (f64, f64),
    /// Share of the variance of the prior that is left, 0 to 1: near 1 the logs say nothing; `None` without prior.
    pub prior_share: Option<f64>,
}

impl Estimate {
    /// Standard deviation in the search's coordinate: that of a positive parameter is of its logarithm.
    pub fn coordinate_sd(&self) -> f64 {
        if self.parameter.is_positive() { self.sd / self.value } else { self.sd }
    }

    /// Whether the interval holds a value.
    pub fn holds(&self, value: f64) -> bool {
        (self.interval.0..=self.interval.1).contains(&value)
    }
}

/// A finished calibration.
#[derive(Clone, Debug)]
pub struct Calibrated {
    /// The parameters, in the order of the calibration.
    pub estimates: Vec<Estimate>,
    /// Covariance of the estimates in their units, (parameters, parameters).
    pub covariance: DMatrix<f64>,
    /// Which combinations the logs cannot separate.
    pub identifiability: Identifiability,
    /// What is left of each channel.
    pub channels: Vec<ChannelResiduals>,
    /// Weighted sum of squares, priors included.
    pub sum_of_squares: f64,
    /// Readings less parameters.
    pub degrees_of_freedom: usize,
    /// Steps of the search.
    pub iterations: usize,
    pub(super) fit: Fit,
    pub(super) solution: Solution,
}

/// Search, then judge.
pub(super) fn calibrate(fit: &Fit, watch: &mut dyn FnMut(SearchStep)) -> Result<Calibrated, CalibrateError> {
    let start: Vec<f64> = fit.specs.iter().map(|spec| spec.coordinate(spec.start)).collect();
    let held = fit.absent();
    let solution = search_watched(fit, start.clone(), &held, watch).map_err(|error| match error {
        CalibrateError::NotConverged { .. } => error.with_leak(|| {
            let mut here = Solution::at(fit, start, &held)?;
            here.jacobian = sensitivities(fit, &here.z, &here.evaluation, &held)?;
            Ok(apparent_leaks(fit, &here))
        }),
        _ => error,
    })?;
    let asked = |error: CalibrateError| error.with_leak(|| Ok(apparent_leaks(fit, &solution)));
    let channels = channel_residuals(fit, &solution.evaluation);
    check_misfit(fit, &channels).map_err(asked)?;
    let identifiability = identifiability(fit, &solution);
    check_determined(fit, &identifiability)?;
    check_bounds(fit, &solution, &identifiability).map_err(asked)?;
    let Some(covariance) = covariance(fit, &solution, &channels) else {
        let combination = "all parameters together".to_owned();
        return Err(CalibrateError::Undetermined { combination, deviation: f64::INFINITY });
    };
    let slope =
        |i: usize| if fit.specs[i].kind.is_positive() { fit.specs[i].value(solution.z[i]) } else { 1.0 };
    Ok(Calibrated {
        estimates: estimates(fit, &solution, &covariance),
        covariance: covariance.map_with_location(|i, j, value| value * slope(i) * slope(j)),
        identifiability,
        channels,
        sum_of_squares: solution.cost,
        degrees_of_freedom: fit.samples().saturating_sub(fit.specs.len()),
        iterations: solution.iterations,
        fit: fit.clone(),
        solution,
    })
}

/// At a bound a parameter has no interval. Where the logs do not tell it from others, that is why it ran there.
fn check_bounds(fit: &Fit, solution: &Solution, found: &Identifiability) -> Result<(), CalibrateError> {
    for (i, spec) in fit.specs.iter().enumerate().filter(|(i, _)| !solution.held[*i]) {
        let (low, high) = spec.bounds_coordinate();
        let bounds = spec.bounds();
        let reached = match solution.z[i] {
            z if z <= low => Some(bounds.0),
            z if z >= high => Some(bounds.1),
            _ => None,
        };
        let Some(bound) = reached else { continue };
        let takes_part = |one: &&super::Combination| one.parts.iter().any(|(part, _)| *part == i);
        if let Some(combination) = found.inseparable.iter().find(takes_part) {
            let (combination, deviation) = (combination.to_string(), combination.deviation);
            return Err(CalibrateError::Undetermined { combination, deviation });
        }
        return Err(CalibrateError::AtBound { parameter: spec.kind.to_string(), bound });
    }
    Ok(())
}

fn estimates(fit: &Fit, solution: &Solution, covariance: &DMatrix<f64>) -> Vec<Estimate> {
    let quantile = fit.settings.quantile();
    let estimate = |(i, spec): (usize, &super::ParameterSpec)| {
        let (z, sd) = (solution.z[i], covariance[(i, i)].sqrt());
        let value = spec.value(z);
        Estimate {
            parameter: spec.kind.clone(),
            scope: spec.scope.clone(),
            value,
            sd: if spec.kind.is_positive() { value * sd } else { sd },
            interval: (spec.value(z - quantile * sd), spec.value(z + quantile * sd)),
            prior_share: spec.prior_coordinate().map(|(_, prior)| (sd / prior).powi(2).min(1.0)),
        }
    };
    fit.specs.iter().enumerate().map(estimate).collect()
}

impl Calibrated {
    /// The estimate of a parameter; the first one where experiments have their own.
    pub fn estimate(&self, parameter: &ParameterKind) -> Option<&Estimate> {
        self.estimates.iter().find(|estimate| estimate.parameter == *parameter)
    }

    /// Correlation of the estimates, (parameters, parameters); NaN for parameters that no log has.
    pub fn correlation(&self) -> DMatrix<f64> {
        let c = &self.covariance;
        DMatrix::from_fn(c.nrows(), c.ncols(), |i, j| c[(i, j)] / (c[(i, i)] * c[(j, j)]).sqrt())
    }

    /// A vessel with the factors that were fitted to the vessel of an experiment (0 is the first). They hold for any vessel of the same
    /// kind: a smaller one takes them as well.
    pub fn applied(&self, experiment: usize, vessel: &Vessel) -> Vessel {
        let mut vessel = vessel.clone();
        for estimate in self.estimates.iter().filter(|estimate| estimate.scope.contains(experiment)) {
            super::apply::apply_to_vessel(&mut vessel, &estimate.parameter, estimate.value);
        }
        vessel
    }

    /// A scenario of the calibrated kind: its discharge coefficients as found; fill and initial temperature are those of the
    /// scenario given, since they belong to one experiment, and the factor on the outside film is the vessel's.
    ///
    /// # Errors
    /// A model that cannot be made.
    pub fn applied_to_scenario(
        &self,
        experiment: usize,
        scenario: &Scenario,
    ) -> Result<Scenario, ThermalError> {
        let lasting = |kind: &ParameterKind| matches!(kind, ParameterKind::DischargeCoefficient { .. });
        let (specs, values): (Vec<_>, Vec<_>) = self
            .fit
            .specs
            .iter()
            .zip(self.fit.values(&self.solution.z))
            .filter(|(spec, _)| lasting(&spec.kind))
            .map(|(spec, value)| (spec.clone(), value))
            .unzip();
        let mut setup = self.fit.cases[0].base.clone();
        setup.scenario = scenario.clone();
        Ok(setup.with(&specs, &values, experiment)?.scenario)
    }
}

//! Whether what a fit leaves looks like a loss of gas.
//!
//! A score test: one Gauss-Newton step from the minimum with one more parameter, a constant mass flow `w` out of one experiment's cylinder
//! over its whole log. With the derivatives `s` of the weighted readings to it, `J` those to the parameters, `A = J^T J + prior`,
//! `p = s - J A^-1 J^T s` what of a leak no parameter can make up for, and the residuals `r`,
//!
//! `w = s^T (r - J A^-1 (J^T r - g)) / s^T p`,  `sd(w)^2 = sum_c f_c |p_c|^2 / (s^T p)^2`
//!
//! where the gradient `J^T r - g`, with the priors' part `g`, is zero at a minimum; a search that found none is judged where it began. The
//! factors `f_c >= 1` of the channels ([`ChannelResiduals::variance_factor`](super::ChannelResiduals::variance_factor)) are those of what the
//! step leaves: what remains may be as long-lived as it likes, and a leak does not count as noise against itself.
//!
//! Assumes that a leak is small to the fill, and that what else the model lacks looks unlike one; a leak that begins in the middle is
//! underestimated. It is a question to who calibrates: the parameters take up what they can of a leak, and are wrong by that.
//!
//! Source: Rao 1948 (score test).
use cylwatch_thermal::ThermalError;
use cylwatch_thermal::flow::{Flow, FlowKind};
use cylwatch_thermal::simulate::{Neighbours, simulate_with_neighbours};
use nalgebra::DVector;

use super::apply::Setup;
use super::fit::{Case, Evaluation, Fit};
use super::residuals::{SIGNIFICANT_SD, channel_residuals};
use super::sensitivity::settings;
use super::solution::Solution;
use super::uncertainty::first_order_step;
use super::{CalibrateError, Calibrated, ParameterSpec};
use crate::log::Quantity;

/// Part of the fill that the leak along which derivatives are taken loses over the log.
const TRIAL_LOSS: f64 = 1e-4;

/// A leak that the residuals of an experiment look like.
#[derive(Clone, Debug, PartialEq)]
pub struct ApparentLeak {
    /// Source of the experiment.
    pub experiment: String,
    /// Mass flow out, kg/s.
    pub rate_kg_s: f64,
    /// Its standard deviation, kg/s.
    pub sd_kg_s: f64,
}

impl Calibrated {
    /// Experiments whose residuals look like a loss of gas, by 5 standard deviations or more, with the leak that they look like. Takes a
    /// simulation of each experiment that has a pressure; one whose leak cannot be simulated is left out.
    pub fn apparent_leaks(&self) -> Vec<ApparentLeak> {
        apparent_leaks(&self.fit, &self.solution)
    }
}

/// Those of [`Calibrated::apparent_leaks`], wherever a search stands.
pub(super) fn apparent_leaks(fit: &Fit, solution: &Solution) -> Vec<ApparentLeak> {
    let has_pressure =
        |case: &Case| case.base.sensors.iter().any(|sensor| sensor.quantity() == Quantity::Pressure);
    let mut first_row = 0;
    let mut found = Vec::new();
    for (case, course) in fit.cases.iter().zip(&solution.evaluation.courses) {
        let mass_kg = course.mass_kg.first().copied().filter(|_| has_pressure(case));
        let mut signature = DVector::zeros(fit.samples());
        let leak = mass_kg.and_then(|mass_kg| {
            let of_case = of_leak(fit, solution, case, mass_kg).ok()?;
            signature.rows_mut(first_row, case.samples()).copy_from(&of_case);
            let (rate_kg_s, sd_kg_s) = rate(fit, solution, &signature)?;
            Some(ApparentLeak { experiment: case.source.clone(), rate_kg_s, sd_kg_s })
        });
        found.extend(leak.filter(|leak| leak.rate_kg_s > SIGNIFICANT_SD * leak.sd_kg_s));
        first_row += case.samples();
    }
    found
}

/// The leak of a signature that the residuals hold, with its standard deviation, kg/s.
fn rate(fit: &Fit, solution: &Solution, signature: &DVector<f64>) -> Option<(f64, f64)> {
    let jacobian = &solution.jacobian;
    let without = |column: &DVector<f64>, rhs: &DVector<f64>| {
        Some(column - jacobian * first_order_step(fit, solution, rhs)?)
    };
    let proper = without(signature, &jacobian.tr_mul(signature))?;
    let residuals = DVector::from_column_slice(&solution.evaluation.residuals);
    let residuals = without(&residuals, &(jacobian.tr_mul(&residuals) - prior_gradient(fit, solution)))?;
    let information = signature.dot(&proper);
    let rate_kg_s = signature.dot(&residuals) / information;
    let left = residuals - &proper * rate_kg_s;
    let left = Evaluation { courses: Vec::new(), residuals: left.as_slice().to_vec() };
    let mut first = 0;
    let mut variance = 0.0;
    for channel in channel_residuals(fit, &left) {
        let count = channel.residuals.len();
        variance += channel.variance_factor * proper.rows(first, count).norm_squared();
        first += count;
    }
    let sd_kg_s = variance.sqrt() / information;
    (information > 0.0 && rate_kg_s.is_finite() && sd_kg_s.is_finite()).then_some((rate_kg_s, sd_kg_s))
}

/// Half the derivative of the priors' sum of squares.
fn prior_gradient(fit: &Fit, solution: &Solution) -> DVector<f64> {
    let of =
        |spec: &ParameterSpec, z: f64| spec.prior_coordinate().map_or(0.0, |(m, sd)| (z - m) / (sd * sd));
    DVector::from_iterator(fit.specs.len(), fit.specs.iter().zip(&solution.z).map(|(spec, z)| of(spec, *z)))
}

/// Derivatives of the weighted readings of a case, filled with `mass_kg`, to a leak, per kg/s.
fn of_leak(
    fit: &Fit,
    solution: &Solution,
    case: &Case,
    mass_kg: f64,
) -> Result<DVector<f64>, CalibrateError> {
    let values = fit.values(&solution.z);
    let with = |source: ThermalError| case.cannot_simulate(source.into());
    let setup = case.base.with(&fit.specs, &values, case.experiment).map_err(with)?;
    let Setup { vessel, scenario, .. } = setup;
    let trial_kg_s = TRIAL_LOSS * mass_kg / scenario.duration_s.max(1.0);
    let leaking = |mass_flow_kg_s: f64| {
        let mut scenario = scenario.clone();
        scenario.flows.push(Flow::open("apparent leak", FlowKind::Leak { mass_flow_kg_s }));
        (vessel.clone(), scenario)
    };
    let neighbours = Neighbours { below: leaking(0.5 * trial_kg_s), above: leaking(1.5 * trial_kg_s) };
    let (_, here) = leaking(trial_kg_s);
    let (_, courses) =
        simulate_with_neighbours(&vessel, &here, &[neighbours], &settings(fit), &mut |_| fit.goes_on())
            .map_err(with)?;
    let readings = |course| fit.readings(case, &values, course);
    let [below, above] = &courses[0];
    let (below, above) = (DVector::from_vec(readings(below)?), DVector::from_vec(readings(above)?));
    Ok((above - below) / trial_kg_s)
}

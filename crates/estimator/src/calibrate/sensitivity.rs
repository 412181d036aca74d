//! Derivatives of the weighted readings to the search's coordinates.
//!
//! The readings of a course's neighbours (`thermal::simulate::simulate_with_neighbours`) differ by what the parameters
//! change, to first order and without the solver's error; so do readings of one course by sensors of different numbers.
use cylwatch_thermal::simulate::{Neighbours, SimulationSettings, simulate_with_neighbours};
use cylwatch_thermal::trajectory::Trajectory;
use nalgebra::DMatrix;
use rayon::prelude::*;

use super::apply::Setup;
use super::fit::{Case, Evaluation, Fit};
use super::parameter::Stage;
use super::{CalibrateError, ParameterKind};
use crate::EstimatorError;

/// Half distance of neighbours in a logarithm: its square is the derivatives' relative error.
const HALF_DISTANCE: f64 = 1e-4;

/// Change of a temperature that bends the course as much as a factor e of another parameter does, K.
const TEMPERATURE_SCALE_K: f64 = 20.0;

/// Relative tolerance of the run along which derivatives are taken. Their error, some hundred times as large, costs the search
/// nothing: where it ends depends on the readings alone.
const TOLERANCE: f64 = 1e-8;

/// How courses are run along which derivatives are taken.
pub(super) fn settings(fit: &Fit) -> SimulationSettings {
    let settings = fit.settings.simulation;
    SimulationSettings { relative_tolerance: settings.relative_tolerance.max(TOLERANCE), ..settings }
}

/// Relative error of derivatives to what the course depends on.
const RELATIVE_ERROR: f64 = 2e-5;

/// Derivatives of all parameters but those held.
///
/// # Shapes
/// (readings, parameters), columns of held parameters are zero.
pub(super) fn sensitivities(
    fit: &Fit,
    z: &[f64],
    here: &Evaluation,
    held: &[bool],
) -> Result<DMatrix<f64>, CalibrateError> {
    let mut jacobian = DMatrix::zeros(fit.samples(), z.len());
    let tasks = tasks(fit, held);
    let columns: Vec<_> = tasks.par_iter().map(|task| task.columns(fit, z, here)).collect();
    for (task, columns) in tasks.iter().zip(columns) {
        for (parameter, column) in columns? {
            for (row, value) in column.into_iter().enumerate() {
                jacobian[(task.first_row + row, parameter)] = value;
            }
        }
    }
    Ok(jacobian)
}

/// Relative error of a parameter's derivatives.
pub(super) fn relative_error(fit: &Fit, parameter: usize) -> f64 {
    match fit.specs[parameter].kind.stage() {
        Stage::Simulation => RELATIVE_ERROR,
        Stage::Reading => 0.0,
    }
}

/// Parameters of one case that are found together.
struct Task<'a> {
    parameters: Vec<usize>,
    case: &'a Case,
    /// Place of the case in the list.
    index: usize,
    first_row: usize,
}

/// For each case, what its course depends on, in as many parts as there are threads for, and what its sensors depend on.
fn tasks<'a>(fit: &'a Fit, held: &[bool]) -> Vec<Task<'a>> {
    let parts = rayon::current_num_threads().div_ceil(fit.cases.len().max(1));
    let mut tasks = Vec::new();
    let mut first_row = 0;
    for (index, case) in fit.cases.iter().enumerate() {
        let concerned =
            |&parameter: &usize| !held[parameter] && fit.specs[parameter].scope.contains(case.experiment);
        let (course, reading): (Vec<usize>, Vec<usize>) = (0..fit.specs.len())
            .filter(concerned)
            .partition(|&parameter| fit.specs[parameter].kind.stage() == Stage::Simulation);
        let size = course.len().div_ceil(parts).max(1);
        for parameters in course.chunks(size).map(<[usize]>::to_vec).chain([reading]) {
            tasks.push(Task { parameters, case, index, first_row });
        }
        first_row += case.samples();
    }
    tasks
}

/// A parameter with the derivatives of a case's readings.
type Column = (usize, Vec<f64>);

impl Task<'_> {
    fn columns(&self, fit: &Fit, z: &[f64], here: &Evaluation) -> Result<Vec<Column>, CalibrateError> {
        match self.parameters.first() {
            None => Ok(Vec::new()),
            Some(&first) if fit.specs[first].kind.stage() == Stage::Simulation => self.of_course(fit, z),
            Some(_) => self.of_readings(fit, z, &here.courses[self.index]),
        }
    }

    /// Derivatives to what the course depends on.
    fn of_course(&self, fit: &Fit, z: &[f64]) -> Result<Vec<Column>, CalibrateError> {
        let failed = |source| self.case.cannot_simulate(source);
        let setup = |z: &[f64]| self.case.base.with(&fit.specs, &fit.values(z), self.case.experiment);
        let run = || -> Result<Vec<[Trajectory; 2]>, EstimatorError> {
            let side = |parameter: usize, by: f64| {
                setup(&shifted(z, parameter, by)).map(|Setup { vessel, scenario, .. }| (vessel, scenario))
            };
            let neighbours: Vec<Neighbours> = self
                .parameters
                .iter()
                .map(|&parameter| {
                    let half = half_distance(&fit.specs[parameter].kind);
                    Ok(Neighbours { below: side(parameter, -half)?, above: side(parameter, half)? })
                })
                .collect::<Result<_, EstimatorError>>()?;
            let Setup { vessel, scenario, .. } = setup(z)?;
            Ok(simulate_with_neighbours(&vessel, &scenario, &neighbours, &settings(fit), &mut |_| {
                fit.goes_on()
            })?
            .1)
        };
        let values = fit.values(z);
        let courses = run().map_err(failed)?;
        let columns = self.parameters.iter().zip(courses).map(|(&parameter, [below, above])| {
            let half = half_distance(&fit.specs[parameter].kind);
            let (below, above) =
                (fit.readings(self.case, &values, &below)?, fit.readings(self.case, &values, &above)?);
            Ok((parameter, central(&below, &above, half)))
        });
        columns.collect()
    }

    /// Derivatives to the sensors' numbers, at the same course: only rounding limits them.
    fn of_readings(&self, fit: &Fit, z: &[f64], course: &Trajectory) -> Result<Vec<Column>, CalibrateError> {
        let column = |&parameter: &usize| {
            let kind = &fit.specs[parameter].kind;
            // Readings are linear in all but the lag, for which the distance must be small.
            let half = match kind {
                ParameterKind::SensorLag { .. } => HALF_DISTANCE,
                kind => kind.usual_width(self.case.base.is_of_pressure(kind)),
            };
            let readings = |by: f64| fit.readings(self.case, &fit.values(&shifted(z, parameter, by)), course);
            Ok((parameter, central(&readings(-half)?, &readings(half)?, half)))
        };
        self.parameters.iter().map(column).collect()
    }
}

/// Half distance of the neighbours of what the course depends on, in the search's coordinate.
fn half_distance(kind: &ParameterKind) -> f64 {
    if kind.is_positive() { HALF_DISTANCE } else { HALF_DISTANCE * TEMPERATURE_SCALE_K }
}

/// Coordinates with one of them moved.
fn shifted(z: &[f64], parameter: usize, by: f64) -> Vec<f64> {
    let mut z = z.to_vec();
    z[parameter] += by;
    z
}

fn central(below: &[f64], above: &[f64], half: f64) -> Vec<f64> {
    above.iter().zip(below).map(|(above, below)| (above - below) / (2.0 * half)).collect()
}

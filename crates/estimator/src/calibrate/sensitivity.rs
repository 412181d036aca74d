//! Derivatives of the weighted readings to the search's coordinates.
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use nalgebra::DMatrix;

use super::fit::{Case, Evaluation, Fit};
use super::parameter::Stage;
use super::{CalibrateError, ParameterKind};

/// Step of a difference at the same course where the reading is not linear: only rounding limits it.
const READING_STEP: f64 = 1e-4;

/// Change of the initial temperature that bends the course as much as a factor e of another parameter does, K.
const TEMPERATURE_SCALE_K: f64 = 20.0;

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
    let tasks: Vec<Task<'_>> = tasks(fit, held);
    for (task, column) in tasks.iter().zip(in_parallel(&tasks, |task| task.column(fit, z, here))) {
        for (row, value) in column?.into_iter().enumerate() {
            jacobian[(task.first_row + row, task.parameter)] = value;
        }
    }
    Ok(jacobian)
}

/// Relative error of a parameter's derivatives.
pub(super) fn relative_error(fit: &Fit, parameter: usize) -> f64 {
    match fit.specs[parameter].kind.stage() {
        Stage::Course => fit.settings.simulation_error().powf(2.0 / 3.0),
        Stage::LinearReading | Stage::Reading => 0.0,
    }
}

/// One parameter in one case.
struct Task<'a> {
    parameter: usize,
    case: &'a Case,
    /// Place of the case in the list.
    index: usize,
    first_row: usize,
}

fn tasks<'a>(fit: &'a Fit, held: &[bool]) -> Vec<Task<'a>> {
    let mut tasks = Vec::new();
    let mut first_row = 0;
    for (index, case) in fit.cases.iter().enumerate() {
        let concerned =
            |&parameter: &usize| !held[parameter] && fit.specs[parameter].scope.contains(case.experiment);
        let parameters = (0..fit.specs.len()).filter(concerned);
        tasks.extend(parameters.map(|parameter| Task { parameter, case, index, first_row }));
        first_row += case.samples();
    }
    tasks
}

impl Task<'_> {
    /// Central difference of the case's weighted readings.
    fn column(&self, fit: &Fit, z: &[f64], here: &Evaluation) -> Result<Vec<f64>, CalibrateError> {
        let spec = &fit.specs[self.parameter];
        let course_step = fit.settings.simulation_error().cbrt();
        let step = match (spec.kind.stage(), &spec.kind) {
            (_, ParameterKind::InitialTemperature) => course_step * TEMPERATURE_SCALE_K,
            (Stage::Course, _) => course_step,
            (Stage::Reading, _) => READING_STEP,
            // Exact for any step: one at which rounding does not matter.
            (Stage::LinearReading, kind) => kind.usual_width(self.case.base.is_of_pressure(kind)),
        };
        let beside = |step: f64| {
            let mut z = z.to_vec();
            z[self.parameter] += step;
            let values = fit.values(&z);
            if spec.kind.stage() == Stage::Course {
                fit.readings(self.case, &values, &fit.course(self.case, &values)?)
            } else {
                fit.readings(self.case, &values, &here.courses[self.index])
            }
        };
        let (below, above) = (beside(-step)?, beside(step)?);
        Ok(above.into_iter().zip(below).map(|(above, below)| (above - below) / (2.0 * step)).collect())
    }
}

/// Results of independent tasks in their order, computed by as many threads as the machine runs at once.
fn in_parallel<T: Sync, R: Send>(tasks: &[T], run: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let threads = std::thread::available_parallelism().map_or(1, usize::from).min(tasks.len());
    let next = AtomicUsize::new(0);
    let done = Mutex::new(Vec::with_capacity(tasks.len()));
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(task) = tasks.get(index) else { break };
                    let result = run(task);
                    done.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push((index, result));
                }
            });
        }
    });
    let mut done = done.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    done.sort_by_key(|(index, _)| *index);
    done.into_iter().map(|(_, result)| result).collect()
}

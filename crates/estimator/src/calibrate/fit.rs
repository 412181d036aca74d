//! The readings to be fitted, and the model's readings for given parameters.
use cylwatch_thermal::simulate::simulate_while;
use cylwatch_thermal::trajectory::Trajectory;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::apply::Setup;
use super::experiment::{Column, check_excitation};
use super::{CalibrateError, Calibration, CalibrationSettings, Experiment, ParameterSpec, Scope};
use crate::EstimatorError;
use crate::log::median_interval;
use crate::sensor::{Sensor, SensorKind, Specimen, SuiteTruth, sample_at};

/// Which readings take part.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Selection {
    Everything,
    /// Up to and with this time, s.
    Until(f64),
    /// Later than this time, s.
    After(f64),
    Only(Vec<usize>),
    Except(Vec<usize>),
}

impl Selection {
    fn keeps(&self, experiment: usize, time_s: f64) -> bool {
        match self {
            Self::Everything => true,
            Self::Until(end_s) => time_s <= *end_s,
            Self::After(start_s) => time_s > *start_s,
            Self::Only(these) => these.contains(&experiment),
            Self::Except(these) => !these.contains(&experiment),
        }
    }
}

/// An experiment with its usable readings.
#[derive(Clone, Debug)]
pub(super) struct Case {
    /// Its place in the list.
    pub experiment: usize,
    pub source: String,
    /// Vessel, scenario and sensors as stated.
    pub base: Setup,
    /// Times of the kept rows, s.
    pub times_s: Vec<f64>,
    /// One for each sensor.
    pub columns: Vec<Column>,
}

/// A calibration's readings with its parameters, checked.
#[derive(Clone, Debug)]
pub(super) struct Fit {
    pub specs: Vec<ParameterSpec>,
    pub settings: CalibrationSettings,
    pub cases: Vec<Case>,
    /// Set it, and every simulation ends.
    pub stop: Arc<AtomicBool>,
}

/// The model's readings for some parameters.
#[derive(Clone, Debug)]
pub(super) struct Evaluation {
    /// Course of each case.
    pub courses: Vec<Trajectory>,
    /// Weighted residuals `(y - y(theta)) / sigma`, case by case, sensor by sensor.
    pub residuals: Vec<f64>,
}

impl Fit {
    pub(super) fn new(calibration: &Calibration, selection: &Selection) -> Result<Self, CalibrateError> {
        let fit = Self::for_scoring(calibration, selection)?;
        let (samples, parameters) = (fit.samples(), fit.specs.len());
        if fit.cases.is_empty() {
            return Ok(fit);
        }
        if samples < parameters {
            return Err(CalibrateError::TooFewSamples { samples, parameters });
        }
        check_excitation(fit.cases.iter().flat_map(|case| &case.columns))?;
        Ok(fit)
    }

    /// Readings that need not suffice for a fit.
    pub(super) fn for_scoring(
        calibration: &Calibration,
        selection: &Selection,
    ) -> Result<Self, CalibrateError> {
        calibration.settings.validate()?;
        if calibration.experiments.is_empty() {
            return Err(CalibrateError::Empty { missing: "experiment" });
        }
        if calibration.parameters.is_empty() {
            return Err(CalibrateError::Empty { missing: "parameter" });
        }
        check_parameters(calibration)?;
        let cases: Vec<Case> = (0..calibration.experiments.len())
            .filter_map(|index| Case::new(calibration, index, selection).transpose())
            .collect::<Result<_, _>>()?;
        Ok(Self {
            specs: calibration.parameters.clone(),
            settings: calibration.settings,
            cases,
            stop: Arc::default(),
        })
    }

    /// The same, ended when `stop` is set.
    pub(super) fn stopped_by(self, stop: &Arc<AtomicBool>) -> Self {
        Self { stop: stop.clone(), ..self }
    }

    pub(super) fn goes_on(&self) -> bool {
        !self.stop.load(Ordering::Relaxed)
    }

    /// What a stop made of a search is no result, and no error of the logs.
    pub(super) fn unless_stopped<T>(&self, found: Result<T, CalibrateError>) -> Result<T, CalibrateError> {
        if self.goes_on() { found } else { Err(CalibrateError::Stopped) }
    }

    /// Number of readings.
    pub(super) fn samples(&self) -> usize {
        self.cases.iter().map(Case::samples).sum()
    }

    /// Parameters that no case has: they stay where they begin.
    pub(super) fn absent(&self) -> Vec<bool> {
        let absent =
            |spec: &ParameterSpec| !self.cases.iter().any(|case| spec.scope.contains(case.experiment));
        self.specs.iter().map(absent).collect()
    }

    /// Parameters from the search's coordinates.
    pub(super) fn values(&self, z: &[f64]) -> Vec<f64> {
        self.specs.iter().zip(z).map(|(spec, &z)| spec.value(z)).collect()
    }

    pub(super) fn evaluate(&self, z: &[f64]) -> Result<Evaluation, CalibrateError> {
        let values = self.values(z);
        let mut evaluation =
            Evaluation { courses: Vec::new(), residuals: Vec::with_capacity(self.samples()) };
        for case in &self.cases {
            let course = self.course(case, &values)?;
            let readings = self.readings(case, &values, &course)?;
            evaluation.residuals.extend(case.weighted_values().zip(readings).map(|(y, model)| y - model));
            evaluation.courses.push(course);
        }
        Ok(evaluation)
    }

    /// Simulated course of a case.
    pub(super) fn course(&self, case: &Case, values: &[f64]) -> Result<Trajectory, CalibrateError> {
        let run = || -> Result<Trajectory, EstimatorError> {
            let setup = case.base.with(&self.specs, values, case.experiment)?;
            Ok(simulate_while(&setup.vessel, &setup.scenario, &self.settings.simulation, &mut |_| {
                self.goes_on()
            })?)
        };
        run().map_err(|source| case.cannot_simulate(source))
    }

    /// The sensors' readings of a course over the standard deviations of their noise, sensor by sensor.
    pub(super) fn readings(
        &self,
        case: &Case,
        values: &[f64],
        course: &Trajectory,
    ) -> Result<Vec<f64>, CalibrateError> {
        let sensors = case.base.sensors_with(&self.specs, values, case.experiment);
        let suite = SuiteTruth { specimens: sensors.iter().map(faultless).collect() };
        let log =
            sample_at(course, &suite, &case.times_s, 0).map_err(|source| case.cannot_simulate(source))?;
        let weighted = case.columns.iter().enumerate().flat_map(|(index, column)| {
            let log = &log;
            column.rows.iter().map(move |&row| log.row(row)[index] / column.sigma)
        });
        Ok(weighted.collect())
    }
}

impl Case {
    /// An experiment's part of the selection; `None`: it has none.
    fn new(
        calibration: &Calibration,
        index: usize,
        selection: &Selection,
    ) -> Result<Option<Self>, CalibrateError> {
        let experiment = &calibration.experiments[index];
        experiment.check_times()?;
        let times = &experiment.log.time_s;
        let kept: Vec<usize> = (0..times.len()).filter(|&row| selection.keeps(index, times[row])).collect();
        if kept.is_empty() && *selection != Selection::Everything {
            return Ok(None);
        }
        let columns = experiment
            .channels
            .iter()
            .map(|sensor| experiment.column(sensor, &kept))
            .collect::<Result<Vec<_>, _>>()?;
        let times_s: Vec<f64> = kept.iter().map(|&row| times[row]).collect();
        Ok(Some(Self {
            experiment: index,
            source: experiment.source.clone(),
            base: base(calibration, experiment, &times_s),
            times_s,
            columns,
        }))
    }

    pub(super) fn samples(&self) -> usize {
        self.columns.iter().map(|column| column.values.len()).sum()
    }

    /// Measured readings over the standard deviations of their noise, sensor by sensor.
    pub(super) fn weighted_values(&self) -> impl Iterator<Item = f64> + '_ {
        self.columns.iter().flat_map(|column| column.values.iter().map(|value| value / column.sigma))
    }

    pub(super) fn cannot_simulate(&self, source: EstimatorError) -> CalibrateError {
        CalibrateError::Simulation { experiment: self.source.clone(), source: Box::new(source) }
    }
}

/// Vessel, scenario and sensors as stated; the scenario ends with the last reading and is sampled as often as the log.
fn base(calibration: &Calibration, experiment: &Experiment, times_s: &[f64]) -> Setup {
    let mut scenario = experiment.scenario.clone();
    if let Some(&last_s) = times_s.last().filter(|&&last_s| last_s > 0.0) {
        scenario.duration_s = last_s;
    }
    if let Some(interval_s) = median_interval(times_s) {
        scenario.sample_time_s = scenario.sample_time_s.min(interval_s);
    }
    scenario.pressure_limits_pa.clear();
    let vessel = experiment.vessel.as_ref().unwrap_or(&calibration.vessel);
    Setup { vessel: vessel.clone(), scenario, sensors: experiment.channels.clone() }
}

/// A sensor as it reads on average, drift included, and beyond the ends of its range.
fn faultless(sensor: &Sensor) -> Specimen {
    let drift_per_s = sensor.drift_per_s;
    let mut sensor = sensor.ideal();
    sensor.drift_per_s = drift_per_s;
    if let SensorKind::Pressure { full_scale_pa, .. } = &mut sensor.kind {
        *full_scale_pa = None;
    }
    let truth = sensor.nominal();
    Specimen { sensor, truth }
}

/// Every parameter by itself, then with the experiments that it is for.
fn check_parameters(calibration: &Calibration) -> Result<(), CalibrateError> {
    let Calibration { parameters: specs, experiments, .. } = calibration;
    for (index, spec) in specs.iter().enumerate() {
        spec.check()?;
        if let Scope::Only(these) = &spec.scope
            && let Some(&experiment) = these.iter().find(|&&these| these >= experiments.len())
        {
            let (parameter, experiments) = (spec.kind.to_string(), experiments.len());
            return Err(CalibrateError::ScopeUnknown { parameter, experiment, experiments });
        }
        for (number, experiment) in experiments.iter().enumerate().filter(|(n, _)| spec.scope.contains(*n)) {
            base(calibration, experiment, &[]).check(&spec.kind, &experiment.source)?;
            let twin = |other: &&ParameterSpec| other.kind == spec.kind && other.scope.contains(number);
            if specs[..index].iter().any(|other| twin(&other)) {
                let (parameter, experiment) = (spec.kind.to_string(), experiment.source.clone());
                return Err(CalibrateError::ParameterTwice { parameter, experiment });
            }
        }
    }
    Ok(())
}

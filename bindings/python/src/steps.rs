//! Monitor and observer step by step.
use crate::border;
use crate::request::{FRAME, Request};
use crate::{arrow, outcome, rows, time};
use cylwatch::run::{Cells, MonitorSteps, ObserverSteps, RowsWanted, RunError, StepTime, Told};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyList};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Names and values of a row.
type Readings = Vec<(String, f64)>;

/// Runs a step on an object that only one thread has at a time, without the interpreter.
fn locked<S: Send, T: Send>(
    py: Python<'_>,
    steps: &Mutex<S>,
    step: impl FnOnce(&mut S) -> Result<T, RunError> + Send,
) -> PyResult<T> {
    border::detached(py, &border::Signal::default(), || {
        // A step that panicked has been told as an error; the object is restored or made anew by its owner.
        let mut steps: MutexGuard<'_, S> = steps.lock().unwrap_or_else(PoisonError::into_inner);
        step(&mut steps)
    })
}

fn row(time: &Bound<'_, PyAny>, readings: &Bound<'_, PyDict>) -> PyResult<(StepTime, Readings)> {
    let mut row = Vec::with_capacity(readings.len());
    for (name, value) in readings {
        let value = if value.is_none() { f64::NAN } else { value.extract()? };
        row.push((name.extract()?, value));
    }
    Ok((time::time(time)?, row))
}

fn borrowed(readings: &Readings) -> Vec<(&str, f64)> {
    readings.iter().map(|(name, value)| (name.as_str(), *value)).collect()
}

/// A monitor that is fed row by row.
#[pyclass(frozen, module = "cylwatch")]
pub(crate) struct Monitor(Mutex<MonitorSteps>);

#[pymethods]
impl Monitor {
    #[new]
    #[pyo3(signature = (vessel, **options))]
    fn new(vessel: &Bound<'_, PyAny>, options: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let request = Request::new("Monitor", Some(vessel), options)?;
        let steps = border::guarded(vessel.py(), || MonitorSteps::new(request.into_call()))?;
        Ok(Self(Mutex::new(steps)))
    }

    /// Takes in a row; a dict of the `rows` that have become final and of their `events`.
    fn step<'py>(
        &self,
        time: &Bound<'py, PyAny>,
        readings: &Bound<'py, PyDict>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (stamp, row) = row(time, readings)?;
        let told = locked(time.py(), &self.0, |steps| steps.step(stamp, &borrowed(&row)))?;
        told_dict(time.py(), &told)
    }

    /// Takes in the rows of a table in their order; with `rows=False` hands out the last row alone.
    #[pyo3(signature = (table, rows = true))]
    fn steps<'py>(&self, table: &Bound<'py, PyAny>, rows: bool) -> PyResult<Bound<'py, PyDict>> {
        let py = table.py();
        let log = arrow::log(table, FRAME)?;
        let zone = log.columns.iter().find_map(|(_, cells)| match cells {
            Cells::Instants { zone, .. } => zone.as_ref().map(ToString::to_string),
            _ => None,
        });
        let wanted = if rows { RowsWanted::Every } else { RowsWanted::Last };
        let (table, told) = locked(py, &self.0, |steps| steps.steps(&log, wanted))?;
        let dict = PyDict::new(py);
        dict.set_item("rows", rows::Rows::new(py, &table, zone.as_deref())?)?;
        let list = PyList::empty(py);
        for told in &told {
            list.append(told_item(py, told)?)?;
        }
        dict.set_item("told", list)?;
        Ok(dict)
    }

    /// The rows that are held back, as at the end of a log.
    fn finish<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        told_dict(py, &locked(py, &self.0, MonitorSteps::finish)?)
    }

    /// Verdict of the last row that came out.
    #[getter]
    fn verdict(&self, py: Python<'_>) -> PyResult<&'static str> {
        locked(py, &self.0, |steps| Ok(steps.verdict()))
    }

    /// All of it as bytes.
    fn save<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        Ok(PyBytes::new(py, &locked(py, &self.0, |steps| steps.save())?))
    }

    /// The bytes of the command's state file; None: the fill is not known yet.
    fn state_file<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyBytes>>> {
        let bytes = locked(py, &self.0, |steps| steps.state_file())?;
        Ok(bytes.map(|bytes| PyBytes::new(py, &bytes)))
    }

    /// Goes on from bytes as if there had been no stop.
    fn restore(&self, py: Python<'_>, state: &[u8]) -> PyResult<()> {
        locked(py, &self.0, |steps| steps.restore(state))
    }
}

fn told_dict<'py>(
    py: Python<'py>,
    (table, told): &(cylwatch::report::Table, Vec<Told>),
) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("rows", rows::dicts(py, table)?)?;
    dict.set_item("events", outcome::lines(py, told.iter().map(|told| told.line.as_str()))?)?;
    Ok(dict)
}

/// What happened, in the columns of the events of a fleet.
fn told_item<'py>(py: Python<'py>, told: &Told) -> PyResult<Bound<'py, PyDict>> {
    let Told { id, event, time_s, time, words, line } = told;
    let dict = PyDict::new(py);
    dict.set_item("time_s", time_s)?;
    dict.set_item("time", Some(time).filter(|time| !time.is_empty()))?;
    for (name, text) in [("event", event), ("id", id), ("words", words), ("line", line)] {
        dict.set_item(name, text)?;
    }
    Ok(dict)
}

/// An observer that is fed row by row.
#[pyclass(frozen, module = "cylwatch")]
pub(crate) struct Observer(Mutex<ObserverSteps>);

#[pymethods]
impl Observer {
    #[new]
    #[pyo3(signature = (vessel, **options))]
    fn new(vessel: &Bound<'_, PyAny>, options: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let request = Request::new("Observer", Some(vessel), options)?;
        let steps = border::guarded(vessel.py(), || ObserverSteps::new(request.into_call()))?;
        Ok(Self(Mutex::new(steps)))
    }

    /// Takes in a row; a dict of the `rows` of estimates, one, or as many as have waited for a pressure.
    fn step<'py>(
        &self,
        time: &Bound<'py, PyAny>,
        readings: &Bound<'py, PyDict>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (stamp, row) = row(time, readings)?;
        let table = locked(time.py(), &self.0, |steps| steps.step(stamp, &borrowed(&row)))?;
        let dict = PyDict::new(time.py());
        dict.set_item("rows", rows::dicts(time.py(), &table)?)?;
        Ok(dict)
    }

    /// All of it as bytes.
    fn save<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        Ok(PyBytes::new(py, &locked(py, &self.0, |steps| steps.save())?))
    }

    /// Goes on from bytes as if there had been no stop.
    fn restore(&self, py: Python<'_>, state: &[u8]) -> PyResult<()> {
        locked(py, &self.0, |steps| steps.restore(state))
    }
}

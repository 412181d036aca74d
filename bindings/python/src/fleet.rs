//! A fleet: a folder of logs, and the tables of what came out.
use crate::border::{self, Signal};
use crate::rows::Rows;
use crate::{arguments, error};
use cylwatch::run::{self, Call, FleetProgress};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict};
use std::path::PathBuf;

/// What a run over a fleet comes to: tables of cylinders, events and errors.
#[pyclass(frozen, module = "cylwatch")]
pub(crate) struct Fleet {
    summary: Py<Rows>,
    events: Py<Rows>,
    errors: Py<Rows>,
    exit_code: u8,
    page: PathBuf,
}

/// Monitors many cylinders on all cores, as `cylwatch fleet` does.
#[pyfunction]
#[pyo3(signature = (logs, output, *, progress=None, **options))]
pub(crate) fn fleet(
    py: Python<'_>,
    logs: PathBuf,
    output: PathBuf,
    progress: Option<&Bound<'_, PyAny>>,
    options: Option<&Bound<'_, PyDict>>,
) -> PyResult<Fleet> {
    let given = arguments::options(options)?;
    if let Some((name, _)) = given.documents.first() {
        let message =
            format!("{name}: each thread of a fleet reads files: write it to a file and give its path");
        return Err(error::refused(py, &message));
    }
    let signal = Signal::default();
    let (asked, failed) = (signal.clone(), signal.clone());
    let told = progress.map(told).transpose()?.flatten();
    let outcome = border::detached(py, &signal, move || {
        let mut call = Call::of_fleet(&logs, &output).stopped_by(move || asked.has_come());
        if let Some(told) = told {
            call = call.progress(move |so_far| {
                Python::attach(|py| tell(told.bind(py), so_far).unwrap_or_else(|error| failed.keep(error)));
            });
        }
        let options = given.options.iter();
        run::fleet(options.fold(call, |call, (name, value)| call.option(name, value.as_deref())))
    })?;
    let table = |table| Py::new(py, Rows::new(py, table, None)?);
    Ok(Fleet {
        summary: table(&outcome.summary)?,
        events: table(&outcome.events)?,
        errors: table(&outcome.errors)?,
        exit_code: outcome.exit_code,
        page: outcome.page,
    })
}

/// Who is told how far the run is: a callable, or `print` to stderr; `None`: nobody.
fn told(progress: &Bound<'_, PyAny>) -> PyResult<Option<Py<PyAny>>> {
    let py = progress.py();
    if let Ok(switch) = progress.cast::<PyBool>() {
        return switch
            .is_true()
            .then(|| Ok(py.import("cylwatch._progress")?.getattr("show")?.unbind()))
            .transpose();
    }
    if !progress.is_callable() {
        let message = format!("progress is of type {}: give True or a callable", progress.get_type().name()?);
        return Err(error::refused(py, &message));
    }
    Ok(Some(progress.clone().unbind()))
}

fn tell(told: &Bound<'_, PyAny>, so_far: FleetProgress) -> PyResult<()> {
    let FleetProgress { done, cylinders, rows_per_s, left_s } = so_far;
    told.call1((done, cylinders, rows_per_s, left_s)).map(|_| ())
}

#[pymethods]
impl Fleet {
    /// A row for each cylinder, the most urgent first.
    #[getter]
    fn summary(&self, py: Python<'_>) -> Py<Rows> {
        self.summary.clone_ref(py)
    }

    /// A row for each event and change of an alarm, by cylinder.
    #[getter]
    fn events(&self, py: Python<'_>) -> Py<Rows> {
        self.events.clone_ref(py)
    }

    /// A row for everything that could not be read.
    #[getter]
    fn errors(&self, py: Python<'_>) -> Py<Rows> {
        self.errors.clone_ref(py)
    }

    /// Exit code of the command: 0 no cylinder lost gas, 1 one did, 3 of one it cannot be told.
    #[getter]
    fn exit_code(&self) -> u8 {
        self.exit_code
    }

    /// The page that was written.
    #[getter]
    fn page(&self) -> PathBuf {
        self.page.clone()
    }

    fn __len__(&self) -> usize {
        self.summary.get().count()
    }

    fn __repr__(&self) -> String {
        let counts = [&self.summary, &self.events, &self.errors].map(|rows| rows.get().count());
        let [cylinders, events, errors] = counts;
        format!(
            "<cylwatch.Fleet: {cylinders} cylinders, {events} events, {errors} errors, {}>",
            self.page.display()
        )
    }
}

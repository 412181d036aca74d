//! What a call hands out.
use crate::border;
use crate::rows::Rows;
use cylwatch::run;
use pyo3::prelude::*;
use pyo3::types::{PyList, PyString};

/// Result of a call: rows, events, summary, verdict. A notebook shows its report with the figure.
#[pyclass(frozen, module = "cylwatch", name = "Result")]
pub(crate) struct Outcome {
    rows: Py<Rows>,
    events: Py<PyList>,
    summary: Py<PyAny>,
    outcome: run::Outcome,
}

impl Outcome {
    pub(crate) fn new(py: Python<'_>, outcome: run::Outcome) -> PyResult<Self> {
        let rows = Py::new(py, Rows::new(py, &outcome.rows, outcome.zone.as_deref())?)?;
        let events = lines(py, outcome.events.iter().map(String::as_str))?.unbind();
        let summary = value(py, &outcome.summary.to_string())?.unbind();
        Ok(Self { rows, events, summary, outcome })
    }
}

/// JSON as Python values.
fn value<'py>(py: Python<'py>, json: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("json")?.call_method1("loads", (PyString::new(py, json),))
}

/// Lines of JSON as a list of dicts.
pub(crate) fn lines<'py, 'a>(
    py: Python<'py>,
    lines: impl Iterator<Item = &'a str>,
) -> PyResult<Bound<'py, PyList>> {
    let list = PyList::empty(py);
    for line in lines {
        list.append(value(py, line)?)?;
    }
    Ok(list)
}

#[pymethods]
impl Outcome {
    /// Rows, for frames and for numpy.
    #[getter]
    fn rows(&self, py: Python<'_>) -> Py<Rows> {
        self.rows.clone_ref(py)
    }

    /// Events and alarms in the order in which they happened, each a dict.
    #[getter]
    fn events(&self, py: Python<'_>) -> Py<PyList> {
        self.events.clone_ref(py)
    }

    /// The summary of the command's JSON.
    #[getter]
    fn summary(&self, py: Python<'_>) -> Py<PyAny> {
        self.summary.clone_ref(py)
    }

    /// Verdict at the end, of `monitor`; else None.
    #[getter]
    fn verdict(&self) -> Option<&str> {
        Some(self.outcome.verdict).filter(|verdict| !verdict.is_empty())
    }

    /// The calibrated vessel as TOML, of `calibrate`; else None.
    #[getter]
    fn vessel(&self) -> Option<&str> {
        Some(self.outcome.vessel.as_str()).filter(|text| !text.is_empty())
    }

    /// The fitted sensors as TOML, of `calibrate`; else None.
    #[getter]
    fn sensors(&self) -> Option<&str> {
        Some(self.outcome.sensors.as_str()).filter(|text| !text.is_empty())
    }

    /// Exit code of the command: 0 done and no loss, 1 gas was lost, 3 inconclusive, or a search that was ended early.
    #[getter]
    fn exit_code(&self) -> u8 {
        self.outcome.exit_code
    }

    /// Cautions, which the command writes to stderr.
    #[getter]
    fn cautions(&self) -> Vec<String> {
        self.outcome.cautions.clone()
    }

    /// A column of the rows as an array of numpy.
    fn __getitem__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        self.rows.get().__getitem__(py, name)
    }

    fn __len__(&self) -> usize {
        self.rows.get().count()
    }

    /// The rows as the command writes them in CSV, with its digits and comment lines.
    fn to_csv(&self) -> String {
        self.outcome.to_csv()
    }

    /// The report as a page that refers to nothing outside.
    fn to_html(&self, py: Python<'_>) -> PyResult<String> {
        border::guarded(py, || self.outcome.to_html())
    }

    fn _repr_html_(&self, py: Python<'_>) -> PyResult<String> {
        // The page in a frame of its own: its styles stay inside, the notebook's outside.
        let page = self.to_html(py)?.replace('&', "&amp;").replace('"', "&quot;");
        Ok(format!("<iframe srcdoc=\"{page}\" width=\"100%\" height=\"900\" style=\"border:0\"></iframe>"))
    }

    fn __repr__(&self) -> String {
        self.outcome.report.to_text()
    }
}

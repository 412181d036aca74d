//! Tables that come from Python.
use crate::{arrow, columns};
use cylwatch::run::MemoryLog;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// A table of Arrow or a dict of columns as a log of this name.
pub(crate) fn table(log: &Bound<'_, PyAny>, name: &str) -> PyResult<MemoryLog> {
    match log.cast::<PyDict>() {
        Ok(dict) => columns::log(dict, name),
        Err(_) => arrow::log(log, name),
    }
}

//! The exception of the package.
use cylwatch::run::RunError;
use pyo3::create_exception;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

create_exception!(
    cylwatch,
    CylwatchError,
    PyValueError,
    "What the program refuses, in its words; `file`, `line` and `remedy` are parts of them, or None."
);

/// The exception for an error of a run.
pub(crate) fn of(py: Python<'_>, error: &RunError) -> PyErr {
    with_parts(py, &error.to_string(), error.file(), error.line(), error.remedy())
}

/// The exception for what the package itself refuses; the remedy stands behind the last colon.
pub(crate) fn refused(py: Python<'_>, message: &str) -> PyErr {
    with_parts(py, message, None, None, message.rsplit_once(": ").map(|(_, remedy)| remedy))
}

fn with_parts(
    py: Python<'_>,
    message: &str,
    file: Option<&str>,
    line: Option<u64>,
    remedy: Option<&str>,
) -> PyErr {
    let error = CylwatchError::new_err(message.to_owned());
    let value = error.value(py);
    let set = || {
        value.setattr("file", file)?;
        value.setattr("line", line)?;
        value.setattr("remedy", remedy)
    };
    set().err().unwrap_or(error)
}

//! The border to Python: no panic passes, and Ctrl-C ends a run.
use crate::error;
use cylwatch::run::RunError;
use pyo3::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex};

/// A signal that came during a run, as the exception that Python made of it, or an exception of what the run called.
#[derive(Clone, Default)]
pub(crate) struct Signal(Arc<Mutex<Option<PyErr>>>);

impl Signal {
    /// Whether one has come; asks Python for it.
    pub(crate) fn has_come(&self) -> bool {
        if let Err(error) = Python::attach(|py| py.check_signals()) {
            self.keep(error);
        }
        self.0.lock().is_ok_and(|kept| kept.is_some())
    }

    /// Ends the run with an exception of what it called.
    pub(crate) fn keep(&self, error: PyErr) {
        if let Ok(mut kept) = self.0.lock() {
            kept.get_or_insert(error);
        }
    }

    fn take(&self) -> Option<PyErr> {
        self.0.lock().ok().and_then(|mut kept| kept.take())
    }
}

/// Runs without the interpreter. A signal is raised as Python wants it (`KeyboardInterrupt`), an error as the package's exception.
pub(crate) fn detached<T: Send>(
    py: Python<'_>,
    signal: &Signal,
    run: impl FnOnce() -> Result<T, RunError> + Send,
) -> PyResult<T> {
    let outcome = py.detach(|| caught(run));
    match signal.take() {
        Some(signal) => Err(signal),
        None => told(py, outcome),
    }
}

/// Runs with the interpreter: for what takes microseconds.
pub(crate) fn guarded<T>(py: Python<'_>, run: impl FnOnce() -> Result<T, RunError>) -> PyResult<T> {
    told(py, caught(run))
}

/// The outcome, or the words of a panic.
fn caught<T>(run: impl FnOnce() -> Result<T, RunError>) -> Result<Result<T, RunError>, String> {
    // What was being changed when a panic came is not looked at again: objects of steps are marked as broken by their caller.
    catch_unwind(AssertUnwindSafe(run)).map_err(|panic| {
        let words = panic.downcast_ref::<&str>().map(ToString::to_string);
        words.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default()
    })
}

fn told<T>(py: Python<'_>, outcome: Result<Result<T, RunError>, String>) -> PyResult<T> {
    match outcome {
        Ok(Ok(value)) => Ok(value),
        Ok(Err(refused)) => Err(error::of(py, &refused)),
        Err(words) => {
            let message =
                format!("an internal error of cylwatch, {words}: report it with the input that led to it");
            Err(error::refused(py, &message))
        }
    }
}

//! A call from Python, as data that goes to the run without the interpreter.
use crate::arguments::{self, Document};
use crate::border::{self, Signal};
use crate::outcome::Outcome;
use crate::{arrow, error};
use cylwatch::run::{self, Call, MemoryLog, RunError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

/// The second argument of a call.
enum Second {
    Frame(MemoryLog),
    File(PathBuf),
    Scenario(Document),
    Nothing,
}

/// A call.
pub(crate) struct Request {
    command: &'static str,
    vessel: Document,
    second: Second,
    options: arguments::Options,
}

impl Request {
    /// A call with a log: a table of Arrow, or a path.
    pub(crate) fn of_log(
        command: &'static str,
        vessel: &Bound<'_, PyAny>,
        log: &Bound<'_, PyAny>,
        options: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let second = if log.hasattr("__arrow_c_stream__")? {
            Second::Frame(arrow::log(log)?)
        } else if let Ok(path) = log.extract::<PathBuf>() {
            Second::File(path)
        } else {
            let name = log.get_type().name()?;
            let message = format!(
                "log is of type {name}: give a path, or a table with Arrow's interface, as of pandas 2.2, Polars or pyarrow"
            );
            return Err(error::refused(log.py(), &message));
        };
        let vessel = arguments::document(vessel, "vessel")?;
        Ok(Self { command, vessel, second, options: arguments::options(options)? })
    }

    /// A call with a scenario.
    pub(crate) fn of_scenario(
        vessel: &Bound<'_, PyAny>,
        scenario: &Bound<'_, PyAny>,
        options: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let second = Second::Scenario(arguments::document(scenario, "scenario")?);
        let vessel = arguments::document(vessel, "vessel")?;
        Ok(Self { command: "simulate", vessel, second, options: arguments::options(options)? })
    }

    /// A call without log or scenario.
    pub(crate) fn of_steps(
        command: &'static str,
        vessel: &Bound<'_, PyAny>,
        options: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let vessel = arguments::document(vessel, "vessel")?;
        Ok(Self { command, vessel, second: Second::Nothing, options: arguments::options(options)? })
    }

    /// With one more option.
    pub(crate) fn with(mut self, name: &str, value: Option<String>) -> Self {
        self.options.options.push((name.to_owned(), value));
        self
    }

    /// Runs without the interpreter.
    pub(crate) fn run(
        self,
        py: Python<'_>,
        run: fn(Call) -> Result<run::Outcome, RunError>,
    ) -> PyResult<Outcome> {
        let signal = Signal::default();
        let asked = signal.clone();
        let outcome = border::detached(py, &signal, move || {
            run(self.into_call().stopped_by(move || asked.has_come()))
        })?;
        Outcome::new(py, outcome)
    }

    /// As the library takes it.
    pub(crate) fn into_call(self) -> Call {
        let shown = format!("cylwatch.{} (Python)", self.command);
        let call = match self.vessel {
            Document::Place(place) => Call::new(place),
            Document::Text(text) => Call::of_text(text),
        };
        let call = match self.second {
            Second::Frame(log) => call.log(log),
            Second::File(path) => call.log_file(&path),
            Second::Scenario(Document::Place(place)) => call.scenario(place),
            Second::Scenario(Document::Text(text)) => call.scenario_of_text(text),
            Second::Nothing => call,
        };
        let documents = self.options.documents.into_iter();
        let call = documents.fold(call.shown_as(shown), |call, (name, text)| call.document(&name, text));
        let options = self.options.options.into_iter();
        options.fold(call, |call, (name, value)| call.option(&name, value.as_deref()))
    }
}

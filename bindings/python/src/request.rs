//! A call from Python, as data that goes to the run without the interpreter.
use crate::arguments::{self, Document};
use crate::border::{self, Signal};
use crate::error;
use crate::outcome::Outcome;
use crate::table::table;
use cylwatch::run::{self, Call, MemoryLog, RunError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

/// What stands before the options.
enum Place {
    Frame(MemoryLog),
    File(PathBuf),
    Scenario(Document),
}

/// What messages call a table.
pub(crate) const FRAME: &str = "<frame>";

/// A call.
pub(crate) struct Request {
    command: &'static str,
    vessel: Option<Document>,
    places: Vec<Place>,
    options: arguments::Options,
}

type Keywords<'a, 'py> = Option<&'a Bound<'py, PyDict>>;

impl Request {
    /// A call without logs and scenario.
    pub(crate) fn new(
        command: &'static str,
        vessel: Option<&Bound<'_, PyAny>>,
        options: Keywords<'_, '_>,
    ) -> PyResult<Self> {
        let vessel = vessel.map(|vessel| arguments::document(vessel, "vessel")).transpose()?;
        Ok(Self { command, vessel, places: Vec::new(), options: arguments::options(options)? })
    }

    /// With a log: a table of Arrow, a dict of columns, or a path.
    pub(crate) fn with_log(mut self, log: &Bound<'_, PyAny>) -> PyResult<Self> {
        self.places.push(place(log, FRAME)?);
        Ok(self)
    }

    /// A call of `calibrate`: a log or a list of them, each with a scenario and a vessel if they are lists, too.
    pub(crate) fn of_logs(
        vessel: &Bound<'_, PyAny>,
        logs: &Bound<'_, PyAny>,
        options: Keywords<'_, '_>,
    ) -> PyResult<Self> {
        let keywords = options.map_or_else(|| Ok(PyDict::new(vessel.py())), Bound::copy)?;
        let mut of_logs = Vec::new();
        for key in ["scenario", "vessel_of"] {
            if let Some(value) = keywords.get_item(key)? {
                keywords.del_item(key)?;
                of_logs.extend((!value.is_none()).then_some((key, value)));
            }
        }
        let mut request = Self::new("calibrate", Some(vessel), Some(&keywords))?;
        match arguments::list(logs) {
            None => request = request.with_log(logs)?,
            Some(list) => {
                let frame = |(k, log)| place(log, &format!("<frame {}>", k + 1));
                request.places = list.iter().enumerate().map(frame).collect::<PyResult<_>>()?;
            }
        }
        let names = request.names_of_logs();
        for (key, value) in of_logs {
            request.options.documents_of_logs(key, &value, &names)?;
        }
        Ok(request)
    }

    /// Names of the logs, that of `validate` last.
    fn names_of_logs(&self) -> Vec<String> {
        let name = |place: &Place| match place {
            Place::Frame(log) => log.name.clone(),
            Place::File(path) => path.to_string_lossy().into_owned(),
            Place::Scenario(_) => String::new(),
        };
        let held_out = self.options.options.iter().find(|(name, _)| name == "validate");
        let held_out =
            held_out.and_then(|(_, value)| value.clone()).filter(|value| value.parse::<f64>().is_err());
        self.places.iter().map(name).chain(held_out).collect()
    }

    /// With a scenario.
    pub(crate) fn with_scenario(mut self, scenario: &Bound<'_, PyAny>) -> PyResult<Self> {
        self.places.push(Place::Scenario(arguments::document(scenario, "scenario")?));
        Ok(self)
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
            None => Call::without_vessel(),
            Some(Document::Place(place)) => Call::new(place),
            Some(Document::Text(text)) => Call::of_text(text),
        };
        let call = self.places.into_iter().fold(call, |call, place| match place {
            Place::Frame(log) => call.log(log),
            Place::File(path) => call.log_file(&path),
            Place::Scenario(Document::Place(place)) => call.scenario(place),
            Place::Scenario(Document::Text(text)) => call.scenario_of_text(text),
        });
        let call = self.options.logs.into_iter().fold(call, Call::log_of_option);
        let documents = self.options.documents.into_iter();
        let call = documents.fold(call.shown_as(shown), |call, (name, text)| call.document(&name, text));
        let options = self.options.options.into_iter();
        options.fold(call, |call, (name, value)| call.option(&name, value.as_deref()))
    }
}

/// A log: a table, or a path.
fn place(log: &Bound<'_, PyAny>, name: &str) -> PyResult<Place> {
    if log.is_instance_of::<PyDict>() || log.hasattr("__arrow_c_stream__")? {
        return Ok(Place::Frame(table(log, name)?));
    }
    log.extract::<PathBuf>().map(Place::File).map_err(|_| {
        let kind = log.get_type().name().map_or_else(|_| String::new(), |kind| kind.to_string());
        let message = format!(
            "log is of type {kind}: give a path, a table with Arrow's interface, as of pandas 2.2, Polars or pyarrow, or a dict of arrays"
        );
        error::refused(log.py(), &message)
    })
}

//! The commands for programs: what `cylwatch monitor`, `fleet`, `estimate`, `simulate`, `identify`, `calibrate`, `place` and `properties` do,
//! without a shell.
//!
//! A [`Call`] names vessel, log and options as a command line does; the log may be columns in memory ([`MemoryLog`]). The run goes
//! the way of the command, so that every number is the command's, and hands out an [`Outcome`] instead of files: rows with all
//! digits, events, the summary, the report with its figure.
//!
//! ```
//! use cylwatch::log::{Cells, MemoryLog};
//! use cylwatch::run::{self, Call};
//!
//! # fn main() -> Result<(), run::RunError> {
//! let hours: Vec<f64> = (0..48).map(f64::from).collect();
//! let log = MemoryLog {
//!     name: "frame".to_owned(),
//!     columns: vec![
//!         ("shoulder_degc".to_owned(), Cells::Numbers(hours.iter().map(|h| 15.0 + (0.26 * h).sin()).collect())),
//!         ("pressure_bar".to_owned(), Cells::Numbers(hours.iter().map(|h| 200.0 + 0.7 * (0.26 * h).sin()).collect())),
//!         ("time_h".to_owned(), Cells::Numbers(hours)),
//!     ],
//! };
//! let outcome = run::monitor(Call::new("nitrogen-20l").log(log).option("settled", None))?;
//! assert_eq!((outcome.rows.columns[0].name.as_str(), outcome.exit_code == 2), ("time_s", false));
//! # Ok(())
//! # }
//! ```
mod error;
mod steps;

pub use crate::log::{Cells, MemoryLog};
pub use error::RunError;
pub use steps::{MonitorSteps, ObserverSteps, RowsWanted, StepTime, Told};

use crate::cli::{self, Host, called, properties_of};
pub use crate::cli::{FleetOutcome, FleetProgress, Outcome};
use crate::report::{Page, Table};
use std::cell::RefCell;
use std::ffi::OsString;
use std::path::Path;
use std::rc::Rc;

/// What messages call a vessel that is given as text.
const VESSEL: &str = "<vessel>";
/// What messages call a scenario that is given as text.
const SCENARIO: &str = "<scenario>";

/// A call of a command.
pub struct Call {
    host: Host,
    /// Vessel, logs, scenario, as a command line has them before its options.
    places: Vec<OsString>,
    options: Vec<OsString>,
}

impl Call {
    /// A call for a vessel: the name of a built-in one, or the path of a file.
    pub fn new(vessel: impl Into<OsString>) -> Self {
        Self { places: vec![vessel.into()], ..Self::without_vessel() }
    }

    /// A call of a command that takes no vessel: [`identify`].
    pub fn without_vessel() -> Self {
        let host = Host { command: "a call from a program".to_owned(), ..Host::default() };
        Self { host, places: Vec::new(), options: Vec::new() }
    }

    /// A call for a vessel that is given as TOML.
    pub fn of_text(vessel: impl Into<String>) -> Self {
        Self::new(VESSEL).document(VESSEL, vessel)
    }

    /// A call for a fleet: the folder of its logs, and the folder for the results. The option `vessels` names the file with a row
    /// for each cylinder, or `vessel` the vessel of all.
    pub fn of_fleet(logs: &Path, output: &Path) -> Self {
        let mut place = OsString::from("--output=");
        place.push(output);
        let call = Self::new(logs);
        Self { options: vec![place], ..call }
    }

    /// The call as provenance shows it.
    #[must_use]
    pub fn shown_as(mut self, command: impl Into<String>) -> Self {
        self.host.command = command.into();
        self
    }

    /// With a log in memory. [`calibrate`] takes several, each with a name of its own, and files among them.
    #[must_use]
    pub fn log(mut self, log: MemoryLog) -> Self {
        self.places.push(OsString::from(&log.name));
        self.log_of_option(log)
    }

    /// With the log of a file.
    #[must_use]
    pub fn log_file(mut self, path: &Path) -> Self {
        self.places.push(path.into());
        self
    }

    /// With a log in memory that stands for the file of its name where an option names it, as `validate` of [`calibrate`] and
    /// [`identify`] does.
    #[must_use]
    pub fn log_of_option(self, log: MemoryLog) -> Self {
        self.host.logs.borrow_mut().push(log);
        self
    }

    /// With a scenario: the name of a built-in one, or the path of a file.
    #[must_use]
    pub fn scenario(mut self, scenario: impl Into<OsString>) -> Self {
        self.places.push(scenario.into());
        self
    }

    /// With a scenario that is given as TOML.
    #[must_use]
    pub fn scenario_of_text(self, scenario: impl Into<String>) -> Self {
        self.scenario(SCENARIO).document(SCENARIO, scenario)
    }

    /// With an option of the command line, without its dashes (`limit-bar`), and its value; `None`: a switch. Options that name
    /// places of results are refused by the run.
    #[must_use]
    pub fn option(mut self, name: &str, value: Option<&str>) -> Self {
        self.options.push(match value {
            Some(value) => format!("--{name}={value}").into(),
            None => format!("--{name}").into(),
        });
        self
    }

    /// With a text that stands for the file `name` wherever an option names it.
    #[must_use]
    pub fn document(mut self, name: &str, text: impl Into<String>) -> Self {
        self.host.documents.push((name.to_owned(), text.into()));
        self
    }

    /// With a question that is asked every thousand rows of a log, and every 50 ms of a simulation or a search: whether the run is to
    /// end, which is then [an error](RunError::is_stopped).
    #[must_use]
    pub fn stopped_by(mut self, stop: impl FnMut() -> bool + 'static) -> Self {
        self.host.stop = Some(Rc::new(RefCell::new(stop)));
        self
    }

    /// With somebody who is told how far a [`fleet`] is, each time when cylinders have been done, at most every 50 ms.
    #[must_use]
    pub fn progress(mut self, progress: impl FnMut(FleetProgress) + 'static) -> Self {
        self.host.progress = Some(RefCell::new(Box::new(progress)));
        self
    }

    fn arguments(&self, command: &str) -> Vec<OsString> {
        let command = std::iter::once(command.into());
        command.chain(self.places.iter().cloned()).chain(self.options.iter().cloned()).collect()
    }

    /// A log's place is filled by what never is a file.
    fn arguments_without_log(&self, command: &str) -> Vec<OsString> {
        let mut arguments = self.arguments(command);
        arguments.insert(1 + self.places.len(), "<steps>".into());
        arguments
    }

    fn run(self, command: &str) -> Result<Outcome, RunError> {
        let arguments = self.arguments(command);
        called(self.host, &arguments).map_err(|error| RunError::of(&error))
    }
}

impl Outcome {
    /// The rows as the command writes them, with comment lines at the top.
    pub fn to_csv(&self) -> String {
        self.rows.to_csv(&self.provenance, &[])
    }

    /// The report as a page that refers to nothing outside.
    ///
    /// # Errors
    /// The figure cannot be drawn.
    pub fn to_html(&self) -> Result<String, RunError> {
        let page = Page { report: &self.report, provenance: &self.provenance }.to_html();
        page.map_err(|error| RunError::of(&error.into()))
    }
}

/// Monitors a log: `cylwatch monitor`.
///
/// # Errors
/// As of the command: vessel, log or an option is refused, or the run was stopped.
pub fn monitor(call: Call) -> Result<Outcome, RunError> {
    call.run("monitor")
}

/// Estimates gas temperature, mass and leak rate from a log: `cylwatch estimate`.
///
/// # Errors
/// As of the command: vessel, log or an option is refused, or the run was stopped.
pub fn estimate(call: Call) -> Result<Outcome, RunError> {
    call.run("estimate")
}

/// Simulates a vessel in a scenario: `cylwatch simulate`.
///
/// # Errors
/// As of the command: vessel, scenario or an option is refused, or the solver fails.
pub fn simulate(call: Call) -> Result<Outcome, RunError> {
    call.run("simulate")
}

/// Monitors many cylinders on all cores: `cylwatch fleet`. The folder of results is the command's, to the last byte; the tables are
/// handed out as well. A run that was stopped is resumed by the same call.
///
/// # Errors
/// As of the command: a folder, the file of vessels or an option is refused, nothing could be read, or the run was stopped.
pub fn fleet(call: Call) -> Result<FleetOutcome, RunError> {
    let arguments = call.arguments("fleet");
    cli::fleet_of(call.host, &arguments).map_err(|error| RunError::of(&error))
}

/// Identifies a transfer function from one column of a log to another: `cylwatch identify`. The call has [no
/// vessel](Call::without_vessel), a log and the options `input` and `output`. The rows are data, model and errors; the summary is the
/// command's JSON, with the coefficients in `coefficients`.
///
/// # Errors
/// As of the command: log or an option is refused, the log does not determine the model, or the run was stopped.
pub fn identify(call: Call) -> Result<Outcome, RunError> {
    call.run("identify")
}

/// Fits physical parameters of a vessel to logs: `cylwatch calibrate`. The rows are the parameters with their intervals, the
/// summary is the command's JSON; [`Outcome::vessel`] is the calibrated vessel for [`Call::of_text`], [`Outcome::sensors`] the sensors.
///
/// # Errors
/// As of the command: vessel, a log or an option is refused, the logs do not determine the parameters, or the run was stopped.
pub fn calibrate(call: Call) -> Result<Outcome, RunError> {
    call.run("calibrate")
}

/// Finds where sensors should sit: `cylwatch place`. The rows are the judged layouts, the summary is the command's JSON. A search
/// that `time-limit-min` ends has what was found, and exit code 3.
///
/// # Errors
/// As of the command: vessel, a scenario, a candidate or an option is refused, no layout sees what it should, or the run was stopped.
pub fn place(call: Call) -> Result<Outcome, RunError> {
    call.run("place")
}

/// Properties of a gas at a state: `cylwatch properties`; a table of one row with the units in the names of its columns. The
/// options fix two of temperature, pressure and density, as `("temperature-degc", "15")`.
///
/// # Errors
/// The gas is unknown, an option is refused, or the gas does not have the state.
pub fn properties(gas: &str, options: &[(String, String)]) -> Result<Table, RunError> {
    let options = options.iter().map(|(name, value)| format!("--{name}={value}").into());
    let arguments: Vec<OsString> = ["properties".into(), gas.into()].into_iter().chain(options).collect();
    properties_of(&arguments).map_err(|error| RunError::of(&error))
}

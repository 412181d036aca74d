//! Monitor and observer step by step, for programs that have the readings as they come.
use super::{Call, MemoryLog, RunError};
use crate::cli::{self, EstimateSteps, MonitorStepper};
pub use crate::cli::{RowsWanted, StepTime, Told};
use crate::report::Table;

/// A monitor that is fed row by row and hands out what `cylwatch monitor` writes for the same rows. It can be saved and restored at any row.
///
/// A row of readings has the names and units of the columns of a log. Without a stated fill, rows wait until one has a pressure.
pub struct MonitorSteps(MonitorStepper);

impl MonitorSteps {
    /// A monitor of a vessel with the options of the command; the call has no log.
    ///
    /// # Errors
    /// Vessel or an option is refused.
    pub fn new(call: Call) -> Result<Self, RunError> {
        let arguments = call.arguments_without_log("monitor");
        cli::monitor_steps(&arguments, call.host.documents).map(Self).map_err(|error| RunError::of(&error))
    }

    /// Takes in a row of names and values; hands out the rows that have become final, in the columns of the command, and their events
    /// and alarms. Rows that are closer together than `step` become one.
    ///
    /// # Errors
    /// A name or a time is refused, or the first rows do not fit the vessel.
    pub fn step(&mut self, time: StepTime, readings: &[(&str, f64)]) -> Result<(Table, Vec<Told>), RunError> {
        self.0.step(time, readings).map_err(|error| RunError::of(&error))
    }

    /// Takes in the rows of a table in their order, as [`MonitorSteps::step`] takes each of them, and hands out the rows that are wanted
    /// and what happened. Its columns are `time` with dates in a zone, or `time_s` or another unit, and readings in numbers.
    ///
    /// # Errors
    /// As of a step, or a column has something else. The rows before the one that is refused have been taken in.
    pub fn steps(&mut self, table: &MemoryLog, wanted: RowsWanted) -> Result<(Table, Vec<Told>), RunError> {
        self.0.steps(table, wanted).map_err(|error| RunError::of(&error))
    }

    /// Hands out the rows that are held back, as at the end of a log.
    ///
    /// # Errors
    /// The monitor fails.
    pub fn finish(&mut self) -> Result<(Table, Vec<Told>), RunError> {
        self.0.finish().map_err(|error| RunError::of(&error))
    }

    /// Verdict of the last row that came out; `unknown` before.
    pub fn verdict(&self) -> &'static str {
        self.0.verdict()
    }

    /// All of it as bytes.
    ///
    /// # Errors
    /// The state cannot be put into bytes.
    pub fn save(&self) -> Result<Vec<u8>, RunError> {
        self.0.save().map_err(|error| RunError::of(&error))
    }

    /// The bytes of the state file that `cylwatch monitor --state` and `cylwatch fleet` write after the same rows; `None`: the fill is
    /// not known yet.
    ///
    /// # Errors
    /// The state cannot be put into bytes.
    pub fn state_file(&self) -> Result<Option<Vec<u8>>, RunError> {
        self.0.state_file().map_err(|error| RunError::of(&error))
    }

    /// Goes on from bytes as if there had been no stop.
    ///
    /// # Errors
    /// They are damaged or of another vessel, other sensors or other options; all stays as it is then.
    pub fn restore(&mut self, bytes: &[u8]) -> Result<(), RunError> {
        self.0.restore(bytes).map_err(|error| RunError::of(&error))
    }
}

/// An observer that is fed row by row and hands out what `cylwatch estimate` writes for the same rows.
pub struct ObserverSteps(EstimateSteps);

impl ObserverSteps {
    /// An observer of a vessel with the options of the command; the call has no log.
    ///
    /// # Errors
    /// Vessel or an option is refused.
    pub fn new(call: Call) -> Result<Self, RunError> {
        let arguments = call.arguments_without_log("estimate");
        cli::estimate_steps(&arguments, call.host.documents).map(Self).map_err(|error| RunError::of(&error))
    }

    /// Takes in a row of names and values; hands out its estimates in the columns of the command, one row, or as many as have
    /// waited for a pressure.
    ///
    /// # Errors
    /// A name or a time is refused, or the first rows do not fit the vessel.
    pub fn step(&mut self, time: StepTime, readings: &[(&str, f64)]) -> Result<Table, RunError> {
        self.0.step(time, readings).map_err(|error| RunError::of(&error))
    }

    /// All of it as bytes.
    ///
    /// # Errors
    /// Only an observer with the filter ekf can be saved.
    pub fn save(&self) -> Result<Vec<u8>, RunError> {
        self.0.save().map_err(|error| RunError::of(&error))
    }

    /// Goes on from bytes as if there had been no stop.
    ///
    /// # Errors
    /// They are damaged or of another vessel, other sensors or other options; all stays as it is then.
    pub fn restore(&mut self, bytes: &[u8]) -> Result<(), RunError> {
        self.0.restore(bytes).map_err(|error| RunError::of(&error))
    }
}

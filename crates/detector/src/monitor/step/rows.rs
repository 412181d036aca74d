//! Rows in, outputs out.
use super::{Monitor, State};
use crate::DetectorError;
use crate::monitor::alarm::AlarmEvent;
use crate::monitor::{Event, Health, Output};
use alloc::vec::Vec;

/// Output of a row, in memory that the next one uses again.
#[derive(Debug)]
pub(super) struct Said {
    pub output: Option<Output>,
    pub health: Vec<Health>,
    events: Vec<Event>,
    pub alarms: Vec<AlarmEvent>,
}

/// Events and alarms of a row for which there is room from the first row on.
const EVENTS: usize = 16;
const ALARMS: usize = 12;

impl Said {
    pub(super) fn with_room(sensors: usize) -> Self {
        let (events, alarms) = (Vec::with_capacity(EVENTS), Vec::with_capacity(ALARMS));
        Self { output: None, health: Vec::with_capacity(sensors), events, alarms }
    }

    /// The row before is over: its memory is free.
    fn begin(&mut self) {
        if let Some(last) = self.output.take() {
            (self.health, self.events, self.alarms) = (last.health, last.events, last.alarms);
        }
        self.events.clear();
        self.alarms.clear();
    }
}

impl Monitor {
    /// Take in a row with its stamp, s, and one reading per sensor, SI, NaN where missing. What it makes ready [`next_output`](Self::next_output) gives.
    ///
    /// # Errors
    /// The row has another length; all is then as it was.
    pub fn take(&mut self, stamp_s: f64, readings: &[f64]) -> Result<(), DetectorError> {
        let State { intake, ready, .. } = &mut *self.state;
        intake.take_into(stamp_s, readings, false, ready)
    }

    /// The same of a row that says that it is replayed from a store: it never moves the clock.
    ///
    /// # Errors
    /// As [`Monitor::take`].
    pub fn take_historical(&mut self, stamp_s: f64, readings: &[f64]) -> Result<(), DetectorError> {
        let State { intake, ready, .. } = &mut *self.state;
        intake.take_into(stamp_s, readings, true, ready)
    }

    /// The rows have come to their end: what was held back is ready.
    pub fn flush(&mut self) {
        let State { intake, ready, .. } = &mut *self.state;
        intake.flush_into(ready);
    }

    /// What is said of the next row that is ready; `None`: no other one is. Several rows may be ready at once, or none. It needs no memory that it has not
    /// had since the monitor was made.
    ///
    /// # Errors
    /// The filling fits no state of the fluid.
    pub fn next_output(&mut self) -> Result<Option<&Output>, DetectorError> {
        let Some(row) = self.state.ready.rows.pop_front() else { return Ok(None) };
        self.said.begin();
        let mut events = core::mem::take(&mut self.said.events);
        // What happened without a row that could tell it comes with this one.
        events.append(&mut self.state.ready.events);
        let estimate = self.process(&row, &mut events)?;
        self.say(&row, estimate, events)?;
        Ok(self.said.output.as_ref())
    }

    /// Rows that are ready and have not been asked for; a saved state has them, too.
    pub fn ready(&self) -> usize {
        self.state.ready.rows.len()
    }

    /// What was said last; `None` before the first row, and after a restart.
    pub fn last_output(&self) -> Option<&Output> {
        self.said.output.as_ref()
    }

    /// [Take](Self::take) a row: the outputs of all that are ready.
    ///
    /// # Errors
    /// As [`Monitor::take`] and [`Monitor::next_output`].
    pub fn step(&mut self, stamp_s: f64, readings: &[f64]) -> Result<Vec<Output>, DetectorError> {
        self.take(stamp_s, readings)?;
        self.outputs()
    }

    /// [Flush](Self::flush): the outputs of all that are ready.
    ///
    /// # Errors
    /// As [`Monitor::next_output`].
    pub fn finish(&mut self) -> Result<Vec<Output>, DetectorError> {
        self.flush();
        self.outputs()
    }

    /// The outputs of all rows that are ready.
    ///
    /// # Errors
    /// As [`Monitor::next_output`].
    pub fn outputs(&mut self) -> Result<Vec<Output>, DetectorError> {
        let mut outputs = Vec::with_capacity(self.state.ready.rows.len());
        while let Some(output) = self.next_output()? {
            outputs.push(output.clone());
        }
        Ok(outputs)
    }
}

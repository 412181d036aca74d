//! A monitor between calls, and the rows that are ready.
use crate::code::{Failure, Text};
use crate::event::{CW_TEXT_SIZE, cw_alarm, cw_event};
use crate::output::{CW_MOST_SENSORS, cw_output};
use alloc::vec::Vec;
use core::str;
use cylwatch_detector::compiled::CompiledCylinder;
use cylwatch_detector::monitor::alarm::AlarmEvent;
use cylwatch_detector::monitor::{Monitor, Output};

/// The monitor, and how rows come out of it: the one place that knows.
pub(crate) struct Rows {
    monitor: Monitor,
}

impl Rows {
    /// Of the bytes of a cylinder, from the first row or from a saved state.
    pub(crate) fn of(blob: &[u8], state: Option<&[u8]>) -> Result<Self, Failure> {
        let cylinder = CompiledCylinder::from_bytes(blob)?;
        if cylinder.sensors.len() > CW_MOST_SENSORS {
            return Err(Failure::Sensors(cylinder.sensors.len()));
        }
        let monitor = match state {
            None => cylinder.monitor()?,
            Some(state) => cylinder.restored(state)?,
        };
        Ok(Self { monitor })
    }

    pub(crate) fn take_in(&mut self, time_s: f64, readings: &[f64]) -> Result<(), Failure> {
        self.check_taken()?;
        Ok(self.monitor.take(time_s, readings)?)
    }

    pub(crate) fn finish(&mut self) -> Result<(), Failure> {
        self.check_taken()?;
        self.monitor.flush();
        Ok(())
    }

    pub(crate) fn next(&mut self) -> Result<Option<&Output>, Failure> {
        Ok(self.monitor.next_output()?)
    }

    /// Into room for it, and how many bytes it is.
    pub(crate) fn save_into(&self, room: &mut [u8]) -> Result<usize, Failure> {
        self.check_taken()?;
        Ok(self.monitor.save_into(room).map_err(cylwatch_detector::DetectorError::from)?)
    }

    /// A row that nobody has taken would be lost.
    fn check_taken(&self) -> Result<(), Failure> {
        match self.monitor.ready() {
            0 => Ok(()),
            waiting => Err(Failure::RowsWaiting(waiting)),
        }
    }
}

/// What lies behind a handle.
pub(crate) struct Session {
    rows: Option<Rows>,
    /// Of an acknowledgement after the last output.
    acknowledged: Option<Vec<AlarmEvent>>,
    detail: Text<CW_TEXT_SIZE>,
}

impl Session {
    pub(crate) const EMPTY: Self = Self { rows: None, acknowledged: None, detail: Text::EMPTY };

    pub(crate) fn begin(&mut self, rows: Rows) {
        self.rows = Some(rows);
    }

    /// Drops everything that lies in the arena.
    pub(crate) fn end(&mut self) {
        (self.rows, self.acknowledged) = (None, None);
    }

    pub(crate) fn rows(&mut self) -> Result<&mut Rows, Failure> {
        self.rows.as_mut().ok_or(Failure::Ended)
    }

    /// The next row that is ready.
    pub(crate) fn next(&mut self) -> Result<Option<cw_output>, Failure> {
        let Some(output) = self.rows()?.next()? else { return Ok(None) };
        let plain = cw_output::from(output);
        self.acknowledged = None;
        Ok(Some(plain))
    }

    /// How many alarms have changed.
    pub(crate) fn acknowledge(&mut self, comment: &[u8]) -> Result<u32, Failure> {
        let comment = str::from_utf8(comment).ok().filter(|comment| comment.len() < CW_TEXT_SIZE);
        let changed = self.rows()?.monitor.acknowledge(comment.ok_or(Failure::Text)?);
        let count = changed.len() as u32;
        self.acknowledged = Some(changed);
        Ok(count)
    }

    pub(crate) fn announce(&mut self, from_s: f64, until_s: f64) -> Result<(), Failure> {
        self.rows()?.monitor.announce(from_s, until_s);
        Ok(())
    }

    pub(crate) fn event(&self, index: u32) -> Result<cw_event, Failure> {
        let none = self.acknowledged.is_some();
        one(self.last().filter(|_| !none).map_or(&[], |last| &last.events), index)
    }

    pub(crate) fn alarm(&self, index: u32) -> Result<cw_alarm, Failure> {
        let of_row = || self.last().map_or(&[][..], |last| &last.alarms);
        one(self.acknowledged.as_deref().unwrap_or_else(of_row), index)
    }

    fn last(&self) -> Option<&Output> {
        self.rows.as_ref().and_then(|rows| rows.monitor.last_output())
    }

    pub(crate) fn explain(&mut self, failure: &Failure) {
        self.detail = Text::of(failure);
    }

    pub(crate) fn detail(&self) -> &[u8] {
        self.detail.as_bytes()
    }
}

fn one<'a, T, P: From<&'a T>>(all: &'a [T], index: u32) -> Result<P, Failure> {
    all.get(index as usize).map(P::from).ok_or(Failure::Index { index, count: all.len() })
}

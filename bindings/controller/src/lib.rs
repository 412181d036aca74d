//! A log goes through the monitor of a compiled cylinder, and every bit of what it says comes out: the same code on a
//! microcontroller and on the host, so that files can be compared.
//!
//! The log is CSV in SI: `time_s`, then a column for each sensor of the cylinder, in its order; an empty cell is a reading that is missing. In the
//! middle the monitor is saved and goes on from its state. What comes out, little endian: for each row of the monitor, and for
//! the last state, its length as u32 and its bytes, which are postcard's.
#![no_std]
use core::fmt;
use cylwatch_detector::DetectorError;
use cylwatch_detector::compiled::CompiledCylinder;
use cylwatch_detector::monitor::Monitor;

mod row;

/// Most sensors of a cylinder.
pub const MOST_SENSORS: usize = 8;

/// Bytes of a state at most.
pub const LARGEST_STATE: usize = 24 << 10;

/// Bytes of an output at most.
const LARGEST_OUTPUT: usize = 4096;

/// Why a replay ended.
#[derive(Debug)]
pub enum ReplayError {
    /// The monitor refused something, in this line of the log; 0: before the first.
    Monitor(usize, DetectorError),
    /// A line has a cell that is no number, or another number of cells.
    Line(usize),
    /// An output or a state is longer than there is room for.
    Bytes,
}

impl fmt::Display for ReplayError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Monitor(line, error) => write!(f, "line {line}: {error}"),
            Self::Line(line) => write!(f, "line {line}: give time_s and a number or nothing for each sensor"),
            Self::Bytes => write!(f, "there is too little room for an output or a state"),
        }
    }
}

/// What is told while a log goes through.
pub trait Observed {
    /// Bytes of the result.
    fn write(&mut self, bytes: &[u8]);
    /// The monitor is there, and no row has been read.
    fn begun(&mut self) {}
    /// The monitor is to be saved and restored.
    fn saving(&mut self) {}
    /// It has been saved.
    fn saved(&mut self) {}
    /// It has been restored.
    fn restored(&mut self) {}
    /// The monitor begins to work.
    fn work(&mut self) {}
    /// It rests.
    fn rest(&mut self) {}
    /// It has said something of a row of this time, s.
    fn said(&mut self, _time_s: f64) {}
    /// It is done with the row of this line.
    fn done(&mut self, _line: usize) {}
}

/// Replays a log, with room for a state.
///
/// # Errors
/// As [`ReplayError`] says.
pub fn replay(
    cylinder: &[u8],
    log: &str,
    room: &mut [u8; LARGEST_STATE],
    observed: &mut impl Observed,
) -> Result<usize, ReplayError> {
    let of = |line: usize| move |error| ReplayError::Monitor(line, error);
    let cylinder = CompiledCylinder::from_bytes(cylinder).map_err(of(0))?;
    let mut monitor = cylinder.monitor().map_err(of(0))?;
    let lines = || log.lines().enumerate().skip(1).filter(|(_, line)| !line.is_empty());
    let middle = lines().count() / 2;
    observed.begun();
    let mut rows = 0;
    for (count, (at, line)) in lines().enumerate() {
        let number = at + 1;
        if count == middle {
            observed.saving();
            let state = save(&monitor, number, room)?;
            observed.saved();
            // An arena need not hold two.
            drop(monitor);
            monitor = cylinder.restored(state).map_err(of(number))?;
            observed.restored();
        }
        let mut cells = [f64::NAN; 1 + MOST_SENSORS];
        let mut length = 0;
        for text in line.split(',') {
            let cell = cells.get_mut(length).ok_or(ReplayError::Line(number))?;
            *cell = if text.is_empty() {
                f64::NAN
            } else {
                text.parse().map_err(|_| ReplayError::Line(number))?
            };
            length += 1;
        }
        observed.work();
        let taken = row::take(&mut monitor, cells[0], &cells[1..length]);
        observed.rest();
        taken.map_err(of(number))?;
        rows += put(&mut monitor, number, observed)?;
        observed.done(number);
    }
    row::flush(&mut monitor);
    rows += put(&mut monitor, 0, observed)?;
    framed(save(&monitor, 0, room)?, observed);
    Ok(rows)
}

fn save<'a>(monitor: &Monitor, line: usize, room: &'a mut [u8]) -> Result<&'a [u8], ReplayError> {
    let length = monitor.save_into(room).map_err(|error| ReplayError::Monitor(line, error.into()))?;
    room.get(..length).ok_or(ReplayError::Bytes)
}

/// Write what the monitor says of the rows that are ready, and count them.
fn put(monitor: &mut Monitor, line: usize, observed: &mut impl Observed) -> Result<usize, ReplayError> {
    let mut rows = 0;
    loop {
        observed.work();
        let output = row::next_output(monitor);
        observed.rest();
        let Some(output) = output.map_err(|error| ReplayError::Monitor(line, error))? else {
            return Ok(rows);
        };
        observed.said(output.estimate.time_s);
        let mut bytes = [0; LARGEST_OUTPUT];
        let bytes = postcard::to_slice(output, &mut bytes).map_err(|_| ReplayError::Bytes)?;
        framed(bytes, observed);
        rows += 1;
    }
}

fn framed(bytes: &[u8], observed: &mut impl Observed) {
    observed.write(&(bytes.len() as u32).to_le_bytes());
    observed.write(bytes);
}

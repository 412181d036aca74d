//! What a saved state is held to before a monitor goes on from it. A check sum finds accidents, not what was sealed with a wrong value in it: a length
//! that an index relies on, a count that has no place for one more, a time from which a step would take years.
use crate::DetectorError;
use crate::monitor::intake::settings::IntakeSettings;

/// Longest gap between two rows, as a multiple of the longest that is believed of rows that come often.
const LONGEST: f64 = 4.0;
/// Most that is ever counted one by one.
const COUNTED: u64 = 1 << 31;

/// What the parts of a state are checked against.
#[derive(Clone, Copy, Debug)]
pub(super) struct Restored {
    /// Number of sensors.
    pub sensors: usize,
    /// Time of the latest row that was accepted, s; minus infinity: of none.
    latest_s: f64,
    /// How far from it what has been taken last may be, s.
    longest_s: f64,
}

/// Refuse a value that is not as it must be.
pub(super) fn require(
    ok: bool,
    what: &'static str,
    value: f64,
    bound: &'static str,
) -> Result<(), DetectorError> {
    if ok { Ok(()) } else { Err(DetectorError::Restored { what, value, bound: bound.into() }) }
}

/// A number, or the length of a list, that is no more than so much.
pub(super) fn at_most(most: usize, what: &'static str, length: usize) -> Result<(), DetectorError> {
    if length <= most {
        return Ok(());
    }
    Err(DetectorError::Restored { what, value: length as f64, bound: format!("at most {most}").into() })
}

/// A count that has place for more.
pub(super) fn count(what: &'static str, count: u64) -> Result<(), DetectorError> {
    require(count < COUNTED, what, count as f64, "below 2^31")
}

/// Which one of two.
pub(super) fn one_of_two(what: &'static str, which: usize) -> Result<(), DetectorError> {
    require(which < 2, what, which as f64, "0 or 1")
}

impl Restored {
    /// A state with so many sensors whose latest row was accepted at a time, s.
    pub(super) fn new(sensors: usize, latest_s: f64, settings: &IntakeSettings) -> Self {
        let longest_s = LONGEST * settings.longest_gap_s + settings.lateness_s;
        Self { sensors, latest_s, longest_s }
    }

    /// As many elements as there are sensors.
    pub(super) fn each(&self, what: &'static str, length: usize) -> Result<(), DetectorError> {
        require(length == self.sensors, what, length as f64, "one for each sensor")
    }

    /// The number of a sensor.
    pub(super) fn sensor(&self, what: &'static str, sensor: usize) -> Result<(), DetectorError> {
        require(sensor < self.sensors, what, sensor as f64, "a sensor's number")
    }

    /// A time that a step counts from.
    pub(super) fn time(&self, what: &'static str, time_s: f64) -> Result<(), DetectorError> {
        let near = (time_s - self.latest_s).abs() <= self.longest_s;
        require(near, what, time_s, "no farther from the latest row than a gap may be")
    }

    /// The same of one that may not be there.
    pub(super) fn any_time(&self, what: &'static str, time_s: Option<f64>) -> Result<(), DetectorError> {
        time_s.map_or(Ok(()), |time_s| self.time(what, time_s))
    }
}

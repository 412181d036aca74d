//! A study of sensor positions as words, as a figure, as CSV and JSON.
//!
//! | part | what it says |
//! |---|---|
//! | `summary` | the answer, what was asked, and the order of the tables |
//! | `rankings` | the best layouts, and layouts by every number |
//! | `places` | cost against accuracy, and one thermometer anywhere |
//! | `faults` | sensors lost and at fault, unknown errors |
//! | `paper` | the same places by the paper's measure |
//! | `achieved` | what Monte Carlo runs achieve |
//! | `document` | CSV, JSON, matrices |
//! | `figure`, `outline` | the picture |
mod achieved;
mod document;
mod faults;
mod figure;
mod outline;
mod paper;
mod places;
mod rankings;
mod summary;

pub(crate) use document::matrices;

use super::number;
use crate::estimator::log::Quantity;
use crate::estimator::placement::study::Study;
use crate::estimator::placement::{Candidates, Criterion, Status};
use crate::estimator::sensor::{Site, SurfacePlace};
use crate::evaluation::placement::{ClosedLoop, ClosedLoopSettings};
use crate::thermal::vessel::Vessel;

/// What the figure shows.
pub(crate) const CAPTION: &str = "The cylinder to scale with its candidates and what a thermometer at each height is worth; cost against accuracy; what the best \
                           layouts reach.";

const MILLIMETRES: f64 = 1e3;
/// Significant digits of the tables.
const DIGITS: usize = 3;

/// A study with what it is of.
#[derive(Clone, Copy, Debug)]
pub struct PlacementReport<'a> {
    /// The study.
    pub study: &'a Study,
    /// Its candidates.
    pub candidates: &'a Candidates,
    /// Its vessel.
    pub vessel: &'a Vessel,
    /// Monte Carlo runs that were asked for.
    pub runs: ClosedLoopSettings,
    /// What the best layouts of most sensors achieve in them; `None`: there were none.
    pub closed_loop: Option<&'a ClosedLoop>,
}

/// A unit that people think in.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Unit {
    symbol: &'static str,
    /// Of it in the SI unit.
    per_si: f64,
}

const KELVIN: Unit = Unit { symbol: "K", per_si: 1.0 };
const BAR: Unit = Unit { symbol: "bar", per_si: 1e-5 };
const WATT: Unit = Unit { symbol: "W", per_si: 1.0 };
const GRAM: Unit = Unit { symbol: "g", per_si: crate::report::GRAM };
const GRAM_PER_HOUR: Unit = Unit { symbol: "g/h", per_si: crate::report::GRAM_PER_HOUR };
const HOUR: Unit = Unit { symbol: "h", per_si: 1.0 / crate::report::HOUR_S };

impl Unit {
    fn of(criterion: Criterion) -> Self {
        match criterion {
            Criterion::GasTemperature | Criterion::Scenario(_) => KELVIN,
            Criterion::Mass => GRAM,
            Criterion::LeakRate | Criterion::SmallestLeak => GRAM_PER_HOUR,
        }
    }

    /// The number of an SI value; infinite: empty.
    fn number(self, si: f64) -> String {
        if si.is_finite() { number(self.per_si * si, DIGITS) } else { String::new() }
    }

    /// With its symbol.
    fn with_symbol(self, si: f64) -> String {
        format!("{} {}", self.number(si), self.symbol)
    }
}

impl PlacementReport<'_> {
    /// Whether study or runs were stopped before their end.
    pub(crate) fn is_partial(&self) -> bool {
        self.study.partial || self.closed_loop.is_some_and(|found| found.partial)
    }

    fn name(&self, sensor: usize) -> &str {
        self.study.candidates.get(sensor).map_or("?", String::as_str)
    }

    fn is(&self, sensor: usize, status: Status) -> bool {
        self.candidates.list.get(sensor).is_some_and(|candidate| candidate.status == status)
    }

    /// Names of all sensors of a layout.
    fn names(&self, layout: &[usize]) -> String {
        layout.iter().map(|&sensor| self.name(sensor)).collect::<Vec<_>>().join(" + ")
    }

    /// Names of those that were chosen: what every layout has goes without saying.
    fn chosen(&self, layout: &[usize]) -> String {
        let chosen: Vec<usize> =
            layout.iter().copied().filter(|sensor| !self.is(*sensor, Status::Required)).collect();
        if chosen.is_empty() { "nothing else".into() } else { self.names(&chosen) }
    }

    /// Names of what every layout has.
    fn required(&self) -> Option<String> {
        let required: Vec<usize> =
            (0..self.study.candidates.len()).filter(|sensor| self.is(*sensor, Status::Required)).collect();
        (!required.is_empty()).then(|| self.names(&required))
    }

    /// Unit of what a sensor reads.
    fn unit_of(&self, sensor: usize) -> Unit {
        match self.candidates.list.get(sensor).map(|candidate| candidate.sensor.quantity()) {
            Some(Quantity::Pressure) => BAR,
            _ => KELVIN,
        }
    }

    /// Whether a sensor sits on a place that the paper asks about: its name.
    fn asked_about(&self, sensor: usize) -> Option<&'static str> {
        match self.candidates.list.get(sensor)?.sensor.site() {
            Site::Surface(SurfacePlace::Shoulder) => Some("shoulder"),
            Site::Surface(SurfacePlace::Valve) => Some("valve"),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests;

//! What a monitor says: rows of a file, events and alarms in words and as JSON lines, a summary to act on, a figure.
//!
//! Everything takes one output after the other and keeps what fits in bounded memory.
mod alarm;
mod event;
mod figure;
mod marks;
mod prognosis;
mod row;
mod strip;
mod summary;

pub(crate) use alarm::{alarm_line, alarm_text};
#[cfg(feature = "serve")]
pub(crate) use alarm::{transition_line, transition_text};
pub(crate) use event::{Naming, event_line, event_text, health_text, health_word};
pub(crate) use figure::{FigureData, figure};
pub(crate) use prognosis::{passage_text, reaction_reason, reaction_text, reaction_word};
pub(crate) use row::{DOCUMENTATION, MonitorRow, fields};
pub(crate) use strip::VerdictStrip;
pub(crate) use summary::{OperatingLimits, RowCounts, Summary, document, summary};

/// What the figure of a run shows.
pub(crate) const CAPTION: &str = "Pressure at 15 °C and as read with the limit, mass and leak rate with their intervals, verdicts as colours, events \
                           and alarms as marks.";

/// A number for people: so many digits that count, none that do not.
fn short(value: f64) -> String {
    crate::report::number(value, 3)
}

//! Many cylinders: a row each with the most urgent first, what happened, what could not be read, and a page.
//!
//! [`Cylinder`] is what is left of a cylinder when its log has gone: numbers as the monitor gave them, SI.
#[cfg(feature = "serve")]
mod live;
mod order;
mod page;
mod row;
mod tables;
mod trace;
mod words;

#[cfg(feature = "serve")]
pub(crate) use live::{live_page, live_policy, live_row};
pub(crate) use order::sort_by_urgency;
pub(crate) use page::page;
pub(crate) use row::{Cylinder, Fault, Finding, Source};
pub(crate) use tables::{EventRow, errors, events, summary};
pub(crate) use trace::Trace;
pub(crate) use words::report;

/// What the columns of the tables mean, for a help page.
pub(crate) const DOCUMENTATION: &str = "\
Columns of summary, a row for each cylinder, the most urgent first:
  cylinder, vessel       names
  light                  act, plan, unknown or fine: the colour of the page
  outcome                loss: gas was lost in these rows; no-loss; unknown
  verdict, reason        as by `monitor` at the last row, and why it is unknown
  reaction, due_because  what is due, and why
  leak_probability       that gas is being lost
  p15_bar, limit_bar     pressure at 15 degc and the limit it is held against
  cold_pressure_bar      what will be read on the coldest night
  lost_g, _low_, _high_  gas lost since the leak began, with its 95 % interval; empty without a leak
  leak_g_h, _low_, _high_   leak rate, with its 95 % interval
  left_p5_d, _p50_, _p95_   days to the limit at 15 degc: 5, 50 and 95 %; empty: beyond horizon_d
  severity, alarms       of the alarms that stand
  sensors_at_fault       names with what is wrong
  events, cautions, rows counts; first, last: times of the first and the last row (_s: of the log)
  log, log_sha256        files
events: cylinder, time, event, in words, and the line of JSON that `monitor --events` writes.
errors: cylinder, file, line, reason, remedy.";

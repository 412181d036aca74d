//! The monitor: rows of a log in, a verdict, what it rests on and events out.
//!
//! A row goes through these, each of which can be saved and restored at any row:
//!
//! | part | what it does |
//! |---|---|
//! | [`intake`] | rows as they arrive become rows in order on one axis of time |
//! | [`readings::health`], [`readings::thermometers`] | readings that are none, stand still or have an offset that jumped |
//! | wiring | whether a channel is late or the thermometers are in each other's place: put right |
//! | filling | whether the first readings fit the filling that was stated |
//! | parity | whether one end is warmed or cooled by itself, and what the gas may be off by then |
//! | the observer | mass, gas temperature and leak rate ([`crate::estimator::observer`]) |
//! | [`gas::jump`] | a pressure that jumps: gas, transmitter or spike, told by what comes back |
//! | [`crate::evidence`] | whether gas is being lost, on time scales from an hour to a month, at a stated rate of false alarms |
//! | [`gas::onset`] | since when, how fast, how much, with intervals |
//! | outlook | the time left and the reaction that is due ([`crate::prognosis`]) |
//! | [`decide`] | verdict, probability of a leak, alarm, reaction and exit code from what is known: one function |
//! | [`alarm`] | what must be dealt with, in the words of OPC UA Part 9 |
//!
//! Where it cannot be told the verdict is [`Verdict::Unknown`] with its reason, never [`Verdict::Tight`].
//!
//! # What one cylinder cannot tell
//! A transmitter that drifts downwards looks like a leak: 0.1 % of 400 bar in a year are 5e-5 bar/h. Two cylinders exchanged for
//! each other look like cylinders.
pub mod alarm;
mod decision;
mod event;
mod examination;
mod extremes;
pub mod gas;
pub mod intake;
mod median;
mod output;
pub mod readings;
mod restored;
mod roles;
pub mod settings;
mod step;
mod verdict;

pub use decision::{Decision, Known, KnownExchange, LIKELY, Outcome, decide};
pub use event::{Event, EventKind};
pub use output::{Health, Interval, LeakFinding, Outlook, Output};
pub use settings::{Limits, MonitorSettings};
pub use step::Monitor;
pub use verdict::{Reason, Verdict};

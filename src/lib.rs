//! cylwatch tells a leaking gas cylinder from a cold one.
//!
//! This crate puts the workspace under one roof ([`thermal`], [`estimator`], [`detector`], [`evaluation`], [`cosimulation`]) and adds what the program needs:
//! logs as files ([`log`]), results as text and figures ([`report`]), gas properties (`properties`), the reproduction of
//! the paper that it follows ([`reproduce`]).
//!
//! # Data flow
//!
//! One type stands at each station, and one function leads to the next. All signatures are SI, with the unit in the name.
//!
//! | from | by | to |
//! |---|---|---|
//! | files of vessel and scenario | [`read_vessel`](thermal::vessel::read_vessel), [`read_scenario`](thermal::scenario::read_scenario) | [`Vessel`](thermal::vessel::Vessel), [`Scenario`](thermal::scenario::Scenario) |
//! | vessel and scenario | [`simulate`](thermal::simulate::simulate) | [`Trajectory`](thermal::trajectory::Trajectory) |
//! | trajectory and [sensors](estimator::sensor) | [`sample`](estimator::sensor::sample) | [`Log`](estimator::log::Log) |
//! | a file of readings | [`LogReader`](log::LogReader), or [`Inspector`](log::inspect::Inspector) for an unknown one | rows |
//! | rows | [`Observer`](estimator::observer::Observer) | [`Estimate`](estimator::observer::Estimate): gas temperature, mass and leak rate with standard deviations |
//! | rows | [`Monitor`](detector::monitor::Monitor) | [`Output`](detector::monitor::Output): [`Verdict`](detector::monitor::Verdict), events, time left |
//! | any result | [`report`] | tables, JSON, [`Figure`](report::figure::Figure) |
//!
//! Three ways lead back from a log: [`identify`](estimator::identify) finds the transfer function from one reading to
//! another, [`calibrate`](estimator::calibrate) the films, capacities and contacts of a vessel, and
//! [`placement`](estimator::placement) tells beforehand where sensors should sit so that the rest goes well.
//!
//! # From a vessel to a verdict
//!
//! ```
//! use cylwatch::detector::monitor::{Monitor, MonitorSettings, Verdict};
//! use cylwatch::estimator::observer::Commissioning;
//! use cylwatch::estimator::sensor::{Sensor, SensorSuite, sample};
//! use cylwatch::report::simulation;
//! use cylwatch::thermal::simulate::{SimulationSettings, simulate};
//! use cylwatch::thermal::{scenario, vessel};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // A cylinder leaves the cold for a warm tunnel and begins to leak 60 g/h: the pressure rises all the same.
//! let vessel = vessel::presets::load("nitrogen-20l")?;
//! let scenario = scenario::presets::load("leak-after-tunnel")?;
//! let run = simulate(&vessel, &scenario, &SimulationSettings::default(), &mut |_done| ())?;
//! println!("{}", simulation::summary(&run).to_text());
//!
//! // What two thermometers and a transmitter read, with the errors of drawn specimens.
//! let sensors = vec![Sensor::typical("shoulder")?, Sensor::typical("valve")?, Sensor::typical("pressure")?];
//! let log = sample(&run, &SensorSuite::try_new(sensors.clone())?.draw(7), 7)?;
//!
//! // The monitor knows the readings and what was filled in, and nothing else.
//! let filled = Commissioning::filled(200e5, 288.15);
//! let mut monitor = Monitor::new(&vessel, &sensors, &filled, &MonitorSettings::default())?;
//! let mut verdicts = Vec::new();
//! for (time_s, readings) in log.rows() {
//!     verdicts.extend(monitor.step(time_s, readings)?.into_iter().map(|output| output.decision.verdict));
//! }
//! assert_eq!(verdicts.last(), Some(&Verdict::Leak));
//! # Ok(())
//! # }
//! ```
//!
//! The programs in the folder `examples` answer one question each in the same way; the `book` says what the numbers mean.
pub use cylwatch_cosimulation as cosimulation;
pub use cylwatch_detector as detector;
pub use cylwatch_estimator as estimator;
pub use cylwatch_evaluation as evaluation;
pub use cylwatch_thermal as thermal;

mod cli;
pub mod log;
mod properties;
pub mod report;
pub mod reproduce;
pub mod run;

pub use cli::main;

/// The code of the README, so that it is compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

//! The tests of this crate in one binary, modules by kind.
#![allow(clippy::unwrap_used, clippy::print_stdout)]
mod baseline;
mod campaign;
mod correlated;
mod data_calibration;
mod delay;
mod equivalence;
mod evidence;
mod failure_alarms;
mod fault;
mod intake;
mod likelihood_ratio;
mod monitor;
mod monte_carlo;
mod prognosis;
mod run_lengths;
mod state;

//! The tests of this crate in one binary, modules by kind.
#![allow(clippy::unwrap_used, clippy::print_stdout)]
mod correlated;
mod data_calibration;
mod delay;
mod equivalence;
mod failure_alarms;
mod intake;
mod likelihood_ratio;
mod monte_carlo;
mod prognosis;
mod run_lengths;
mod state;

//! Calibration against simulated logs of known truth, against a published experiment, and on logs that cannot be used.
mod assumed;
mod blowdown;
mod coverage;
mod cylinder;
mod joint;
mod refill;
mod refusals;
mod study;

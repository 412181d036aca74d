//! Tests of the program and of what it writes, by kind.
// Helpers outside of test functions fail a test by panicking, too.
#![allow(clippy::unwrap_used)]

mod bad_inputs;
mod bench_detector;
mod book;
mod browser;
mod calibrate;
mod calls;
mod commission;
mod compile;
mod estimate;
mod examples;
mod files;
mod fleet;
mod fmu;
mod foreign_log;
mod foreign_units;
mod identify;
mod inspect;
mod inspection;
mod log;
mod log_forms;
#[cfg(feature = "parquet")]
mod log_parquet;
mod monitor;
mod packaging;
mod pages;
mod peer_inputs;
mod place;
mod properties;
mod report;
mod reproduce;
#[cfg(feature = "serve")]
mod serve;
mod simulate;
mod support;
mod table_1;
mod tutorial;

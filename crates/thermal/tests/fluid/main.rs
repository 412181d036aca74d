//! Tests of the fluid properties, modules by kind.
#![allow(clippy::unwrap_used, reason = "shared functions of tests, too")]
#![allow(clippy::needless_range_loop, reason = "several arrays run side by side")]
#![allow(clippy::print_stdout, reason = "a skipped table is said")]
mod errors;
mod identities;
mod published;
mod solves;
mod support;

//! Tests of the thermal crate, modules by kind.
#![allow(clippy::unwrap_used, clippy::print_stdout)]
mod analytic;
mod blowdown;
mod conservation;
mod convergence;
mod filling;
mod jacobian;
mod measured;
mod preset_runs;
mod stepped;
mod stratified;
mod support;
mod surroundings;
mod tangents;

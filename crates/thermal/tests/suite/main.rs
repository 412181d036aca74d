//! Tests of the thermal crate, modules by kind.
mod analytic;
mod convergence;
mod blowdown;
mod conservation;
mod preset_runs;
mod jacobian;
mod support;

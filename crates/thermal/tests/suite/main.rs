//! Tests of the thermal crate, modules by kind.
mod analytic;
mod blowdown;
mod conservation;
mod convergence;
mod jacobian;
mod preset_runs;
mod support;

//! Tests of the thermal crate, modules by kind.
mod analytic;
mod convergence;
mod jacobian;
mod support;

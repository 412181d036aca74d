//! Tests of the thermal crate, modules by kind.
mod analytic;
mod convergence;
mod i1;
mod jacobian;
mod support;

//! The tests of this crate in one binary, modules by kind.
#![allow(clippy::unwrap_used, clippy::print_stdout)]
mod allocations;
mod copying_model;
mod equivalence_filters;
mod equivalence_forms;
mod equivalence_smoother;
mod equivalence_steady;
mod equivalence_unscented;
mod horizon;
mod ill_conditioned;
mod late_samples;
mod linear_model;
mod properties;
mod sensors;

//! The tests of this crate in one binary, modules by kind.
#![allow(clippy::unwrap_used, clippy::print_stdout)]
mod allocations;
mod forgery;
mod intake;
mod mutation;
mod prognosis;

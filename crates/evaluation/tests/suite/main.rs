//! The tests of this crate in one binary, modules by kind.
#![allow(clippy::unwrap_used, clippy::print_stdout)]
mod baseline;
mod campaign;
mod evidence;
mod fault;
mod honest;
mod matched;
mod monitor;
mod observer;
mod placement_confirm;

//! The tests of this crate in one binary, modules by kind.
#![allow(clippy::unwrap_used, clippy::print_stdout)]
mod baseline;
mod begin_anywhere;
mod evidence;
mod fault;
mod fault_table;
mod honest;
mod inspection;
mod matched;
mod monitor;
mod observer;
mod placement_confirm;

//! The C functions of the Functional Mock-up Interface, co-simulation of 2.0 (`fmi2`) and 3.0 (`fmi3`), for a simulated cylinder and its
//! monitor.
//!
//! Thin: all numbers, names and refusals are those of [`cylwatch_cosimulation`]; here pointers become slices and refusals a status and a
//! message to the master's logger. No panic passes (`border`), a null pointer or an instance that is none is an error, and functions that a
//! description does not announce (derivatives, clocks, model exchange) are there and refuse.
//!
//! # References
//! Functional Mock-up Interface 2.0.4 and 3.0.1, headers and sections 2 to 4. <https://fmi-standard.org>
#![allow(non_snake_case)]
#[macro_use]
mod exports;
mod border;
mod fmi2;
mod fmi3;
mod place;
mod states;

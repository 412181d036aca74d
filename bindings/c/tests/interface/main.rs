//! The C interface, called as C calls it.
// SAFETY, of every block in here: each pointer leads to memory of the test that is large enough and used by nothing else, or is wrong
// in the way that the library checks.
#![allow(clippy::undocumented_unsafe_blocks, clippy::unwrap_used)]
mod header;
mod memory;
#[path = "../../../../crates/detector/tests/suite/mutation.rs"]
mod mutation;
mod mutations;
mod refused;
mod replayed;
mod same;
mod support;

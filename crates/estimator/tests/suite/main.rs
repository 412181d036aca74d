//! The tests of this crate in one binary, modules by kind.
mod sensors;

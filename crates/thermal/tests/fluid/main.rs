//! Tests of the fluid properties, modules by kind.
mod errors;
mod identities;
mod published;
mod solves;
mod support;

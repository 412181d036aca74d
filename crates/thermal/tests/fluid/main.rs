//! Tests of the fluid properties, modules by kind.
mod published;

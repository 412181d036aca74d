//! Tests of the program and of what it writes, by kind.
mod files;
mod properties;
mod report;
mod reproduce;
mod simulate;
mod support;

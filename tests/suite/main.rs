//! Tests of the program and of what it writes, by kind.
mod report;

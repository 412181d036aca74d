//! The command-line program `cylwatch`.
fn main() {}

//! The command-line program `cylwatch`.
#![warn(unreachable_pub)]
mod cli;

fn main() -> std::process::ExitCode {
    cli::main()
}

//! The command-line program `cylwatch`.
mod cli;

fn main() -> std::process::ExitCode {
    cli::main()
}

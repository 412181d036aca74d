//! The command-line program `cylwatch`.
fn main() -> std::process::ExitCode {
    cylwatch::main()
}

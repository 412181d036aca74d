//! The command-line program `cylwatch`.
use peak_alloc::PeakAlloc;

/// Counts bytes for `compile --footprint`.
#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

fn main() -> std::process::ExitCode {
    cylwatch::main()
}

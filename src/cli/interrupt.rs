//! Ctrl-C, SIGTERM and SIGHUP: the first asks the run to end with what it has, the second ends the program.
use std::sync::atomic::{AtomicBool, Ordering};

/// What a shell expects of a program that SIGINT ended.
pub(super) const CODE: i32 = 130;

static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// Listens from now on; `first` runs, on a thread of its own, when the first signal comes.
pub(super) fn listen(mut first: impl FnMut() + Send + 'static) -> anyhow::Result<()> {
    let interrupt = move || {
        if INTERRUPTED.swap(true, Ordering::Relaxed) {
            std::process::exit(CODE);
        }
        first();
    };
    Ok(ctrlc::set_handler(interrupt)?)
}

/// Whether a signal has come.
pub(super) fn has_come() -> bool {
    INTERRUPTED.load(Ordering::Relaxed)
}

//! Work beside a thread that attends to it: who may end it is asked on the thread of the call, where Python's signals come, and a
//! progress goes on.
use super::host::Stopped;
use super::input::Inputs;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

/// How often work is attended to.
pub(super) const TICK: Duration = Duration::from_millis(50);

/// Does the work on a thread of its own; this one calls `attend` now and then until it is done. A panic of the work goes on here.
pub(super) fn beside<T: Send>(work: impl FnOnce() -> T + Send, mut attend: impl FnMut()) -> T {
    std::thread::scope(|scope| {
        let (done, ended) = channel::<()>();
        let worker = scope.spawn(move || {
            // Dropped at the end, however it comes.
            let _done = done;
            work()
        });
        while ended.recv_timeout(TICK) == Err(RecvTimeoutError::Timeout) {
            attend();
        }
        worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    })
}

/// Does work that looks at a flag, which is set when the caller wants it to end.
pub(super) fn until_stopped<T: Send>(
    inputs: &Inputs,
    work: impl FnOnce(&Arc<AtomicBool>) -> anyhow::Result<T> + Send,
) -> anyhow::Result<T> {
    let stop = Arc::new(AtomicBool::new(false));
    let found = beside(|| work(&stop), || _ = stop.fetch_or(inputs.is_stopped(), Ordering::Relaxed));
    if stop.load(Ordering::Relaxed) { Err(Stopped.into()) } else { found }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_is_attended_to_until_it_ends() {
        let stop = AtomicBool::new(false);
        let mut asked = 0;
        let turns = beside(
            || {
                let mut turns = 0_u64;
                while !stop.load(Ordering::Relaxed) {
                    turns += 1;
                    std::thread::yield_now();
                }
                turns
            },
            || {
                asked += 1;
                stop.store(asked == 3, Ordering::Relaxed);
            },
        );
        assert!(turns > 0 && asked == 3, "{turns} turns, asked {asked} times");
    }

    #[test]
    fn a_panic_of_the_work_goes_on_with_its_words() {
        let caught = std::panic::catch_unwind(|| beside(|| panic!("words"), || {}));
        assert_eq!(caught.unwrap_err().downcast_ref(), Some(&"words"));
    }
}

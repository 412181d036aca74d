//! What ends a search early: a signal and the time limit. Meanwhile the progress is shown.
use crate::cli::interrupt;
use crate::cli::progress::Progress;
use crate::estimator::placement::search::SearchControl;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

/// How often limit and Ctrl-C are looked at.
const TICK: Duration = Duration::from_millis(50);
/// Whether the user or the time has ended the search.
pub(super) fn is_due(deadline: Option<Instant>) -> bool {
    interrupt::has_come() || deadline.is_some_and(|deadline| Instant::now() >= deadline)
}

/// Shows what has been looked at, and stops the search when it is due, until the other end of the channel is gone.
pub(super) fn attend(
    control: &SearchControl,
    deadline: Option<Instant>,
    (progress, expected): (&Progress, Option<f64>),
    ended: &Receiver<()>,
) {
    while ended.recv_timeout(TICK) == Err(RecvTimeoutError::Timeout) {
        if is_due(deadline) {
            control.stop.store(true, Ordering::Relaxed);
            progress.say("ending with what there is");
        } else {
            let evaluated = control.evaluated.load(Ordering::Relaxed);
            match expected {
                Some(expected) if (evaluated as f64) < expected => {
                    progress.show("searching layouts", evaluated as f64 / expected);
                }
                Some(_) => progress.show("judging the best", 1.0),
                None => progress.say(&format!("placing sensors: {evaluated} layouts looked at")),
            }
        }
    }
}

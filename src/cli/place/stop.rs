//! What ends a search early: a signal and the time limit. Meanwhile the progress is shown.
use crate::cli::interrupt;
use crate::cli::progress::Progress;
use crate::estimator::placement::search::SearchControl;
use std::sync::atomic::Ordering;
use std::time::Instant;

/// Whether the user or the time has ended the search.
pub(super) fn is_due(deadline: Option<Instant>) -> bool {
    interrupt::has_come() || deadline.is_some_and(|deadline| Instant::now() >= deadline)
}

/// Stops the search when it is due, else shows what has been looked at.
pub(super) fn attend(control: &SearchControl, is_due: bool, (progress, expected): (&Progress, Option<f64>)) {
    if is_due {
        control.stop.store(true, Ordering::Relaxed);
        progress.say("ending with what there is");
        return;
    }
    let evaluated = control.evaluated.load(Ordering::Relaxed);
    match expected {
        Some(expected) if (evaluated as f64) < expected => {
            progress.show("searching layouts", evaluated as f64 / expected);
        }
        Some(_) => progress.show("judging the best", 1.0),
        None => progress.say(&format!("placing sensors: {evaluated} layouts looked at")),
    }
}

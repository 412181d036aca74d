//! A progress bar, on a terminal only.
use super::message::Messages;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::time::Duration;

const PARTS: u64 = 1000;
/// How often a bar without a known length moves.
const TICK: Duration = Duration::from_millis(120);

/// A bar that is cleared when it is dropped.
pub(super) struct Progress {
    bar: ProgressBar,
}

impl Progress {
    /// A bar on stderr; nothing where stderr is no terminal or nothing is to be said.
    pub(super) fn new(messages: &Messages) -> Self {
        let target =
            if messages.quiet() { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        let bar = ProgressBar::with_draw_target(Some(PARTS), target);
        if let Ok(style) = ProgressStyle::with_template("{msg:24} [{bar:40}] {percent:>3} %  {eta} left") {
            bar.set_style(style.progress_chars("=> "));
        }
        Self { bar }
    }

    /// The same for work of unknown length: what is being done, and for how long.
    pub(super) fn open_ended(messages: &Messages, what: &str) -> Self {
        let progress = Self::new(messages);
        if let Ok(style) = ProgressStyle::with_template("{spinner} {msg} ({elapsed})") {
            progress.bar.set_style(style);
        }
        progress.say(what);
        progress.bar.enable_steady_tick(TICK);
        progress
    }

    /// No bar: for one of many runs side by side.
    pub(super) fn hidden() -> Self {
        Self { bar: ProgressBar::hidden() }
    }

    /// A bar of many logs: those that are done, rows a second, time left by their bytes.
    pub(super) fn of_bytes(messages: &Messages, bytes: u64) -> Self {
        let progress = Self::new(messages);
        progress.bar.set_length(bytes);
        if let Ok(style) = ProgressStyle::with_template("[{bar:40}] {percent:>3} %  {msg}  {eta} left") {
            progress.bar.set_style(style.progress_chars("=> "));
        }
        progress
    }

    /// Counts bytes that are done, and says so.
    pub(super) fn advance(&self, bytes: u64, what: String) {
        self.bar.inc(bytes);
        self.bar.set_message(what);
    }

    /// Says what is being done.
    pub(super) fn say(&self, what: &str) {
        self.bar.set_message(what.to_owned());
    }

    /// Does something that writes to the terminal, with the bar out of the way.
    pub(super) fn suspended(&self, act: impl FnOnce()) {
        self.bar.suspend(act);
    }

    /// Shows what is being done and which share of it is done.
    pub(super) fn show(&self, what: &str, fraction: f64) {
        if self.bar.message() != what {
            self.bar.set_message(what.to_owned());
        }
        self.bar.set_position((fraction.clamp(0.0, 1.0) * PARTS as f64) as u64);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

//! A progress bar, on a terminal only.
use super::message::Messages;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

const PARTS: u64 = 1000;

/// A bar that is cleared when it is dropped.
pub struct Progress {
    bar: ProgressBar,
}

impl Progress {
    /// A bar on stderr; nothing where stderr is no terminal or nothing is to be said.
    pub fn new(messages: &Messages) -> Self {
        let target =
            if messages.quiet() { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        let bar = ProgressBar::with_draw_target(Some(PARTS), target);
        if let Ok(style) = ProgressStyle::with_template("{msg:24} [{bar:40}] {percent:>3} %  {eta} left") {
            bar.set_style(style.progress_chars("=> "));
        }
        Self { bar }
    }

    /// Shows what is being done and which share of it is done.
    pub fn show(&self, what: &str, fraction: f64) {
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

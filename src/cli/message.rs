//! Words for people, on stderr.
use std::io::{IsTerminal, Write};
use std::sync::{Arc, Mutex, PoisonError};

/// Where words go.
#[derive(Clone, Debug)]
pub(super) struct Messages {
    quiet: bool,
    color: bool,
    /// Cautions that are kept instead of printed.
    kept: Option<Arc<Mutex<Vec<String>>>>,
}

impl Messages {
    /// Words on stderr; `quiet` keeps all but errors to itself. Colour on a terminal without `NO_COLOR`.
    pub(super) fn new(quiet: bool) -> Self {
        let forbidden = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
        Self { quiet, color: std::io::stderr().is_terminal() && !forbidden, kept: None }
    }

    /// Prints nothing and keeps cautions, for one of many runs side by side.
    pub(super) fn kept() -> Self {
        Self { quiet: true, color: false, kept: Some(Arc::default()) }
    }

    /// The cautions that were kept, in their order.
    pub(super) fn take_cautions(&self) -> Vec<String> {
        let kept = self.kept.as_ref().map(|kept| kept.lock().unwrap_or_else(PoisonError::into_inner));
        kept.map(|mut kept| std::mem::take(&mut *kept)).unwrap_or_default()
    }

    /// Whether only errors are wanted.
    pub(super) fn quiet(&self) -> bool {
        self.quiet
    }

    /// Prints a message.
    pub(super) fn say(&self, words: &str) {
        if !self.quiet {
            self.write(words.trim_end());
        }
    }

    /// Prints a caution.
    pub(super) fn caution(&self, words: &str) {
        if let Some(kept) = &self.kept {
            kept.lock().unwrap_or_else(PoisonError::into_inner).push(words.to_owned());
        }
        if !self.quiet {
            self.write(&format!("{} {words}", self.label("caution:", "33")));
        }
    }

    /// Prints an error with its causes, in one line.
    pub(super) fn error(&self, error: &anyhow::Error) {
        self.write(&format!("{} {error:#}", self.label("error:", "31")));
    }

    fn label(&self, word: &str, code: &str) -> String {
        if self.color { format!("\u{1b}[1;{code}m{word}\u{1b}[0m") } else { word.to_owned() }
    }

    fn write(&self, words: &str) {
        // A closed stderr cannot be reported.
        let _ = writeln!(std::io::stderr(), "{words}");
    }
}

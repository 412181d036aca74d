//! Why a run is refused, with the parts of its message.
use crate::cli::Stopped;
use crate::log::LogError;
use crate::thermal::ThermalError;

/// Why a run is refused: the message of the command, and what of it is known by itself.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct RunError {
    message: String,
    file: Option<String>,
    line: Option<u64>,
    remedy: Option<String>,
    stopped: bool,
}

impl RunError {
    pub(super) fn of(error: &anyhow::Error) -> Self {
        let message = format!("{error:#}");
        let stopped = error.chain().any(|cause| {
            matches!(cause.downcast_ref(), Some(LogError::Stopped { .. }))
                || matches!(cause.downcast_ref(), Some(ThermalError::Stopped { .. }))
                || cause.is::<Stopped>()
        });
        let (place, words) = place(&message).unzip();
        let (file, line) = place.unzip();
        // What the system says is no remedy.
        let is_of_system = error.root_cause().is::<std::io::Error>();
        let remedy = remedy(words.unwrap_or(&message)).filter(|_| !is_of_system);
        Self { file, line, remedy, stopped, message }
    }

    /// File that is wrong; of a log in memory its name.
    pub fn file(&self) -> Option<&str> {
        self.file.as_deref()
    }

    /// Line of the file, or row of the log in memory, from 1.
    pub fn line(&self) -> Option<u64> {
        self.line
    }

    /// What to do.
    pub fn remedy(&self) -> Option<&str> {
        self.remedy.as_deref()
    }

    /// Whether the caller wanted the run to end.
    pub fn is_stopped(&self) -> bool {
        self.stopped
    }
}

/// File and line with which a message begins, `file:line: ` or `file row N: `, and what follows.
fn place(message: &str) -> Option<((String, u64), &str)> {
    let (place, words) = message.split_once(": ")?;
    let (file, line) = place.rsplit_once(" row ").or_else(|| place.rsplit_once(':'))?;
    Some(((file.to_owned(), line.parse().ok()?), words))
}

/// The remedy stands behind the last colon, by the form of all messages.
fn remedy(words: &str) -> Option<String> {
    let (_, remedy) = words.rsplit_once(": ")?;
    Some(remedy.trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_is_cut_into_file_line_and_remedy() {
        for (message, file, line, remedy) in [
            (
                "log.csv:3: time 5 s is before the row above: sort the rows",
                Some("log.csv"),
                Some(3),
                Some("sort the rows"),
            ),
            ("<frame> row 7: it is wrong: write it again", Some("<frame>"), Some(7), Some("write it again")),
            ("log.csv: there is nothing: write something", None, None, Some("write something")),
            ("nothing is known", None, None, None),
        ] {
            let error = RunError::of(&anyhow::anyhow!(message));
            assert_eq!((error.file(), error.line(), error.remedy()), (file, line, remedy), "{message}");
            assert_eq!(error.to_string(), message);
        }
    }
}

//! Where an output comes from: program version, command, inputs with their SHA-256, seed.
use serde::Serialize;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};

/// Provenance of an output.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Provenance {
    /// The command line, quoted so that a shell runs it again.
    pub command: String,
    /// What was read.
    pub inputs: Vec<Input>,
    /// Seed of everything random; `None`: nothing is random.
    pub seed: Option<u64>,
}

/// Something that was read.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Input {
    /// Path, `-`, or `preset NAME`.
    pub name: String,
    /// SHA-256 of its bytes, in hexadecimal.
    pub sha256: String,
}

impl Input {
    /// The record of an input with this content.
    pub fn of(name: impl Into<String>, content: &[u8]) -> Self {
        let mut fingerprint = Fingerprint::default();
        fingerprint.update(content);
        fingerprint.input(name)
    }

    /// As a comment line of a CSV file, without its line feed.
    pub(crate) fn comment_line(&self) -> String {
        format!("# input: {} sha256 {}", one_line(&self.name), self.sha256)
    }
}

/// SHA-256 of an input that is read piece by piece.
#[derive(Clone, Debug, Default)]
pub(crate) struct Fingerprint(Sha256);

impl Fingerprint {
    /// Takes in a piece.
    pub(crate) fn update(&mut self, piece: &[u8]) {
        self.0.update(piece);
    }

    /// The record of the input that the pieces make.
    pub(crate) fn input(&self, name: impl Into<String>) -> Input {
        let sha256 = self.0.clone().finalize().iter().map(|byte| format!("{byte:02x}")).collect();
        Input { name: name.into(), sha256 }
    }
}

impl Provenance {
    /// Version of the program.
    pub(crate) const VERSION: &str = env!("CARGO_PKG_VERSION");

    /// As comment lines for the top of a CSV file, each with its line feed.
    pub(crate) fn comment_lines(&self) -> String {
        let mut text = format!("# cylwatch {}\n# command: {}\n", Self::VERSION, one_line(&self.command));
        for input in &self.inputs {
            text.push_str(&input.comment_line());
            text.push('\n');
        }
        match self.seed {
            Some(seed) => text.push_str(&format!("# seed: {seed}\n")),
            None => text.push_str("# seed: none, nothing is random\n"),
        }
        text
    }

    /// As the `provenance` object of a JSON file.
    pub fn to_json(&self) -> Value {
        json!({
            "program": "cylwatch",
            "version": Self::VERSION,
            "command": self.command,
            "inputs": self.inputs,
            "seed": self.seed,
        })
    }

    /// As lines without marks, for the description of a picture.
    pub fn lines(&self) -> String {
        self.comment_lines().lines().map(|line| line.trim_start_matches("# ")).collect::<Vec<_>>().join("\n")
    }
}

/// A short hash of a text.
pub(crate) fn digest(text: &str) -> String {
    Input::of("", text.as_bytes()).sha256[..12].to_owned()
}

/// A word of a command line, quoted so that a shell reads it as one.
pub(crate) fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "-_./=:,+@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

/// A line feed in a file's name must not end a comment.
fn one_line(text: &str) -> String {
    text.replace(['\n', '\r'], " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_is_the_published_one_of_abc() {
        let input = Input::of("x", b"abc");
        assert_eq!(input.sha256, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    }

    #[test]
    fn a_line_feed_in_a_name_does_not_end_the_comment() {
        let provenance =
            Provenance { command: "cylwatch x".into(), inputs: vec![Input::of("a\nb", b"")], seed: Some(3) };
        assert!(provenance.comment_lines().lines().all(|line| line.starts_with('#')));
        assert!(provenance.comment_lines().ends_with("# seed: 3\n"));
    }
}

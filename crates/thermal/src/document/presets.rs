//! Built-in documents: files that are embedded in the program.
use super::suggestion;
use crate::ThermalError;

/// The built-in documents of one kind.
#[derive(Debug)]
pub struct Presets {
    /// Kind, for messages: vessel, scenario.
    pub kind: &'static str,
    /// Names and texts.
    pub files: &'static [(&'static str, &'static str)],
}

impl Presets {
    /// Their names.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        self.files.iter().map(|(name, _)| *name)
    }

    /// Text of one of them.
    ///
    /// # Errors
    /// [`ThermalError::UnknownPreset`] for any other name.
    pub fn text(&self, name: &str) -> Result<&'static str, ThermalError> {
        let found = self.files.iter().find(|(known, _)| *known == name).map(|(_, text)| *text);
        found.ok_or_else(|| {
            let known: Vec<&str> = self.names().collect();
            let nearest = suggestion(name, known.iter().copied());
            ThermalError::UnknownPreset {
                kind: self.kind,
                name: name.to_owned(),
                nearest,
                known: known.join(", "),
            }
        })
    }
}

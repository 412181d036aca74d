//! Names of the cylinders that came by the pattern, on disk before their states: after a start they are there before their next row, on the page
//! and where silence is looked for.
use super::*;
use crate::cli::output::write_file;

impl Keeper<'_> {
    fn list(&self) -> PathBuf {
        self.settings.folder.join("pattern.json")
    }

    /// Takes up those that are on disk, if the configuration still has room for them.
    pub(super) fn take_up_noted(&mut self) -> anyhow::Result<()> {
        let Some(bytes) = read(&self.list())? else { return Ok(()) };
        match serde_json::from_slice::<Vec<String>>(&bytes) {
            Ok(names) => self.noted = names,
            Err(error) => {
                let shown = self.list().display().to_string();
                self.messages.caution(&format!(
                    "{shown}: {error}; it is set aside, and cylinders come back with their rows"
                ));
                set_aside(&self.list())?;
            }
        }
        for name in self.noted.clone() {
            if let Err((refusal, reason)) = self.admits(&name)
                && refusal == Refusal::Monitor
            {
                self.messages.caution(&format!("{name} came by the pattern: {reason}"));
            }
        }
        Ok(())
    }

    /// Puts them on disk if there are others.
    pub(super) fn note_names(&mut self) -> anyhow::Result<()> {
        let named = &self.settings.named;
        let names = || self.cylinders.keys().filter(|name| !named.contains_key(*name));
        if names().eq(&self.noted) {
            return Ok(());
        }
        let names: Vec<String> = names().cloned().collect();
        write_file(&self.list(), &serde_json::to_vec(&names)?)?;
        self.noted = names;
        Ok(())
    }
}

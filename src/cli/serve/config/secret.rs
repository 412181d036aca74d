//! Secrets, which come from a file or the environment alone.
use super::Checked;
use anyhow::{Context, anyhow, bail};

impl Checked<'_> {
    /// The secret at a path such as `broker.password`: of the file or the variable that `_file` or `_env` of it name.
    pub(super) fn secret(
        &self,
        path: &str,
        file: Option<&str>,
        variable: Option<&str>,
    ) -> anyhow::Result<Option<String>> {
        let [of_file, of_variable] = ["file", "env"].map(|ending| format!("{path}_{ending}"));
        match (file, variable) {
            (Some(_), Some(_)) => {
                let key = path.rsplit('.').next().unwrap_or(path);
                bail!("{}: give {key}_file or {key}_env, not both", self.at(&of_variable))
            }
            (Some(file), None) => {
                let path = self.folder.join(file);
                let text = std::fs::read_to_string(&path);
                let text = text
                    .with_context(|| format!("{}: {} cannot be read", self.at(&of_file), path.display()))?;
                Ok(Some(text.trim_end_matches(['\r', '\n']).to_owned()))
            }
            (None, Some(name)) => Ok(Some(std::env::var(name).map_err(|_| {
                anyhow!("{}: the environment has no text in {name}: set it", self.at(&of_variable))
            })?)),
            (None, None) => Ok(None),
        }
    }
}

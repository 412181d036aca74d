//! Files that may not be there, and names that nothing reads.
use crate::report::Input;
use anyhow::Context;
use std::path::Path;

/// The content of a file; `None`: there is none.
pub(super) fn read(file: &Path) -> anyhow::Result<Option<Vec<u8>>> {
    match std::fs::read(file) {
        Ok(bytes) => Ok(Some(bytes)),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error).with_context(|| format!("{} cannot be read", file.display())),
    }
}

/// Gives a file, if it is there, a name that nothing reads.
pub(super) fn set_aside(file: &Path) -> anyhow::Result<()> {
    if let Some(bytes) = read(file)? {
        let mut aside = file.to_owned().into_os_string();
        aside.push(format!(".{}.aside", &Input::of("", &bytes).sha256[..12]));
        std::fs::rename(file, &aside).with_context(|| format!("{} cannot be renamed", file.display()))?;
    }
    Ok(())
}

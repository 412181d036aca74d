//! Where the resources of an archive lie.
use cylwatch_cosimulation::{Instance, Resource};
use std::path::{Path, PathBuf};

/// The folder that a URI names: `file:///a%20b`, `file:/a` or, as some masters hand it over, a path.
pub(crate) fn folder_of(uri: &str) -> Result<PathBuf, String> {
    let Some(rest) = uri.strip_prefix("file:") else {
        return Ok(PathBuf::from(uri));
    };
    let path = match rest.strip_prefix("//") {
        Some(rest) => rest.strip_prefix("localhost").unwrap_or(rest),
        None => rest,
    };
    let bytes = decoded(path.as_bytes());
    let text = String::from_utf8(bytes).map_err(|_| format!("{uri} is no path in UTF-8"))?;
    // `/C:/folder` is a path of Windows.
    let is_drive = text.as_bytes().get(2) == Some(&b':');
    Ok(PathBuf::from(if is_drive { text.trim_start_matches('/') } else { &text }))
}

fn decoded(text: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut at = 0;
    while let Some(&byte) = text.get(at) {
        let hex = text.get(at + 1..at + 3).and_then(|two| std::str::from_utf8(two).ok());
        match hex.filter(|_| byte == b'%').and_then(|two| u8::from_str_radix(two, 16).ok()) {
            Some(value) => {
                bytes.push(value);
                at += 3;
            }
            None => {
                bytes.push(byte);
                at += 1;
            }
        }
    }
    bytes
}

/// The unit whose resources lie in a folder; `token` is what the description says of them.
pub(crate) fn unit(folder: &Path, token: &str) -> Result<Instance, String> {
    let path = folder.join(Resource::FILE);
    let shown = path.display();
    let bytes = std::fs::read(&path).map_err(|error| format!("{shown} cannot be read: {error}"))?;
    let unit = Instance::new(&bytes).map_err(|error| format!("{shown}: {error}"))?;
    if unit.token() == token {
        return Ok(unit);
    }
    Err(format!(
        "{shown} does not belong to the description, whose token is {token} and not {}: write the archive again",
        unit.token()
    ))
}

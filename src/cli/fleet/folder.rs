//! The output folder: a state, rows and a record for each cylinder, and one run at a time.
use crate::cli::output::{make_folder, remove_orphans};
use crate::report::digest;
use anyhow::{Context, bail};
use std::fs::File;
use std::path::{Path, PathBuf};

/// Longest name of a file, without its ending.
const LONGEST: usize = 80;
/// Folder of what waits during a run.
const WORK: &str = ".work";

/// A checked output folder, which no other run writes while this one is there.
pub(super) struct Folder {
    root: PathBuf,
    /// Locked.
    _lock: File,
}

/// The files of a cylinder.
#[derive(Clone, Debug)]
pub(super) struct Files {
    /// State to go on from.
    pub state: PathBuf,
    /// Its rows.
    pub rows: PathBuf,
    /// What is known of it when it is done.
    pub record: PathBuf,
    /// A new state that waits for its record.
    pub work: PathBuf,
}

impl Folder {
    /// Makes the folder.
    pub(super) fn make(root: &Path, with_rows: bool) -> anyhow::Result<Self> {
        make_folder(root)?;
        let folders = ["states", "records", WORK].into_iter().chain(with_rows.then_some("rows"));
        remove_orphans(root);
        for folder in folders.map(|name| root.join(name)) {
            make_folder(&folder)?;
            remove_orphans(&folder);
        }
        let lock = locked(root, "choose another --output")?;
        Ok(Self { root: root.to_path_buf(), _lock: lock })
    }

    /// A file in it.
    pub(super) fn file(&self, name: &str) -> PathBuf {
        self.root.join(name)
    }

    /// The files of a cylinder.
    pub(super) fn files(&self, cylinder: &str) -> Files {
        let stem = stem(cylinder);
        let of = |folder: &str, ending: &str| self.root.join(folder).join(format!("{stem}.{ending}"));
        Files {
            state: of("states", "state"),
            rows: of("rows", "csv"),
            record: of("records", "record"),
            work: of(WORK, "state"),
        }
    }

    /// What is known of a log of several cylinders.
    pub(super) fn index(&self, log: &str) -> PathBuf {
        self.root.join("records").join(format!("{log}.index"))
    }

    /// Where its rows wait.
    pub(super) fn spool(&self, log: &str) -> PathBuf {
        self.root.join(WORK).join(log)
    }

    /// Removes what only a run that is resumed has a use for.
    pub(super) fn tidy(&self) {
        // What stays costs room and nothing else.
        _ = std::fs::remove_dir_all(self.root.join(WORK));
    }
}

/// Locks a folder that one run at a time writes.
pub(in crate::cli) fn locked(root: &Path, remedy: &str) -> anyhow::Result<File> {
    let shown = root.display();
    let lock = File::create(root.join(".lock")).with_context(|| format!("{shown} cannot be written"))?;
    if matches!(lock.try_lock(), Err(std::fs::TryLockError::WouldBlock)) {
        bail!("{shown} is being written by another run: wait for it, or {remedy}");
    }
    Ok(lock)
}

/// A name of a file for any name of a cylinder: letters beyond plain ones are escaped, no two names become one.
pub(in crate::cli) fn stem(cylinder: &str) -> String {
    let mut stem = String::new();
    for (k, byte) in cylinder.bytes().enumerate() {
        let is_plain =
            byte.is_ascii_alphanumeric() || byte == b'-' || byte == b'_' || (byte == b'.' && k > 0);
        if is_plain { stem.push(char::from(byte)) } else { stem.push_str(&format!("%{byte:02X}")) }
    }
    if stem.len() > LONGEST {
        stem.truncate(LONGEST);
        stem.push_str(&format!("%{}", digest(cylinder)));
    }
    stem
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_name_leaves_the_folder_and_no_two_names_share_a_file() {
        for (name, file) in [
            ("A-12.b", "A-12.b"),
            ("../../x", "%2E.%2F..%2Fx"),
            (".", "%2E"),
            ("a/b", "a%2Fb"),
            ("<script>", "%3Cscript%3E"),
            ("a%2Fb", "a%252Fb"),
            ("\u{e4}", "%C3%A4"),
        ] {
            assert_eq!(stem(name), file);
        }
        let long = |end: &str| stem(&("x".repeat(500) + end));
        assert!(long("1").len() < 120 && long("1") != long("2"));
    }
}

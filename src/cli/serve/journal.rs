//! The journal: every row that was accepted, on disk before the broker hears of it, until a state knows it.
//!
//! It is a folder of segments that only grow. A record is its length, the beginning of its SHA-256, and its content; a record that a
//! power cut left incomplete ends its segment. Before a state is written its hash goes into the journal: the state on disk tells from
//! where on rows are new, whatever moment the gateway was killed at.
use crate::report::Input;
use anyhow::Context;
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Ending of a segment's name.
const ENDING: &str = "rows";
/// Characters of a record's checksum.
const SUM: usize = 16;
/// Bytes before a record's content.
const HEAD: usize = 4 + SUM;

/// A record.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) enum Entry {
    /// Names of the readings of the rows that follow.
    Readings(Vec<String>),
    /// A row.
    Row { cylinder: String, time_ns: i64, cells: Vec<f64> },
    /// The alarms of a cylinder were acknowledged.
    Acknowledged { cylinder: String, comment: String },
    /// The state with this hash is going to be written; it knows everything before.
    Saving { cylinder: String, sha256: String },
    /// The monitor begins anew with what follows; the time is that of the last row before, since 1970.
    Anew { cylinder: String, reason: String, time_s: f64 },
}

impl Entry {
    /// Its cylinder.
    pub(super) fn cylinder(&self) -> Option<&str> {
        match self {
            Self::Readings(_) => None,
            Self::Row { cylinder, .. }
            | Self::Acknowledged { cylinder, .. }
            | Self::Saving { cylinder, .. }
            | Self::Anew { cylinder, .. } => Some(cylinder),
        }
    }
}

/// A segment as it was found.
pub(super) struct Segment {
    pub number: u64,
    pub entries: Vec<Entry>,
    /// Bytes at its end that are no whole record.
    pub surplus: usize,
}

/// The journal while it grows.
pub(super) struct Journal {
    folder: PathBuf,
    names: Vec<String>,
    number: u64,
    file: File,
    /// Bytes that are whole records.
    length: u64,
}

impl Journal {
    /// What is there, and a new segment after it.
    pub(super) fn open(folder: &Path, names: &[String]) -> anyhow::Result<(Self, Vec<Segment>)> {
        let mut segments = Vec::new();
        for number in numbers(folder)? {
            let path = path(folder, number);
            let bytes = std::fs::read(&path).with_context(|| format!("{} cannot be read", path.display()))?;
            segments.push(segment(number, &bytes));
        }
        let number = segments.last().map_or(1, |last| last.number + 1);
        let (file, length) = begun(folder, number, names)?;
        Ok((Self { folder: folder.to_owned(), names: names.to_vec(), number, file, length }, segments))
    }

    /// Number of the segment that grows.
    pub(super) fn number(&self) -> u64 {
        self.number
    }

    /// Adds records, on disk when this returns; if they cannot be written, none of them is there.
    pub(super) fn append(&mut self, entries: &[Entry]) -> anyhow::Result<()> {
        let mut bytes = Vec::new();
        entries.iter().try_for_each(|entry| put(entry, &mut bytes))?;
        let written = self.file.write_all(&bytes).and_then(|()| self.file.sync_data());
        if let Err(error) = written {
            // What is there of them goes; if that fails, too, the next record overwrites it.
            _ = self.file.set_len(self.length);
            _ = self.file.seek(SeekFrom::Start(self.length));
            let shown = path(&self.folder, self.number);
            return Err(error).with_context(|| format!("{} cannot be written", shown.display()));
        }
        self.length += bytes.len() as u64;
        Ok(())
    }

    /// Goes on in a new segment.
    pub(super) fn rotate(&mut self) -> anyhow::Result<()> {
        let (file, length) = begun(&self.folder, self.number + 1, &self.names)?;
        (self.file, self.length, self.number) = (file, length, self.number + 1);
        Ok(())
    }

    /// Goes on in a new segment, with rows of other readings.
    pub(super) fn go_on_with(&mut self, names: &[String]) -> anyhow::Result<()> {
        let before = std::mem::replace(&mut self.names, names.to_vec());
        self.rotate().inspect_err(|_| self.names = before)
    }

    /// Removes the segments before one.
    pub(super) fn remove_before(&self, number: u64) -> anyhow::Result<()> {
        for old in numbers(&self.folder)?.into_iter().filter(|old| *old < number) {
            let path = path(&self.folder, old);
            std::fs::remove_file(&path).with_context(|| format!("{} cannot be removed", path.display()))?;
        }
        Ok(())
    }
}

fn path(folder: &Path, number: u64) -> PathBuf {
    folder.join(format!("{number:012}.{ENDING}"))
}

/// Numbers of the segments that are there, in their order.
fn numbers(folder: &Path) -> anyhow::Result<Vec<u64>> {
    let entries =
        std::fs::read_dir(folder).with_context(|| format!("{} cannot be read", folder.display()))?;
    let number = |name: &str| name.strip_suffix(ENDING)?.strip_suffix('.')?.parse().ok();
    let mut numbers: Vec<u64> =
        entries.flatten().filter_map(|entry| number(entry.file_name().to_str()?)).collect();
    numbers.sort_unstable();
    Ok(numbers)
}

/// A new segment with the names of the readings.
fn begun(folder: &Path, number: u64, names: &[String]) -> anyhow::Result<(File, u64)> {
    let path = path(folder, number);
    let mut bytes = Vec::new();
    put(&Entry::Readings(names.to_vec()), &mut bytes)?;
    let made = File::create(&path).and_then(|mut file| {
        file.write_all(&bytes)?;
        file.sync_all()?;
        // The name is on disk as well.
        File::open(folder)?.sync_all()?;
        Ok(file)
    });
    let file = made.with_context(|| format!("{} cannot be written", path.display()))?;
    Ok((file, bytes.len() as u64))
}

fn sum(content: &[u8]) -> String {
    Input::of("", content).sha256[..SUM].to_owned()
}

fn put(entry: &Entry, bytes: &mut Vec<u8>) -> anyhow::Result<()> {
    let content = postcard::to_allocvec(entry).context("a row cannot be put into bytes")?;
    bytes.extend_from_slice(&u32::try_from(content.len())?.to_le_bytes());
    bytes.extend_from_slice(sum(&content).as_bytes());
    bytes.extend_from_slice(&content);
    Ok(())
}

fn segment(number: u64, bytes: &[u8]) -> Segment {
    let (mut entries, mut rest) = (Vec::new(), bytes);
    while let Some((entry, after)) = taken(rest) {
        entries.push(entry);
        rest = after;
    }
    Segment { number, entries, surplus: rest.len() }
}

/// The first record, and what follows; `None`: there is no whole one.
fn taken(bytes: &[u8]) -> Option<(Entry, &[u8])> {
    let (head, rest) = bytes.split_at_checked(HEAD)?;
    let (length, expected) = head.split_at(4);
    let length = u32::from_le_bytes(length.try_into().ok()?) as usize;
    let (content, after) = rest.split_at_checked(length)?;
    if sum(content).as_bytes() != expected {
        return None;
    }
    Some((postcard::from_bytes(content).ok()?, after))
}

#[cfg(test)]
mod tests {
    use super::*;
    use tempfile::tempdir;

    fn row(k: u32) -> Entry {
        Entry::Row { cylinder: "A".into(), time_ns: i64::from(k), cells: vec![f64::from(k), 0.1] }
    }

    fn names() -> Vec<String> {
        vec!["pressure_bar".into()]
    }

    #[test]
    fn what_was_appended_is_there_after_a_kill_at_any_byte_up_to_the_last_whole_row() {
        let folder = tempdir().unwrap();
        let (mut journal, found) = Journal::open(folder.path(), &names()).unwrap();
        assert!(found.is_empty());
        journal.append(&[row(1), row(2)]).unwrap();
        let two = journal.length;
        journal.append(&[row(3)]).unwrap();
        let bytes = std::fs::read(path(folder.path(), 1)).unwrap();
        assert_eq!(bytes.len() as u64, journal.length);
        let expected = vec![Entry::Readings(names()), row(1), row(2), row(3)];
        assert_eq!(segment(1, &bytes).entries, expected);
        for cut in two as usize..bytes.len() {
            let found = segment(1, &bytes[..cut]);
            assert_eq!((&found.entries[..], found.surplus), (&expected[..3], cut - two as usize));
        }
        let mut damaged = bytes.clone();
        damaged[two as usize + HEAD + 1] ^= 1;
        assert_eq!(segment(1, &damaged).entries, expected[..3]);
    }

    #[test]
    fn segments_follow_each_other_and_the_old_ones_go() {
        let folder = tempdir().unwrap();
        let (mut journal, _) = Journal::open(folder.path(), &names()).unwrap();
        journal.append(&[row(1)]).unwrap();
        journal.rotate().unwrap();
        journal.append(&[row(2)]).unwrap();
        drop(journal);
        let (journal, found) = Journal::open(folder.path(), &names()).unwrap();
        assert_eq!((journal.number(), found.len()), (3, 2));
        assert_eq!(found[1].entries[1], row(2));
        journal.remove_before(2).unwrap();
        assert_eq!(numbers(folder.path()).unwrap(), [2, 3]);
    }
}

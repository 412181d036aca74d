//! The journal: one line for each finished world, so that a run that was killed goes on where it was.
//!
//! A line is `{"sum":"<16 hexadecimal digits>","entry":<JSON>}`, its sum the beginning of the SHA-256 of the entry's text. Lines are
//! appended by one write and flushed. A run that is killed while it writes leaves the beginning of a line, without its end: that line is
//! dropped. Any other line that is not as it was written is an error. The first line says which plan and which program the results
//! are of. The file is locked while a run writes, and the lock goes with the process.
//!
//! The order of the lines is that in which worlds were finished. Results are read in the order of the plan, from the text alone, so that
//! they do not depend on the order, on threads, or on kills.
use std::collections::BTreeMap;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::JudgeError;
use super::plan::hex;

/// Name of the journal in its folder.
pub(super) const JOURNAL: &str = "journal.jsonl";
const BEFORE_SUM: &str = "{\"sum\":\"";
const BEFORE_ENTRY: &str = "\",\"entry\":";
const DIGITS: usize = 16;

/// What the results are of.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Binding {
    /// Hash of the plan.
    pub plan: String,
    /// Version of the program, and the beginning of its file's hash.
    pub program: String,
}

/// An entry with the index of its world.
#[derive(Serialize, Deserialize)]
struct Numbered<T> {
    world: usize,
    result: T,
}

/// The number of a line alone.
#[derive(Deserialize)]
struct Number {
    world: usize,
}

/// A journal that is open for writing.
#[derive(Debug)]
pub(super) struct Journal {
    path: PathBuf,
    file: File,
    /// Begin and length of each world's entry, bytes.
    places: BTreeMap<usize, (u64, usize)>,
    end: u64,
}

impl Drop for Journal {
    /// A process that is being started holds a copy of the file for a moment, and with it the lock that closing would leave.
    fn drop(&mut self) {
        // What cannot be unlocked is unlocked when it is closed.
        let _ = self.file.unlock();
    }
}

impl Journal {
    /// Open or begin the journal of a folder; what a kill left of its last line is dropped.
    ///
    /// # Errors
    /// Another process writes here, the results are of another plan or program, or a line that is not the last one is broken.
    pub(crate) fn open(folder: &Path, binding: &Binding) -> Result<Self, JudgeError> {
        let path = folder.join(JOURNAL);
        let failed = |source| JudgeError::File { path: path.clone(), source };
        std::fs::create_dir_all(folder).map_err(failed)?;
        let file = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(&path)
            .map_err(failed)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(JudgeError::Busy { path }),
            Err(TryLockError::Error(source)) => return Err(failed(source)),
        }
        let mut journal = Self { path, file, places: BTreeMap::new(), end: 0 };
        journal.read_back(binding)?;
        Ok(journal)
    }

    /// Index of the lines that are there; the file ends after the last whole one.
    fn read_back(&mut self, binding: &Binding) -> Result<(), JudgeError> {
        let mut reader = BufReader::new(self.file.try_clone().map_err(|source| self.failed(source))?);
        let mut line = Vec::new();
        let mut number = 0;
        loop {
            line.clear();
            let read = reader.read_until(b'\n', &mut line).map_err(|source| self.failed(source))?;
            if line.pop() != Some(b'\n') {
                break;
            }
            number += 1;
            self.take(&line, number, binding)?;
            self.end += read as u64;
        }
        self.file.set_len(self.end).map_err(|source| self.failed(source))?;
        if number == 0 {
            self.write(&serde_json::to_string(binding)?)?;
        }
        Ok(())
    }

    fn take(&mut self, line: &[u8], number: usize, binding: &Binding) -> Result<(), JudgeError> {
        let broken = |reason: &str| JudgeError::Journal {
            path: self.path.clone(),
            line: number,
            reason: reason.to_owned(),
        };
        let entry = entry_of(line).ok_or_else(|| broken("the sum does not fit"))?;
        if number == 1 {
            let found: Binding = serde_json::from_str(entry).map_err(|_| broken("no heading"))?;
            return self.check(&found, binding);
        }
        let Number { world } = serde_json::from_str(entry).map_err(|_| broken("no entry of a world"))?;
        let begin = self.end + (BEFORE_SUM.len() + DIGITS + BEFORE_ENTRY.len()) as u64;
        self.places.insert(world, (begin, entry.len()));
        Ok(())
    }

    fn check(&self, found: &Binding, now: &Binding) -> Result<(), JudgeError> {
        let differing = [("plan", &found.plan, &now.plan), ("program", &found.program, &now.program)];
        match differing.into_iter().find(|(_, found, now)| found != now) {
            Some((what, found, now)) => Err(JudgeError::OtherJournal {
                path: self.path.clone(),
                what,
                found: found.clone(),
                now: now.clone(),
            }),
            None => Ok(()),
        }
    }

    /// Append the result of a world.
    ///
    /// # Errors
    /// The file cannot be written.
    pub(crate) fn append<T: Serialize>(&mut self, world: usize, result: &T) -> Result<(), JudgeError> {
        let text = serde_json::to_string(&Numbered { world, result })?;
        let begin = self.end + (BEFORE_SUM.len() + DIGITS + BEFORE_ENTRY.len()) as u64;
        self.write(&text)?;
        self.places.insert(world, (begin, text.len()));
        Ok(())
    }

    fn write(&mut self, entry: &str) -> Result<(), JudgeError> {
        let line = format!("{BEFORE_SUM}{}{BEFORE_ENTRY}{entry}}}\n", sum_of(entry.as_bytes()));
        let write = |file: &mut File, end| {
            file.seek(SeekFrom::Start(end))?;
            file.write_all(line.as_bytes())?;
            file.flush()
        };
        write(&mut self.file, self.end).map_err(|source| self.failed(source))?;
        self.end += line.len() as u64;
        Ok(())
    }

    /// Whether a world is finished.
    pub(crate) fn holds(&self, world: usize) -> bool {
        self.places.contains_key(&world)
    }

    /// Number of finished worlds.
    pub(crate) fn len(&self) -> usize {
        self.places.len()
    }

    /// A reader of the worlds that are finished now.
    ///
    /// # Errors
    /// The file cannot be opened.
    pub(crate) fn results(&self) -> Result<Results, JudgeError> {
        let file = File::open(&self.path).map_err(|source| self.failed(source))?;
        Ok(Results { path: self.path.clone(), file, places: self.places.clone() })
    }

    fn failed(&self, source: std::io::Error) -> JudgeError {
        JudgeError::File { path: self.path.clone(), source }
    }
}

/// Results of the worlds that were finished at a time, read one by one.
#[derive(Debug)]
pub(crate) struct Results {
    path: PathBuf,
    file: File,
    places: BTreeMap<usize, (u64, usize)>,
}

impl Results {
    /// The result of a world; `None`: it is not finished.
    ///
    /// # Errors
    /// The file cannot be read, or is not what was written.
    pub(crate) fn of<T: DeserializeOwned>(&mut self, world: usize) -> Result<Option<T>, JudgeError> {
        let Some(&(begin, length)) = self.places.get(&world) else { return Ok(None) };
        let mut entry = vec![0; length];
        let read = |file: &mut File, entry: &mut [u8]| {
            file.seek(SeekFrom::Start(begin))?;
            file.read_exact(entry)
        };
        read(&mut self.file, &mut entry)
            .map_err(|source| JudgeError::File { path: self.path.clone(), source })?;
        let Numbered { result, .. } = serde_json::from_slice(&entry)?;
        Ok(Some(result))
    }

    /// Number of finished worlds.
    pub(crate) fn len(&self) -> usize {
        self.places.len()
    }
}

fn sum_of(entry: &[u8]) -> String {
    hex(&Sha256::digest(entry)[..DIGITS / 2])
}

/// The entry of a whole line without its end; `None`: it is not as it was written.
fn entry_of(line: &[u8]) -> Option<&str> {
    let rest = line.strip_prefix(BEFORE_SUM.as_bytes())?;
    let (sum, rest) = rest.split_at_checked(DIGITS)?;
    let entry = rest.strip_prefix(BEFORE_ENTRY.as_bytes())?.strip_suffix(b"}")?;
    (sum == sum_of(entry).as_bytes()).then(|| std::str::from_utf8(entry).ok())?
}

#[cfg(test)]
mod tests {
    use super::*;

    fn binding() -> Binding {
        Binding { plan: "p".into(), program: "1".into() }
    }

    fn filled(folder: &Path) -> Vec<u8> {
        let mut journal = Journal::open(folder, &binding()).unwrap();
        for world in [2, 0, 5] {
            journal.append(world, &format!("result {world} \u{e9}")).unwrap();
        }
        drop(journal);
        std::fs::read(folder.join(JOURNAL)).unwrap()
    }

    fn read(folder: &Path) -> Result<Vec<Option<String>>, JudgeError> {
        let mut results = Journal::open(folder, &binding())?.results()?;
        (0..6).map(|world| results.of(world)).collect()
    }

    #[test]
    fn results_come_back_whatever_the_order_they_were_written_in() {
        let folder = tempfile::tempdir().unwrap();
        filled(folder.path());
        let all = read(folder.path()).unwrap();
        assert_eq!(all[0].as_deref(), Some("result 0 \u{e9}"));
        assert_eq!(all.iter().flatten().count(), 3);
    }

    #[test]
    fn cut_off_at_any_byte_the_journal_holds_its_whole_lines_and_goes_on_to_the_same_file() {
        let folder = tempfile::tempdir().unwrap();
        let whole = filled(folder.path());
        let path = folder.path().join(JOURNAL);
        for length in 0..=whole.len() {
            std::fs::write(&path, &whole[..length]).unwrap();
            let lines = whole[..length].iter().filter(|byte| **byte == b'\n').count();
            let mut journal = Journal::open(folder.path(), &binding()).unwrap();
            assert_eq!(journal.len(), lines.saturating_sub(1), "cut off at {length}");
            for world in [2, 0, 5] {
                if !journal.holds(world) {
                    journal.append(world, &format!("result {world} \u{e9}")).unwrap();
                }
            }
            drop(journal);
            assert_eq!(std::fs::read(&path).unwrap(), whole, "cut off at {length}");
        }
    }

    #[test]
    fn a_byte_changed_within_a_line_is_an_error_that_names_the_line() {
        let folder = tempfile::tempdir().unwrap();
        let whole = filled(folder.path());
        let path = folder.path().join(JOURNAL);
        let second = whole.iter().position(|byte| *byte == b'\n').unwrap() + 1;
        for at in second..whole.len() - 1 {
            let mut changed = whole.clone();
            changed[at] ^= 1;
            std::fs::write(&path, &changed).unwrap();
            let error = read(folder.path()).unwrap_err();
            assert!(matches!(error, JudgeError::Journal { line: 2..=4, .. }), "{at}: {error}");
        }
    }

    #[test]
    fn results_of_another_plan_or_program_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        filled(folder.path());
        for other in [Binding { plan: "q".into(), ..binding() }, Binding { program: "2".into(), ..binding() }]
        {
            let error = Journal::open(folder.path(), &other).unwrap_err();
            assert!(matches!(error, JudgeError::OtherJournal { .. }), "{error}");
        }
        assert!(read(folder.path()).is_ok());
    }

    #[test]
    fn a_second_writer_is_refused_while_the_first_one_writes() {
        let folder = tempfile::tempdir().unwrap();
        let journal = Journal::open(folder.path(), &binding()).unwrap();
        let error = Journal::open(folder.path(), &binding()).unwrap_err();
        assert!(matches!(error, JudgeError::Busy { .. }), "{error}");
        drop(journal);
        assert!(Journal::open(folder.path(), &binding()).is_ok());
    }
}

//! Which logs there are, and whose they are.
use super::columns::{ColumnLog, Index};
use super::folder::Folder;
use super::vessels::is_same;
use crate::cli::inspection::is_log;
use crate::log::LogOptions;
use crate::log::cylinders::has_column;
use crate::report::fleet::Fault;
use anyhow::{Context, bail};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Beginning of the name of a folder that is a cylinder's.
const HIVE: &str = "cylinder=";
/// Endings of logs, which are no part of a cylinder's name.
const ENDINGS: [&str; 5] = [".csv.gz", ".txt.gz", ".csv", ".txt", ".parquet"];

/// How a log says whose it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Naming {
    /// By its own name.
    File,
    /// By a folder `cylinder=NAME`.
    Folder,
    /// By its column `cylinder`.
    Column,
}

/// The logs of a cylinder, in their order.
#[derive(Clone, Debug)]
pub(super) struct Logs {
    /// How they say whose they are.
    pub naming: Naming,
    /// Files.
    pub files: Vec<PathBuf>,
}

/// A log and the cylinder that its folder names.
pub(in crate::cli) type Named = (PathBuf, Option<String>);

/// The logs of a folder by cylinder, and what is wrong with it.
#[derive(Default)]
pub(super) struct Found {
    /// By the name of the cylinder.
    pub logs: BTreeMap<String, Logs>,
    /// What cannot be used.
    pub faults: Vec<Fault>,
    /// Logs of several cylinders, by their paths.
    pub columns: BTreeMap<PathBuf, ColumnLog>,
}

/// The logs of a folder in the order of their names, and what is wrong with it; `others` are files and folders in it that are no logs.
pub(in crate::cli) fn files(folder: &Path, others: &[&Path]) -> anyhow::Result<(Vec<Named>, Vec<Fault>)> {
    let shown = folder.display();
    if folder.is_file() {
        bail!("{shown} is a file: name a folder of logs, or use `cylwatch monitor` for one log");
    }
    let (mut files, mut faults) = (Vec::new(), Vec::new());
    walk(folder, others, None, &mut files, &mut faults).with_context(|| format!("{shown} cannot be read"))?;
    if files.is_empty() {
        bail!("{shown} has no log: files that end in .csv, .csv.gz, .txt or .parquet");
    }
    files.sort();
    Ok((files, faults))
}

/// Finds out whose the logs are; those of several cylinders are read for that, with all cores of the pool.
pub(super) fn find(
    (files, faults): (Vec<Named>, Vec<Fault>),
    options: &LogOptions,
    folder: &Folder,
    stop: &(dyn Fn() -> bool + Sync),
) -> anyhow::Result<Found> {
    let read = |(file, of_folder): &Named| match of_folder {
        // Where a header cannot be read the run says so.
        None if has_column(file, options).unwrap_or(false) => {
            ColumnLog::read(file, options, folder, stop).map(Some)
        }
        _ => Ok(None),
    };
    let columns: anyhow::Result<Vec<_>> = files.par_iter().map(read).collect();
    let mut found = Found { faults, ..Found::default() };
    for ((file, of_folder), column) in files.into_iter().zip(columns?) {
        match (of_folder, column) {
            (Some(name), _) => found.add(name, Naming::Folder, file),
            (None, None) => found.add(name_of(&file), Naming::File, file),
            (None, Some(column)) => {
                found.faults.extend(faults_of(&column.index, &file));
                for name in &column.index.names {
                    found.add(name.clone(), Naming::Column, file.clone());
                }
                found.columns.insert(file, column);
            }
        }
    }
    Ok(found)
}

/// What is wrong with a log of several cylinders, of none of them in particular.
fn faults_of(index: &Index, file: &Path) -> Vec<Fault> {
    let shown = file.display().to_string();
    let nameless = index.nameless.map(|line| Fault {
        cylinder: String::new(),
        file: shown.clone(),
        line: Some(line),
        reason: "a row names no cylinder".to_owned(),
        remedy: "complete the column cylinder; the row is left out".to_owned(),
    });
    // Otherwise each of its cylinders says so.
    let damage = index.damage.as_ref().filter(|_| index.names.is_empty());
    nameless.into_iter().chain(damage.map(|damage| Fault::of("", &shown, damage))).collect()
}

impl Found {
    fn add(&mut self, name: String, naming: Naming, file: PathBuf) {
        let Some(logs) = self.logs.get_mut(&name) else {
            self.logs.insert(name, Logs { naming, files: vec![file] });
            return;
        };
        if logs.naming == naming && naming != Naming::File {
            logs.files.push(file);
            return;
        }
        let first = logs.files[0].display();
        self.faults.push(Fault {
            reason: format!("cylinder {name} has another log, {first}, which is used"),
            remedy: format!("rename one of them, or put both in a folder {HIVE}{name}"),
            cylinder: name,
            file: file.display().to_string(),
            line: None,
        });
    }
}

/// Collects logs with the cylinder that their folder names. Folders that cannot be read are faults.
fn walk(
    folder: &Path,
    others: &[&Path],
    cylinder: Option<&str>,
    files: &mut Vec<Named>,
    faults: &mut Vec<Fault>,
) -> std::io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        if name.starts_with('.') || others.iter().any(|other| is_same(other, &path)) {
            continue;
        }
        if !path.is_dir() {
            if is_log(&path) {
                files.push((path, cylinder.map(str::to_owned)));
            }
            continue;
        }
        let shown = path.display().to_string();
        if ENDINGS.iter().any(|ending| name.ends_with(ending)) {
            let reason = "it is a folder, and a log is a file";
            faults.push(fault(&name_of(&path), shown, reason, "rename it, or put the log in its place"));
            continue;
        }
        let own = name.strip_prefix(HIVE).map(unescaped);
        if let Err(error) = walk(&path, others, own.as_deref().or(cylinder), files, faults) {
            faults.push(fault("", shown, &format!("it cannot be read: {error}"), "allow reading it"));
        }
    }
    Ok(())
}

fn fault(cylinder: &str, file: String, reason: &str, remedy: &str) -> Fault {
    let (reason, remedy) = (reason.to_owned(), remedy.to_owned());
    Fault { cylinder: cylinder.to_owned(), file, line: None, reason, remedy }
}

/// Name of a cylinder that has a file of its own.
pub(in crate::cli) fn name_of(path: &Path) -> String {
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let small = name.to_ascii_lowercase();
    let ending = ENDINGS.iter().find(|ending| small.ends_with(*ending)).map_or(0, |ending| ending.len());
    name[..name.len() - ending].to_owned()
}

/// A name of a hive folder without its escapes: `%2F` is `/`.
fn unescaped(name: &str) -> String {
    let mut bytes = Vec::new();
    let mut rest = name.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        let digits = after.get(..2).and_then(|digits| std::str::from_utf8(digits).ok());
        let escaped = digits.and_then(|digits| u8::from_str_radix(digits, 16).ok()).filter(|_| first == b'%');
        bytes.push(escaped.unwrap_or(first));
        rest = if escaped.is_some() { &after[2..] } else { after };
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_loses_its_ending_and_its_escapes_and_nothing_else() {
        for (file, name) in [("A.12.csv", "A.12"), ("b.CSV.GZ", "b"), ("c.parquet", "c"), ("d.e.txt", "d.e")]
        {
            assert_eq!(name_of(Path::new(file)), name);
        }
        for (folder, name) in [("A%2F1", "A/1"), ("50%", "50%"), ("%zz", "%zz"), ("%C3%A4", "\u{e4}")] {
            assert_eq!(unescaped(folder), name);
        }
    }
}

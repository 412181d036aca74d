//! Where results go: stdout or files that appear complete or not at all.
//!
//! A [`Target`] is checked before the run. A file is written beside its place under another name and then renamed,
//! so that a reader never meets half of it and an older file stays until the new one is there.
use crate::report::quoted;
use anyhow::{Context, anyhow, bail};
use std::ffi::OsString;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use tempfile::NamedTempFile;

/// A checked place for one result.
#[derive(Debug)]
pub(super) enum Target {
    /// Standard output.
    Stdout,
    /// A file that is or will be a regular one.
    File(PathBuf),
    /// Something that cannot be replaced, as a terminal or a pipe with a name.
    Device(PathBuf),
    /// Memory, from which the caller of [`crate::run`] takes it.
    Memory,
}

impl Target {
    /// Checks that a result can be written to `path`; none or `-` is stdout. `inputs` must not be overwritten.
    pub(super) fn checked(path: Option<&Path>, inputs: &[&Path]) -> anyhow::Result<Self> {
        let Some(path) = path.filter(|path| *path != Path::new("-")) else { return Ok(Self::Stdout) };
        let shown = path.display();
        if path.as_os_str().is_empty() {
            bail!("the output has an empty name: write a file name or `-` for stdout");
        }
        // A link stays and its file is replaced.
        let path = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
        if inputs.iter().any(|input| input.canonicalize().is_ok_and(|input| input == path)) {
            bail!("{shown} is an input of this run and would be overwritten: choose another output");
        }
        match path.metadata() {
            Ok(found) if found.is_dir() => bail!("{shown} is a folder: name a file in it"),
            Ok(found) if !found.is_file() => return Ok(Self::Device(path)),
            Ok(found) if found.permissions().readonly() => {
                bail!("{shown} is write-protected: allow writing or choose another output")
            }
            _ => {}
        }
        let folder = folder_of(&path);
        remove_orphans(folder);
        if !folder.is_dir() {
            bail!("{shown} cannot be written: there is no folder {}, make it first", folder.display());
        }
        temporary(folder).with_context(|| format!("{shown} cannot be written"))?;
        Ok(Self::File(path))
    }

    /// Whether both are one regular file.
    pub(super) fn is_same_file(&self, other: &Self) -> bool {
        matches!((self, other), (Self::File(a), Self::File(b)) if a == b)
    }

    fn shown(&self) -> String {
        match self {
            Self::Stdout => "stdout".to_owned(),
            Self::Memory => "memory".to_owned(),
            Self::File(path) | Self::Device(path) => path.display().to_string(),
        }
    }

    /// Begins a result that is written piece by piece.
    pub(super) fn open(&self) -> anyhow::Result<Stream> {
        let shown = self.shown();
        let failed = || format!("{shown} cannot be written");
        let writer = match self {
            Self::Stdout => Writer::Plain(Box::new(std::io::stdout())),
            Self::Memory => Writer::Plain(Box::new(std::io::sink())),
            Self::File(path) => Writer::File(temporary(folder_of(path)).with_context(failed)?, path.clone()),
            Self::Device(path) => {
                Writer::Plain(Box::new(File::options().write(true).open(path).with_context(failed)?))
            }
        };
        Ok(Stream { writer: BufWriter::with_capacity(BUFFER, writer), shown, flushed: Instant::now() })
    }

    /// Writes the result.
    pub(super) fn write(&self, bytes: &[u8]) -> anyhow::Result<()> {
        match self {
            Self::Stdout => {
                let mut stdout = std::io::stdout().lock();
                stdout.write_all(bytes).and_then(|()| stdout.flush()).context("stdout cannot be written")
            }
            Self::Memory => Ok(()),
            Self::File(path) => write_file(path, bytes),
            Self::Device(path) => {
                let write = File::options().write(true).open(path).and_then(|mut file| file.write_all(bytes));
                write.with_context(|| format!("{} cannot be written", path.display()))
            }
        }
    }
}

/// Refuses outputs that name one place; each with its option.
pub(super) fn check_distinct(outputs: &[(&str, Option<&Target>)]) -> anyhow::Result<()> {
    for (k, (one, a)) in outputs.iter().enumerate() {
        for (other, b) in &outputs[k + 1..] {
            if let (Some(a), Some(b)) = (a, b)
                && (a.is_same_file(b) || matches!((a, b), (Target::Stdout, Target::Stdout)))
            {
                bail!("{one} and {other} name the same place, {}: choose two", a.shown());
            }
        }
    }
    Ok(())
}

const BUFFER: usize = 1 << 16;

/// What waits longer in the buffer of a stream goes out with the next piece, for whoever watches a pipe.
const FLUSH_INTERVAL: Duration = Duration::from_millis(200);

/// A result that is written piece by piece. A file appears with [`Stream::finish`]; dropped before, it leaves nothing.
pub(super) struct Stream {
    writer: BufWriter<Writer>,
    shown: String,
    flushed: Instant,
}

enum Writer {
    /// Stdout or a device.
    Plain(Box<dyn Write>),
    /// A file under another name, and its place.
    File(NamedTempFile, PathBuf),
}

impl Write for Writer {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        match self {
            Self::Plain(writer) => writer.write(bytes),
            Self::File(file, _) => file.write(bytes),
        }
    }

    fn flush(&mut self) -> std::io::Result<()> {
        match self {
            Self::Plain(writer) => writer.flush(),
            Self::File(file, _) => file.flush(),
        }
    }
}

impl Stream {
    /// Writes a piece.
    pub(super) fn write(&mut self, text: &str) -> anyhow::Result<()> {
        let failed = || format!("{} cannot be written", self.shown);
        self.writer.write_all(text.as_bytes()).with_context(failed)?;
        if self.flushed.elapsed() > FLUSH_INTERVAL {
            self.writer.flush().with_context(failed)?;
            self.flushed = Instant::now();
        }
        Ok(())
    }

    /// Hands on what waits in the buffer.
    pub(super) fn flush(&mut self) -> anyhow::Result<()> {
        self.flushed = Instant::now();
        self.writer.flush().with_context(|| format!("{} cannot be written", self.shown))
    }

    /// Ends the result: all of it is there.
    pub(super) fn finish(self) -> anyhow::Result<()> {
        let failed = || format!("{} cannot be written", self.shown);
        let writer = self.writer.into_inner().map_err(|error| error.into_error()).with_context(failed)?;
        match writer {
            Writer::Plain(mut writer) => writer.flush().with_context(failed),
            Writer::File(file, path) => {
                file.as_file().sync_all().with_context(failed)?;
                file.persist(path).map_err(|error| error.error).with_context(failed)?;
                Ok(())
            }
        }
    }
}

/// Lines of a summary as remarks at the top of a CSV.
pub(super) fn remarks(summary: &str) -> Vec<String> {
    summary.lines().filter(|line| !line.is_empty()).map(str::to_owned).collect()
}

/// Writes a file so that it appears complete or not at all.
pub(super) fn write_file(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    let failed = || format!("{} cannot be written", path.display());
    complete(path, bytes).with_context(failed)?.persist(path).map_err(|e| e.error).with_context(failed)?;
    Ok(())
}

/// Writes some files, each so that it appears complete or not at all. They are on disk together, which takes hardly longer than one.
#[cfg(feature = "serve")]
pub(super) fn write_files(files: &[(&Path, &[u8])]) -> Vec<anyhow::Result<()>> {
    let begun: Vec<_> = files.iter().map(|(path, bytes)| filled(path, bytes)).collect();
    let persist = |(begun, (path, _)): (std::io::Result<NamedTempFile>, &(&Path, &[u8]))| {
        let persisted = begun.and_then(|file| {
            file.as_file().sync_all()?;
            file.persist(path).map_err(|error| error.error)
        });
        persisted.map(|_| ()).with_context(|| format!("{} cannot be written", path.display()))
    };
    begun.into_iter().zip(files).map(persist).collect()
}

/// Writes a file that is not there yet, complete or not at all.
pub(super) fn write_new_file(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    let failed = || format!("{} cannot be written", path.display());
    complete(path, bytes)
        .with_context(failed)?
        .persist_noclobber(path)
        .map_err(|e| e.error)
        .with_context(failed)?;
    Ok(())
}

/// Makes a folder for results and finds out whether it can be written.
pub(super) fn make_folder(folder: &Path) -> anyhow::Result<()> {
    let shown = folder.display();
    if folder.exists() && !folder.is_dir() {
        bail!("{shown} is a file where the output folder should be: choose another folder");
    }
    std::fs::create_dir_all(folder).map_err(|error| {
        anyhow!("the output folder {shown} cannot be made: {error}; choose another with --out")
    })?;
    temporary(folder).map_err(|error| {
        anyhow!("the output folder {shown} cannot be written: {error}; choose another with --out")
    })?;
    Ok(())
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// A file beside its place with all its bytes, which need not be on disk.
fn filled(path: &Path, bytes: &[u8]) -> std::io::Result<NamedTempFile> {
    let mut file = temporary(folder_of(path))?;
    file.write_all(bytes)?;
    Ok(file)
}

fn complete(path: &Path, bytes: &[u8]) -> std::io::Result<NamedTempFile> {
    let file = filled(path, bytes)?;
    file.as_file().sync_all()?;
    Ok(file)
}

/// Beginning and end of the names of files that are being written.
const PART: (&str, &str) = (".cylwatch-", ".part");
/// A file that is being written is locked within this time after it was made.
const UNLOCKED: Duration = Duration::from_secs(60);

/// A file under a name of its own in `folder`; it goes when it is dropped. Its lock says that somebody is writing it.
fn temporary(folder: &Path) -> std::io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(PART.0).suffix(PART.1);
    #[cfg(unix)]
    {
        // What any new file gets: the user's mask applies.
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let file = builder.tempfile_in(folder)?;
    // A file system without locks keeps what a killed run leaves.
    _ = file.as_file().try_lock();
    Ok(file)
}

/// Removes what runs that were killed have left in `folder`.
pub(super) fn remove_orphans(folder: &Path) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let is_part = name.to_str().is_some_and(|name| name.starts_with(PART.0) && name.ends_with(PART.1));
        let age = || entry.metadata().and_then(|found| found.modified()).ok()?.elapsed().ok();
        if !is_part || age().is_none_or(|age| age < UNLOCKED) {
            continue;
        }
        let file = File::options().write(true).open(entry.path());
        if file.is_ok_and(|file| file.try_lock().is_ok()) {
            // Somebody else may have removed it.
            _ = std::fs::remove_file(entry.path());
        }
    }
}

/// The command line as it was typed, quoted so that a shell runs it again.
pub(super) fn command_line() -> String {
    quoted_line(std::env::args_os())
}

/// The same without an option and its value that change nothing about the results.
pub(super) fn command_line_without(option: &str) -> String {
    quoted_line_without(std::env::args_os(), option)
}

/// The same of any words, the first of which is the program.
pub(super) fn quoted_line_without(words: impl Iterator<Item = OsString>, option: &str) -> String {
    let mut is_value = false;
    let kept = words.filter(|word| {
        let was_value = std::mem::replace(&mut is_value, word == option);
        let is_whole = word.to_str().is_some_and(|word| word.starts_with(&format!("{option}=")));
        !(was_value || is_value || is_whole)
    });
    quoted_line(kept)
}

fn quoted_line(words: impl Iterator<Item = OsString>) -> String {
    let words = words.enumerate().map(|(k, word)| {
        let word = word.to_string_lossy().into_owned();
        if k == 0 { "cylwatch".to_owned() } else { quoted(&word) }
    });
    words.collect::<Vec<_>>().join(" ")
}

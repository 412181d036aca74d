//! Results that grow while a run goes on: events, and the rows of runs that continue one state.
//!
//! What cannot be written, as on a full disk, waits, costs one caution, and is tried again: the run goes on. A run fails by it at its
//! end alone, if it still waits then.
use super::message::Messages;
use super::output::Target;
use anyhow::{Context, anyhow, bail};
use std::fs::File;
use std::io::{BufRead, BufReader, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::Path;
use std::time::{Duration, Instant};

/// Bytes that wait before they are written.
const BUFFER: usize = 1 << 16;
/// How long a line waits at most while others come.
const INTERVAL: Duration = Duration::from_millis(200);
/// What may wait for room on the disk, bytes: months of rows.
const WAITING: usize = 64 << 20;

/// A result that grows.
pub(super) struct Appended {
    writer: Box<dyn Write>,
    /// The file of a table.
    table: Option<File>,
    shown: String,
    messages: Messages,
    waiting: Vec<u8>,
    /// Bytes written.
    length: u64,
    tried: Instant,
    /// Why nothing can be written at present.
    failure: Option<std::io::Error>,
}

impl Appended {
    /// Begins or goes on at the end of what is there.
    pub(super) fn open(target: &Target, goes_on: bool, messages: &Messages) -> anyhow::Result<Self> {
        let (writer, shown): (Box<dyn Write>, String) = match target {
            Target::Stdout => (Box::new(std::io::stdout()), "stdout".to_owned()),
            Target::File(path) | Target::Device(path) => {
                let shown = path.display().to_string();
                let mut options = File::options();
                let is_device = matches!(target, Target::Device(_));
                options.append(true).create(!is_device);
                let opened = options.open(path).with_context(|| format!("{shown} cannot be written"))?;
                if !goes_on && !is_device {
                    opened.set_len(0).with_context(|| format!("{shown} cannot be emptied"))?;
                }
                (Box::new(opened), shown)
            }
        };
        Ok(Self::to(writer, shown, messages))
    }

    fn to(writer: Box<dyn Write>, shown: String, messages: &Messages) -> Self {
        let (waiting, tried) = (Vec::new(), Instant::now());
        Self {
            writer,
            table: None,
            shown,
            messages: messages.clone(),
            waiting,
            length: 0,
            tried,
            failure: None,
        }
    }

    /// Goes on with a table whose names of columns stand in `header`; `None`: there is none yet. A line without an end goes.
    pub(super) fn table(path: &Path, header: &str, messages: &Messages) -> anyhow::Result<Option<Self>> {
        let shown = path.display().to_string();
        let mut file = match File::options().read(true).append(true).open(path) {
            Ok(file) => file,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(error).with_context(|| format!("{shown} cannot be written")),
        };
        let failed = || format!("{shown} cannot be read");
        let mut names = Vec::new();
        let mut reader = BufReader::new(&mut file);
        while names.is_empty() || names.starts_with(b"#") {
            names.clear();
            if reader.read_until(b'\n', &mut names).with_context(failed)? == 0 {
                break;
            }
        }
        if names.is_empty() {
            return Ok(None);
        }
        if names != header.as_bytes() {
            bail!(
                "{shown} has other columns than this run writes, so that its rows cannot go on there: choose another \
                 output"
            );
        }
        let length = end_of_last_line(&mut file).with_context(failed)?;
        file.set_len(length).with_context(|| format!("{shown} cannot be cut"))?;
        let table = Some(file.try_clone().with_context(failed)?);
        Ok(Some(Self { length, table, ..Self::to(Box::new(file), shown, messages) }))
    }

    /// Takes back what a table has beyond a length, bytes.
    pub(super) fn cut(&mut self, length: u64) -> anyhow::Result<()> {
        if let Some(file) = self.table.as_ref().filter(|_| length < self.length) {
            file.set_len(length).with_context(|| format!("{} cannot be cut", self.shown))?;
            self.length = length;
        }
        Ok(())
    }

    /// Writes a line at once.
    pub(super) fn line(&mut self, line: &str) -> anyhow::Result<()> {
        self.waiting.extend_from_slice(line.as_bytes());
        self.waiting.push(b'\n');
        self.flush()
    }

    /// Writes a piece, at once or with those that follow.
    pub(super) fn write(&mut self, text: &str) -> anyhow::Result<()> {
        self.waiting.extend_from_slice(text.as_bytes());
        let is_due =
            self.waiting.len() >= BUFFER && self.failure.is_none() || self.tried.elapsed() > INTERVAL;
        if is_due { self.flush() } else { Ok(()) }
    }

    /// Writes what waits, as far as can be.
    pub(super) fn flush(&mut self) -> anyhow::Result<()> {
        self.tried = Instant::now();
        let mut written = 0;
        let outcome = loop {
            if written == self.waiting.len() {
                break self.writer.flush();
            }
            match self.writer.write(&self.waiting[written..]) {
                Ok(0) => break Err(ErrorKind::WriteZero.into()),
                Ok(count) => written += count,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => break Err(error),
            }
        };
        self.waiting.drain(..written);
        self.length += written as u64;
        match outcome {
            Ok(()) => {
                if self.failure.take().is_some() {
                    self.messages.caution(&format!("{} is written again; nothing is missing", self.shown));
                }
                Ok(())
            }
            // Nobody reads any more.
            Err(error) if error.kind() == ErrorKind::BrokenPipe || self.waiting.len() > WAITING => {
                Err(error).with_context(|| format!("{} cannot be written", self.shown))
            }
            Err(error) => {
                if self.failure.is_none() {
                    self.messages.caution(&format!(
                        "{} cannot be written: {error}; what belongs there waits, and the run goes on",
                        self.shown
                    ));
                }
                self.failure = Some(error);
                Ok(())
            }
        }
    }

    /// Bytes of the file, if all that was written is there.
    pub(super) fn complete_length(&self) -> Option<u64> {
        self.waiting.is_empty().then_some(self.length)
    }

    /// Ends the result.
    pub(super) fn finish(mut self) -> anyhow::Result<()> {
        self.flush()?;
        let Some(failure) = self.failure else { return Ok(()) };
        let lines = self.waiting.iter().filter(|&&byte| byte == b'\n').count();
        Err(anyhow!("{} lacks its last {lines} lines, which cannot be written: {failure}", self.shown))
    }
}

/// Where the last line with an end ends.
fn end_of_last_line(file: &mut File) -> std::io::Result<u64> {
    let mut end = file.metadata()?.len();
    let mut piece = [0; 4096];
    while end > 0 {
        let from = end.saturating_sub(piece.len() as u64);
        let bytes = &mut piece[..(end - from) as usize];
        file.seek(SeekFrom::Start(from))?;
        file.read_exact(bytes)?;
        if let Some(last) = bytes.iter().rposition(|&byte| byte == b'\n') {
            return Ok(from + last as u64 + 1);
        }
        end = from;
    }
    Ok(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::{Cell, RefCell};
    use std::rc::Rc;

    const QUIET: fn() -> Messages = || Messages::new(true);

    /// A disk with so much room.
    #[derive(Clone, Default)]
    struct Disk(Rc<(Cell<usize>, RefCell<Vec<u8>>)>);

    impl Write for Disk {
        fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
            let (room, written) = &*self.0;
            let count = bytes.len().min(room.get());
            if count == 0 {
                return Err(ErrorKind::StorageFull.into());
            }
            room.set(room.get() - count);
            written.borrow_mut().extend_from_slice(&bytes[..count]);
            Ok(count)
        }

        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn what_finds_no_room_waits_and_comes_when_there_is_some() {
        let disk = Disk::default();
        disk.0.0.set(4);
        let mut appended = Appended::to(Box::new(disk.clone()), "disk".to_owned(), &QUIET());
        appended.line("one").unwrap();
        assert_eq!(appended.complete_length(), Some(4));
        appended.line("two").unwrap();
        disk.0.0.set(2);
        appended.line("three").unwrap();
        assert_eq!((&disk.0.1.borrow()[..], appended.complete_length()), (&b"one\ntw"[..], None));
        disk.0.0.set(100);
        appended.finish().unwrap();
        assert_eq!(&disk.0.1.borrow()[..], b"one\ntwo\nthree\n");
    }

    #[test]
    fn what_still_waits_at_the_end_is_an_error_that_counts_its_lines() {
        let mut appended = Appended::to(Box::new(Disk::default()), "disk".to_owned(), &QUIET());
        appended.line("one").unwrap();
        appended.line("two").unwrap();
        let error = appended.finish().unwrap_err().to_string();
        assert!(error.starts_with("disk lacks its last 2 lines"), "{error}");
    }

    #[test]
    fn a_table_goes_on_after_its_last_whole_line_and_only_with_its_own_columns() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rows.csv");
        assert!(Appended::table(&path, "a,b\n", &QUIET()).unwrap().is_none());
        std::fs::write(&path, "# made\na,b\n1,2\n3,").unwrap();
        let mut table = Appended::table(&path, "a,b\n", &QUIET()).unwrap().unwrap();
        table.line("5,6").unwrap();
        assert_eq!(table.complete_length(), Some(19));
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "# made\na,b\n1,2\n5,6\n");
        let error = Appended::table(&path, "a,c\n", &QUIET()).err().unwrap().to_string();
        assert!(error.contains("other columns"), "{error}");
        table.cut(25).unwrap();
        table.cut(15).unwrap();
        table.line("7,8").unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "# made\na,b\n1,2\n7,8\n");
        std::fs::write(&path, "# made\n").unwrap();
        assert!(Appended::table(&path, "a,b\n", &QUIET()).unwrap().is_none());
    }
}

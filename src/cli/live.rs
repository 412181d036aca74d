//! A log that comes through a pipe while it is written: whole lines, told when none is waiting, ended by a signal.
//!
//! A thread reads; the run takes pieces from a channel. So the run can ask whether more is there without waiting for it, and a
//! signal ends the log as its end would, but for a line that is not complete.
use super::interrupt;
use std::cell::RefCell;
use std::io::{Error, Read};
use std::rc::Rc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::time::Duration;

/// Pieces that wait at most; then the writer of the pipe waits.
const PIECES: usize = 64;
const PIECE: usize = 1 << 16;
/// Longest line that is waited for; no row is as long.
const LONGEST: usize = 1 << 20;
/// Rows that come together come within this.
const PATIENCE: Duration = Duration::from_millis(200);

enum Piece {
    Bytes(Vec<u8>),
    Failed(Error),
    /// The input has ended.
    End,
    /// A signal has come.
    Stop,
}

/// A log from a pipe. Clones read the same one.
#[derive(Clone)]
pub(super) struct Live(Rc<RefCell<Lines>>);

struct Lines {
    pieces: Receiver<Piece>,
    /// Whole lines that wait to be read, and how much of them has been.
    lines: Vec<u8>,
    read: usize,
    /// The beginning of a line whose end has not come.
    begun: Vec<u8>,
    failed: Option<Error>,
    has_ended: bool,
}

impl Live {
    /// Reads from now on, and listens for signals.
    pub(super) fn new(input: impl Read + Send + 'static) -> anyhow::Result<Self> {
        let (sender, pieces) = sync_channel(PIECES);
        let stop = sender.clone();
        interrupt::listen(move || _ = stop.send(Piece::Stop))?;
        std::thread::spawn(move || pump(input, &sender));
        Ok(Self::of(pieces))
    }

    fn of(pieces: Receiver<Piece>) -> Self {
        let (lines, begun) = (Vec::new(), Vec::new());
        Self(Rc::new(RefCell::new(Lines { pieces, lines, read: 0, begun, failed: None, has_ended: false })))
    }

    /// Whether nothing more comes at once.
    pub(super) fn is_waiting(&self) -> bool {
        let mut lines = self.0.borrow_mut();
        while lines.is_empty() && !lines.has_ended {
            match lines.pieces.recv_timeout(PATIENCE) {
                Ok(piece) => lines.take(piece),
                Err(RecvTimeoutError::Timeout) => return true,
                Err(RecvTimeoutError::Disconnected) => lines.take(Piece::End),
            }
        }
        false
    }
}

impl Read for Live {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let mut lines = self.0.borrow_mut();
        while lines.is_empty() && !lines.has_ended {
            let piece = lines.pieces.recv().unwrap_or(Piece::End);
            lines.take(piece);
        }
        if lines.is_empty() {
            return lines.failed.take().map_or(Ok(0), Err);
        }
        let Lines { lines: waiting, read, .. } = &mut *lines;
        let count = buffer.len().min(waiting.len() - *read);
        buffer[..count].copy_from_slice(&waiting[*read..*read + count]);
        *read += count;
        Ok(count)
    }
}

impl Lines {
    fn is_empty(&self) -> bool {
        self.read == self.lines.len()
    }

    /// Takes a piece while no line waits.
    fn take(&mut self, piece: Piece) {
        self.lines.clear();
        self.read = 0;
        match piece {
            Piece::Bytes(bytes) => {
                self.begun.extend_from_slice(&bytes);
                let whole = self.begun.iter().rposition(|&byte| byte == b'\n').map_or(0, |last| last + 1);
                let whole = if self.begun.len() > LONGEST { self.begun.len() } else { whole };
                self.lines.extend(self.begun.drain(..whole));
            }
            Piece::End => {
                std::mem::swap(&mut self.lines, &mut self.begun);
                self.has_ended = true;
            }
            Piece::Failed(error) => (self.failed, self.has_ended) = (Some(error), true),
            Piece::Stop => self.has_ended = true,
        }
    }
}

/// Hands on what comes until it ends or nobody takes it.
fn pump(mut input: impl Read, sender: &SyncSender<Piece>) {
    let mut bytes = vec![0; PIECE];
    loop {
        let piece = match input.read(&mut bytes) {
            Ok(0) => Piece::End,
            Ok(count) => Piece::Bytes(bytes[..count].to_vec()),
            Err(error) if error.kind() == std::io::ErrorKind::Interrupted => continue,
            Err(error) => Piece::Failed(error),
        };
        let is_last = !matches!(piece, Piece::Bytes(_));
        if sender.send(piece).is_err() || is_last {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(pieces: Vec<Piece>) -> String {
        let (sender, receiver) = sync_channel(PIECES);
        pieces.into_iter().for_each(|piece| sender.send(piece).unwrap());
        let mut text = String::new();
        Live::of(receiver).read_to_string(&mut text).unwrap();
        text
    }

    fn bytes(text: &str) -> Piece {
        Piece::Bytes(text.as_bytes().to_vec())
    }

    #[test]
    fn a_line_that_a_signal_cuts_is_left_out_and_one_that_the_end_cuts_is_not() {
        assert_eq!(read(vec![bytes("a\nb"), bytes("c\n16"), Piece::Stop]), "a\nbc\n");
        assert_eq!(read(vec![bytes("a\nb"), bytes("c\n16"), Piece::End]), "a\nbc\n16");
    }

    #[test]
    fn a_long_line_is_not_kept_for_ever() {
        let long = "x".repeat(LONGEST + 1);
        assert_eq!(read(vec![bytes(&long), Piece::Stop]).len(), LONGEST + 1);
    }

    #[test]
    fn a_failure_comes_after_what_was_read() {
        let (sender, receiver) = sync_channel(PIECES);
        sender.send(bytes("a\n")).unwrap();
        sender.send(Piece::Failed(Error::other("gone"))).unwrap();
        let (mut live, mut text) = (Live::of(receiver), String::new());
        assert_eq!(live.read_to_string(&mut text).unwrap_err().to_string(), "gone");
        assert_eq!(text, "a\n");
    }

    #[test]
    fn it_waits_while_there_is_no_whole_line() {
        let (sender, receiver) = sync_channel(PIECES);
        let mut live = Live::of(receiver);
        sender.send(bytes("a")).unwrap();
        assert!(live.is_waiting());
        sender.send(bytes("\n")).unwrap();
        assert!(!live.is_waiting());
        assert_eq!(live.read(&mut [0; 9]).unwrap(), 2);
        drop(sender);
        // The end is something that comes at once.
        assert!(!live.is_waiting());
    }
}

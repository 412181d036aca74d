//! What a log is packed in, told by its first bytes rather than by its name: gzip is unpacked on the way.
use super::LogError;
use flate2::bufread::MultiGzDecoder;
use std::io::{BufReader, Cursor, ErrorKind, Read};

/// How the bytes of a log are packed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Packing {
    /// Not at all.
    Plain,
    /// gzip, also several streams one after the other.
    Gzip,
}

const NO_TABLE: &str = "name a table in CSV or Parquet";
/// Bytes that are looked at, and those that tell how they are packed.
const HEAD: usize = 256;
const MARK: usize = 4;

/// First bytes of what is no text: what it is, and what to do.
const FOREIGN: [(&[u8], &str, &str); 10] = [
    (b"PAR1", "a Parquet file", "give its name the ending .parquet; Parquet cannot be read from a pipe"),
    (
        b"PK\x03\x04",
        "a ZIP archive or a workbook of a spreadsheet program",
        "unpack it, or save the sheet as CSV",
    ),
    (b"\x28\xb5\x2f\xfd", "packed with zstd", "unpack it with `zstd -d`, or pack it with gzip"),
    (b"\xfd7zX", "packed with xz", "unpack it with `xz -d`, or pack it with gzip"),
    (b"\x89PNG", "a picture", NO_TABLE),
    (b"\xff\xd8\xff", "a picture", NO_TABLE),
    (b"%PDF", "a PDF document", NO_TABLE),
    (b"\x7fELF", "a program", NO_TABLE),
    (b"\xd0\xcf\x11\xe0", "a workbook of a spreadsheet program", "save the sheet as CSV"),
    (b"BZh", "packed with bzip2", "unpack it with `bzip2 -d`, or pack it with gzip"),
];

/// The text of a log and how it is packed.
///
/// # Errors
/// The first bytes cannot be read, or are those of something else than text and gzip.
pub(super) fn unpacked(mut input: Box<dyn Read>, file: &str) -> Result<(Box<dyn Read>, Packing), LogError> {
    let mut head = Vec::new();
    // No more than is there: a live log may begin with a few bytes.
    while head.len() < MARK {
        let mut piece = [0; HEAD];
        match input.read(&mut piece) {
            Ok(0) => break,
            Ok(count) => head.extend_from_slice(&piece[..count]),
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(source) => return Err(LogError::Io { file: file.to_owned(), source }),
        }
    }
    if let Some(&(_, what, remedy)) = FOREIGN.iter().find(|(bytes, ..)| head.starts_with(bytes)) {
        return Err(LogError::NoText { file: file.to_owned(), what, remedy });
    }
    let is_gzip = head.starts_with(b"\x1f\x8b");
    // Those of UTF-16 are told with what to do.
    let is_control =
        |byte: &u8| *byte < b' ' && !matches!(byte, 0 | b'\t' | b'\n' | b'\r' | b'\x0c' | b'\x1a');
    if !is_gzip && head.iter().any(is_control) {
        let what = "no text: its first bytes are those of a program's own data";
        return Err(LogError::NoText { file: file.to_owned(), what, remedy: NO_TABLE });
    }
    let whole = Cursor::new(head).chain(input);
    Ok(if is_gzip {
        (Box::new(MultiGzDecoder::new(BufReader::new(whole))), Packing::Gzip)
    } else {
        (Box::new(whole), Packing::Plain)
    })
}

impl Packing {
    /// Why reading failed at this place: the file system, or the packed stream.
    pub(super) fn error(self, file: &str, at: String, source: std::io::Error) -> LogError {
        use ErrorKind::{InvalidData, InvalidInput, UnexpectedEof};
        let is_damage = matches!(source.kind(), InvalidData | InvalidInput | UnexpectedEof);
        let what = if source.kind() == UnexpectedEof { "ends too early" } else { "is damaged" };
        match self {
            Self::Gzip if is_damage => LogError::Gzip { at, what, source },
            _ => LogError::Io { file: file.to_owned(), source },
        }
    }
}

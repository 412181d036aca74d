//! Records of a text: lines cut into cells, with the line they stand in.
use super::LogError;
use super::spool;
use super::unpack::{Packing, unpacked};
use std::collections::VecDeque;
use std::io::{BufRead, BufReader, Read};

/// Longest record, bytes: what lies above is no row but a quotation mark without its twin.
pub(super) const LONGEST: usize = 1 << 20;
const BUFFER: usize = 1 << 16;

/// Cuts a text into records, one at a time in one buffer.
///
/// Comments (`#`) and blank lines are passed over. A cell in quotation marks may hold separators and line feeds.
pub(super) struct Records {
    file: String,
    input: BufReader<Box<dyn Read>>,
    packing: Packing,
    /// Lines that were looked at and not yet read.
    ahead: VecDeque<Vec<u8>>,
    /// Separator of cells; until it is known a record is one cell.
    separator: Option<u8>,
    bytes: Vec<u8>,
    cells: Vec<(usize, usize)>,
    /// Line of the record, from 1.
    line: u64,
    /// Lines read.
    lines: u64,
    /// Whether the record's last line had an end.
    is_ended: bool,
    /// Whether the input is a [spool](super::spool), not a text.
    is_spool: bool,
}

impl Records {
    /// The records of a text that may be packed.
    pub(super) fn new(input: Box<dyn Read>, file: &str) -> Result<Self, LogError> {
        let (input, packing) = unpacked(input, file)?;
        Ok(Self {
            file: file.to_owned(),
            input: BufReader::with_capacity(BUFFER, input),
            packing,
            ahead: VecDeque::new(),
            separator: None,
            bytes: Vec::new(),
            cells: Vec::new(),
            line: 0,
            lines: 0,
            is_ended: true,
            is_spool: false,
        })
    }

    /// The records of a spool, which were those of a text.
    pub(super) fn of_spool(input: Box<dyn Read>, file: &str, separator: u8) -> Self {
        Self {
            file: file.to_owned(),
            input: BufReader::with_capacity(BUFFER, input),
            packing: Packing::Plain,
            ahead: VecDeque::new(),
            separator: Some(separator),
            bytes: Vec::new(),
            cells: Vec::new(),
            line: 0,
            lines: 0,
            is_ended: true,
            is_spool: true,
        }
    }

    /// How the text is packed.
    pub(super) fn packing(&self) -> Packing {
        self.packing
    }

    /// Whether what comes next has not been taken from the input yet.
    pub(super) fn is_drained(&self) -> bool {
        self.packing == Packing::Plain && self.ahead.is_empty() && self.input.buffer().is_empty()
    }

    /// A line that comes, 0 the next, with its end; `None`: the text ends before it.
    pub(super) fn ahead(&mut self, index: usize) -> Result<Option<&[u8]>, LogError> {
        while self.ahead.len() <= index {
            let mut line = Vec::new();
            if read_line(&mut self.input, &mut line).map_err(|error| self.failed(error))? == 0 {
                return Ok(None);
            }
            self.ahead.push_back(line);
        }
        Ok(self.ahead.get(index).map(Vec::as_slice))
    }

    /// Leaves out lines that were looked at.
    pub(super) fn skip(&mut self, lines: usize) {
        self.lines += self.ahead.drain(..lines.min(self.ahead.len())).len() as u64;
    }

    /// Appends the record to a spool.
    pub(super) fn spool(&self, out: &mut Vec<u8>) {
        spool::write(out, (self.line, self.is_ended), &self.bytes, &self.cells);
    }

    /// Reads the next record; `false` at the end.
    pub(super) fn advance(&mut self) -> Result<bool, LogError> {
        if self.is_spool {
            let frame = spool::read(&mut self.input, &mut self.bytes, &mut self.cells);
            let frame = frame.map_err(|error| self.failed(error))?;
            (self.line, self.is_ended) = frame.unwrap_or_default();
            return Ok(frame.is_some());
        }
        loop {
            self.bytes.clear();
            self.line = self.lines + 1;
            if !self.append_line()? {
                return Ok(false);
            }
            if self.line == 1 {
                self.byte_order_mark()?;
            }
            if !self.bytes.starts_with(b"#") && !self.bytes.trim_ascii().is_empty() {
                break;
            }
        }
        if self.bytes.contains(&b'"') {
            let mut marks = Marks::default();
            let mut seen = 0;
            while marks.leave_open(&self.bytes[seen..], self.separator) {
                seen = self.bytes.len();
                if !self.append_line()? {
                    break;
                }
            }
            self.cut_quoted();
        } else {
            self.cut();
        }
        Ok(true)
    }

    /// Cuts the record that is there, and all further ones, at this separator.
    pub(super) fn separate(&mut self, separator: u8) {
        self.separator = Some(separator);
        if self.bytes.contains(&b'"') { self.cut_quoted() } else { self.cut() }
    }

    /// The record as it was read, without its end of line.
    pub(super) fn text(&self) -> &[u8] {
        self.bytes.trim_ascii_end()
    }

    pub(super) fn len(&self) -> usize {
        self.cells.len()
    }

    pub(super) fn cell(&self, index: usize) -> &[u8] {
        let (from, to) = self.cells[index];
        &self.bytes[from..to]
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = &[u8]> {
        self.cells.iter().map(|&(from, to)| &self.bytes[from..to])
    }

    /// Place of the record.
    pub(super) fn place(&self) -> String {
        format!("{}:{}", self.file, self.line)
    }

    pub(super) fn line(&self) -> u64 {
        self.line
    }

    /// Whether the file ends in the middle of this record's line.
    pub(super) fn is_cut(&self) -> bool {
        !self.is_ended
    }

    fn append_line(&mut self) -> Result<bool, LogError> {
        let count = match self.ahead.pop_front() {
            Some(line) => {
                self.bytes.extend_from_slice(&line);
                line.len()
            }
            None => read_line(&mut self.input, &mut self.bytes).map_err(|error| self.failed(error))?,
        };
        if self.bytes.len() > LONGEST {
            return Err(LogError::Overlong { at: self.place(), limit: LONGEST });
        }
        self.lines += 1;
        self.is_ended = self.bytes.ends_with(b"\n");
        Ok(count > 0)
    }

    fn failed(&self, source: std::io::Error) -> LogError {
        self.packing.error(&self.file, format!("{}:{}", self.file, self.lines + 1), source)
    }

    fn byte_order_mark(&mut self) -> Result<(), LogError> {
        if self.bytes.starts_with(&[0xff, 0xfe]) || self.bytes.starts_with(&[0xfe, 0xff]) {
            return Err(LogError::NotUtf8 { at: self.place(), what: "the log is UTF-16".to_owned() });
        }
        if self.bytes.starts_with(b"\xef\xbb\xbf") {
            self.bytes.drain(..3);
        }
        Ok(())
    }

    fn cut(&mut self) {
        let end = self.bytes.trim_ascii_end().len();
        // White space at the end is no cell, but a tab may be a separator.
        let end = match self.separator {
            Some(b'\t') => self.bytes.len() - end_of_line(&self.bytes),
            _ => end,
        };
        self.cells.clear();
        let mut from = 0;
        if let Some(separator) = self.separator {
            for (at, &byte) in self.bytes[..end].iter().enumerate() {
                if byte == separator {
                    self.cells.push((from, at));
                    from = at + 1;
                }
            }
        }
        self.cells.push((from, end));
    }

    /// As [`Records::cut`] for a record with quotation marks, which go.
    fn cut_quoted(&mut self) {
        let end = self.bytes.len() - end_of_line(&self.bytes);
        let Some(separator) = self.separator else {
            self.cells = vec![(0, end)];
            return;
        };
        let mut record = ::csv::ByteRecord::new();
        let mut reader = ::csv::ReaderBuilder::new()
            .delimiter(separator)
            .has_headers(false)
            .buffer_capacity(end.max(1))
            .from_reader(&self.bytes[..end]);
        // Bytes in memory do not fail, and one record has one width.
        let _ = reader.read_byte_record(&mut record);
        self.bytes.clear();
        self.cells.clear();
        for cell in &record {
            let from = self.bytes.len();
            self.bytes.extend_from_slice(cell);
            self.cells.push((from, self.bytes.len()));
        }
    }
}

/// Appends a line, or as much of one as a record can have and a byte.
fn read_line(input: &mut impl BufRead, bytes: &mut Vec<u8>) -> std::io::Result<usize> {
    let room = (LONGEST + 1).saturating_sub(bytes.len()) as u64;
    input.take(room).read_until(b'\n', bytes)
}

/// The separator that a line has most of; a comma where it has none.
pub(super) fn separator(line: &[u8]) -> u8 {
    let count = |separator: u8| line.iter().filter(|&&byte| byte == separator).count();
    // The last of equals wins.
    [b'\t', b';', b','].into_iter().max_by_key(|&separator| count(separator)).unwrap_or(b',')
}

/// Where a text stands between quotation marks.
#[derive(Debug, Default)]
struct Marks {
    is_quoted: bool,
    /// Whether the last byte was inside of a cell, where a mark is a letter unless the cell begins with one.
    is_inside: bool,
}

impl Marks {
    /// Whether the text ends inside of quotation marks; each call brings the next piece of it.
    fn leave_open(&mut self, piece: &[u8], separator: Option<u8>) -> bool {
        for &byte in piece {
            let is_mark = byte == b'"' && (self.is_quoted || !self.is_inside);
            if is_mark {
                self.is_quoted = !self.is_quoted;
            }
            // The second of two marks inside of a quoted cell opens it again.
            self.is_inside = self.is_quoted || !(is_mark || Some(byte) == separator);
        }
        self.is_quoted
    }
}

/// Bytes of the end of line.
fn end_of_line(bytes: &[u8]) -> usize {
    bytes.iter().rev().take_while(|byte| matches!(byte, b'\n' | b'\r')).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn records(text: &'static str, separator: u8) -> Vec<(u64, Vec<String>)> {
        let mut records = Records::new(Box::new(text.as_bytes()), "x").unwrap();
        records.separate(separator);
        let mut out = Vec::new();
        while records.advance().unwrap() {
            let cells = records.iter().map(|cell| String::from_utf8(cell.to_vec()).unwrap()).collect();
            out.push((records.line(), cells));
        }
        out
    }

    #[test]
    fn lines_are_counted_over_comments_blank_lines_and_quoted_line_feeds() {
        let text = "# remark\r\n\r\na,b\r\n\"1\nx\",\"2,\"\"y\"\"\"\r\n#\r\n  \r\n3,4";
        let found = records(text, b',');
        let cells = |line: u64, cells: [&str; 2]| (line, cells.map(str::to_owned).to_vec());
        assert_eq!(found, [cells(3, ["a", "b"]), cells(4, ["1\nx", "2,\"y\""]), cells(8, ["3", "4"])]);
    }

    #[test]
    fn a_mark_inside_of_a_cell_is_a_letter_and_swallows_no_row() {
        let found = records("a,5\" pipe\nb,c\n", b',');
        assert_eq!(found[0], (1, vec!["a".to_owned(), "5\" pipe".to_owned()]));
        assert_eq!(found.len(), 2);
    }

    #[test]
    fn empty_cells_at_the_end_stay_with_every_separator() {
        for (text, separator) in
            [("1,,\n", b','), ("1;;\r\n", b';'), ("1\t\t\r\n", b'\t'), ("\"1\",,\n", b',')]
        {
            let found = records(text, separator);
            assert_eq!(found, [(1, vec!["1".to_owned(), String::new(), String::new()])], "{text:?}");
        }
    }

    #[test]
    fn the_last_record_tells_whether_its_line_ended() {
        for (text, cut) in [("a\nb", true), ("a\nb\n", false)] {
            let mut records = Records::new(Box::new(text.as_bytes()), "x").unwrap();
            assert!(records.advance().unwrap() && !records.is_cut());
            assert!(records.advance().unwrap());
            assert_eq!(records.is_cut(), cut);
            assert!(!records.advance().unwrap());
        }
    }
}

//! Where the header stands, and what its cells say.
//!
//! Loggers write a few lines above it: device, serial number, date of the export. The header is the first line with a
//! name that is known or mapped; without one, the first line of words above a line of as many cells with numbers. What is
//! above it is passed over with a caution. A line of units below the names belongs to them.
use super::cell::Cell;
use super::columns;
use super::label::{self, Label};
use super::record::{Records, separator};
use super::{LogError, LogOptions};

/// Lines that are looked through for a header.
const LINES: usize = 200;
/// Bytes that are looked through for a header.
const BYTES: usize = 1 << 20;

/// Names of the columns, and where they stand.
#[derive(Debug)]
pub(super) struct Header {
    /// One name for each column, with the unit of a line of units in brackets.
    pub names: Vec<String>,
    /// Cells as they were read.
    pub cells: Vec<Vec<u8>>,
    /// Place for messages.
    pub at: String,
    /// Line of the names, from 1.
    pub line: u64,
    /// Lines above it that are no comments.
    pub passed: usize,
    /// Whether the names are no UTF-8 and were read as Windows-1252.
    pub is_windows_1252: bool,
    /// Separator of the cells.
    pub separator: u8,
}

impl Header {
    /// Finds and reads the header; `None`: there is no line.
    pub(super) fn read(records: &mut Records, options: &LogOptions) -> Result<Option<Self>, LogError> {
        let (skipped, passed) = find(records, options)?;
        records.skip(skipped);
        if !records.advance()? {
            return Ok(None);
        }
        let separator = separator(records.text());
        records.separate(separator);
        let (at, line) = (records.place(), records.line());
        let mut cells: Vec<Vec<u8>> = records.iter().map(<[u8]>::to_vec).collect();
        while cells.len() > 1 && cells.last().is_some_and(|cell| cell.trim_ascii().is_empty()) {
            cells.pop();
        }
        if cells.iter().any(|cell| cell.trim_ascii().contains(&b'\r')) {
            return Err(LogError::NotUtf8 { at, what: "lines end in carriage returns alone".to_owned() });
        }
        let is_windows_1252 = cells.iter().any(|cell| std::str::from_utf8(cell).is_err());
        let mut names: Vec<String> = cells.iter().map(|cell| decoded(cell.trim_ascii())).collect();
        if !names.iter().any(|name| columns::is_ours(&Label::of(name).own(), &options.sensors)) {
            units(records, separator, &mut names)?;
        }
        Ok(Some(Self { names, cells, at, line, passed, is_windows_1252, separator }))
    }
}

/// Reads a line of units below the names, if there is one.
fn units(records: &mut Records, separator: u8, names: &mut [String]) -> Result<(), LogError> {
    let Some(line) = records.ahead(0)? else { return Ok(()) };
    let mut cells = cut(line, separator);
    if cells.iter().skip(names.len()).all(String::is_empty) {
        cells.resize(names.len(), String::new());
    }
    let words: Vec<&str> = cells.iter().map(|cell| bare(cell)).collect();
    let is_unit = |word: &&str| label::suffixes(word).is_some();
    let is_line = words.len() == names.len()
        && words.iter().any(is_unit)
        && !cells.iter().any(|cell| is_value(cell))
        && words.iter().filter(|word| !is_unit(word) && !word.is_empty()).count() <= 2;
    if !is_line {
        return Ok(());
    }
    records.skip(1);
    for (name, word) in names.iter_mut().zip(&words) {
        if is_unit(word) {
            *name = format!("{name} [{word}]");
        }
    }
    Ok(())
}

/// A unit without the brackets around it.
fn bare(cell: &str) -> &str {
    let inside = |open, close| cell.strip_prefix(open)?.strip_suffix(close);
    inside('[', ']').or_else(|| inside('(', ')')).unwrap_or(cell)
}

/// Lines to skip up to the header, and how many of them say something.
fn find(records: &mut Records, options: &LogOptions) -> Result<(usize, usize), LogError> {
    let mut lines: Vec<(usize, Vec<String>)> = Vec::new();
    let mut bytes = 0;
    for number in 0..LINES {
        let Some(line) = records.ahead(number)? else { break };
        bytes += line.len();
        let line = line.strip_prefix(b"\xef\xbb\xbf").unwrap_or(line);
        if !line.starts_with(b"#") && !line.trim_ascii().is_empty() {
            let cells = cut(line, separator(line));
            if is_known(&cells, options) {
                return Ok((number, lines.len()));
            }
            lines.push((number, cells));
        }
        if bytes > BYTES {
            break;
        }
    }
    let by_shape = (0..lines.len()).find(|&k| is_header(&lines[k..]));
    let at = by_shape.unwrap_or(0);
    Ok((lines.get(at).map_or(0, |(number, _)| *number), at))
}

/// Whether a line has a name that is known or mapped. A word such as `Datum` counts only beside words.
fn is_known(cells: &[String], options: &LogOptions) -> bool {
    if cells.len() < 2 {
        return false;
    }
    let is_mapped = |cell: &String| options.mappings.iter().any(|mapping| mapping.names(cell));
    let is_own = |cell: &String| columns::is_ours(&Label::of(cell).own(), &options.sensors);
    let is_word = |cell: &String| columns::is_time_word(&Label::of(cell).own());
    let has_values = || cells.iter().any(|cell| is_value(cell));
    cells.iter().any(|cell| is_own(cell) || is_mapped(cell)) || (cells.iter().any(is_word) && !has_values())
}

/// Whether the first of these lines looks like the names of those below.
fn is_header(lines: &[(usize, Vec<String>)]) -> bool {
    let words = &lines[0].1;
    let below = lines.iter().skip(1).take(2);
    words.len() > 1
        && !words.iter().any(|word| is_value(word))
        && below.into_iter().any(|(_, cells)| {
            cells.len().abs_diff(words.len()) <= 1 && cells.iter().any(|cell| is_value(cell))
        })
}

/// Whether a cell holds a number, a date or a time of day.
pub(super) fn is_value(cell: &str) -> bool {
    let is_digit = |letter: char| letter.is_ascii_digit();
    let is_date = cell.starts_with(is_digit)
        && cell.contains([':', '.', '/', '-'])
        && cell.chars().all(|letter| is_digit(letter) || "-:./,TZ+ ".contains(letter));
    is_date || matches!(Cell::read(cell.as_bytes(), true), Cell::Number(_) | Cell::WithComma(_))
}

/// Cells of one line, without quotation marks.
pub(super) fn cut(line: &[u8], separator: u8) -> Vec<String> {
    let line = line.strip_suffix(b"\n").unwrap_or(line);
    let line = line.strip_suffix(b"\r").unwrap_or(line);
    let mut record = ::csv::ByteRecord::new();
    let mut reader = ::csv::ReaderBuilder::new().delimiter(separator).has_headers(false).from_reader(line);
    // Bytes in memory do not fail, and one record has one width.
    let _ = reader.read_byte_record(&mut record);
    record.iter().map(|cell| decoded(cell.trim_ascii())).collect()
}

/// A text in UTF-8, or else in Windows-1252, in which every byte is a letter.
pub(super) fn decoded(bytes: &[u8]) -> String {
    /// 0x80 to 0x9f; all others are those of Unicode.
    const HIGH: &str = "€\u{81}‚ƒ„…†‡ˆ‰Š‹Œ\u{8d}Ž\u{8f}\u{90}‘’“”•–—˜™š›œ\u{9d}žŸ";
    let letter = |&byte: &u8| match byte {
        0x80..=0x9f => HIGH.chars().nth(usize::from(byte) - 0x80).unwrap_or('?'),
        _ => char::from(byte),
    };
    std::str::from_utf8(bytes).map_or_else(|_| bytes.iter().map(letter).collect(), str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header(text: &str, maps: &[&str]) -> Header {
        let mut records = Records::new(Box::new(std::io::Cursor::new(text.to_owned())), "log.csv").unwrap();
        let mappings = maps.iter().map(|map| map.parse().unwrap()).collect();
        Header::read(&mut records, &LogOptions { mappings, ..LogOptions::default() }).unwrap().unwrap()
    }

    #[test]
    fn lines_above_the_header_are_passed_over_by_name_by_mapping_and_by_shape() {
        let export = "testo 176 T4;12345678\nDatum;22.11.2026\n\n";
        for (names, maps) in [
            ("Datum;Zeit;T1 [°C]", &[][..]),
            ("Wann;Druck", &["pressure_bar=Druck"]),
            ("Wann;Kanal 1;Kanal 2", &[]),
        ] {
            let row = "22.11.2026;14:05;12,5";
            let found = header(&format!("{export}{names}\n{row}\n{row}\n"), maps);
            assert_eq!((found.line, found.passed, found.names.join(";").as_str()), (4, 2, names));
        }
        assert_eq!(header("a;b\nc;d\n", &[]).line, 1);
    }

    #[test]
    fn a_line_of_units_belongs_to_the_names() {
        let found = header("Zeit;Druck;T1;Notiz;\n[s];bar;[°C];;\n0;200;15;x;\n", &[]);
        assert_eq!(found.names, ["Zeit [s]", "Druck [bar]", "T1 [°C]", "Notiz"]);
        assert_eq!(header("Zeit;Druck\n0;200\n", &[]).names, ["Zeit", "Druck"]);
    }

    #[test]
    fn bytes_of_windows_1252_are_read_where_utf_8_is_broken() {
        assert_eq!(decoded(b"T [\xb0C] \x80"), "T [°C] €");
        assert_eq!(decoded("T [°C]".as_bytes()), "T [°C]");
    }
}

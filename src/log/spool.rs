//! Records that were taken out of a text and wait in a file to be read: line, cells, and whether the line had an end.
//!
//! In bytes, numbers little-endian: line (8), ended (1), cells (4), bytes (4); for each cell where it begins and ends (4 + 4); the
//! bytes of the record.
use std::io::{Error, ErrorKind, Read};

/// Bytes before the cells.
const HEAD: usize = 17;

/// Appends a record; `line` is its line and whether that had an end.
pub(super) fn write(out: &mut Vec<u8>, line: (u64, bool), bytes: &[u8], cells: &[(usize, usize)]) {
    // A record has a mebibyte at most.
    let short = |number: usize| (number as u32).to_le_bytes();
    out.extend_from_slice(&line.0.to_le_bytes());
    out.push(u8::from(line.1));
    out.extend_from_slice(&short(cells.len()));
    out.extend_from_slice(&short(bytes.len()));
    for &(from, to) in cells {
        out.extend_from_slice(&short(from));
        out.extend_from_slice(&short(to));
    }
    out.extend_from_slice(bytes);
}

/// Reads the next record; `None` at the end.
pub(super) fn read(
    input: &mut impl Read,
    bytes: &mut Vec<u8>,
    cells: &mut Vec<(usize, usize)>,
) -> Result<Option<(u64, bool)>, Error> {
    let mut head = Vec::with_capacity(HEAD);
    input.by_ref().take(HEAD as u64).read_to_end(&mut head)?;
    if head.is_empty() {
        return Ok(None);
    }
    let (line, rest) = head.split_first_chunk().ok_or_else(cut)?;
    let (ended, rest) = rest.split_first().ok_or_else(cut)?;
    let numbers: Vec<usize> = numbers(rest).collect();
    let [count, length] = numbers[..] else { return Err(cut()) };
    let mut places = Vec::new();
    input.by_ref().take(8 * count as u64).read_to_end(&mut places)?;
    bytes.clear();
    input.by_ref().take(length as u64).read_to_end(bytes)?;
    cells.clear();
    let mut ends = self::numbers(&places);
    while let (Some(from), Some(to)) = (ends.next(), ends.next()) {
        cells.push((from, to));
    }
    let is_whole = cells.len() == count && bytes.len() == length;
    if !is_whole || cells.iter().any(|&(from, to)| from > to || to > length) {
        return Err(cut());
    }
    Ok(Some((u64::from_le_bytes(*line), *ended == 1)))
}

fn numbers(bytes: &[u8]) -> impl Iterator<Item = usize> {
    bytes.as_chunks().0.iter().map(|number| u32::from_le_bytes(*number) as usize)
}

fn cut() -> Error {
    Error::new(ErrorKind::InvalidData, "a file of rows is cut short: run again")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_read_is_what_was_written_and_a_cut_is_told() {
        let mut file = Vec::new();
        write(&mut file, (7, true), b"a,,b\n", &[(0, 1), (2, 2), (3, 4)]);
        write(&mut file, (90_000_000_000, false), b"", &[]);
        let (mut bytes, mut cells) = (Vec::new(), Vec::new());
        let mut input = &file[..];
        assert_eq!(read(&mut input, &mut bytes, &mut cells).unwrap(), Some((7, true)));
        assert_eq!((&bytes[..], &cells[..]), (&b"a,,b\n"[..], &[(0, 1), (2, 2), (3, 4)][..]));
        assert_eq!(read(&mut input, &mut bytes, &mut cells).unwrap(), Some((90_000_000_000, false)));
        assert_eq!(read(&mut input, &mut bytes, &mut cells).unwrap(), None);
        for length in 1..HEAD + 24 {
            assert!(read(&mut &file[..length], &mut bytes, &mut cells).is_err(), "{length}");
        }
    }
}

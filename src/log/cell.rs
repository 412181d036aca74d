//! A cell of a text log: a number, or nothing.
use std::borrow::Cow;

/// What a cell says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Cell {
    /// A finite number.
    Number(f64),
    /// A finite number with a decimal comma.
    WithComma(f64),
    /// Nothing: empty, or a word for it.
    Missing,
    /// An infinity, or a number too large for floating point.
    Infinite,
    /// Anything else.
    Unreadable,
}

/// Words for a missing value, in small letters; dashes are one, too.
const MISSING: [&str; 6] = ["nan", "na", "n/a", "#n/a", "null", "none"];

impl Cell {
    /// Reads a cell; `decimal_comma` allows `12,5` for 12.5.
    pub(super) fn read(bytes: &[u8], decimal_comma: bool) -> Self {
        let bytes = bytes.trim_ascii();
        if bytes.is_empty() {
            return Self::Missing;
        }
        let Ok(text) = std::str::from_utf8(bytes) else { return Self::Unreadable };
        match text.parse::<f64>() {
            Ok(number) if number.is_finite() => Self::Number(number),
            Ok(number) if number.is_infinite() => Self::Infinite,
            Ok(_) => Self::Missing,
            Err(_) if text.bytes().all(|byte| byte == b'-') => Self::Missing,
            Err(_) if MISSING.iter().any(|word| word.eq_ignore_ascii_case(text)) => Self::Missing,
            Err(_) if decimal_comma && text.bytes().filter(|&b| b == b',').count() == 1 => {
                let number = text.replace(',', ".").parse::<f64>().ok().filter(|number| number.is_finite());
                number.map_or(Self::Unreadable, Self::WithComma)
            }
            Err(_) => Self::Unreadable,
        }
    }
}

/// A cell as text for a message: short, and printable whatever the bytes are.
pub(super) fn shown(bytes: &[u8]) -> String {
    const LONGEST: usize = 40;
    let text: Cow<str> = String::from_utf8_lossy(bytes.trim_ascii());
    let mut out: String = text.chars().take(LONGEST).flat_map(char::escape_debug).collect();
    if text.chars().nth(LONGEST).is_some() {
        out.push_str("...");
    }
    if out.is_empty() { "\"\"".to_owned() } else { out }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_with_spaces_around_and_exponents() {
        for (text, value) in [("12.5", 12.5), (" -0.25\t", -0.25), ("1e-3", 1e-3), ("+7", 7.0), (".5", 0.5)] {
            assert_eq!(Cell::read(text.as_bytes(), false), Cell::Number(value), "{text}");
        }
    }

    #[test]
    fn words_for_nothing_are_missing_in_any_case() {
        for text in ["", "  ", "NaN", "nan", "NA", "N/A", "null", "None", "-", "----"] {
            assert_eq!(Cell::read(text.as_bytes(), false), Cell::Missing, "{text}");
        }
    }

    #[test]
    fn infinities_and_overflow_are_infinite() {
        for text in ["inf", "-Infinity", "1e999"] {
            assert_eq!(Cell::read(text.as_bytes(), false), Cell::Infinite, "{text}");
        }
    }

    #[test]
    fn a_decimal_comma_counts_where_it_is_allowed_and_stands_alone() {
        assert_eq!(Cell::read(b"12,5", true), Cell::WithComma(12.5));
        assert_eq!(Cell::read(b"12,5", false), Cell::Unreadable);
        for text in ["1.234,5", "1,234,5", ",", "1,5 C"] {
            assert_eq!(Cell::read(text.as_bytes(), true), Cell::Unreadable, "{text}");
        }
    }

    #[test]
    fn bytes_that_are_no_text_are_unreadable_and_shown_printable() {
        assert_eq!(Cell::read(&[0xff, 0x31], false), Cell::Unreadable);
        assert_eq!(Cell::read(&[0, 0], false), Cell::Unreadable);
        assert_eq!(shown(&[0, b'1']), "\\01");
        assert_eq!(shown("x".repeat(50).as_bytes()).len(), 43);
    }
}

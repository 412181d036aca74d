//! Numbers as text: significant digits, decimals, or all digits that a number has.
use std::io::{Result, Write};

/// Precision that a number is written with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Digits {
    /// So many significant digits, without trailing zeros.
    Significant(usize),
    /// So many decimals, with trailing zeros.
    Decimals(usize),
    /// The shortest text that reads back as the same number.
    All,
}

impl Digits {
    /// Writes a finite number; negative zero becomes zero.
    pub(super) fn write(self, value: f64, out: &mut (impl Write + ?Sized)) -> Result<()> {
        match self {
            Self::Significant(digits) => out.write_all(number(value, digits).as_bytes()),
            Self::Decimals(decimals) => write_fixed(value, decimals, out),
            Self::All if value.fract() == 0.0 => write_fixed(value, 0, out),
            Self::All => write!(out, "{value}"),
        }
    }

    /// The number that is written.
    pub(super) fn rounded(self, value: f64) -> f64 {
        match self {
            Self::Significant(digits) => rounded(value, digits),
            Self::Decimals(decimals) => format!("{value:.decimals$}").parse().unwrap_or(value),
            Self::All => value,
        }
    }
}

/// A value with so many significant digits.
pub(crate) fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits.max(1) - 1).parse().unwrap_or(value)
}

/// A number as text with so many significant digits, without trailing zeros; an exponent where it is shorter.
pub fn number(value: f64, digits: usize) -> String {
    // Adding zero turns a negative zero into a positive one.
    let value = rounded(value, digits) + 0.0;
    if value != 0.0 && !(1e-4..1e15).contains(&value.abs()) {
        format!("{value:e}")
    } else {
        format!("{value}")
    }
}

/// Writes a number with so many decimals. The standard library's formatter, which is exact to the last of all digits, takes longer
/// than reading the row, and a year of readings has 35 million numbers.
fn write_fixed(value: f64, decimals: usize, out: &mut (impl Write + ?Sized)) -> Result<()> {
    /// From here on a float has no fraction.
    const EXACT: f64 = 9_007_199_254_740_992.0;
    let power = 10_u64.pow(decimals as u32);
    let scaled = (value.abs() * power as f64).round();
    if scaled >= EXACT {
        return write!(out, "{value:.decimals$}");
    }
    let scaled = scaled as u64;
    if value < 0.0 && scaled > 0 {
        out.write_all(b"-")?;
    }
    let mut digits = itoa::Buffer::new();
    out.write_all(digits.format(scaled / power).as_bytes())?;
    if decimals == 0 {
        return Ok(());
    }
    // With a one above the fraction its leading zeros are written, and the one itself is left out.
    out.write_all(b".")?;
    out.write_all(&digits.format(power + scaled % power).as_bytes()[1..])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(value: f64, digits: Digits) -> String {
        let mut out = Vec::new();
        digits.write(value, &mut out).unwrap();
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn numbers_have_the_digits_they_are_given_and_no_more() {
        assert_eq!(number(293.15 - 273.15, 10), "20");
        assert_eq!(number(1.0 / 3.0, 4), "0.3333");
        assert_eq!(number(1.786e-5, 10), "1.786e-5");
        assert_eq!(number(-0.0, 3), "0");
    }

    proptest::proptest! {
        #[test]
        fn a_fixed_number_is_within_half_a_last_digit_and_written_as_the_standard_library_does(
            value in -1e7..1e7_f64,
            decimals in 0..9_usize,
        ) {
            let text = written(value, Digits::Decimals(decimals));
            let read: f64 = text.parse().unwrap();
            let half_a_digit = 0.5 * 10f64.powi(-(decimals as i32));
            proptest::prop_assert!((read - value).abs() <= half_a_digit + 1e-15 * value.abs());
            let formatted = format!("{read:.decimals$}");
            proptest::prop_assert_eq!(text, if read == 0.0 { formatted.replace('-', "") } else { formatted });
        }
    }

    #[test]
    fn small_whole_and_huge_numbers_keep_their_places() {
        use Digits::{All, Decimals};
        for (value, digits, expected) in [
            (0.0, Decimals(0), "0"),
            (-0.0, Decimals(3), "0.000"),
            (-1e-9, Decimals(4), "0.0000"),
            (0.05, Decimals(1), "0.1"),
            (-0.049, Decimals(1), "0.0"),
            (9.9996, Decimals(3), "10.000"),
            (-12.5, Decimals(2), "-12.50"),
            (1e15, Decimals(3), "1000000000000000.000"),
            (7.0, All, "7"),
            (-7.25, All, "-7.25"),
            (1e17, All, "100000000000000000"),
        ] {
            assert_eq!(written(value, digits), expected);
        }
    }
}

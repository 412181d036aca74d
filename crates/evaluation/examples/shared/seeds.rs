//! The seeds that an example is asked for.
use std::num::ParseIntError;
use std::ops::Range;

/// A count from the first on, or `first..end`.
pub fn seeds(text: &str, first: u64) -> Result<Range<u64>, ParseIntError> {
    Ok(match text.split_once("..") {
        Some((from, end)) => from.parse()?..end.parse()?,
        None => first..first + text.parse::<u64>()?,
    })
}

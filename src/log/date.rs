//! Dates as loggers write them, brought into the form of RFC 3339.
//!
//! Dots mean day first (`22.11.2026`), a year in front means year, month, day (`2026/11/22`). A day and a month with
//! slashes between them (`01/02/2026`) can be either and are not guessed.

/// `22.11.2026 14:05:30,5` and `2026/11/22 14:05` as `2026-11-22T14:05:30.5`; `None`: the text has another form.
///
/// Hours without minutes, months above twelve and the like are left for the reader of RFC 3339 to refuse. A year of two
/// digits is one of this century.
pub(super) fn as_rfc3339(text: &str) -> Option<String> {
    let (date, clock) = text.split_once([' ', 'T', ',']).unwrap_or((text, ""));
    let date = if date.contains('.') { day_first(date)? } else { year_first(date)? };
    let clock = clock.trim_start_matches([' ', ',']);
    Some(if clock.is_empty() { date } else { format!("{date}T{}", of_clock(clock)) })
}

/// Date and time of day from two cells, as one text; a cell that holds both is enough.
pub(super) fn joined(date: &str, clock: &str) -> String {
    let (date, clock) = (date.trim(), clock.trim());
    let is_whole = clock.find(':').is_some_and(|at| at > 4);
    if is_whole {
        return clock.to_owned();
    }
    // A spreadsheet writes a date as its midnight.
    let day = date.split([' ', 'T']).next().unwrap_or(date);
    if day.is_empty() || clock.is_empty() { String::new() } else { format!("{day} {clock}") }
}

/// Whether nobody can tell the day from the month: both before the year, with slashes or dashes.
pub(super) fn is_ambiguous(text: &str) -> bool {
    let date = text.split([' ', 'T']).next().unwrap_or(text);
    let parts: Vec<&str> = date.split(['/', '-']).collect();
    let is_number = |part: &&str| (1..=2).contains(&part.len()) && part.bytes().all(|b| b.is_ascii_digit());
    parts.len() == 3 && parts[..2].iter().all(is_number) && parts[2].bytes().all(|b| b.is_ascii_digit())
}

fn day_first(date: &str) -> Option<String> {
    let mut parts = date.split('.');
    let (day, month, year) = (number(parts.next()?)?, number(parts.next()?)?, parts.next()?);
    let century = if year.len() == 2 { 2000 } else { 0 };
    let whole = parts.next().is_none() && matches!(year.len(), 2 | 4);
    whole.then_some(format!("{:04}-{month:02}-{day:02}", century + number(year)?))
}

fn year_first(date: &str) -> Option<String> {
    let mut parts = date.split('/');
    let (year, month, day) = (parts.next()?, number(parts.next()?)?, number(parts.next()?)?);
    (parts.next().is_none() && year.len() == 4).then_some(format!("{:04}-{month:02}-{day:02}", number(year)?))
}

/// The time of day with two digits of the hour and a point before fractions.
fn of_clock(clock: &str) -> String {
    let pad = if clock.find(':') == Some(1) { "0" } else { "" };
    format!("{pad}{}", clock.replace(',', "."))
}

fn number(digits: &str) -> Option<u32> {
    let is_number = (1..=4).contains(&digits.len()) && digits.bytes().all(|byte| byte.is_ascii_digit());
    if is_number { digits.parse().ok() } else { None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn german_and_year_first_dates_become_those_of_rfc_3339() {
        for (text, iso) in [
            ("22.11.2026 14:05", "2026-11-22T14:05"),
            ("22.11.2026 14:05:30,5", "2026-11-22T14:05:30.5"),
            ("1.2.26, 8:05:30", "2026-02-01T08:05:30"),
            ("22.11.2026T14:05:30.25", "2026-11-22T14:05:30.25"),
            ("2026/11/22 14:05:30", "2026-11-22T14:05:30"),
        ] {
            assert_eq!(as_rfc3339(text).as_deref(), Some(iso), "{text}");
        }
        for text in ["01/02/2026 08:00", "12.5", "1.2.3.4", "22.11.126 8:00", "2026-11-22 14:05", "", "."] {
            assert_eq!(as_rfc3339(text), None, "{text}");
        }
    }

    #[test]
    fn a_day_and_a_month_before_the_year_are_ambiguous_with_slashes_and_dashes() {
        assert!(is_ambiguous("01/02/2026 08:00") && is_ambiguous("1-2-26"));
        for text in ["2026/01/02", "2026-01-02", "01.02.2026", "1/2", "x/y/z"] {
            assert!(!is_ambiguous(text), "{text}");
        }
    }

    #[test]
    fn two_cells_are_one_time_and_a_cell_with_both_is_enough() {
        assert_eq!(joined("22.11.2026", " 14:05:30"), "22.11.2026 14:05:30");
        assert_eq!(joined("22.11.2026 00:00:00", "14:05"), "22.11.2026 14:05");
        assert_eq!(joined("2026-11-22", "2026-11-22T14:05:30Z"), "2026-11-22T14:05:30Z");
        assert_eq!(joined("22.11.2026", ""), "");
    }
}

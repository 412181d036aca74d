//! Tables and sentences that fit a terminal.
use super::table::{aligned, aligned_below};

/// Width of a terminal that everything fits, characters.
const WIDTH: usize = 110;
/// What stands between two columns, characters.
const BETWEEN: usize = 2;

/// A table; where it would be too wide, its widest columns are narrowed and their cells go on in further lines.
pub(super) fn table(header: &[&str], rows: &[Vec<String>]) -> String {
    let all: Vec<Vec<&str>> = std::iter::once(header.to_vec())
        .chain(rows.iter().map(|row| row.iter().map(String::as_str).collect()))
        .collect();
    let columns = all.iter().map(Vec::len).max().unwrap_or(0);
    let cells = |k: usize| all.iter().filter_map(move |row| row.get(k).copied());
    let size = |words: &str| words.chars().count();
    let mut widths: Vec<usize> = (0..columns).map(|k| cells(k).map(size).max().unwrap_or(0)).collect();
    let least: Vec<usize> = (0..columns)
        .map(|k| cells(k).flat_map(|cell| cell.split(' ')).map(size).max().unwrap_or(0))
        .collect();
    let room = WIDTH.saturating_sub(BETWEEN * columns.saturating_sub(1));
    if widths.iter().sum::<usize>() <= room {
        return aligned(header, rows);
    }
    while widths.iter().sum::<usize>() > room {
        let narrowable = (0..columns).filter(|&k| widths[k] > least[k]);
        let Some(widest) = narrowable.max_by_key(|&k| widths[k]) else { break };
        widths[widest] -= 1;
    }
    let lines = |row: &[&str]| broken(row, &widths);
    let header = if header.is_empty() { Vec::new() } else { lines(header) };
    let rows: Vec<Vec<String>> = all[1..].iter().flat_map(|row| lines(row)).collect();
    aligned_below(&header, &rows)
}

/// A row in as many lines as its longest cell needs.
fn broken(row: &[&str], widths: &[usize]) -> Vec<Vec<String>> {
    let cells: Vec<Vec<String>> =
        row.iter().zip(widths).map(|(cell, width)| lines(cell, "", "", *width)).collect();
    let height = cells.iter().map(Vec::len).max().unwrap_or(0);
    (0..height).map(|k| cells.iter().map(|cell| cell.get(k).cloned().unwrap_or_default()).collect()).collect()
}

/// Words in lines of a width, the first behind `first`, the others behind `next`. A longer word stays whole.
fn lines(words: &str, first: &str, next: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    let mut line = first.to_owned();
    let mut is_begun = false;
    for word in words.split(' ') {
        if is_begun && line.chars().count() + 1 + word.chars().count() > width {
            lines.push(std::mem::replace(&mut line, next.to_owned()));
        } else if is_begun {
            line.push(' ');
        }
        line.push_str(word);
        is_begun = true;
    }
    lines.push(line);
    lines
}

/// Words that fit a terminal behind a mark, the lines that follow behind `next`, with a line feed at the end.
pub(super) fn hanging(words: &str, first: &str, next: &str) -> String {
    lines(words, first, next, WIDTH).join("\n") + "\n"
}

/// Lines that fit a terminal, broken at blanks and then indented by two more, with a line feed at the end.
pub(super) fn wrapped(text: &str) -> String {
    let lines = text.lines().map(|line| {
        let indent = " ".repeat(line.len() - line.trim_start().len());
        hanging(line.trim(), &indent, &format!("{indent}  "))
    });
    lines.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lines_are_broken_at_blanks_and_short_ones_stay() {
        assert_eq!(wrapped("  a b\nc"), "  a b\nc\n");
        let long = wrapped(&format!("  {}", "word ".repeat(40)));
        assert!(long.lines().all(|line| line.chars().count() <= WIDTH), "{long}");
        assert!(long.starts_with("  word") && long.lines().nth(1).unwrap().starts_with("    word"));
        assert_eq!(long.split_whitespace().count(), 40);
    }

    #[test]
    fn a_cell_goes_on_in_further_lines_where_the_table_is_too_wide() {
        let names: Vec<String> = (100..112).map(|height| format!("wall_{height}mm")).collect();
        let row = vec!["12".to_owned(), names.join(" + "), "1.5".to_owned()];
        let wide = table(&["n", "layout", "value"], &[row]);
        assert!(wide.lines().all(|line| line.chars().count() <= WIDTH), "{wide}");
        assert!(names.iter().all(|name| wide.contains(name.as_str())), "{wide}");
        assert_eq!(wide.matches('+').count(), 11);
        let short = vec!["1".to_owned(), "a + b".to_owned(), "2".to_owned()];
        assert_eq!(table(&["n", "layout", "value"], &[short]).lines().count(), 3);
    }

    #[test]
    fn two_wide_columns_are_both_narrowed() {
        let words = "word ".repeat(20);
        let wide = table(&["a", "b", "c"], &[vec!["x".into(), words.clone(), words]]);
        assert!(wide.lines().all(|line| line.chars().count() <= WIDTH), "{wide}");
        assert_eq!(wide.matches("word").count(), 40);
    }
}

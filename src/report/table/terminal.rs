//! Tables and sentences that fit a terminal.
use super::{Column, Table};

/// Width of a terminal that everything fits, characters.
const WIDTH: usize = 110;
/// What stands between two columns, characters.
const BETWEEN: usize = 2;

impl Table {
    /// For a terminal: aligned columns. Where it would be too wide, the widest columns are narrowed and their cells go on in further
    /// lines.
    pub fn to_text(&self) -> String {
        let header: Vec<String> = self.columns.iter().map(Column::heading).collect();
        let rows = self.text_rows();
        let all = || std::iter::once(&header).chain(&rows);
        let longest = |k: usize, length: &dyn Fn(&str) -> usize| {
            all().filter_map(|row| row.get(k)).map(|cell| length(cell)).max().unwrap_or(0)
        };
        let columns = self.columns.len();
        let size = |words: &str| words.chars().count();
        let longest_word = |words: &str| words.split(' ').map(size).max().unwrap_or(0);
        let mut widths: Vec<usize> = (0..columns).map(|k| longest(k, &size)).collect();
        let least: Vec<usize> = (0..columns).map(|k| longest(k, &longest_word)).collect();
        let room = WIDTH.saturating_sub(BETWEEN * columns.saturating_sub(1));
        if widths.iter().sum::<usize>() <= room {
            return self.aligned(&[header], &rows);
        }
        while widths.iter().sum::<usize>() > room {
            let narrowable = (0..columns).filter(|&k| widths[k] > least[k]);
            let Some(widest) = narrowable.max_by_key(|&k| widths[k]) else { break };
            widths[widest] -= 1;
        }
        let rows: Vec<Vec<String>> = rows.iter().flat_map(|row| broken(row, &widths)).collect();
        self.aligned(&broken(&header, &widths), &rows)
    }

    fn text_rows(&self) -> Vec<Vec<String>> {
        let row = |row: usize| self.columns.iter().map(|column| column.values.cell(row).to_text()).collect();
        (0..self.rows()).map(row).collect()
    }

    /// Lines of cells below a header of one or more lines; numbers stand to the right.
    fn aligned(&self, header: &[Vec<String>], rows: &[Vec<String>]) -> String {
        let header = if self.has_header() { header } else { &[] };
        let width = |k: usize| {
            let cells = header.iter().chain(rows).filter_map(|row| row.get(k));
            cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
        };
        let columns = self.columns.iter().enumerate();
        let layout: Vec<(usize, bool)> = columns.map(|(k, column)| (width(k), column.is_numeric())).collect();
        let line = |cells: &[String]| {
            let padded = layout.iter().zip(cells).map(|(&(width, right), cell)| {
                let pad = " ".repeat(width - cell.chars().count());
                if right { format!("{pad}{cell}") } else { format!("{cell}{pad}") }
            });
            padded.collect::<Vec<_>>().join("  ").trim_end().to_owned() + "\n"
        };
        let mut text: String = header.iter().map(|names| line(names)).collect();
        if !header.is_empty() {
            text.push_str(&line(&layout.iter().map(|(width, _)| "-".repeat(*width)).collect::<Vec<_>>()));
        }
        text.extend(rows.iter().map(|row| line(row)));
        text
    }
}

/// Rows of texts, aligned; however wide they are, no cell is broken.
pub fn aligned(header: &[&str], rows: &[Vec<String>]) -> String {
    let table = Table::of_texts(header, rows.to_vec());
    let names = header.iter().map(|&name| name.to_owned()).collect();
    table.aligned(&[names], &table.text_rows())
}

/// A row in as many lines as its longest cell needs.
fn broken(row: &[String], widths: &[usize]) -> Vec<Vec<String>> {
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
pub(in crate::report) fn hanging(words: &str, first: &str, next: &str) -> String {
    lines(words, first, next, WIDTH).join("\n") + "\n"
}

/// Lines that fit a terminal, broken at blanks and then indented by two more, with a line feed at the end.
pub(in crate::report) fn wrapped(text: &str) -> String {
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
        let text = |row| Table::of_texts(&["n", "layout", "value"], vec![row]).to_text();
        let wide = text(row);
        assert!(wide.lines().all(|line| line.chars().count() <= WIDTH), "{wide}");
        assert!(names.iter().all(|name| wide.contains(name.as_str())), "{wide}");
        assert_eq!(wide.matches('+').count(), 11);
        let short = vec!["1".to_owned(), "a + b".to_owned(), "2".to_owned()];
        assert_eq!(text(short).lines().count(), 3);
    }

    #[test]
    fn numbers_stand_to_the_right_and_words_to_the_left() {
        let text =
            aligned(&["what", "value"], &[vec!["a".into(), "10".into()], vec!["bcd".into(), "-1.5".into()]]);
        assert_eq!(text, "what  value\n----  -----\na        10\nbcd    -1.5\n");
    }

    #[test]
    fn two_wide_columns_are_both_narrowed() {
        let words = "word ".repeat(20);
        let wide = Table::of_texts(&["a", "b", "c"], vec![vec!["x".into(), words.clone(), words]]).to_text();
        assert!(wide.lines().all(|line| line.chars().count() <= WIDTH), "{wide}");
        assert_eq!(wide.matches("word").count(), 40);
    }
}

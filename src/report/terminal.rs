//! Tables and sentences that fit a terminal.
use super::table::aligned;

/// Width of a terminal that everything fits, characters.
pub(super) const WIDTH: usize = 110;
/// Least width that a column is narrowed to, characters.
const NARROWEST: usize = 14;

/// A table; where it would be too wide, cells of its widest columns go on in further lines.
pub(super) fn table(header: &[&str], rows: &[Vec<String>]) -> String {
    let mut rows = rows.to_vec();
    // Each pass narrows the widest column by what is too much, or to the least width: as many passes as columns do.
    for _ in 0..header.len().max(1) {
        let table = aligned(header, &rows);
        let wide = table.lines().map(|line| line.chars().count()).max().unwrap_or(0);
        let widest = (0..header.len()).map(|column| (width(&rows, column), column)).max();
        let Some((broad, column)) = widest.filter(|(broad, _)| wide > WIDTH && *broad > NARROWEST) else {
            return table;
        };
        let room = broad.saturating_sub(wide - WIDTH).max(NARROWEST);
        rows = rows.into_iter().flat_map(|row| continued(row, column, room)).collect();
    }
    aligned(header, &rows)
}

fn width(rows: &[Vec<String>], column: usize) -> usize {
    rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max().unwrap_or(0)
}

/// A row, and further ones for what a cell has too many words for.
fn continued(row: Vec<String>, column: usize, room: usize) -> Vec<Vec<String>> {
    let Some(cell) = row.get(column).filter(|cell| cell.chars().count() > room) else { return vec![row] };
    let mut lines: Vec<String> = Vec::new();
    for word in cell.split(' ') {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= room => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    let further = lines.split_off(lines.len().min(1));
    let mut first = row;
    first[column] = lines.concat();
    let mut rows = vec![first];
    for line in further {
        let mut cells = vec![String::new(); column];
        cells.push(line);
        rows.push(cells);
    }
    rows
}

/// Lines that are no wider than a terminal, broken at blanks and then indented by two more, with a line feed at the end.
pub(super) fn wrapped(text: &str) -> String {
    let mut out = String::new();
    for line in text.lines() {
        let indent = line.len() - line.trim_start().len();
        let mut length = 0;
        for word in line.split_whitespace() {
            let size = word.chars().count();
            let before = match length {
                0 => " ".repeat(indent),
                _ if length + 1 + size <= WIDTH => " ".to_owned(),
                _ => {
                    length = 0;
                    format!("\n{}", " ".repeat(indent + 2))
                }
            };
            length += before.trim_start_matches('\n').len() + size;
            out.push_str(&before);
            out.push_str(word);
        }
        out.push('\n');
    }
    out
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

//! Tables and sentences that fit a terminal.
use crate::report::aligned;

/// Width of a terminal that everything fits, characters.
const WIDTH: usize = 110;
/// What joins the names of a layout.
const JOINT: &str = " + ";

/// A table under its title; nothing without rows.
pub(super) fn titled(title: &str, header: &[&str], rows: &[Vec<String>], remarks: &str) -> String {
    if rows.is_empty() {
        return String::new();
    }
    format!("{}{}{remarks}", wrapped(title), aligned(header, rows))
}

/// The same with a column of layouts, which go on in further lines where the table would be too wide.
pub(super) fn titled_with_layouts(
    title: &str,
    header: &[&str],
    rows: Vec<Vec<String>>,
    column: usize,
    remarks: &str,
) -> String {
    let table = aligned(header, &rows);
    let wide = table.lines().map(|line| line.chars().count()).max().unwrap_or(0);
    let longest = rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max();
    let room = longest.unwrap_or(0).saturating_sub(wide.saturating_sub(WIDTH));
    let rows: Vec<Vec<String>> = rows.into_iter().flat_map(|row| continued(row, column, room)).collect();
    titled(title, header, &rows, remarks)
}

/// A row, and further ones for what its layout has too many names for.
fn continued(row: Vec<String>, column: usize, room: usize) -> Vec<Vec<String>> {
    let Some(cell) = row.get(column).filter(|cell| cell.chars().count() > room) else { return vec![row] };
    let mut lines: Vec<String> = Vec::new();
    for name in cell.split(JOINT) {
        match lines.last_mut() {
            // The line also has the joint that leads on to the next.
            Some(line) if line.chars().count() + name.chars().count() + 2 * JOINT.len() - 1 <= room => {
                line.push_str(&format!("{JOINT}{name}"));
            }
            Some(line) => {
                line.push_str(JOINT.trim_end());
                lines.push(name.to_owned());
            }
            None => lines.push(name.to_owned()),
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
    fn a_layout_goes_on_in_further_lines_where_the_table_is_too_wide() {
        let names: Vec<String> = (100..112).map(|height| format!("wall_{height}mm")).collect();
        let row = vec!["12".to_owned(), names.join(JOINT), "1.5".to_owned()];
        let table = titled_with_layouts("t", &["n", "layout", "value"], vec![row], 1, "");
        assert!(table.lines().all(|line| line.chars().count() <= WIDTH), "{table}");
        assert!(names.iter().all(|name| table.contains(name.as_str())), "{table}");
        assert_eq!(table.matches('+').count(), 11);
        let short = vec!["1".to_owned(), "a + b".to_owned(), "2".to_owned()];
        assert_eq!(
            titled_with_layouts("t", &["n", "layout", "value"], vec![short], 1, "").lines().count(),
            4
        );
    }
}

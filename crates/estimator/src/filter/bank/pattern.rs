//! Where a transition may differ from zero.

/// Columns of each leading row of a transition that may differ from zero.
///
/// Neighbouring rows with the same columns are kept together, up to four: they are multiplied at once.
#[derive(Clone, Debug, PartialEq)]
pub struct Pattern {
    pub(super) groups: Vec<Group>,
    /// Number of leading rows.
    pub(super) leading: usize,
    /// Number of elements.
    pub(super) elements: usize,
}

/// Rows of the same columns.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Group {
    pub first_row: usize,
    pub rows: usize,
    pub columns: Vec<usize>,
    /// Place of the first element; elements go column by column.
    pub start: usize,
}

/// Rows that are multiplied together.
pub(super) const TOGETHER: usize = 4;

impl Pattern {
    /// Columns of each row, in any order.
    pub fn new(rows: &[Vec<usize>]) -> Self {
        let mut groups: Vec<Group> = Vec::new();
        let mut elements = 0;
        for (row, columns) in rows.iter().enumerate() {
            let mut columns = columns.clone();
            columns.sort_unstable();
            columns.dedup();
            elements += columns.len();
            match groups.last_mut() {
                Some(last) if last.columns == columns && last.rows < TOGETHER => last.rows += 1,
                _ => groups.push(Group { first_row: row, rows: 1, columns, start: 0 }),
            }
        }
        let mut start = 0;
        for group in &mut groups {
            group.start = start;
            start += group.rows * group.columns.len();
        }
        Self { groups, leading: rows.len(), elements }
    }
}

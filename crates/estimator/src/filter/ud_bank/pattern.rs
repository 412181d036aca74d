//! Where a transition may differ from zero.
use alloc::vec::Vec;
use core::ops::Range;

/// Rows that are multiplied together.
pub(super) const BLOCK_ROWS: usize = 4;

/// Columns of each leading row of a transition that may differ from zero.
///
/// Four neighbouring rows with the same columns are multiplied at once, the others element by element.
#[derive(Clone, Debug, PartialEq)]
pub struct Pattern {
    /// Number of leading rows.
    pub(super) leading: usize,
    /// Four rows of the same columns each.
    pub(super) blocks: Vec<Block>,
    /// Row and column of the elements of all other rows.
    pub(super) elements: Vec<(usize, usize)>,
    /// First column of each row.
    pub(super) firsts: Vec<usize>,
    /// Earlier states whose noise each state's noise may be correlated with.
    pub(super) noise: Vec<Vec<usize>>,
}

/// Four rows of the same columns: runs of neighbours, in ascending order.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Block {
    pub first_row: usize,
    pub runs: Vec<Range<usize>>,
}

impl Block {
    /// Sorted columns of the rows from `first_row` on.
    fn new(first_row: usize, columns: &[usize]) -> Self {
        let runs = columns.chunk_by(|left, right| left + 1 == *right);
        Self { first_row, runs: runs.map(|run| run[0]..run[0] + run.len()).collect() }
    }

    /// The columns one by one.
    pub(super) fn columns(&self) -> impl Iterator<Item = usize> {
        self.runs.iter().cloned().flatten()
    }
}

impl Pattern {
    /// Columns of each row, in any order.
    pub(crate) fn new(rows: &[Vec<usize>]) -> Self {
        let sorted = |columns: &Vec<usize>| {
            let mut columns = columns.clone();
            columns.sort_unstable();
            columns.dedup();
            columns
        };
        let rows: Vec<Vec<usize>> = rows.iter().map(sorted).collect();
        let first = |columns: &Vec<usize>| columns.first().map_or(rows.len(), |&c| c.min(rows.len()));
        let (mut blocks, mut elements) = (Vec::new(), Vec::new());
        let mut row = 0;
        while let Some(columns) = rows.get(row) {
            let alike = rows[row..].iter().take_while(|other| *other == columns).count();
            if alike >= BLOCK_ROWS && columns.len() > 1 {
                blocks.push(Block::new(row, columns));
                row += BLOCK_ROWS;
            } else {
                elements.extend(columns.iter().map(|&column| (row, column)));
                row += 1;
            }
        }
        Self {
            leading: rows.len(),
            blocks,
            elements,
            firsts: rows.iter().map(first).collect(),
            noise: (0..rows.len()).map(|state| (0..state).collect()).collect(),
        }
    }

    /// The same where noise of two leading states is correlated only if `correlated` says so, or by what a later state has in common
    /// with both.
    pub(crate) fn with_noise(mut self, correlated: impl Fn(usize, usize) -> bool) -> Self {
        let m = self.leading;
        let mut linked: Vec<Vec<bool>> =
            (0..m).map(|j| (0..m).map(|i| i < j && correlated(i, j)).collect()).collect();
        for j in (0..m).rev() {
            let own = linked[j].clone();
            for (i, linked) in linked.iter_mut().enumerate().filter(|(i, _)| own[*i]) {
                (0..i).filter(|&k| own[k]).for_each(|k| linked[k] = true);
            }
        }
        self.noise = linked.iter().map(|row| (0..m).filter(|&i| row[i]).collect()).collect();
        self
    }
}

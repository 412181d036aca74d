//! Columns of few rows in groups of four: products of small matrices without loops that end in between.

/// Four rows of a column.
pub(super) type Group = [f64; 4];

/// `to <- to + c x`.
#[inline(always)]
pub(super) fn add_scaled(c: f64, x: &[Group], to: &mut [Group]) {
    for (to, x) in to.iter_mut().zip(x) {
        for lane in 0..4 {
            to[lane] += c * x[lane];
        }
    }
}

/// Columns of `rows` rows, padded with zeros to whole groups.
#[derive(Clone, Debug)]
pub(super) struct Columns {
    groups: usize,
    values: Vec<Group>,
}

impl Columns {
    /// Zeros.
    pub fn zeros(rows: usize, columns: usize) -> Self {
        let groups = rows.div_ceil(4);
        Self { groups, values: vec![[0.0; 4]; groups * columns] }
    }

    /// Column `j`.
    #[inline(always)]
    pub fn column(&self, j: usize) -> &[Group] {
        &self.values[j * self.groups..(j + 1) * self.groups]
    }

    /// Column `j`.
    #[inline(always)]
    pub fn column_mut(&mut self, j: usize) -> &mut [Group] {
        &mut self.values[j * self.groups..(j + 1) * self.groups]
    }

    /// Column `j` with its padding, number by number.
    pub fn flat(&self, j: usize) -> &[f64] {
        self.column(j).as_flattened()
    }

    /// Column `j` with its padding, number by number.
    pub fn flat_mut(&mut self, j: usize) -> &mut [f64] {
        self.column_mut(j).as_flattened_mut()
    }

    /// Element of row `i` and column `j`.
    pub fn at(&self, i: usize, j: usize) -> f64 {
        self.flat(j)[i]
    }

    /// All zero.
    pub fn clear(&mut self) {
        self.values.fill([0.0; 4]);
    }

    /// `self <- c other`.
    pub fn set_scaled(&mut self, c: f64, other: &Self) {
        for (to, from) in self.values.iter_mut().zip(&other.values) {
            *to = from.map(|value| c * value);
        }
    }

    /// `self <- other`.
    pub fn copy_from(&mut self, other: &Self) {
        self.values.copy_from_slice(&other.values);
    }

    /// `self <- self + other`.
    pub fn add(&mut self, other: &Self) {
        add_scaled(1.0, &other.values, &mut self.values);
    }

    /// `self <- a Z B + c B` with a square `Z` of as many rows.
    pub fn set_product(&mut self, a: f64, z: &Square, b: &Self, c: f64) {
        let groups = self.groups;
        for (to, from) in self.values.chunks_exact_mut(groups).zip(b.values.chunks_exact(groups)) {
            for ((to, own), row) in to.iter_mut().zip(from).zip(z.blocks.chunks_exact(groups)) {
                let mut sum = [0.0; 4];
                for (block, part) in row.iter().zip(from) {
                    for (column, value) in block.iter().zip(part) {
                        for lane in 0..4 {
                            sum[lane] += column[lane] * value;
                        }
                    }
                }
                for lane in 0..4 {
                    to[lane] = a * sum[lane] + c * own[lane];
                }
            }
        }
    }

    /// `self <- self + c v v^T` for a square of columns as long as `v`.
    pub fn add_square(&mut self, c: f64, v: &[Group]) {
        for (to, value) in self.values.chunks_exact_mut(self.groups).zip(v.as_flattened()) {
            add_scaled(c * value, v, to);
        }
    }
}

/// A square matrix of 4 x 4 blocks, row of blocks by row of blocks; each block by columns.
#[derive(Clone, Debug)]
pub(super) struct Square {
    blocks: Vec<[Group; 4]>,
}

impl Square {
    /// Zeros of so many rows and columns, padded.
    pub fn zeros(rows: usize) -> Self {
        let groups = rows.div_ceil(4);
        Self { blocks: vec![[[0.0; 4]; 4]; groups * groups] }
    }

    /// The first `rows` columns of `from`.
    pub fn copy_from(&mut self, from: &Columns, rows: usize) {
        let groups = from.groups;
        for j in 0..rows {
            for (i, group) in from.column(j).iter().enumerate() {
                self.blocks[i * groups + j / 4][j % 4] = *group;
            }
        }
    }
}

//! Columns of few rows in groups of four: products of small matrices without loops that end in between.
use crate::filter::kernel::{Group, axpy};
use alloc::vec::Vec;

/// `to <- to + c x`.
#[inline(always)]
pub(super) fn add_scaled(c: f64, x: &[Group], to: &mut [Group]) {
    if let ([x], [to]) = (x, &mut *to) {
        *to = combined(1.0, *to, c, x);
        return;
    }
    axpy(c, x.as_flattened(), to.as_flattened_mut());
}

/// Columns of `rows` rows, padded with zeros to whole groups.
#[derive(Clone, Debug)]
pub(super) struct Columns {
    groups: usize,
    values: Vec<Group>,
}

impl Columns {
    /// Zeros.
    pub(super) fn zeros(rows: usize, columns: usize) -> Self {
        let groups = rows.div_ceil(4);
        Self { groups, values: vec![[0.0; 4]; groups * columns] }
    }

    /// Column `j`.
    #[inline(always)]
    pub(super) fn column(&self, j: usize) -> &[Group] {
        &self.values[j * self.groups..(j + 1) * self.groups]
    }

    /// Column `j`.
    #[inline(always)]
    pub(super) fn column_mut(&mut self, j: usize) -> &mut [Group] {
        &mut self.values[j * self.groups..(j + 1) * self.groups]
    }

    /// Column `j` with its padding, number by number.
    #[inline(always)]
    pub(super) fn flat(&self, j: usize) -> &[f64] {
        self.column(j).as_flattened()
    }

    /// Column `j` with its padding, number by number.
    #[inline(always)]
    pub(super) fn flat_mut(&mut self, j: usize) -> &mut [f64] {
        self.column_mut(j).as_flattened_mut()
    }

    /// Element of row `i` and column `j`.
    #[inline(always)]
    pub(super) fn at(&self, i: usize, j: usize) -> f64 {
        self.flat(j)[i]
    }

    /// All zero.
    #[inline(always)]
    pub(super) fn clear(&mut self) {
        self.values.fill([0.0; 4]);
    }

    /// `self <- c other`.
    #[inline(always)]
    pub(super) fn set_scaled(&mut self, c: f64, other: &Self) {
        for (to, from) in self.values.as_flattened_mut().iter_mut().zip(other.values.as_flattened()) {
            *to = c * from;
        }
    }

    /// `self <- other`.
    #[inline(always)]
    pub(super) fn copy_from(&mut self, other: &Self) {
        self.values.copy_from_slice(&other.values);
    }

    /// `self <- self + other`.
    #[inline(always)]
    pub(super) fn add(&mut self, other: &Self) {
        axpy(1.0, other.values.as_flattened(), self.values.as_flattened_mut());
    }

    /// `self <- a Z B + c B` with a square `Z` of as many rows.
    #[inline(always)]
    pub(super) fn set_product(&mut self, a: f64, z: &Square, b: &Self, c: f64) {
        if let [block] = z.blocks.as_slice() {
            for (to, from) in self.values.iter_mut().zip(&b.values) {
                *to = combined(a, product(block, from), c, from);
            }
            return;
        }
        let groups = self.groups;
        for (to, from) in self.values.chunks_exact_mut(groups).zip(b.values.chunks_exact(groups)) {
            for ((to, own), row) in to.iter_mut().zip(from).zip(z.blocks.chunks_exact(groups)) {
                let mut sum = [0.0; 4];
                for (block, part) in row.iter().zip(from) {
                    sum = combined(1.0, sum, 1.0, &product(block, part));
                }
                *to = combined(a, sum, c, own);
            }
        }
    }

    /// `self <- self + c v v^T` for a square of columns as long as `v`.
    #[inline(always)]
    pub(super) fn add_square(&mut self, c: f64, v: &[Group]) {
        if let ([v], [x0, x1, x2, x3]) = (v, self.values.as_mut_slice()) {
            for (to, value) in [x0, x1, x2, x3].into_iter().zip(v) {
                *to = combined(1.0, *to, c * value, v);
            }
            return;
        }
        for (to, value) in self.values.chunks_exact_mut(self.groups).zip(v.as_flattened()) {
            add_scaled(c * value, v, to);
        }
    }
}

/// `a x + b y`.
#[inline(always)]
fn combined(a: f64, x: Group, b: f64, y: &Group) -> Group {
    core::array::from_fn(|lane| a * x[lane] + b * y[lane])
}

/// A block times four rows.
#[inline(always)]
fn product([c0, c1, c2, c3]: &[Group; 4], [v0, v1, v2, v3]: &Group) -> Group {
    core::array::from_fn(|lane| (c0[lane] * v0 + c1[lane] * v1) + (c2[lane] * v2 + c3[lane] * v3))
}

/// A square matrix of 4 x 4 blocks, row of blocks by row of blocks; each block by columns.
#[derive(Clone, Debug)]
pub(super) struct Square {
    blocks: Vec<[Group; 4]>,
}

impl Square {
    /// Zeros of so many rows and columns, padded.
    pub(super) fn zeros(rows: usize) -> Self {
        let groups = rows.div_ceil(4);
        Self { blocks: vec![[[0.0; 4]; 4]; groups * groups] }
    }

    /// The first `rows` columns of `from`.
    #[inline(always)]
    pub(super) fn copy_from(&mut self, from: &Columns, rows: usize) {
        let groups = from.groups;
        for j in 0..rows {
            for (i, group) in from.column(j).iter().enumerate() {
                self.blocks[i * groups + j / 4][j % 4] = *group;
            }
        }
    }
}

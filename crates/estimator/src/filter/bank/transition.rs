//! Transitions of four filters and the noise that they add.
use super::pattern::{Pattern, TOGETHER};
use crate::filter::lanes::{LANES, Lanes};

/// Transitions of four filters over one interval, of one pattern, with noise covariances.
#[derive(Clone, Debug)]
pub struct BankTransition {
    pattern: Pattern,
    /// Elements of the blocks of rows, block by block, column by column.
    blocks: Vec<[Lanes; TOGETHER]>,
    /// Elements of all other rows.
    elements: Vec<Lanes>,
    /// Noise covariances, upper triangle, by columns: (leading, leading). A time update uses them up.
    noise: Vec<Lanes>,
}

impl BankTransition {
    /// Zeros.
    pub fn new(pattern: Pattern) -> Self {
        let m = pattern.leading;
        let columns = pattern.blocks.iter().map(|block| block.columns.len()).sum();
        Self {
            blocks: vec![[Lanes::ZERO; TOGETHER]; columns],
            elements: vec![Lanes::ZERO; pattern.elements.len()],
            noise: vec![Lanes::ZERO; m * m],
            pattern,
        }
    }

    /// Number of leading rows.
    pub fn leading(&self) -> usize {
        self.pattern.leading
    }

    /// Let the given lanes have the leading rows `phi`: column-major, (leading, n).
    pub fn set(&mut self, lanes: [bool; LANES], phi: &[f64]) {
        let m = self.pattern.leading;
        let columns = self
            .pattern
            .blocks
            .iter()
            .flat_map(|block| block.columns.iter().map(|column| column * m + block.first_row));
        for (to, first) in self.blocks.iter_mut().zip(columns) {
            to.iter_mut()
                .zip(&phi[first..first + TOGETHER])
                .for_each(|(to, &from)| to.put(lanes, Lanes::splat(from)));
        }
        for (to, (row, column)) in self.elements.iter_mut().zip(&self.pattern.elements) {
            to.put(lanes, Lanes::splat(phi[column * m + row]));
        }
    }

    /// Let the given lanes have noise covariances by row and column, those of the pattern in the upper triangle.
    #[inline(always)]
    pub fn set_noise(&mut self, lanes: [bool; LANES], covariance: impl Fn((usize, usize)) -> Lanes) {
        let m = self.pattern.leading;
        for (j, rows) in self.pattern.noise.iter().enumerate() {
            for &i in rows.iter().chain([&j]) {
                self.noise[j * m + i].put(lanes, covariance((i, j)));
            }
        }
    }

    /// `Phi u` of several columns, `last` being the last row in which one of them may differ from zero; `out`: (leading) each.
    #[inline(always)]
    pub fn multiply<const C: usize>(&self, u: [&[Lanes]; C], last: usize, out: &mut [[Lanes; C]]) {
        let mut from = self.blocks.iter();
        for block in &self.pattern.blocks {
            let mut sum = [[Lanes::ZERO; C]; TOGETHER];
            for (&column, elements) in block.columns.iter().zip(from.by_ref()) {
                if column > last {
                    continue;
                }
                let values = u.map(|u| u[column]);
                for (sum, &element) in sum.iter_mut().zip(elements) {
                    for (sum, &value) in sum.iter_mut().zip(&values) {
                        *sum += element * value;
                    }
                }
            }
            out[block.first_row..block.first_row + TOGETHER].copy_from_slice(&sum);
        }
        let others = || self.pattern.elements.iter();
        others().for_each(|&(row, _)| out[row] = [Lanes::ZERO; C]);
        for (&(row, column), &element) in others().zip(&self.elements) {
            for (out, u) in out[row].iter_mut().zip(u) {
                *out += element * u[column];
            }
        }
    }

    /// First column of each row of `Phi U` that may differ from zero.
    pub(super) fn firsts(&self) -> &[usize] {
        &self.pattern.firsts
    }

    /// Write the noise as `G diag(q) G^T` behind the transition's `m` columns in `rows` (m, 2 m), the column of the last state first,
    /// and the variances `q` of its sources; the noise is used up.
    ///
    /// A variance that the later states explain up to rounding counts as explained in full: its column stays zero.
    #[inline(always)]
    pub(super) fn factor_noise(
        &mut self,
        m: usize,
        rows: &mut [Lanes],
        spans: &mut [(usize, usize)],
        q: &mut [Lanes],
    ) {
        let rounding = m as f64 * f64::EPSILON;
        rows.chunks_exact_mut(2 * m).for_each(|row| row[m..].fill(Lanes::ZERO));
        for j in (0..m).rev() {
            let (before, column) = self.noise.split_at_mut(j * m);
            let (place, left) = (m - 1 - j, column[j]);
            q[place] = left;
            let inverse = left.inverse();
            rows[j * 2 * m + m + place] = Lanes::splat(1.0);
            spans[j].1 = m + place + 1;
            for &i in &self.pattern.noise[j] {
                let target = &mut before[i * m..i * m + i + 1];
                let share = column[i] * inverse;
                rows[i * 2 * m + m + place] = share;
                let diagonal = target[i];
                for (to, &value) in target.iter_mut().zip(column.iter()) {
                    *to -= share * value;
                }
                let least = diagonal * rounding;
                if target[i].any_at_most(least) {
                    let left = target[i];
                    for lane in (0..LANES).filter(|&lane| left.0[lane] <= least.0[lane]) {
                        target.iter_mut().for_each(|to| to.0[lane] = 0.0);
                    }
                }
            }
        }
    }
}

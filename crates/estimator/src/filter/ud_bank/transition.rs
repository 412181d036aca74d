//! Transitions of four filters and the noise that they add.
use crate::filter::simd::{Arch, Simd, WithSimd};
use alloc::vec::Vec;

use super::pattern::{BLOCK_ROWS, Block, Pattern};
use crate::filter::lanes::{LANES, Lanes};

/// Transitions of four filters over one interval, of one pattern, with noise covariances.
#[derive(Clone, Debug)]
pub(crate) struct BankTransition {
    pattern: Pattern,
    /// Elements of the blocks of rows, block by block, column by column.
    blocks: Vec<[Lanes; BLOCK_ROWS]>,
    /// Elements of all other rows.
    elements: Vec<Lanes>,
    /// Noise covariances, upper triangle, by columns: (leading, leading). A time update uses them up.
    noise: Vec<Lanes>,
}

impl BankTransition {
    /// Zeros.
    pub(crate) fn new(pattern: Pattern) -> Self {
        let m = pattern.leading;
        let columns = pattern.blocks.iter().flat_map(Block::columns).count();
        Self {
            blocks: vec![[Lanes::ZERO; BLOCK_ROWS]; columns],
            elements: vec![Lanes::ZERO; pattern.elements.len()],
            noise: vec![Lanes::ZERO; m * m],
            pattern,
        }
    }

    /// Number of leading rows.
    pub(crate) fn leading(&self) -> usize {
        self.pattern.leading
    }

    /// Let the given lanes have the leading rows `phi`: column-major, (leading, n).
    pub(crate) fn set(&mut self, lanes: [bool; LANES], phi: &[f64]) {
        let m = self.pattern.leading;
        let columns = self
            .pattern
            .blocks
            .iter()
            .flat_map(|block| block.columns().map(move |column| column * m + block.first_row));
        for (to, first) in self.blocks.iter_mut().zip(columns) {
            let from = &phi[first..first + BLOCK_ROWS];
            to.iter_mut().zip(from).for_each(|(to, &from)| to.put(lanes, Lanes::splat(from)));
        }
        for (to, (row, column)) in self.elements.iter_mut().zip(&self.pattern.elements) {
            to.put(lanes, Lanes::splat(phi[column * m + row]));
        }
    }

    /// Let the given lanes have noise covariances by row and column, those of the pattern in the upper triangle.
    #[inline(always)]
    pub(crate) fn set_noise(&mut self, lanes: [bool; LANES], covariance: impl Fn((usize, usize)) -> Lanes) {
        let m = self.pattern.leading;
        for (j, rows) in self.pattern.noise.iter().enumerate() {
            for &i in rows.iter().chain([&j]) {
                self.noise[j * m + i].put(lanes, covariance((i, j)));
            }
        }
    }

    /// `Phi u` of one column, `u`: (n), `out`: (leading).
    pub(crate) fn carry(&self, u: &[Lanes], out: &mut [[Lanes; 1]]) {
        Arch::new().dispatch(Carry { transition: self, u, out });
    }

    /// `Phi u` of several columns, `last` being the last row in which one of them may differ from zero; `out`: (leading) each.
    #[inline(always)]
    pub(super) fn multiply<const C: usize>(&self, u: [&[Lanes]; C], last: usize, out: &mut [[Lanes; C]]) {
        let mut from = self.blocks.as_slice();
        for Block { first_row, runs } in &self.pattern.blocks {
            let mut sum = [[Lanes::ZERO; C]; BLOCK_ROWS];
            for run in runs {
                let (own, others) = from.split_at(run.len());
                from = others;
                let end = run.end.min(last + 1);
                if end <= run.start {
                    continue;
                }
                let u = u.map(|u| &u[run.start..end]);
                for (k, own) in own[..end - run.start].iter().enumerate() {
                    let values = u.map(|u| u[k]);
                    for (sum, &element) in sum.iter_mut().zip(own) {
                        for (sum, &value) in sum.iter_mut().zip(&values) {
                            *sum += element * value;
                        }
                    }
                }
            }
            out[*first_row..first_row + BLOCK_ROWS].copy_from_slice(&sum);
        }
        let others = || self.pattern.elements.iter();
        others().for_each(|&(row, _)| out[row] = [Lanes::ZERO; C]);
        for (&(row, column), &element) in
            others().zip(&self.elements).filter(|((_, column), _)| *column <= last)
        {
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
                // Without a variance its column has no share in any other.
                target[i] = target[i].above(diagonal * rounding);
            }
        }
    }
}

/// What [`BankTransition::carry`] compiles for the vector registers of the machine.
struct Carry<'a> {
    transition: &'a BankTransition,
    u: &'a [Lanes],
    out: &'a mut [[Lanes; 1]],
}

impl WithSimd for Carry<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.transition.multiply([self.u], self.u.len() - 1, self.out);
    }
}

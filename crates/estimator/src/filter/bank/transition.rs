//! Transitions of four filters and the noise that they add.
use super::pattern::{Group, Pattern, TOGETHER};
use crate::filter::lanes::Lanes;

/// Transitions of four filters over one interval, of one pattern, with noise covariances.
#[derive(Clone, Debug)]
pub struct BankTransition {
    pattern: Pattern,
    /// Elements of the leading rows, group by group.
    phi: Vec<Lanes>,
    /// Noise covariances, upper triangle, by columns: (leading, leading). A time update uses them up.
    pub noise: Vec<Lanes>,
}

impl BankTransition {
    /// Zeros.
    pub fn new(pattern: Pattern) -> Self {
        let (elements, m) = (pattern.elements, pattern.leading);
        Self { pattern, phi: vec![Lanes::ZERO; elements], noise: vec![Lanes::ZERO; m * m] }
    }

    /// Number of leading rows.
    pub fn leading(&self) -> usize {
        self.pattern.leading
    }

    /// Let the given lanes have the leading rows `phi`: column-major, (leading, n).
    pub fn set(&mut self, used: [bool; 4], phi: &[f64]) {
        let m = self.pattern.leading;
        for group in &self.pattern.groups {
            let elements = group.columns.iter().flat_map(|column| {
                let first = column * m + group.first_row;
                &phi[first..first + group.rows]
            });
            for (to, &from) in self.phi[group.start..].iter_mut().zip(elements) {
                if used == [true; 4] {
                    *to = Lanes::splat(from);
                    continue;
                }
                (0..4).filter(|lane| used[*lane]).for_each(|lane| to.0[lane] = from);
            }
        }
    }

    /// `Phi u` of a column whose elements beyond its length are zero; `out`: (leading).
    #[inline(always)]
    pub fn multiply(&self, u: &[Lanes], out: &mut [Lanes]) {
        for group in &self.pattern.groups {
            let out = &mut out[group.first_row..group.first_row + group.rows];
            let elements = &self.phi[group.start..];
            match out.first_chunk_mut::<TOGETHER>() {
                Some(out) => *out = product(group, elements, u),
                None => {
                    out.fill(Lanes::ZERO);
                    for (&column, elements) in group.columns.iter().zip(elements.chunks_exact(group.rows)) {
                        let Some(&value) = u.get(column) else { break };
                        out.iter_mut().zip(elements).for_each(|(out, &element)| *out += element * value);
                    }
                }
            }
        }
    }

    /// First column of a row of `Phi U` that may differ from zero.
    #[inline(always)]
    pub(super) fn first(&self, row: usize) -> usize {
        let group = self.pattern.groups.iter().rfind(|group| group.first_row <= row);
        group.and_then(|group| group.columns.first()).map_or(self.pattern.leading, |&column| column)
    }

    /// Write the noise as `G diag(q) G^T` behind the transition's `m` columns in `rows` (m, 2 m), the column of the last state first,
    /// and the variances `q` of its sources; the noise is used up.
    ///
    /// A variance that the later states explain up to rounding counts as explained in full: its column stays zero.
    #[inline(always)]
    pub(super) fn factor_noise(&mut self, rows: &mut [Lanes], spans: &mut [(usize, usize)], q: &mut [Lanes]) {
        let m = self.pattern.leading;
        let rounding = m as f64 * f64::EPSILON;
        for j in (0..m).rev() {
            let (before, column) = self.noise.split_at_mut(j * m);
            let (place, left) = (m - 1 - j, column[j]);
            q[place] = left;
            let inverse = Lanes::splat(1.0).divided_where(left, f64::MIN_POSITIVE, Lanes::ZERO);
            rows[j * 2 * m + m + place] = Lanes::splat(1.0);
            rows[j * 2 * m + m + place + 1..(j + 1) * 2 * m].fill(Lanes::ZERO);
            spans[j].1 = m + place + 1;
            for (i, target) in before.chunks_exact_mut(m).enumerate() {
                let share = column[i] * inverse;
                rows[i * 2 * m + m + place] = share;
                if column[i].is_zero() {
                    continue;
                }
                let diagonal = target[i];
                for (to, &value) in target[..=i].iter_mut().zip(column.iter()) {
                    *to -= share * value;
                }
                for lane in 0..4 {
                    if target[i].0[lane] <= rounding * diagonal.0[lane] {
                        target[..=i].iter_mut().for_each(|to| to.0[lane] = 0.0);
                    }
                }
            }
        }
    }
}

/// Four rows of `Phi u`.
#[inline(always)]
fn product(group: &Group, elements: &[Lanes], u: &[Lanes]) -> [Lanes; TOGETHER] {
    let mut sum = [Lanes::ZERO; TOGETHER];
    for (&column, elements) in group.columns.iter().zip(elements.as_chunks::<TOGETHER>().0) {
        let Some(&value) = u.get(column) else { break };
        for (sum, &element) in sum.iter_mut().zip(elements) {
            *sum += element * value;
        }
    }
    sum
}

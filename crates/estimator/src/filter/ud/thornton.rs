//! Time update of the factors by Thornton's modified weighted Gram-Schmidt.
//!
//! What is zero stays out: states that move by themselves have one element in their row of the transition, and a triangular
//! noise input has zeros on one side. Each row of `[Phi_xx U_x, G]` keeps the range of its elements that may differ from zero; the
//! product `Phi U` takes dense rows four at a time and the others by their elements.
use crate::filter::kernel::{axpy, dot, multiply_rows, padded, weigh};
use crate::filter::state_space::Linearisation;

/// Rows of the transition that are multiplied together.
const TOGETHER: usize = 4;

/// An element of a row of the transition.
#[derive(Clone, Copy, Debug)]
struct Element {
    row: usize,
    column: usize,
    value: f64,
}

/// Memory of the time update; it grows at the first use with more noise sources, then stays.
#[derive(Clone, Debug, Default)]
pub(super) struct TimeUpdate {
    /// First row of each dense group, and the elements of all other rows.
    dense: Vec<usize>,
    elements: Vec<Element>,
    /// Sum of the elements of each row besides its diagonal, in absolute value.
    besides: Vec<f64>,
    /// `Phi U`, rows of moving states: (m, n).
    moved: Vec<f64>,
    /// Rows of `[Phi_xx U_x, G]` as columns, padded: (padded(m + k), m).
    rows: Vec<f64>,
    /// Range of each row outside of which it is zero.
    spans: Vec<(usize, usize)>,
    /// `[d_x, q]`, padded with zeros.
    weights: Vec<f64>,
    /// A row times the weights.
    weighted: Vec<f64>,
}

impl TimeUpdate {
    /// Zeroed room for `m` moving states of `n` and `k` noise sources.
    pub fn reserve(&mut self, n: usize, m: usize, k: usize) {
        let width = padded(m + k);
        if self.weights.len() == width && self.moved.len() == m * n {
            return;
        }
        self.dense.reserve(m);
        self.elements.reserve(m * n);
        self.besides.resize(m, 0.0);
        self.moved.resize(m * n, 0.0);
        self.rows.clear();
        self.rows.resize(width * m, 0.0);
        self.spans.resize(m, (0, 0));
        self.weights.clear();
        self.weights.resize(width, 0.0);
        self.weighted.resize(width, 0.0);
    }

    /// Move the factors `u` (n, n) and `d` (n).
    pub fn run(&mut self, linear: &Linearisation, u: &mut [f64], d: &mut [f64]) {
        let (n, m, k) = (d.len(), linear.phi.nrows(), linear.q.len());
        self.reserve(n, m, k);
        if m == 0 {
            return;
        }
        let phi = linear.phi.as_slice();
        self.sort_rows(phi, n, m);
        self.transform(phi, u, n, m);
        self.weights[..m].copy_from_slice(&d[..m]);
        self.weights[m..m + k].copy_from_slice(linear.q.as_slice());
        self.load_noise(linear.g.as_slice(), m);
        self.orthogonalise(u, d, n, m);
    }

    /// Which rows of the transition are dense, and where the others have elements.
    fn sort_rows(&mut self, phi: &[f64], n: usize, m: usize) {
        self.besides.fill(0.0);
        for (j, column) in phi.chunks_exact(m).enumerate() {
            let diagonal = j.min(m);
            let (sums, column) = (&mut self.besides, column);
            sums[..diagonal].iter_mut().zip(column).for_each(|(sum, v)| *sum += v.abs());
            let after = (diagonal + 1).min(m);
            sums[after..].iter_mut().zip(&column[after..]).for_each(|(sum, v)| *sum += v.abs());
        }
        self.dense.clear();
        self.elements.clear();
        for first in (0..m).step_by(TOGETHER) {
            let group = first..(first + TOGETHER).min(m);
            let coupled = self.besides[group.clone()].iter().filter(|sum| **sum != 0.0).count();
            if group.len() == TOGETHER && coupled > 1 {
                self.dense.push(first);
                group.for_each(|row| self.spans[row] = (0, m));
                continue;
            }
            for row in group {
                let columns = if self.besides[row] == 0.0 { row..row + 1 } else { 0..n };
                let elements = columns.filter(|&j| phi[j * m + row] != 0.0);
                let before = self.elements.len();
                self.elements.extend(elements.map(|column| Element { row, column, value: phi[column * m + row] }));
                self.spans[row] = (self.elements.get(before).map_or(m, |first| first.column.min(m)), m);
            }
        }
    }

    /// `Phi U`: its columns of moving states become rows to orthogonalise, those of constants are final.
    fn transform(&mut self, phi: &[f64], u: &mut [f64], n: usize, m: usize) {
        let Self { dense, elements, moved, rows, .. } = self;
        let used = n - phi.rchunks_exact(m).take_while(|column| column.iter().all(|v| *v == 0.0)).count();
        moved.fill(0.0);
        for (j, (moved, u)) in moved.chunks_exact_mut(m).zip(u.chunks_exact(n)).enumerate() {
            let u = &u[..used.min(j + 1)];
            for &first in dense.iter() {
                moved[first..first + TOGETHER].copy_from_slice(&multiply_rows::<TOGETHER>(phi, m, first, u));
            }
        }
        for &Element { row, column, value } in elements.iter() {
            let from = u[column * n + column..].iter().step_by(n);
            let to = moved[column * m + row..].iter_mut().step_by(m);
            to.zip(from).for_each(|(to, from)| *to += value * from);
        }
        let width = rows.len() / m;
        let (moving, constant) = moved.split_at(m * m);
        for (j, column) in moving.chunks_exact(m).enumerate() {
            rows[j..].iter_mut().step_by(width).zip(column).for_each(|(to, from)| *to = *from);
        }
        for (u, column) in u[m * n..].chunks_exact_mut(n).zip(constant.chunks_exact(m)) {
            u[..m].copy_from_slice(column);
        }
    }

    /// `G` behind `Phi U`, and how far each row reaches.
    fn load_noise(&mut self, g: &[f64], m: usize) {
        let width = self.weights.len();
        for (index, column) in g.chunks_exact(m).enumerate() {
            let (rows, spans) = (self.rows[m + index..].iter_mut().step_by(width), &mut self.spans);
            for ((to, &from), span) in rows.zip(column).zip(spans) {
                *to = from;
                span.1 = if from == 0.0 { span.1 } else { m + index + 1 };
            }
        }
        for span in &mut self.spans {
            *span = (span.0 / 4 * 4, padded(span.1));
        }
    }

    /// Modified weighted Gram-Schmidt, last row first: `[Phi_xx U_x, G] = U_x' V`, `V diag(weights) V^T = diag(d')`.
    fn orthogonalise(&mut self, u: &mut [f64], d: &mut [f64], n: usize, m: usize) {
        let width = self.weights.len();
        let Self { rows, weights, weighted, spans, .. } = self;
        for j in (0..m).rev() {
            let (before, row) = rows[..(j + 1) * width].split_at_mut(j * width);
            let (low, high) = spans[j];
            let (row, weighted) = (&row[low..high], &mut weighted[low..high]);
            let variance = weigh(row, &weights[low..high], weighted);
            let u = &mut u[j * n..j * n + j];
            if variance < f64::MIN_POSITIVE {
                d[j] = 0.0;
                u.fill(0.0);
                continue;
            }
            d[j] = variance;
            let inverse = 1.0 / variance;
            for ((other, u), span) in before.chunks_exact_mut(width).zip(u).zip(spans.iter_mut()) {
                let other = &mut other[low..high];
                *u = dot(weighted, other) * inverse;
                if *u != 0.0 {
                    axpy(-*u, row, other);
                    *span = (span.0.min(low), span.1.max(high));
                }
            }
        }
    }
}

//! Time update of the factors by Thornton's modified weighted Gram-Schmidt.
//!
//! What is zero stays out: states that move by themselves have one element in their row of the transition, and a triangular
//! noise input has zeros on one side. Each row of `[Phi_xx U_x, G]` keeps the range of its elements that may differ from zero; the
//! product `Phi U` takes dense rows four at a time and the others by their elements.
use crate::filter::kernel::{Group, axpy, dot_groups, multiply_rows};
use crate::filter::state_space::Linearisation;
use alloc::vec::Vec;

/// Rows of the transition that are multiplied together.
const GROUP: usize = 4;

/// An element of a row of the transition.
#[derive(Clone, Copy, Debug)]
struct Element {
    row: usize,
    column: usize,
    value: f64,
}

/// Memory of the time update; nothing in it outlives an update.
#[derive(Debug, Default)]
pub(super) struct TimeUpdate {
    /// Moving states, all states, noise sources that there is room for.
    sizes: (usize, usize, usize),
    /// First row of each dense group, and the elements of all other rows.
    dense: Vec<usize>,
    elements: Vec<Element>,
    /// `Phi U`, rows of moving states: (m, n).
    moved: Vec<f64>,
    /// Rows of `[Phi_xx U_x, G]` as columns, padded to whole groups: (groups of m + k, m).
    rows: Vec<Group>,
    /// Range of groups of each row outside of which it is zero.
    spans: Vec<(usize, usize)>,
    /// `[d_x, q]`, padded with zeros.
    weights: Vec<Group>,
    /// A row times the weights.
    weighted: Vec<Group>,
}

impl Clone for TimeUpdate {
    /// The same room: a copy does not allocate later where its original would not.
    fn clone(&self) -> Self {
        let mut room = Self::default();
        let (m, n, k) = self.sizes;
        room.reserve(n, m, k);
        room
    }
}

impl TimeUpdate {
    /// Zeroed room for `m` moving states of `n` and `k` noise sources.
    pub(super) fn reserve(&mut self, n: usize, m: usize, k: usize) {
        if self.sizes == (m, n, k) {
            return;
        }
        self.sizes = (m, n, k);
        let width = (m + k).div_ceil(4);
        self.dense.clear();
        self.dense.reserve(m);
        self.elements.clear();
        self.elements.reserve(m * n);
        self.moved.resize(m * n, 0.0);
        self.rows.clear();
        self.rows.resize(width * m, [0.0; 4]);
        self.spans.resize(m, (0, 0));
        self.weights.clear();
        self.weights.resize(width, [0.0; 4]);
        self.weighted.resize(width, [0.0; 4]);
    }

    /// Move the factors `u` (n, n) and `d` (n).
    pub(super) fn run(&mut self, linear: &Linearisation, u: &mut [f64], d: &mut [f64]) {
        let (n, m, k) = (d.len(), linear.phi.nrows(), linear.q.len());
        if m == 0 {
            return;
        }
        self.reserve(n, m, k);
        let (phi, g, q) = (linear.phi.as_slice(), linear.g.as_slice(), linear.q.as_slice());
        let (u, phi, g) = (&mut u[..n * n], &phi[..m * n], &g[..m * k]);
        self.sort_rows(phi, m);
        let width = (m + k).div_ceil(4);
        self.transform(phi, u, n, m, width);
        let weights = self.weights.as_flattened_mut();
        weights[..m].copy_from_slice(&d[..m]);
        weights[m..m + k].copy_from_slice(&q[..k]);
        self.load_noise(g, m, k);
        self.orthogonalise(u, &mut d[..n], n, m, width);
    }

    /// Which rows of the transition are dense, and where the others have elements.
    fn sort_rows(&mut self, phi: &[f64], m: usize) {
        self.dense.clear();
        self.elements.clear();
        for first in (0..m).step_by(GROUP) {
            let group = first..(first + GROUP).min(m);
            let coupled = |row: &usize| group.clone().any(|j| j != *row && phi[j * m + row] != 0.0);
            if group.len() == GROUP && group.clone().filter(coupled).count() > 1 {
                self.dense.push(first);
                group.for_each(|row| self.spans[row] = (0, m));
                continue;
            }
            for row in group {
                let before = self.elements.len();
                for (column, values) in phi.chunks_exact(m).enumerate() {
                    if values[row] != 0.0 {
                        self.elements.push(Element { row, column, value: values[row] });
                    }
                }
                self.spans[row] = (self.elements.get(before).map_or(m, |first| first.column.min(m)), m);
            }
        }
    }

    /// `Phi U`: its columns of moving states become rows to orthogonalise, those of constants are final.
    fn transform(&mut self, phi: &[f64], u: &mut [f64], n: usize, m: usize, width: usize) {
        let Self { dense, elements, moved, rows, .. } = self;
        let used = n - phi.rchunks_exact(m).take_while(|column| column.iter().all(|v| *v == 0.0)).count();
        let (moved, width) = (&mut moved[..m * n], width * 4);
        moved.fill(0.0);
        for (j, (moved, u)) in moved.chunks_exact_mut(m).zip(u.chunks_exact(n)).enumerate() {
            let u = &u[..used.min(j + 1)];
            for &first in dense.iter() {
                moved[first..first + GROUP].copy_from_slice(&multiply_rows::<GROUP>(phi, m, first, u));
            }
        }
        for &Element { row, column, value } in elements.iter() {
            let columns = moved.chunks_exact_mut(m).zip(u.chunks_exact(n)).skip(column);
            columns.for_each(|(to, from)| to[row] += value * from[column]);
        }
        let (moving, constant) = moved.split_at(m * m);
        for (i, row) in rows.as_flattened_mut().chunks_exact_mut(width).enumerate() {
            for (to, column) in row.iter_mut().zip(moving.chunks_exact(m)) {
                *to = column[i];
            }
        }
        for (u, column) in u[m * n..].chunks_exact_mut(n).zip(constant.chunks_exact(m)) {
            u[..m].copy_from_slice(column);
        }
    }

    /// `G` behind `Phi U`, and how far each row reaches.
    fn load_noise(&mut self, g: &[f64], m: usize, k: usize) {
        let width = (m + k).div_ceil(4) * 4;
        let rows = self.rows.as_flattened_mut().chunks_exact_mut(width);
        for ((i, row), span) in rows.enumerate().zip(&mut self.spans) {
            let mut reach = span.1;
            for (index, (to, column)) in row[m..m + k].iter_mut().zip(g.chunks_exact(m)).enumerate() {
                *to = column[i];
                reach = if *to == 0.0 { reach } else { m + index + 1 };
            }
            *span = (span.0 / 4, reach.div_ceil(4));
        }
    }

    /// Modified weighted Gram-Schmidt, last row first: `[Phi_xx U_x, G] = U_x' V`, `V diag(weights) V^T = diag(d')`.
    fn orthogonalise(&mut self, u: &mut [f64], d: &mut [f64], n: usize, m: usize, width: usize) {
        let Self { rows, weights, weighted, spans, .. } = self;
        for j in (0..m).rev() {
            let (before, row) = rows[..(j + 1) * width].split_at_mut(j * width);
            let (low, high) = spans[j];
            let (row, weighted) = (&row[low..high], &mut weighted[low..high]);
            let products = row.as_flattened().iter().zip(weights[low..high].as_flattened());
            for (to, (from, weight)) in weighted.as_flattened_mut().iter_mut().zip(products) {
                *to = from * weight;
            }
            let variance = dot_groups(weighted, row);
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
                *u = dot_groups(weighted, other) * inverse;
                axpy(-*u, row.as_flattened(), other.as_flattened_mut());
                *span = (span.0.min(low), span.1.max(high));
            }
        }
    }
}

//! One step of the linearised equations: transition, increment of the mean, and noise, from one series.
//!
//! Rows of three kinds: the *block* (wall, valve and gas temperatures, sensor lags), coupled to everything; *outer* states, each with
//! memory of itself alone, but for the mass, which the leak empties, `dm/dt = -r`; constants. With `A` the block's own
//! matrix, `a_j` the columns by which the others act on it and `f` its rate at the start,
//!
//! `P(h) = exp(Ah)`, `s_j(h) = int_0^h exp(A(h-t)) a_j e_j(t) dt`, increment `s_f(h)` with `a_f e_f = f + sum_j a_j dx_j(t)`
//!
//! come from a Taylor series over `h / 2^k`, short enough for a few terms, and `k` doublings, which are exact:
//! `P(2h) = P P`, `s_j(2h) = P s_j + s_j e_j(h)`. Process noise is integrated by Simpson's rule, of order 4, on the step's start,
//! middle (the transition before the last doubling) and end.
//!
//! Source: scaling and squaring, Higham 2008, chapter 10; Simpson's rule for the noise integral of Van Loan 1978.
use alloc::vec::Vec;
use cylwatch_thermal::real::powi;
use nalgebra::DMatrix;

use super::lanes::{Columns, Square, add_scaled};
use super::structure::Structure;

/// What the series leaves out, relative to its first term.
const SERIES_TOLERANCE: f64 = 1e-12;
/// Norm of the scaled matrix: a doubling costs as much as a term and a half.
const LARGEST_NORM: f64 = 0.12;
/// Weights of Simpson's rule at start, middle and end.
const SIMPSON: [f64; 3] = [1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0];

/// A state outside the block over the present interval.
#[derive(Clone, Copy, Debug, Default)]
struct Outer {
    state: usize,
    /// Departure from rest at the start of the step.
    away: f64,
    /// `-decay` times the scaled interval, and the current term of its exponential.
    exponent: f64,
    term: f64,
    /// `e_j - 1` after the interval, and after half the step.
    change: f64,
    half_change: f64,
}

/// How a leading state moves on its own.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Walking {
    /// Variance that the noise adds in a second.
    pub intensity: f64,
    /// Inverse memory, 1/s.
    pub decay_per_s: f64,
    /// Value that it returns to.
    pub rest: f64,
}

/// The step. Matrices have a column per block state, outer state, constant, and one for the mean, of block length.
#[derive(Clone, Debug)]
pub(super) struct Transition {
    /// State of each column but the last.
    columns: Vec<usize>,
    /// Column of each state that has one.
    column_of: Vec<Option<usize>>,
    rows: usize,
    temperatures: usize,
    outer: Vec<Outer>,
    /// Positions among the outer states.
    mass: usize,
    leak: usize,
    /// Mass per leak rate after the interval, and after half the step, s.
    mass_per_leak: f64,
    half_mass_per_leak: f64,
    /// Equations: `A`, `a_j`, `f`.
    a: Columns,
    /// Matrix of the scaled interval, or `P - 1` before a doubling.
    z: Square,
    term: Columns,
    next: Columns,
    /// `P - 1`, `s_j`, `s_f`, now and after half the step.
    sum: Columns,
    half: Columns,
    /// Noise of the block.
    noise: Columns,
}

impl Transition {
    /// Room for equations of `count` states.
    pub(super) fn new(structure: &Structure, count: usize) -> Self {
        let Structure { block, outer, constants, .. } = structure;
        let columns: Vec<usize> = block.iter().chain(outer).chain(constants).copied().collect();
        let mut column_of = vec![None; count];
        columns.iter().enumerate().for_each(|(column, &state)| column_of[state] = Some(column));
        let position = |state: usize| {
            outer.iter().position(|&other| other == state).expect("mass and leak rate are outside the block")
        };
        let rows = block.len();
        let zeros = Columns::zeros(rows, columns.len() + 1);
        Self {
            rows,
            temperatures: structure.temperatures,
            mass: position(structure.mass),
            leak: position(structure.leak),
            outer: outer.iter().map(|&state| Outer { state, ..Outer::default() }).collect(),
            mass_per_leak: 0.0,
            half_mass_per_leak: 0.0,
            a: zeros.clone(),
            z: Square::zeros(rows),
            term: zeros.clone(),
            next: zeros.clone(),
            sum: zeros.clone(),
            half: zeros,
            noise: Columns::zeros(rows, rows),
            column_of,
            columns,
        }
    }

    /// By how much each row of the block changes per second and per unit of a state; `None`: the state acts on none.
    pub(super) fn per_state_mut(&mut self, state: usize) -> Option<&mut [f64]> {
        self.column_of[state].map(|column| &mut self.a.flat_mut(column)[..self.rows])
    }

    /// Rate of change of each row of the block at the start.
    pub(super) fn rate_mut(&mut self) -> &mut [f64] {
        &mut self.a.flat_mut(self.columns.len())[..self.rows]
    }

    /// Subtract what the linearisation at `a` makes of a state `b` from its `rate`, row by row of the block.
    pub(super) fn subtract_linear(&self, a: &[f64], b: &[f64], rate: &mut [f64]) {
        let mut linear = |away: f64, column: usize| {
            for (rate, by) in rate.iter_mut().zip(self.a.flat(column)) {
                *rate -= away * by;
            }
        };
        linear(1.0, self.columns.len());
        for (column, &state) in self.columns.iter().enumerate() {
            linear(b[state] - a[state], column);
        }
    }

    /// Solve the equations over `h` seconds from state `x`; `walking` holds the leading states.
    #[inline(always)]
    pub(super) fn solve(&mut self, x: &[f64], walking: &[Walking], h: f64) {
        let rates = self.outer.iter().map(|outer| walking[outer.state].decay_per_s);
        let norm = h * rates.fold(self.norm(), f64::max);
        // At least one, for the middle of the step.
        let doublings = libm::ceil(libm::log2(norm / LARGEST_NORM)).clamp(1.0, 60.0) as i32;
        let share = powi(0.5_f64, doublings);
        for outer in &mut self.outer {
            let Walking { decay_per_s, rest, .. } = walking[outer.state];
            outer.away = x[outer.state] - rest;
            outer.exponent = -decay_per_s * h * share;
        }
        self.sum_series(h * share, terms(norm * share));
        for _ in 1..doublings {
            self.double();
        }
        self.half.copy_from(&self.sum);
        self.half_mass_per_leak = self.mass_per_leak;
        self.outer.iter_mut().for_each(|outer| outer.half_change = outer.change);
        self.double();
    }

    /// Bound on the eigenvalues of the block, 1/s. Driven rows add their own rate only: nothing comes back from them.
    #[inline(always)]
    fn norm(&self) -> f64 {
        let own = |row: usize| {
            if row < self.temperatures {
                (0..self.temperatures).map(|column| self.a.at(row, column).abs()).sum()
            } else {
                self.a.at(row, row).abs()
            }
        };
        (0..self.rows).map(own).fold(0.0, f64::max)
    }

    /// Terms of the series over the scaled interval.
    #[inline(always)]
    fn sum_series(&mut self, interval: f64, terms: usize) {
        self.term.set_scaled(interval, &self.a);
        self.z.copy_from(&self.term, self.rows);
        self.sum.copy_from(&self.term);
        let mut mass_term = -interval;
        self.mass_per_leak = mass_term;
        for outer in &mut self.outer {
            outer.term = outer.exponent;
            outer.change = outer.term;
        }
        for k in 2..=terms {
            let inverse = 1.0 / k as f64;
            self.next.set_product(inverse, &self.z, &self.term, 0.0);
            self.add_forcing(interval * inverse, mass_term);
            mass_term = -interval * inverse * self.outer[self.leak].term;
            self.mass_per_leak += mass_term;
            for outer in &mut self.outer {
                outer.term *= outer.exponent * inverse;
                outer.change += outer.term;
            }
            core::mem::swap(&mut self.term, &mut self.next);
            self.sum.add(&self.term);
        }
    }

    /// What the outer states' own motion adds to the next term, in their columns and in the mean's.
    #[inline(always)]
    fn add_forcing(&mut self, scale: f64, mass_term: f64) {
        let (first, mean) = (self.rows, self.columns.len());
        for (position, outer) in self.outer.iter().enumerate() {
            if outer.term != 0.0 {
                let (by, factor) = (self.a.column(first + position), scale * outer.term);
                add_scaled(factor, by, self.next.column_mut(first + position));
                add_scaled(factor * outer.away, by, self.next.column_mut(mean));
            }
        }
        let (by, factor) = (self.a.column(first + self.mass), scale * mass_term);
        add_scaled(factor, by, self.next.column_mut(first + self.leak));
        add_scaled(factor * self.outer[self.leak].away, by, self.next.column_mut(mean));
    }

    /// From an interval to twice as long a one.
    #[inline(always)]
    fn double(&mut self) {
        let (first, mean) = (self.rows, self.columns.len());
        self.z.copy_from(&self.sum, self.rows);
        self.next.set_product(1.0, &self.z, &self.sum, 2.0);
        for (position, outer) in self.outer.iter().enumerate() {
            if outer.change != 0.0 {
                let by = self.sum.column(first + position);
                add_scaled(outer.change, by, self.next.column_mut(first + position));
                add_scaled(outer.change * outer.away, by, self.next.column_mut(mean));
            }
        }
        let (by, factor) = (self.sum.column(first + self.mass), self.mass_per_leak);
        add_scaled(factor, by, self.next.column_mut(first + self.leak));
        add_scaled(factor * self.outer[self.leak].away, by, self.next.column_mut(mean));
        self.mass_per_leak *= 2.0 + self.outer[self.leak].change;
        for outer in &mut self.outer {
            outer.change *= 2.0 + outer.change;
        }
        core::mem::swap(&mut self.sum, &mut self.next);
    }

    /// Move a state over the step.
    #[inline(always)]
    pub(super) fn advance(&self, x: &mut [f64]) {
        for (state, by) in self.columns[..self.rows].iter().zip(self.sum.flat(self.columns.len())) {
            x[*state] += by;
        }
        for outer in &self.outer {
            x[outer.state] += outer.away * outer.change;
        }
        x[self.outer[self.mass].state] += self.outer[self.leak].away * self.mass_per_leak;
    }

    /// Leading rows of the transition matrix: (leading, n).
    #[inline(always)]
    pub(super) fn write_phi(&self, phi: &mut DMatrix<f64>) {
        let leading = phi.nrows();
        let (first, driven) = self.columns[..self.rows].split_at(self.temperatures);
        let phi = phi.as_mut_slice();
        phi.fill(0.0);
        for (j, state) in self.columns.iter().enumerate() {
            let column = &mut phi[state * leading..(state + 1) * leading];
            let (temperatures, lags) = self.sum.flat(j).split_at(first.len());
            column.iter_mut().zip(temperatures).for_each(|(to, &value)| *to = value);
            driven.iter().zip(lags).for_each(|(&row, &value)| column[row] = value);
        }
        for &state in &self.columns[..self.rows] {
            phi[state * leading + state] += 1.0;
        }
        for outer in &self.outer {
            phi[outer.state * leading + outer.state] = 1.0 + outer.change;
        }
        let (mass, leak) = (self.outer[self.mass].state, self.outer[self.leak].state);
        phi[leak * leading + mass] = self.mass_per_leak;
    }

    /// Noise covariance that the step of `h` seconds adds where each leading state gains `intensity` in a second: (leading, leading),
    /// its upper triangle. The rest has no meaning.
    #[inline(always)]
    pub(super) fn write_noise(&mut self, intensity: impl Fn(usize) -> f64, h: f64, q: &mut DMatrix<f64>) {
        let m = q.nrows();
        let q = q.as_mut_slice();
        q.fill(0.0);
        self.noise.clear();
        for source in 0..self.rows {
            let intensity = h * intensity(self.columns[source]);
            if intensity > 0.0 {
                self.add_block_source(source, intensity);
            }
        }
        for position in 0..self.outer.len() {
            let intensity = h * intensity(self.outer[position].state);
            if intensity > 0.0 {
                self.add_outer_source(position, intensity, q, m);
            }
        }
        let block = &self.columns[..self.rows];
        for (j, &column) in block.iter().enumerate() {
            let to = &mut q[column * m..(column + 1) * m];
            block[..=j].iter().zip(self.noise.flat(j)).for_each(|(&row, value)| to[row] = *value);
        }
    }

    #[inline(always)]
    fn add_block_source(&mut self, source: usize, intensity: f64) {
        self.noise.flat_mut(source)[source] += SIMPSON[0] * intensity;
        for (weight, points) in [(SIMPSON[1], &mut self.half), (SIMPSON[2], &mut self.sum)] {
            points.flat_mut(source)[source] += 1.0;
            self.noise.add_square(weight * intensity, points.column(source));
            points.flat_mut(source)[source] -= 1.0;
        }
    }

    #[inline(always)]
    fn add_outer_source(&mut self, position: usize, intensity: f64, q: &mut [f64], m: usize) {
        let (outer, mass) = (self.outer[position], self.outer[self.mass].state);
        let (own, block) = (outer.state, &self.columns[..self.rows]);
        q[own * m + own] += SIMPSON[0] * intensity;
        let middle = (SIMPSON[1], &self.half, 1.0 + outer.half_change, self.half_mass_per_leak);
        let end = (SIMPSON[2], &self.sum, 1.0 + outer.change, self.mass_per_leak);
        for (weight, points, factor, per_leak) in [middle, end] {
            let weight = weight * intensity;
            let values = points.column(self.rows + position);
            self.noise.add_square(weight, values);
            let values = values.as_flattened();
            couple(q, m, own, weight * factor, (block, values));
            q[own * m + own] += weight * factor * factor;
            if position == self.leak {
                couple(q, m, mass, weight * per_leak, (block, values));
                q[mass * m + mass] += weight * per_leak * per_leak;
                q[own * m + mass] += weight * per_leak * factor;
            }
        }
    }
}

/// Add `weight` times the block's values to the covariances of a state with the block, in the upper triangle.
#[inline(always)]
fn couple(q: &mut [f64], m: usize, state: usize, weight: f64, (block, values): (&[usize], &[f64])) {
    for (&row, value) in block.iter().zip(values) {
        let (row, column) = if row < state { (row, state) } else { (state, row) };
        q[column * m + row] += weight * value;
    }
}

/// Terms after which a series of this norm leaves out no more than the tolerance.
#[inline(always)]
fn terms(norm: f64) -> usize {
    let (mut count, mut left) = (1, norm / 2.0);
    while left > SERIES_TOLERANCE && count < 60 {
        count += 1;
        left *= norm / (count + 1) as f64;
    }
    count
}

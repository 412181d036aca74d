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
use nalgebra::DMatrix;

use crate::filter::kernel::{axpy, multiply, padded};

/// What the series leaves out, relative to its first term.
const SERIES_TOLERANCE: f64 = 1e-14;
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

/// Which states the equations have.
#[derive(Clone, Debug)]
pub(super) struct Structure {
    /// States of the block; those before `temperatures` are coupled both ways, the others are driven only.
    pub block: Vec<usize>,
    pub temperatures: usize,
    /// States outside the block.
    pub outer: Vec<usize>,
    pub mass: usize,
    pub leak: usize,
    /// Constants that act on the block.
    pub constants: Vec<usize>,
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

/// The step. Matrices have a column per block state, outer state, constant, and one for the mean, of padded block length.
#[derive(Clone, Debug)]
pub(super) struct Transition {
    /// State of each column but the last.
    columns: Vec<usize>,
    /// Column of each state that has one.
    column_of: Vec<Option<usize>>,
    rows: usize,
    high: usize,
    temperatures: usize,
    outer: Vec<Outer>,
    /// Positions among the outer states.
    mass: usize,
    leak: usize,
    /// Mass per leak rate after the interval, and after half the step, s.
    mass_per_leak: f64,
    half_mass_per_leak: f64,
    /// Equations: `A`, `a_j`, `f`.
    a: Vec<f64>,
    /// Matrix of the scaled interval, or `P - 1` before a doubling.
    z: Vec<f64>,
    term: Vec<f64>,
    next: Vec<f64>,
    /// `P - 1`, `s_j`, `s_f`, now and after half the step.
    sum: Vec<f64>,
    half: Vec<f64>,
    /// Noise of the block: padded rows.
    noise: Vec<f64>,
}

impl Transition {
    /// Room for equations of `count` states.
    pub fn new(structure: &Structure, count: usize) -> Self {
        let Structure { block, outer, constants, .. } = structure;
        let columns: Vec<usize> = block.iter().chain(outer).chain(constants).copied().collect();
        let mut column_of = vec![None; count];
        columns.iter().enumerate().for_each(|(column, &state)| column_of[state] = Some(column));
        let position = |state: usize| {
            outer.iter().position(|&other| other == state).expect("mass and leak rate are outside the block")
        };
        let (rows, high) = (block.len(), padded(block.len()));
        let zeros = || vec![0.0; high * (columns.len() + 1)];
        Self {
            rows,
            high,
            temperatures: structure.temperatures,
            mass: position(structure.mass),
            leak: position(structure.leak),
            outer: outer.iter().map(|&state| Outer { state, ..Outer::default() }).collect(),
            mass_per_leak: 0.0,
            half_mass_per_leak: 0.0,
            a: zeros(),
            z: vec![0.0; high * rows],
            term: zeros(),
            next: zeros(),
            sum: zeros(),
            half: zeros(),
            noise: vec![0.0; high * rows],
            column_of,
            columns,
        }
    }

    /// By how much each row of the block changes per second and per unit of a state; `None`: the state acts on none.
    pub fn per_state_mut(&mut self, state: usize) -> Option<&mut [f64]> {
        let (high, rows) = (self.high, self.rows);
        self.column_of[state].map(|column| &mut self.a[column * high..column * high + rows])
    }

    /// Rate of change of each row of the block at the start.
    pub fn rate_mut(&mut self) -> &mut [f64] {
        let start = self.high * self.columns.len();
        &mut self.a[start..start + self.rows]
    }

    /// Solve the equations over `h` seconds from state `x`; `walking` holds the leading states.
    pub fn solve(&mut self, x: &[f64], walking: &[Walking], h: f64) {
        let rates = self.outer.iter().map(|outer| walking[outer.state].decay_per_s);
        let norm = h * rates.fold(self.norm(), f64::max);
        // At least one, for the middle of the step.
        let doublings = (norm / LARGEST_NORM).log2().ceil().clamp(1.0, 60.0) as i32;
        let interval = h * 0.5_f64.powi(doublings);
        for outer in &mut self.outer {
            let Walking { decay_per_s, rest, .. } = walking[outer.state];
            outer.away = x[outer.state] - rest;
            outer.exponent = -decay_per_s * interval;
        }
        self.sum_series(interval, terms(norm / h * interval));
        for doubling in 1..=doublings {
            if doubling == doublings {
                self.half.copy_from_slice(&self.sum);
                self.half_mass_per_leak = self.mass_per_leak;
                self.outer.iter_mut().for_each(|outer| outer.half_change = outer.change);
            }
            self.double();
        }
    }

    /// Bound on the eigenvalues of the block, 1/s. Driven rows add their own rate only: nothing comes back from them.
    fn norm(&self) -> f64 {
        let entry = |row: usize, column: usize| self.a[column * self.high + row].abs();
        let own = |row: usize| {
            if row < self.temperatures {
                (0..self.temperatures).map(|column| entry(row, column)).sum()
            } else {
                entry(row, row)
            }
        };
        (0..self.rows).map(own).fold(0.0, f64::max)
    }

    /// Terms of the series over the scaled interval.
    fn sum_series(&mut self, interval: f64, terms: usize) {
        let (high, rows) = (self.high, self.rows);
        self.term.iter_mut().zip(&self.a).for_each(|(term, a)| *term = interval * a);
        self.z.copy_from_slice(&self.term[..high * rows]);
        self.sum.copy_from_slice(&self.term);
        let mut mass_term = -interval;
        self.mass_per_leak = mass_term;
        for outer in &mut self.outer {
            outer.term = outer.exponent;
            outer.change = outer.term;
        }
        for k in 2..=terms {
            let inverse = 1.0 / k as f64;
            for (to, from) in self.next.chunks_exact_mut(high).zip(self.term.chunks_exact(high)) {
                multiply(&self.z, high, &from[..rows], to);
                to.iter_mut().for_each(|to| *to *= inverse);
            }
            self.add_forcing(interval * inverse, mass_term);
            mass_term = -interval * inverse * self.outer[self.leak].term;
            self.mass_per_leak += mass_term;
            for outer in &mut self.outer {
                outer.term *= outer.exponent * inverse;
                outer.change += outer.term;
            }
            std::mem::swap(&mut self.term, &mut self.next);
            self.sum.iter_mut().zip(&self.term).for_each(|(sum, term)| *sum += term);
        }
    }

    /// What the outer states' own motion adds to the next term, in their columns and in the mean's.
    fn add_forcing(&mut self, scale: f64, mass_term: f64) {
        let (high, first) = (self.high, self.rows);
        let (others, mean) = self.next.split_at_mut(high * self.columns.len());
        let acting = |position: usize| &self.a[(first + position) * high..(first + position + 1) * high];
        let mut add = |position: usize, factor: f64, by: &[f64]| {
            let column = first + position;
            axpy(factor, by, &mut others[column * high..(column + 1) * high]);
            axpy(factor * self.outer[position].away, by, mean);
        };
        for (position, outer) in self.outer.iter().enumerate() {
            if outer.term != 0.0 {
                add(position, scale * outer.term, acting(position));
            }
        }
        add(self.leak, scale * mass_term, acting(self.mass));
    }

    /// From an interval to twice as long a one.
    fn double(&mut self) {
        let (high, rows) = (self.high, self.rows);
        self.z.copy_from_slice(&self.sum[..high * rows]);
        for (to, from) in self.next.chunks_exact_mut(high).zip(self.sum.chunks_exact(high)) {
            multiply(&self.z, high, &from[..rows], to);
            to.iter_mut().zip(from).for_each(|(to, from)| *to += 2.0 * from);
        }
        let (others, mean) = self.next.split_at_mut(high * self.columns.len());
        let column = |position: usize| &self.sum[(rows + position) * high..(rows + position + 1) * high];
        let mut add = |position: usize, factor: f64, by: &[f64]| {
            let at = (rows + position) * high;
            axpy(factor, by, &mut others[at..at + high]);
            axpy(factor * self.outer[position].away, by, mean);
        };
        for (position, outer) in self.outer.iter().enumerate() {
            if outer.change != 0.0 {
                add(position, outer.change, column(position));
            }
        }
        add(self.leak, self.mass_per_leak, column(self.mass));
        self.mass_per_leak *= 2.0 + self.outer[self.leak].change;
        for outer in &mut self.outer {
            outer.change *= 2.0 + outer.change;
        }
        std::mem::swap(&mut self.sum, &mut self.next);
    }

    /// Move a state over the step.
    pub fn advance(&self, x: &mut [f64]) {
        let mean = &self.sum[self.high * self.columns.len()..];
        for (state, by) in self.columns[..self.rows].iter().zip(mean) {
            x[*state] += by;
        }
        for outer in &self.outer {
            x[outer.state] += outer.away * outer.change;
        }
        x[self.outer[self.mass].state] += self.outer[self.leak].away * self.mass_per_leak;
    }

    /// Leading rows of the transition matrix: (leading, n).
    pub fn write_phi(&self, phi: &mut DMatrix<f64>) {
        phi.fill(0.0);
        let leading = phi.nrows();
        let block = &self.columns[..self.rows];
        let phi = phi.as_mut_slice();
        for (state, values) in self.columns.iter().zip(self.sum.chunks_exact(self.high)) {
            let column = &mut phi[state * leading..(state + 1) * leading];
            block.iter().zip(values).for_each(|(&row, &value)| column[row] = value);
        }
        for &state in block {
            phi[state * leading + state] += 1.0;
        }
        for outer in &self.outer {
            phi[outer.state * leading + outer.state] = 1.0 + outer.change;
        }
        let (mass, leak) = (self.outer[self.mass].state, self.outer[self.leak].state);
        phi[leak * leading + mass] = self.mass_per_leak;
    }

    /// Noise covariance that the step of `h` seconds adds: (leading, leading), its upper triangle; the rest is zero.
    pub fn write_noise(&mut self, walking: &[Walking], h: f64, q: &mut DMatrix<f64>) {
        q.fill(0.0);
        self.noise.fill(0.0);
        for column in 0..self.rows {
            let intensity = h * walking[self.columns[column]].intensity;
            if intensity > 0.0 {
                self.add_block_source(column, intensity);
            }
        }
        for position in 0..self.outer.len() {
            let intensity = h * walking[self.outer[position].state].intensity;
            if intensity > 0.0 {
                self.add_outer_source(position, intensity, q);
            }
        }
        let block = &self.columns[..self.rows];
        for (values, &column) in self.noise.chunks_exact(self.high).zip(block) {
            for (&row, value) in block.iter().zip(values).filter(|(row, _)| **row <= column) {
                q[(row, column)] = *value;
            }
        }
    }

    fn add_block_source(&mut self, source: usize, intensity: f64) {
        let (high, rows) = (self.high, self.rows);
        self.noise[source * high + source] += SIMPSON[0] * intensity;
        for (weight, points) in [(SIMPSON[1], &mut self.half), (SIMPSON[2], &mut self.sum)] {
            let values = &mut points[source * high..(source + 1) * high];
            values[source] += 1.0;
            add_square(weight * intensity, values, rows, &mut self.noise);
            values[source] -= 1.0;
        }
    }

    fn add_outer_source(&mut self, position: usize, intensity: f64, q: &mut DMatrix<f64>) {
        let (high, rows) = (self.high, self.rows);
        let (outer, mass) = (self.outer[position], self.outer[self.mass].state);
        let (own, block) = (outer.state, &self.columns[..rows]);
        q[(own, own)] += SIMPSON[0] * intensity;
        let middle = (SIMPSON[1], &self.half, 1.0 + outer.half_change, self.half_mass_per_leak);
        let end = (SIMPSON[2], &self.sum, 1.0 + outer.change, self.mass_per_leak);
        for (weight, points, factor, per_leak) in [middle, end] {
            let weight = weight * intensity;
            let values = &points[(rows + position) * high..(rows + position + 1) * high];
            add_square(weight, values, rows, &mut self.noise);
            let couple = |q: &mut DMatrix<f64>, state: usize, factor: f64| {
                for (&row, value) in block.iter().zip(values) {
                    q[(row.min(state), row.max(state))] += weight * factor * value;
                }
            };
            couple(q, own, factor);
            q[(own, own)] += weight * factor * factor;
            if position == self.leak {
                couple(q, mass, per_leak);
                q[(mass, mass)] += weight * per_leak * per_leak;
                q[(mass, own)] += weight * per_leak * factor;
            }
        }
    }
}

/// `to <- to + weight v v^T`.
fn add_square(weight: f64, v: &[f64], rows: usize, to: &mut [f64]) {
    for (to, value) in to.chunks_exact_mut(v.len()).zip(&v[..rows]) {
        axpy(weight * value, v, to);
    }
}

/// Terms after which a series of this norm leaves out no more than the tolerance.
fn terms(norm: f64) -> usize {
    let (mut count, mut left) = (1, norm / 2.0);
    while left > SERIES_TOLERANCE && count < 60 {
        count += 1;
        left *= norm / (count + 1) as f64;
    }
    count
}

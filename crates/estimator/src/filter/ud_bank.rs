//! Factors `P = U diag(d) U^T` of four covariances side by side: filters of one structure that suppose different things.
//!
//! The steps are those of [`UdFactors`] (Bierman's and Thornton's), each in four lanes at once, which costs little more than one filter:
//! small matrices keep a processor waiting for the last result, and four independent ones fill the wait. What is zero by
//! structure stays out: a transition has a [`Pattern`], and its rows keep the range of their elements that may differ from zero. Results do
//! not depend on the registers that a machine has.
//!
//! Source: Bierman 1977 (chapters V, VI), Thornton 1976.
use alloc::vec::Vec;
use core::marker::PhantomData;

use crate::filter::simd::{Arch, Simd, WithSimd};
use nalgebra::DMatrix;
use serde::Deserialize;

use super::lanes::{LANES, Lanes};
use super::ud::UdFactors;

mod factors;
mod pattern;
#[cfg(test)]
mod tests;
mod transition;

pub(crate) use factors::Factors;
pub use pattern::Pattern;
pub(crate) use transition::BankTransition;

/// Numbers of states and of moving states for which loops are unrolled.
pub(crate) trait Unrolled {
    const SIZES: (usize, usize);
}

/// Factors of the covariances of four filters with `n` states.
#[derive(Clone, Debug, Deserialize)]
#[serde(try_from = "Factors")]
pub(crate) struct UdBank {
    n: usize,
    /// States that move.
    leading: usize,
    /// Filters that are kept when it is saved, from the first lane on.
    filters: usize,
    /// Vector registers of this machine.
    arch: Arch,
    /// Columns of `U`, each down to its diagonal in whole groups of four numbers; what is below the diagonal is zero.
    u: Vec<Lanes>,
    /// (n).
    d: Vec<Lanes>,
    /// `U^T h` in an update, `v` in a rank-one update: (n).
    f: Vec<Lanes>,
}

/// Memory of an update, for any bank of as many states.
#[derive(Debug)]
pub(crate) struct UdMemory {
    /// Factors on gain and covariance by which each column changes the other in an update: (n).
    factors: Vec<(Lanes, Lanes)>,
    /// Columns of moving states of `Phi U` and the noise behind them, row by row in pairs: (m, 2 m).
    rows: Vec<[Lanes; 2]>,
    /// Elements of a row that may differ from zero.
    spans: Vec<(usize, usize)>,
    weights: Vec<[Lanes; 2]>,
    weighted: Vec<[Lanes; 2]>,
    moved: Vec<[Lanes; 2]>,
}

impl UdMemory {
    /// For `n` states, of which `leading` move.
    pub(crate) fn new(n: usize, leading: usize) -> Self {
        Self {
            factors: vec![(Lanes::ZERO, Lanes::ZERO); n],
            rows: vec![[Lanes::ZERO; 2]; leading * leading],
            spans: vec![(0, 0); leading],
            weights: vec![[Lanes::ZERO; 2]; leading],
            weighted: vec![[Lanes::ZERO; 2]; leading],
            moved: vec![[Lanes::ZERO; 2]; leading],
        }
    }
}

impl UdBank {
    /// Four times the covariance of `n` states that are known exactly; `leading` of them move.
    pub(crate) fn new(n: usize, leading: usize) -> Self {
        let mut u = vec![Lanes::ZERO; start(n)];
        (0..n).for_each(|j| u[start(j) + j] = Lanes::splat(1.0));
        Self {
            n,
            leading,
            filters: LANES,
            arch: Arch::new(),
            u,
            d: vec![Lanes::ZERO; n],
            f: vec![Lanes::ZERO; n],
        }
    }

    /// Only the first lanes are filters, so many of them: the others do what they do, and are not saved.
    pub(crate) fn with_filters(self, filters: usize) -> Self {
        Self { filters: filters.clamp(1, LANES), ..self }
    }

    /// Whether it is of so many states, moving states and filters.
    pub(crate) fn is_like(&self, states: usize, leading: usize, filters: usize) -> bool {
        [self.n, self.leading, self.filters] == [states, leading, filters]
    }

    /// Let a lane have the covariance of `factors`, of as many states.
    pub(crate) fn set(&mut self, lane: usize, factors: &UdFactors) {
        for (j, from) in factors.unit_upper().column_iter().enumerate() {
            let to = &mut self.u[start(j)..start(j + 1)];
            to.iter_mut().zip(&from).for_each(|(to, &from)| to.0[lane] = from);
        }
        self.d.iter_mut().zip(factors.diagonal()).for_each(|(to, &from)| to.0[lane] = from);
    }

    /// Become as another bank of as many states is, without allocating.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        self.u.copy_from_slice(&other.u);
        self.d.copy_from_slice(&other.d);
    }

    /// Round every factor: still a covariance, whatever is rounded.
    pub(crate) fn round(&mut self, rounded: impl Fn(f64) -> f64) {
        for value in self.u.iter_mut().chain(&mut self.d) {
            value.0 = value.0.map(&rounded);
        }
    }

    /// Let a lane have the covariance of another one.
    pub(crate) fn copy_lane(&mut self, from: usize, to: usize) {
        for value in self.u.iter_mut().chain(&mut self.d) {
            value.0[to] = value.0[from];
        }
    }

    /// Let a lane have the covariance of a lane of another bank, of as many states.
    pub(crate) fn copy_lane_of(&mut self, other: &Self, from: usize, to: usize) {
        for (value, other) in self.u.iter_mut().chain(&mut self.d).zip(other.u.iter().chain(&other.d)) {
            value.0[to] = other.0[from];
        }
    }

    /// Covariance of a lane: (n, n).
    #[cfg(test)]
    pub(crate) fn covariance(&self, lane: usize) -> DMatrix<f64> {
        let mut p = DMatrix::zeros(self.n, self.n);
        self.covariance_into(lane, &mut p);
        p
    }

    /// Write the covariance of a lane: (n, n).
    pub(crate) fn covariance_into(&self, lane: usize, p: &mut DMatrix<f64>) {
        p.fill(0.0);
        for (l, d) in self.d.iter().enumerate() {
            let u = &self.u[start(l)..start(l + 1)];
            for j in 0..=l {
                let factor = d.0[lane] * u[j].0[lane];
                for i in 0..=j {
                    p[(i, j)] += factor * u[i].0[lane];
                }
            }
        }
        p.fill_lower_triangle_with_upper_triangle();
    }

    /// Variance of state `i` of a lane.
    pub(crate) fn variance(&self, lane: usize, i: usize) -> f64 {
        self.covariance_of(lane, i, i)
    }

    /// Covariance of states `i` and `j` of a lane.
    pub(crate) fn covariance_of(&self, lane: usize, i: usize, j: usize) -> f64 {
        let mut sum = 0.0;
        for (l, d) in self.d.iter().enumerate().skip(j.max(i)) {
            let u = &self.u[start(l)..start(l + 1)];
            sum += d.0[lane] * u[i].0[lane] * u[j].0[lane];
        }
        sum
    }

    /// Variance of state `i` of every lane.
    pub(crate) fn variances(&self, i: usize) -> Lanes {
        let mut sum = [Lanes::ZERO; 2];
        for (j, &d) in self.d.iter().enumerate().skip(i) {
            let u = self.u[start(j) + i];
            sum[j % 2] += d * u * u;
        }
        sum[0] + sum[1]
    }

    /// Whether every variance is a number.
    pub(crate) fn is_finite(&self) -> bool {
        self.d.iter().fold(Lanes::ZERO, |sum, &d| sum + d).0.iter().all(|sum| sum.is_finite())
    }

    /// Time update of every lane.
    pub(crate) fn predict<S: Unrolled>(&mut self, transition: &mut BankTransition, memory: &mut UdMemory) {
        self.arch.dispatch(Predict { bank: self, transition, memory, sizes: PhantomData::<S> });
    }

    #[inline(always)]
    fn predict_in_lanes<S: Unrolled>(&mut self, transition: &mut BankTransition, memory: &mut UdMemory) {
        match (self.n, transition.leading()) {
            sizes if sizes == S::SIZES => self.predict_sized(transition, memory, S::SIZES),
            (_, 0) => {}
            sizes => self.predict_sized(transition, memory, sizes),
        }
    }

    /// Of known size its loops are unrolled.
    #[inline(always)]
    fn predict_sized(
        &mut self,
        transition: &mut BankTransition,
        memory: &mut UdMemory,
        (n, m): (usize, usize),
    ) {
        self.transform(transition, memory, (n, m));
        let weights = memory.weights.as_flattened_mut();
        weights[..m].copy_from_slice(&self.d[..m]);
        transition.factor_noise(m, memory.rows.as_flattened_mut(), &mut memory.spans, &mut weights[m..]);
        self.orthogonalise(memory, m);
    }

    /// `Phi U`: its columns of moving states become rows to orthogonalise, those of constants are final.
    #[inline(always)]
    fn transform(&mut self, transition: &BankTransition, memory: &mut UdMemory, (n, m): (usize, usize)) {
        let UdMemory { rows, moved, spans, .. } = memory;
        let u = &mut self.u[..start(n)];
        // An odd last column goes alone.
        for (pair, first) in (0..n).step_by(2).enumerate() {
            let (left, right) = u[start(first)..start((first + 2).min(n))].split_at_mut(length(first));
            let last = (first + 1).min(n - 1);
            let both = [&*left, if right.is_empty() { &*left } else { &*right }];
            transition.multiply(both, last, moved);
            // Where a row's moving states end within the pair, noise takes the place of what is too much.
            if first < m {
                rows.chunks_exact_mut(m).zip(&*moved).for_each(|(row, moved)| row[pair] = *moved);
            }
            for (j, to) in
                [left, right].into_iter().enumerate().filter(|(j, u)| first + j >= m && !u.is_empty())
            {
                to.iter_mut().zip(&*moved).for_each(|(to, moved)| *to = moved[j]);
            }
        }
        for (span, &first) in spans.iter_mut().zip(transition.firsts()) {
            *span = (first, m);
        }
    }

    /// Modified weighted Gram-Schmidt, last row first: `[Phi_xx U_x, G] = U_x' V`, `V diag(weights) V^T = diag(d')`.
    #[inline(always)]
    fn orthogonalise(&mut self, memory: &mut UdMemory, m: usize) {
        let Self { u, d, .. } = self;
        let UdMemory { rows, weights, weighted, spans, .. } = memory;
        for j in (0..m).rev() {
            let (before, row) = rows[..(j + 1) * m].split_at_mut(j * m);
            let span = spans[j];
            // What is outside the span is zero: whole pairs may take part.
            let pairs = span.0 / 2..span.1.div_ceil(2);
            let (row, weighted) = (&row[pairs.clone()], &mut weighted[pairs.clone()]);
            for ((to, value), weight) in weighted.iter_mut().zip(row).zip(&weights[pairs.clone()]) {
                *to = [value[0] * weight[0], value[1] * weight[1]];
            }
            d[j] = dot_pairs(weighted, row);
            let inverse = d[j].inverse();
            let u = &mut u[start(j)..start(j) + j];
            for ((other, u), other_span) in before.chunks_exact_mut(m).zip(u).zip(spans.iter_mut()) {
                let other = &mut other[pairs.clone()];
                let share = dot_pairs(weighted, other) * inverse;
                *u = share;
                subtract(share, row, other);
                *other_span = (other_span.0.min(span.0), other_span.1.max(span.1));
            }
        }
    }

    /// Variances `h^T P h` of linear functions of the state, kept for [`update`](Self::update); `h`: (n).
    pub(crate) fn project<S: Unrolled>(&mut self, h: &[Lanes]) -> Lanes {
        self.arch.dispatch(Project { bank: self, h, sizes: PhantomData::<S> })
    }

    #[inline(always)]
    fn project_in_lanes<S: Unrolled>(&mut self, h: &[Lanes]) -> Lanes {
        match self.n {
            n if n == S::SIZES.0 => self.project_sized(h, S::SIZES.0),
            n => self.project_sized(h, n),
        }
    }

    #[inline(always)]
    fn project_sized(&mut self, h: &[Lanes], n: usize) -> Lanes {
        let Self { u, d, f, .. } = self;
        let u = &u[..start(n)];
        let mut sum = Lanes::ZERO;
        for (j, (&d, f)) in d[..n].iter().zip(f).enumerate() {
            *f = dot(&h[..=j], &u[start(j)..start(j) + j + 1]);
            sum += *f * *f * d;
        }
        sum
    }

    /// Update by scalar measurements with the `h` of the last [`project`](Self::project) and noise of variances `r`, in
    /// the lanes that are `used`. Writes the gains (n), zero in the other lanes, and returns the innovations' variances.
    pub(crate) fn update<S: Unrolled>(
        &mut self,
        r: Lanes,
        used: [bool; 4],
        gain: &mut [Lanes],
        memory: &mut UdMemory,
    ) -> Lanes {
        let factors = &mut memory.factors;
        self.arch.dispatch(Update { bank: self, r, used, gain, factors, sizes: PhantomData::<S> })
    }

    #[inline(always)]
    fn update_sized(
        &mut self,
        r: Lanes,
        used: [bool; 4],
        (gain, factors): (&mut [Lanes], &mut [(Lanes, Lanes)]),
        n: usize,
    ) -> Lanes {
        let gain = &mut gain[..n];
        let mask = Lanes(used.map(|used| if used { 1.0 } else { 0.0 }));
        let Self { u, d, f, .. } = self;
        let (u, d, f, factors) = (&mut u[..start(n)], &mut d[..n], &f[..n], &mut factors[..n]);
        let mut s = r;
        // Where no noise and no variance came before, it is zero, and so is the gain collected so far.
        let mut inverse = r.inverse();
        for ((d, &f), factors) in d.iter_mut().zip(f).zip(factors.iter_mut()) {
            let f = f * mask;
            let v = f * *d;
            *factors = (-f * inverse, v);
            let before = s;
            s += f * v;
            inverse = s.inverse();
            *d = *d * s.choose(before * inverse, Lanes::splat(1.0));
        }
        let inverse = mask * inverse;
        // Four rows at a time: their gain stays in registers. Below the diagonal of U all is zero, and the gain there too.
        for (block, gain) in gain.chunks_mut(4).enumerate() {
            let mut sum = [Lanes::ZERO; 4];
            for (j, &(p, v)) in factors.iter().enumerate().skip(4 * block) {
                let first = start(j) + 4 * block;
                for (u, sum) in u[first..first + 4].iter_mut().zip(&mut sum) {
                    let old = *u;
                    *u += *sum * p;
                    *sum += old * v;
                }
            }
            gain.iter_mut().zip(sum).for_each(|(to, sum)| *to = sum * inverse);
        }
        s
    }

    /// Add variances to state `i`, its covariances unchanged.
    pub(crate) fn inflate(&mut self, i: usize, variance: Lanes) {
        self.f.fill(Lanes::ZERO);
        self.f[i] = Lanes::splat(1.0);
        self.add_leading(variance, i + 1);
    }

    /// Multiply state `i` by a positive factor in every lane: its variances by the square, its covariances by the factor.
    pub(crate) fn scale(&mut self, i: usize, factor: f64) {
        for j in i..self.n {
            let u = &mut self.u[start(j)..start(j + 1)];
            if j == i {
                u[..i].iter_mut().for_each(|above| *above = *above * factor.recip());
            } else {
                u[i] = u[i] * factor;
            }
        }
        self.d[i] = self.d[i] * (factor * factor);
    }

    /// Make state `i` of a lane independent of all others, with the given variance: an event has reset it.
    pub(crate) fn decorrelate_and_set(&mut self, lane: usize, i: usize, variance: f64) {
        for j in i + 1..self.n {
            self.u[start(j) + i].0[lane] = 0.0;
        }
        // What state i explained in the states before it remains theirs.
        self.f.fill(Lanes::ZERO);
        for (f, above) in self.f.iter_mut().zip(&mut self.u[start(i)..][..i]) {
            f.0[lane] = core::mem::take(&mut above.0[lane]);
        }
        let mut left = Lanes::ZERO;
        left.0[lane] = core::mem::replace(&mut self.d[i].0[lane], variance);
        self.add_leading(left, i);
    }

    /// Rank-one update (Agee and Turner) of the leading block of `size` states by `c v v^T` with `v = f[..size]`.
    fn add_leading(&mut self, mut c: Lanes, size: usize) {
        for j in (0..size).rev() {
            let (v, s) = self.f.split_at_mut(j);
            let (s, old) = (s[0], self.d[j]);
            let new = old + c * s * s;
            let inverse = new.inverse();
            let b = c * s * inverse;
            for (u, v) in self.u[start(j)..][..j].iter_mut().zip(v) {
                *v -= s * *u;
                *u += b * *v;
            }
            self.d[j] = new;
            // Where nothing is left to add to, nothing was added.
            c = c * new.choose(old * inverse, Lanes::splat(1.0));
        }
    }
}

/// The steps as what [`Arch::dispatch`] compiles for the vector registers of the machine: closures would not be inlined.
struct Predict<'a, S> {
    sizes: PhantomData<S>,
    bank: &'a mut UdBank,
    transition: &'a mut BankTransition,
    memory: &'a mut UdMemory,
}

struct Project<'a, S> {
    sizes: PhantomData<S>,
    bank: &'a mut UdBank,
    h: &'a [Lanes],
}

struct Update<'a, S> {
    sizes: PhantomData<S>,
    bank: &'a mut UdBank,
    r: Lanes,
    used: [bool; 4],
    gain: &'a mut [Lanes],
    factors: &'a mut [(Lanes, Lanes)],
}

impl<U: Unrolled> WithSimd for Predict<'_, U> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.bank.predict_in_lanes::<U>(self.transition, self.memory);
    }
}

impl<U: Unrolled> WithSimd for Project<'_, U> {
    type Output = Lanes;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Lanes {
        self.bank.project_in_lanes::<U>(self.h)
    }
}

impl<U: Unrolled> WithSimd for Update<'_, U> {
    type Output = Lanes;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Lanes {
        let Self { bank, r, used, gain, factors, .. } = self;
        match bank.n {
            n if n == U::SIZES.0 => bank.update_sized(r, used, (gain, factors), U::SIZES.0),
            n => bank.update_sized(r, used, (gain, factors), n),
        }
    }
}

/// Length of column `j` in memory.
#[inline(always)]
const fn length(j: usize) -> usize {
    4 * (j / 4 + 1)
}

/// Where column `j` begins: the length of all before it.
#[inline(always)]
const fn start(j: usize) -> usize {
    let (groups, rest) = (j / 4, j % 4);
    4 * (groups + 1) * (2 * groups + rest)
}

/// `sum a_i b_i`, in four sums that do not wait for each other.
#[inline(always)]
fn dot(a: &[Lanes], b: &[Lanes]) -> Lanes {
    let ((a4, a1), (b4, b1)) = (a.as_chunks::<4>(), b.as_chunks::<4>());
    let mut sum = [Lanes::ZERO; 4];
    for (a, b) in a4.iter().zip(b4) {
        for ((sum, &a), &b) in sum.iter_mut().zip(a).zip(b) {
            *sum += a * b;
        }
    }
    for ((sum, &a), &b) in sum.iter_mut().zip(a1).zip(b1) {
        *sum += a * b;
    }
    (sum[0] + sum[2]) + (sum[1] + sum[3])
}

/// The same for whole pairs.
#[inline(always)]
fn dot_pairs(a: &[[Lanes; 2]], b: &[[Lanes; 2]]) -> Lanes {
    let ((a4, a2), (b4, b2)) = (a.as_chunks::<2>(), b.as_chunks::<2>());
    let mut sum = [[Lanes::ZERO; 2]; 2];
    for (a, b) in a4.iter().zip(b4) {
        for ((sum, a), b) in sum.iter_mut().zip(a).zip(b) {
            sum[0] += a[0] * b[0];
            sum[1] += a[1] * b[1];
        }
    }
    if let ([a], [b]) = (a2, b2) {
        sum[0][0] += a[0] * b[0];
        sum[0][1] += a[1] * b[1];
    }
    (sum[0][0] + sum[1][0]) + (sum[0][1] + sum[1][1])
}

/// `y <- y - c x`.
#[inline(always)]
fn subtract(c: Lanes, x: &[[Lanes; 2]], y: &mut [[Lanes; 2]]) {
    for (x, y) in x.iter().zip(y) {
        y[0] -= c * x[0];
        y[1] -= c * x[1];
    }
}

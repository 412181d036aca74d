//! Factors `P = U diag(d) U^T` of four covariances side by side: filters of one structure that suppose different things.
//!
//! The steps are those of [`UdFactors`] (Bierman's and Thornton's), each in four lanes at once, which costs little more than one filter:
//! small matrices keep a processor waiting for the last result, and four independent ones fill the wait. What is zero by
//! structure stays out: a transition has a [`Pattern`], and its rows keep the range of their elements that may differ from zero.
use nalgebra::{DMatrix, Dyn};
use pulp::{Arch, Simd, WithSimd};

use super::lanes::Lanes;
use super::ud::UdFactors;

mod pattern;
#[cfg(test)]
mod tests;
mod transition;

pub use pattern::Pattern;
pub use transition::BankTransition;

/// Factors of the covariances of four filters with `n` states, with the memory that their updates work in.
#[derive(Clone, Debug)]
pub struct UdBank {
    n: usize,
    /// Vector registers of this machine.
    arch: Arch,
    /// Columns of `U`: (n, n).
    u: Vec<Lanes>,
    /// (n).
    d: Vec<Lanes>,
    /// `U^T h` in an update, `v` in a rank-one update.
    f: Vec<Lanes>,
    /// Columns of moving states of `Phi U` and the noise behind them, row by row: (m, 2 m).
    rows: Vec<Lanes>,
    /// Elements of a row that may differ from zero.
    spans: Vec<(usize, usize)>,
    weights: Vec<Lanes>,
    weighted: Vec<Lanes>,
    moved: Vec<Lanes>,
}

impl UdBank {
    /// Four times the covariance of `n` states that are known exactly; `leading` of them move.
    pub fn new(n: usize, leading: usize) -> Self {
        let mut u = vec![Lanes::ZERO; n * n];
        u.iter_mut().step_by(n + 1).for_each(|one| *one = Lanes::splat(1.0));
        Self {
            n,
            arch: Arch::new(),
            u,
            d: vec![Lanes::ZERO; n],
            f: vec![Lanes::ZERO; n],
            rows: vec![Lanes::ZERO; 2 * leading * leading],
            spans: vec![(0, 0); leading],
            weights: vec![Lanes::ZERO; 2 * leading],
            weighted: vec![Lanes::ZERO; 2 * leading],
            moved: vec![Lanes::ZERO; leading],
        }
    }

    /// Let a lane have the covariance of `factors`, of as many states.
    pub fn set(&mut self, lane: usize, factors: &UdFactors<Dyn>) {
        let from = factors.unit_upper().iter().chain(factors.diagonal());
        for (to, &from) in self.u.iter_mut().chain(&mut self.d).zip(from) {
            to.0[lane] = from;
        }
    }

    /// Let a lane have the covariance of another one.
    pub fn copy_lane(&mut self, from: usize, to: usize) {
        for value in self.u.iter_mut().chain(&mut self.d) {
            value.0[to] = value.0[from];
        }
    }

    /// Let a lane have the covariance of a lane of another bank, of as many states.
    pub fn copy_lane_of(&mut self, other: &Self, from: usize, to: usize) {
        for (value, other) in self.u.iter_mut().chain(&mut self.d).zip(other.u.iter().chain(&other.d)) {
            value.0[to] = other.0[from];
        }
    }

    /// Covariance of a lane: (n, n).
    pub fn covariance(&self, lane: usize) -> DMatrix<f64> {
        let mut p = DMatrix::zeros(self.n, self.n);
        self.covariance_into(lane, &mut p);
        p
    }

    /// Write the covariance of a lane: (n, n).
    pub fn covariance_into(&self, lane: usize, p: &mut DMatrix<f64>) {
        let n = self.n;
        p.fill(0.0);
        for (l, (u, d)) in self.u.chunks_exact(n).zip(&self.d).enumerate() {
            for j in 0..=l {
                let factor = d.0[lane] * u[j].0[lane];
                for i in 0..=j {
                    p[(i, j)] += factor * u[i].0[lane];
                }
            }
        }
        p.fill_lower_triangle_with_upper_triangle();
    }

    /// Variances of state `i`.
    pub fn variances(&self, i: usize) -> Lanes {
        let mut sum = Lanes::ZERO;
        for (u, &d) in self.u.chunks_exact(self.n).zip(&self.d).skip(i) {
            sum += d * u[i] * u[i];
        }
        sum
    }

    /// Whether every variance is a number.
    pub fn is_finite(&self) -> bool {
        self.d.iter().flat_map(|d| d.0).all(f64::is_finite)
    }

    /// Time update of every lane.
    pub fn predict(&mut self, transition: &mut BankTransition) {
        self.arch.dispatch(Predict { bank: self, transition });
    }

    #[inline(always)]
    fn predict_in_lanes(&mut self, transition: &mut BankTransition) {
        let m = transition.leading();
        self.transform(transition);
        self.weights[..m].copy_from_slice(&self.d[..m]);
        transition.factor_noise(&mut self.rows, &mut self.spans, &mut self.weights[m..]);
        self.orthogonalise(m);
    }

    /// `Phi U`: its columns of moving states become rows to orthogonalise, those of constants are final.
    #[inline(always)]
    fn transform(&mut self, transition: &BankTransition) {
        let (n, m) = (self.n, transition.leading());
        let Self { u, rows, moved, spans, .. } = self;
        for (j, u) in u.chunks_exact_mut(n).enumerate() {
            transition.multiply(&u[..=j], moved);
            if j >= m {
                u[..m].copy_from_slice(moved);
                continue;
            }
            for (row, &value) in rows.chunks_exact_mut(2 * m).zip(moved.iter()) {
                row[j] = value;
            }
        }
        for (row, span) in spans.iter_mut().enumerate() {
            *span = (transition.first(row), m);
        }
    }

    /// Modified weighted Gram-Schmidt, last row first: `[Phi_xx U_x, G] = U_x' V`, `V diag(weights) V^T = diag(d')`.
    #[inline(always)]
    fn orthogonalise(&mut self, m: usize) {
        let Self { n, u, d, rows, weights, weighted, spans, .. } = self;
        for j in (0..m).rev() {
            let (before, row) = rows[..(j + 1) * 2 * m].split_at_mut(j * 2 * m);
            let (low, high) = spans[j];
            let (row, weighted) = (&row[low..high], &mut weighted[low..high]);
            let mut variance = Lanes::ZERO;
            for ((to, &value), &weight) in weighted.iter_mut().zip(row).zip(&weights[low..high]) {
                *to = value * weight;
                variance += *to * value;
            }
            d[j] = variance;
            let inverse = Lanes::splat(1.0).divided_where(variance, f64::MIN_POSITIVE, Lanes::ZERO);
            for ((other, u), span) in
                before.chunks_exact_mut(2 * m).zip(&mut u[j * *n..]).zip(spans.iter_mut())
            {
                let other = &mut other[low..high];
                let share = dot(weighted, other) * inverse;
                *u = share;
                for (other, &value) in other.iter_mut().zip(row) {
                    *other -= share * value;
                }
                *span = (span.0.min(low), span.1.max(high));
            }
        }
    }

    /// Variances `h^T P h` of linear functions of the state, kept for [`update`](Self::update); `h`: (n).
    pub fn project(&mut self, h: &[Lanes]) -> Lanes {
        self.arch.dispatch(Project { bank: self, h })
    }

    #[inline(always)]
    fn project_in_lanes(&mut self, h: &[Lanes]) -> Lanes {
        let n = self.n;
        self.f.fill(Lanes::ZERO);
        for (i, &h) in h.iter().enumerate() {
            if !h.is_zero() {
                for (f, u) in self.f[i..].iter_mut().zip(self.u[i * n + i..].iter().step_by(n)) {
                    *f += h * *u;
                }
            }
        }
        let mut sum = Lanes::ZERO;
        for (&f, &d) in self.f.iter().zip(&self.d) {
            sum += f * f * d;
        }
        sum
    }

    /// Update by scalar measurements with the `h` of the last [`project`](Self::project) and noise of variances `r`, in
    /// the lanes that are `used`. Writes the gains (n), zero in the other lanes, and returns the innovations' variances.
    pub fn update(&mut self, r: Lanes, used: [bool; 4], gain: &mut [Lanes]) -> Lanes {
        self.arch.dispatch(Update { bank: self, r, used, gain })
    }

    #[inline(always)]
    fn update_in_lanes(&mut self, r: Lanes, used: [bool; 4], gain: &mut [Lanes]) -> Lanes {
        let n = self.n;
        let mask = Lanes(used.map(|used| if used { 1.0 } else { 0.0 }));
        gain.fill(Lanes::ZERO);
        let mut s = r;
        for (j, (u, d)) in self.u.chunks_exact_mut(n).zip(&mut self.d).enumerate() {
            let f = self.f[j] * mask;
            let v = f * *d;
            let before = s;
            s += f * v;
            *d = *d * before.divided_where(s, f64::MIN_POSITIVE, Lanes::splat(1.0));
            // Where no noise and no variance came before, the gain collected so far is zero.
            let p = (-f).divided_where(before, f64::MIN_POSITIVE, Lanes::ZERO);
            for (u, gain) in u[..j].iter_mut().zip(gain.iter_mut()) {
                let old = *u;
                *u += *gain * p;
                *gain += old * v;
            }
            gain[j] = v;
        }
        let inverse = mask.divided_where(s, f64::MIN_POSITIVE, Lanes::ZERO);
        gain.iter_mut().for_each(|gain| *gain = *gain * inverse);
        s
    }

    /// Add variances to state `i`, its covariances unchanged.
    pub fn inflate(&mut self, i: usize, variance: Lanes) {
        self.f.fill(Lanes::ZERO);
        self.f[i] = Lanes::splat(1.0);
        self.add_leading(variance, i + 1);
    }

    /// Multiply state `i` by a positive factor in every lane: its variances by the square, its covariances by the factor.
    pub fn scale(&mut self, i: usize, factor: f64) {
        let n = self.n;
        self.u[i * n..i * n + i].iter_mut().for_each(|above| *above = *above * factor.recip());
        self.u[(i + 1) * n..].iter_mut().skip(i).step_by(n).for_each(|right| *right = *right * factor);
        self.d[i] = self.d[i] * (factor * factor);
    }

    /// Make state `i` of a lane independent of all others, with the given variance: an event has reset it.
    pub fn decorrelate_and_set(&mut self, lane: usize, i: usize, variance: f64) {
        let n = self.n;
        for right in self.u[(i + 1) * n..].iter_mut().skip(i).step_by(n) {
            right.0[lane] = 0.0;
        }
        // What state i explained in the states before it remains theirs.
        self.f.fill(Lanes::ZERO);
        for (f, above) in self.f.iter_mut().zip(&mut self.u[i * n..i * n + i]) {
            f.0[lane] = std::mem::take(&mut above.0[lane]);
        }
        let mut left = Lanes::ZERO;
        left.0[lane] = std::mem::replace(&mut self.d[i].0[lane], variance);
        self.add_leading(left, i);
    }

    /// Rank-one update (Agee and Turner) of the leading block of `size` states by `c v v^T` with `v = f[..size]`.
    fn add_leading(&mut self, mut c: Lanes, size: usize) {
        let n = self.n;
        for j in (0..size).rev() {
            let (v, s) = self.f.split_at_mut(j);
            let (s, old) = (s[0], self.d[j]);
            let new = old + c * s * s;
            let b = (c * s).divided_where(new, f64::MIN_POSITIVE, Lanes::ZERO);
            for (u, v) in self.u[j * n..j * n + j].iter_mut().zip(v) {
                *v -= s * *u;
                *u += b * *v;
            }
            self.d[j] = new;
            // Where nothing is left to add to, nothing was added.
            c = c * old.divided_where(new, f64::MIN_POSITIVE, Lanes::splat(1.0));
        }
    }
}

/// The steps as what [`Arch::dispatch`] compiles for the vector registers of the machine: closures would not be inlined.
struct Predict<'a> {
    bank: &'a mut UdBank,
    transition: &'a mut BankTransition,
}

struct Project<'a> {
    bank: &'a mut UdBank,
    h: &'a [Lanes],
}

struct Update<'a> {
    bank: &'a mut UdBank,
    r: Lanes,
    used: [bool; 4],
    gain: &'a mut [Lanes],
}

impl WithSimd for Predict<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.bank.predict_in_lanes(self.transition);
    }
}

impl WithSimd for Project<'_> {
    type Output = Lanes;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Lanes {
        self.bank.project_in_lanes(self.h)
    }
}

impl WithSimd for Update<'_> {
    type Output = Lanes;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Lanes {
        self.bank.update_in_lanes(self.r, self.used, self.gain)
    }
}

/// `sum a_i b_i`.
#[inline(always)]
fn dot(a: &[Lanes], b: &[Lanes]) -> Lanes {
    let ((a2, a1), (b2, b1)) = (a.as_chunks::<2>(), b.as_chunks::<2>());
    let mut sum = [Lanes::ZERO; 2];
    for (a, b) in a2.iter().zip(b2) {
        sum[0] += a[0] * b[0];
        sum[1] += a[1] * b[1];
    }
    for (&a, &b) in a1.iter().zip(b1) {
        sum[0] += a * b;
    }
    sum[0] + sum[1]
}

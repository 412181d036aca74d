//! Response of a model at the output samples and its derivatives by all coefficients, exact for the hold.
//!
//! With `w = [1, s, ..] / a(s) u` (controllable canonical form), `p` the same for an impulse at the start, and `v` the
//! same for the response `x = b w + c p`:
//!
//! `dx/db_j = w_j`, `dx/dc_i = p_i`, `dx/da_i = -v_i`, `dx/d(delay) = -b w'`.
//!
//! `[w, p, v]` is one linear system driven by `u`, so that `v` knows how `x` runs between the samples.
use nalgebra::{DMatrix, SMatrix, SVector};

use super::parametrisation::Coefficients;
use super::problem::Problem;
use super::propagator::Propagators;
use super::schedule::{Piece, Schedule};

/// Response at each output sample.
#[derive(Clone, Debug)]
pub(super) struct Response {
    /// Values, one per output sample.
    pub y: Vec<f64>,
    /// Derivatives by the coefficients: (width, samples).
    pub columns: DMatrix<f64>,
}

/// Response of a model to the input `u` of a problem.
pub(super) fn respond(problem: &Problem, schedule: &Schedule, u: &[f64], k: &Coefficients) -> Response {
    match k.order {
        1 => Run::<3>::new(k, problem, u).finish(schedule),
        2 => Run::<6>::new(k, problem, u).finish(schedule),
        _ => Run::<9>::new(k, problem, u).finish(schedule),
    }
}

/// The system of `[w, p, v]` and its input.
pub(super) fn cascade<const D: usize>(k: &Coefficients) -> (SMatrix<f64, D, D>, SVector<f64, D>) {
    let n = D / 3;
    let (mut f, mut g) = (SMatrix::zeros(), SVector::zeros());
    for chain in 0..3 {
        let last = chain * n + n - 1;
        for i in 0..n {
            f[(last, chain * n + i)] = -k.a[i];
            if i + 1 < n {
                f[(chain * n + i, chain * n + i + 1)] = 1.0;
            }
        }
    }
    for i in 0..n {
        f[(3 * n - 1, i)] = k.b[i];
        f[(3 * n - 1, n + i)] = k.c[i];
    }
    g[n - 1] = 1.0;
    (f, g)
}

struct Run<'a, const D: usize> {
    k: &'a Coefficients,
    u: &'a [f64],
    /// Taken off the input, and what the settled output makes of it.
    base: f64,
    propagators: Propagators<D>,
    state: SVector<f64, D>,
    /// Derivative of `w` by the dead time.
    delayed: SVector<f64, D>,
    response: Response,
}

impl<'a, const D: usize> Run<'a, D> {
    fn new(k: &'a Coefficients, problem: &Problem, u: &'a [f64]) -> Self {
        let (f, g) = cascade(k);
        let mut state = SVector::zeros();
        state[2 * k.order - 1] = 1.0;
        let samples = problem.samples();
        Self {
            k,
            u,
            base: if k.settled { u[0] } else { 0.0 },
            propagators: Propagators::new(f, g),
            state,
            delayed: SVector::zeros(),
            response: Response { y: vec![0.0; samples], columns: DMatrix::zeros(k.width(), samples) },
        }
    }

    fn finish(mut self, schedule: &Schedule) -> Response {
        if let Some(output) = schedule.initial {
            self.record(output);
        }
        for piece in &schedule.pieces {
            self.advance(piece);
            if let Some(output) = piece.output {
                self.record(output);
            }
        }
        self.response
    }

    fn advance(&mut self, piece: &Piece) {
        let n = self.k.order;
        let (from, to) = piece.input(self.u);
        let (from, rise) = (from - self.base, to - from);
        let p = self.propagators.over(piece.duration);
        self.state = p.phi * self.state + p.constant * from + p.rise * rise;
        if !self.k.delay_free {
            return;
        }
        if piece.fresh && piece.left > 0 && piece.to == 0.0 {
            // A held input jumps where its sample acts.
            self.delayed[n - 1] -= self.u[piece.left] - self.u[piece.left - 1];
        }
        self.delayed = p.phi * self.delayed - p.constant * (rise / piece.duration);
        self.delayed.rows_mut(n, 2 * n).fill(0.0);
    }

    fn record(&mut self, output: usize) {
        let (k, n) = (self.k, self.k.order);
        let mut row = self.response.columns.column_mut(output);
        let mut y = k.offset;
        for i in 0..n {
            let (w, p, v) = (self.state[i], self.state[n + i], self.state[2 * n + i]);
            y += k.b[i] * w + k.c[i] * p;
            row[i] = -v;
            row[k.numerator_at() + i] = w;
            row[k.initial_at() + i] = p;
            row[k.dead_time_at()] += k.b[i] * self.delayed[i];
        }
        if k.settled {
            y += k.b[0] / k.a[0] * self.base;
            row[0] -= k.b[0] / (k.a[0] * k.a[0]) * self.base;
            row[k.numerator_at()] += self.base / k.a[0];
        }
        row[k.offset_at()] = 1.0;
        self.response.y[output] = y;
    }
}

/// `[1, s, ..] / a(s)` of a signal given at the output samples and straight between them: (order, samples).
pub(super) fn filter_output(problem: &Problem, k: &Coefficients, signal: &[f64]) -> DMatrix<f64> {
    match k.order {
        1 => chain::<1>(problem, k, signal),
        2 => chain::<2>(problem, k, signal),
        _ => chain::<3>(problem, k, signal),
    }
}

/// The system of one chain and its input.
pub(super) fn companion<const N: usize>(k: &Coefficients) -> (SMatrix<f64, N, N>, SVector<f64, N>) {
    let (mut f, mut g) = (SMatrix::zeros(), SVector::zeros());
    for i in 0..N {
        f[(N - 1, i)] = -k.a[i];
        if i + 1 < N {
            f[(i, i + 1)] = 1.0;
        }
    }
    g[N - 1] = 1.0;
    (f, g)
}

fn chain<const N: usize>(problem: &Problem, k: &Coefficients, signal: &[f64]) -> DMatrix<f64> {
    let (f, g) = companion::<N>(k);
    let mut propagators = Propagators::new(f, g);
    let mut filtered = DMatrix::zeros(N, signal.len());
    let mut q = SVector::<f64, N>::zeros();
    for sample in 1..signal.len() {
        let p = propagators.over(problem.output_time[sample] - problem.output_time[sample - 1]);
        q = p.phi * q + p.constant * signal[sample - 1] + p.rise * (signal[sample] - signal[sample - 1]);
        filtered.column_mut(sample).copy_from_slice(q.as_slice());
    }
    filtered
}

#[cfg(test)]
mod tests;

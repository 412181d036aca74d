//! What white sensor noise adds to the moments of instruments and regressors.
//!
//! Instruments, regressors and errors are linear in the noise of both sensors: `w` and `v` of the response carry that of the input,
//! the filtered errors that of both. Their joint covariance follows the same exact recursion as the signals,
//! `P <- M P M^T + N`, sample by sample, whatever the intervals, hold and order; so the compensation is exact too.
//! For first-order models with regular samples it is the closed form of the state-variable filter's noise gain.
//!
//! Source: Söderström 2007 (section 5) for the principle.
use nalgebra::{DMatrix, DVector};

use super::Hold;
use super::parametrisation::Coefficients;
use super::problem::Problem;
use super::propagator::{Propagator, Propagators};
use super::response::{cascade, companion};
use super::schedule::{Piece, Schedule};

/// Variances of white sensor noise, in the record's units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Variances {
    pub input: f64,
    pub output: f64,
}

/// The noise's part in this many samples in a row must not change for the recursion to have settled.
const SETTLED_SAMPLES: usize = 4;
/// Relative change that counts as none.
const SETTLED: f64 = 1e-15;

/// Sums over the samples of expectations, with the noise in instruments `z`, regressors `phi` and errors `e`.
#[derive(Clone, Debug)]
pub(super) struct NoiseMoments {
    /// `sum E[z phi^T]`: (width, width).
    pub square: DMatrix<f64>,
    /// `sum E[z e]`: (width).
    pub with_error: DVector<f64>,
}

/// Where the instruments come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Instruments {
    /// They are the regressors.
    Regressors,
    /// The model's response: they hold the noise of the input alone.
    Model,
}

/// Moments of the noise in regressors and errors.
pub(super) fn noise_moments(
    problem: &Problem,
    schedule: &Schedule,
    k: &Coefficients,
    variances: Variances,
    instruments: Instruments,
) -> NoiseMoments {
    match k.order {
        1 => Recursion::<1, 3>::new(problem, k, variances, instruments).run(schedule),
        2 => Recursion::<2, 6>::new(problem, k, variances, instruments).run(schedule),
        _ => Recursion::<3, 9>::new(problem, k, variances, instruments).run(schedule),
    }
}

/// Noise state `[w, v, q, u now, u next, e]`, `3 N + 3` long, and its covariance.
struct Recursion<'a, const N: usize, const D: usize> {
    problem: &'a Problem,
    k: &'a Coefficients,
    variances: Variances,
    cascade: Propagators<D>,
    chain: Propagators<N>,
    covariance: DMatrix<f64>,
    /// What the state becomes, linear in what it was at the last sample.
    transition: DMatrix<f64>,
    /// Rows: `z`, and `[phi; e]`, of the state.
    instruments: DMatrix<f64>,
    readout: DMatrix<f64>,
    /// Moments of `z` with `[phi; e]` at the last sample, and their sum.
    moments: DMatrix<f64>,
    sum: DMatrix<f64>,
    last: Option<usize>,
}

impl<'a, const N: usize, const D: usize> Recursion<'a, N, D> {
    const NOW: usize = 3 * N;
    const NEXT: usize = 3 * N + 1;
    const ERROR: usize = 3 * N + 2;
    const SIZE: usize = 3 * N + 3;

    fn new(
        problem: &'a Problem,
        k: &'a Coefficients,
        variances: Variances,
        instruments: Instruments,
    ) -> Self {
        let ((f, g), (fq, gq)) = (cascade::<D>(k), companion::<N>(k));
        let mut readout = DMatrix::zeros(2 * N + 1, Self::SIZE);
        for i in 0..N {
            readout[(i, N + i)] = -1.0;
            readout[(i, 2 * N + i)] = -1.0;
            readout[(N + i, i)] = 1.0;
        }
        readout[(2 * N, Self::ERROR)] = 1.0;
        let mut chosen = readout.rows(0, 2 * N).into_owned();
        if instruments == Instruments::Model {
            (0..N).for_each(|i| chosen[(i, 2 * N + i)] = 0.0);
        }
        let mut covariance = DMatrix::zeros(Self::SIZE, Self::SIZE);
        // The first input sample is the present and, until the first bend, the next one.
        for (i, j) in [
            (Self::NOW, Self::NOW),
            (Self::NOW, Self::NEXT),
            (Self::NEXT, Self::NOW),
            (Self::NEXT, Self::NEXT),
        ] {
            covariance[(i, j)] = variances.input;
        }
        Self {
            problem,
            k,
            variances,
            cascade: Propagators::new(f, g),
            chain: Propagators::new(fq, gq),
            covariance,
            transition: DMatrix::identity(Self::SIZE, Self::SIZE),
            instruments: chosen,
            readout,
            moments: DMatrix::zeros(2 * N, 2 * N + 1),
            sum: DMatrix::zeros(2 * N, 2 * N + 1),
            last: None,
        }
    }

    fn run(mut self, schedule: &Schedule) -> NoiseMoments {
        if let Some(output) = schedule.initial {
            self.sample(output);
        }
        let (mut settled, uniform) = (0, schedule.is_uniform());
        for (index, piece) in schedule.pieces.iter().enumerate() {
            self.piece(piece);
            let Some(output) = piece.output else { continue };
            let before = self.moments.clone();
            self.sample(output);
            let change = (&self.moments - before).amax();
            settled = if change <= SETTLED * self.moments.amax() { settled + 1 } else { 0 };
            if uniform && settled >= SETTLED_SAMPLES {
                self.sum += &self.moments * (schedule.pieces.len() - 1 - index) as f64;
                break;
            }
        }
        self.finish()
    }

    /// Move over a piece; fresh input noise enters where a sample acts.
    fn piece(&mut self, piece: &Piece) {
        if piece.fresh {
            self.enter(piece.left);
        }
        let p = self.cascade.over(piece.duration);
        let share = if piece.from < 1.0 { (piece.to - piece.from) / (1.0 - piece.from) } else { 0.0 };
        let mut step = DMatrix::identity(Self::SIZE, Self::SIZE);
        for (row, i) in (0..N).chain(2 * N..D).enumerate() {
            for (column, j) in (0..N).chain(2 * N..D).enumerate() {
                step[(row, column)] = p.phi[(i, j)];
            }
            step[(row, Self::NOW)] = p.constant[i] - share * p.rise[i];
            step[(row, Self::NEXT)] = share * p.rise[i];
        }
        step[(Self::NOW, Self::NOW)] = 1.0 - share;
        step[(Self::NOW, Self::NEXT)] = share;
        self.transition = step * &self.transition;
    }

    /// A new input sample: it is the next one of a straight input, the present one of a held input.
    fn enter(&mut self, left: usize) {
        let place = match self.problem.hold {
            Hold::First => Self::NEXT,
            Hold::Zero if left > 0 => Self::NOW,
            Hold::Zero => return,
        };
        self.settle();
        self.covariance.row_mut(place).fill(0.0);
        self.covariance.column_mut(place).fill(0.0);
        self.covariance[(place, place)] = self.variances.input;
    }

    fn settle(&mut self) {
        self.covariance = &self.transition * &self.covariance * self.transition.transpose();
        self.transition.fill_with_identity();
    }

    /// An output sample: the error's new value and the filtered error; their moments.
    fn sample(&mut self, output: usize) {
        let mut step = DMatrix::identity(Self::SIZE, Self::SIZE);
        step[(Self::ERROR, Self::ERROR)] = 0.0;
        for i in 0..N {
            step[(Self::ERROR, i)] = -self.k.b[i];
        }
        let mut noise = DMatrix::zeros(Self::SIZE, 1);
        noise[Self::ERROR] = 1.0;
        if let Some(last) = self.last {
            let times = &self.problem.output_time;
            let p: &Propagator<N> = self.chain.over(times[output] - times[last]);
            for i in 0..N {
                for j in 0..N {
                    step[(2 * N + i, 2 * N + j)] = p.phi[(i, j)];
                    step[(2 * N + i, j)] = -p.rise[i] * self.k.b[j];
                }
                step[(2 * N + i, Self::ERROR)] = p.constant[i] - p.rise[i];
                noise[2 * N + i] = p.rise[i];
            }
        }
        self.last = Some(output);
        self.transition = step * &self.transition;
        self.settle();
        self.covariance += &noise * noise.transpose() * self.variances.output;
        self.moments = &self.instruments * &self.covariance * self.readout.transpose();
        self.sum += &self.moments;
    }

    fn finish(self) -> NoiseMoments {
        let width = self.k.width();
        let mut moments =
            NoiseMoments { square: DMatrix::zeros(width, width), with_error: DVector::zeros(width) };
        moments.square.view_mut((0, 0), (2 * N, 2 * N)).copy_from(&self.sum.view((0, 0), (2 * N, 2 * N)));
        moments.with_error.rows_mut(0, 2 * N).copy_from(&self.sum.view((0, 2 * N), (2 * N, 1)));
        moments
    }
}

#[cfg(test)]
mod tests;

//! The extended filter with the gain of its steady state.
//!
//! The leading states are estimated given the constants `c`, which stay where they are. Linearised at one state, over the
//! interval at which samples come, the covariance given the constants settles at the solution of the discrete Riccati equation
//! ([`steady_state`](super::steady_state)), and with it the gain of each output. As long as a sample comes after that interval, is
//! complete, passes its gates, and is about as noisy as the steady state supposes, no covariance moves. Otherwise the covariance
//! given the constants moves as in an extended filter, until it is back.
//!
//! The state of linearisation is that of the first steady state. Where the plant has left it for good, the
//! covariance does not come back; after [`PATIENCE`] complete samples a steady state is sought anew where the plant is.
//!
//! The mean moves by the nonlinear equations. What the constants' uncertainty `B` does to it follows from the sensitivity
//! `E = dx/dc` of the error (Schmidt's consider states), which moves with the actual gradients and gains,
//! `E <- F E + F_c`, `E <- E - K (h^T E + h_c^T)`, and the stated covariance is `P + E B E^T`.
//!
//! Where the outputs do not see every state there is no steady state, and the covariance
//! always moves.
//!
//! Source: Schmidt 1966; Anderson and Moore 1979, chapter 4.
use alloc::boxed::Box;
use alloc::vec::Vec;
use nalgebra::DMatrix;

use super::dense::{add_product, product};
use super::kernel::{axpy, dot};
use super::plant::Plant;
use super::state_space::Linearisation;
use super::ud::UdFactors;
use crate::EstimatorError;
use steady::Steady;

mod steady;

/// Share of the standard deviations within which a covariance counts as that of the steady state.
const SETTLED: f64 = 0.1;
/// Least noise variance with which the steady gain is used, as a share of that which it supposes, the most.
const MIN_NOISE_RATIO: f64 = 0.2;
/// Complete samples out of the steady state after which it is sought anew.
const PATIENCE: u32 = 60;
/// Relative difference within which two intervals are the same.
const SAME_INTERVAL: f64 = 1e-6;
/// Equal intervals in a row that make them the usual one.
const EQUAL_INTERVALS: u32 = 3;

/// Where the covariance given the constants is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// In the factors of the member.
    Moving,
    /// In the steady state, after a sample.
    Settled,
    /// In the steady state, when so many outputs of a sample have been used.
    Within(usize),
}

/// State of the engine in addition to mean and covariance.
#[derive(Clone, Debug)]
pub(super) struct Stationary {
    usual_s: f64,
    /// Interval that has come so many times in a row.
    latest: (f64, u32),
    /// Whether the sample came after the usual interval, and had every reading so far.
    regular: bool,
    /// Regular samples out of the steady state.
    waited: u32,
    steady: Option<Box<Steady>>,
    phase: Phase,
    /// `E`: (leading, constants).
    sensitivity: DMatrix<f64>,
    moved: DMatrix<f64>,
    /// `h^T E + h_c^T`: (constants).
    row: Vec<f64>,
    /// `B`: (constants, constants).
    constants: DMatrix<f64>,
    /// A gain that is not used: (n), and a covariance to compare: (n, n).
    scratch: Vec<f64>,
    compared: DMatrix<f64>,
}

impl Stationary {
    /// `p` becomes the covariance given the constants.
    ///
    /// # Errors
    /// What is left is no covariance.
    pub(super) fn new<P: Plant>(plant: &P, p: &mut UdFactors) -> Result<Self, EstimatorError> {
        let (n, leading) = (plant.states(), plant.leading());
        let count = n - leading;
        let mut covariance = p.covariance();
        let constants = covariance.view((leading, leading), (count, count)).into_owned();
        covariance.columns_mut(leading, count).fill(0.0);
        covariance.rows_mut(leading, count).fill(0.0);
        p.copy_from(&UdFactors::from_covariance(&covariance)?);
        Ok(Self {
            usual_s: f64::NAN,
            latest: (f64::NAN, 0),
            regular: false,
            waited: 0,
            steady: None,
            phase: Phase::Moving,
            sensitivity: DMatrix::zeros(leading, count),
            moved: DMatrix::zeros(leading, count),
            row: vec![0.0; count],
            constants,
            scratch: vec![0.0; n],
            compared: covariance,
        })
    }

    /// A sample comes `dt_s`, s, after the last one.
    pub(super) fn begin(&mut self, p: &mut UdFactors, dt_s: f64) {
        let run = if is_same(dt_s, self.latest.0) { self.latest.1.saturating_add(1) } else { 1 };
        self.latest = (dt_s, run);
        if run == EQUAL_INTERVALS && !is_same(dt_s, self.usual_s) {
            self.unsettle(p);
            (self.usual_s, self.steady, self.waited) = (dt_s, None, 0);
        }
        self.regular = is_same(dt_s, self.usual_s);
        if self.regular && self.phase == Phase::Settled {
            self.phase = Phase::Within(0);
        } else {
            self.unsettle(p);
        }
    }

    /// Move on by a part of the interval.
    pub(super) fn predict(&mut self, linear: &Linearisation, p: &mut UdFactors) {
        self.move_sensitivity(&linear.phi);
        if self.phase == Phase::Moving {
            p.predict(linear);
        }
    }

    /// `E <- F E + F_c` with the transition's leading rows `phi`: (leading, n).
    fn move_sensitivity(&mut self, phi: &DMatrix<f64>) {
        let m = self.sensitivity.nrows();
        let (moving, constant) = phi.as_slice().split_at(m * m);
        self.moved.as_mut_slice().copy_from_slice(constant);
        add_product(self.moved.as_mut_slice(), 1.0, moving, self.sensitivity.as_slice(), m);
        core::mem::swap(&mut self.sensitivity, &mut self.moved);
    }

    /// Variance of an innovation with the gradient `h` (n) and noise `r`, with all that is uncertain.
    pub(super) fn innovation_variance(&mut self, p: &UdFactors, output: usize, h: &[f64], r: f64) -> f64 {
        self.find_row(h);
        let given = match (&self.steady, self.phase) {
            (Some(steady), Phase::Within(_)) => steady.known[output],
            (Some(steady), Phase::Settled) => steady.updated.quadratic(h),
            _ => p.quadratic(h),
        };
        given + self.of_constants(|c| self.row[c]) + r
    }

    /// `h^T E + h_c^T`: derivative of an innovation with the constants.
    fn find_row(&mut self, h: &[f64]) {
        let m = self.sensitivity.nrows();
        for ((row, column), h_c) in
            self.row.iter_mut().zip(self.sensitivity.as_slice().chunks_exact(m)).zip(&h[m..])
        {
            *row = h_c + dot(column, h);
        }
    }

    /// Variance `v^T B v` of a linear function of the constants.
    fn of_constants(&self, v: impl Fn(usize) -> f64) -> f64 {
        let count = self.constants.nrows();
        (0..count)
            .map(|c| v(c) * self.constants.column(c).iter().enumerate().map(|(d, b)| b * v(d)).sum::<f64>())
            .sum()
    }

    /// Gain of a reading with noise of variance `r`; moves the covariance where it is not that of the steady state.
    pub(super) fn update(&mut self, p: &mut UdFactors, output: usize, h: &[f64], r: f64, gain: &mut [f64]) {
        let usual = |steady: &Steady| r <= steady.r[output] && r >= MIN_NOISE_RATIO * steady.r[output];
        let within = self.phase == Phase::Within(output);
        match &self.steady {
            Some(steady) if within && usual(steady) => {
                gain.copy_from_slice(steady.gain.column(output).as_slice());
                let last = output + 1 == steady.r.len();
                self.phase = if last { Phase::Settled } else { Phase::Within(output + 1) };
            }
            steady => {
                // The noise that the steady state supposes, or the covariance would not come back to it.
                let r =
                    steady.as_deref().filter(|&steady| usual(steady)).map_or(r, |steady| steady.r[output]);
                self.unsettle(p);
                p.update(h, r, gain);
            }
        }
        self.correct_sensitivity(h, gain);
    }

    /// `E <- E - K (h^T E + h_c^T)`.
    fn correct_sensitivity(&mut self, h: &[f64], gain: &[f64]) {
        self.find_row(h);
        let m = self.sensitivity.nrows();
        for (column, row) in self.sensitivity.as_mut_slice().chunks_exact_mut(m).zip(&self.row) {
            axpy(-row, gain, column);
        }
    }

    /// Whether the covariance is that of the steady state, after a sample.
    #[cfg(test)]
    pub(super) fn is_settled(&self) -> bool {
        self.phase == Phase::Settled
    }

    /// Leave the steady state: its covariance goes to `p`.
    pub(super) fn unsettle(&mut self, p: &mut UdFactors) {
        let Some(steady) = &self.steady else { return };
        match self.phase {
            Phase::Moving => return,
            Phase::Settled => p.copy_from(&steady.updated),
            Phase::Within(used) => {
                p.copy_from(&steady.predicted);
                for output in 0..used {
                    let h = steady.h.column(output);
                    p.update(h.as_slice(), steady.r[output], &mut self.scratch);
                }
            }
        }
        self.phase = Phase::Moving;
    }

    /// A reading is missing or was rejected.
    pub(super) fn miss(&mut self, p: &mut UdFactors) {
        self.regular = false;
        self.unsettle(p);
    }

    /// Return to the steady state if the covariance has; seek it anew at the state `x` if it has not for long.
    pub(super) fn settle<P: Plant>(&mut self, plant: &mut P, x: &[f64], p: &UdFactors) {
        if self.phase != Phase::Moving || !self.regular {
            return;
        }
        if self.waited.is_multiple_of(PATIENCE) {
            // Without a steady state the covariance goes on moving.
            self.steady = Steady::solve(plant, x, self.usual_s).map(Box::new);
        }
        self.waited += 1;
        let (m, compared) = (self.sensitivity.nrows(), &mut self.compared);
        if self.steady.as_ref().is_some_and(|steady| steady.is_close(p, m, SETTLED, compared)) {
            (self.phase, self.waited) = (Phase::Settled, 1);
        }
    }

    /// Make a state independent of all others, with the given variance. What a constant's error has made of moving states stays theirs.
    pub(super) fn decorrelate_and_set(&mut self, p: &mut UdFactors, state: usize, variance: f64) {
        self.unsettle(p);
        let Some(constant) = state.checked_sub(self.sensitivity.nrows()) else {
            self.sensitivity.row_mut(state).fill(0.0);
            p.decorrelate_and_set(state, variance);
            return;
        };
        let before = self.constants[(constant, constant)];
        for (moving, &by) in self.sensitivity.column(constant).iter().enumerate() {
            p.inflate(moving, by * by * before);
        }
        self.sensitivity.column_mut(constant).fill(0.0);
        self.constants.row_mut(constant).fill(0.0);
        self.constants.column_mut(constant).fill(0.0);
        self.constants[(constant, constant)] = variance;
    }

    /// A constant's error has become smaller by a factor; the error that it made has not.
    pub(super) fn relax(&mut self, state: usize, factor: f64) {
        let constant = state - self.sensitivity.nrows();
        self.constants.row_mut(constant).iter_mut().for_each(|b| *b *= factor);
        self.constants.column_mut(constant).iter_mut().for_each(|b| *b *= factor);
        self.sensitivity.column_mut(constant).iter_mut().for_each(|e| *e /= factor);
    }

    /// Add `variance` to a constant.
    pub(super) fn inflate(&mut self, state: usize, variance: f64) {
        let constant = state - self.sensitivity.nrows();
        self.constants[(constant, constant)] += variance;
    }

    /// Variance of a state, with all that is uncertain.
    pub(super) fn variance(&self, p: &UdFactors, state: usize) -> f64 {
        let m = self.sensitivity.nrows();
        if state >= m {
            return self.constants[(state - m, state - m)];
        }
        let given = match (&self.steady, self.phase) {
            (Some(steady), Phase::Settled | Phase::Within(_)) => steady.covariance[(state, state)],
            _ => p.variance(state),
        };
        given + self.of_constants(|c| self.sensitivity[(state, c)])
    }

    /// Covariance of a state with all states, with all that is uncertain: (n).
    pub(super) fn write_column(&self, p: &UdFactors, state: usize, column: &mut [f64]) {
        let (m, count) = self.sensitivity.shape();
        match (&self.steady, self.phase) {
            (Some(steady), Phase::Settled | Phase::Within(_)) => {
                column.copy_from_slice(steady.covariance.column(state).as_slice());
            }
            _ => p.write_column(state, column),
        }
        let (leading, constants) = column.split_at_mut(m);
        if state >= m {
            leading.fill(0.0);
        }
        for (c, with) in constants.iter_mut().enumerate() {
            let of = |other: usize| {
                if state < m { self.sensitivity[(state, other)] } else { f64::from(other == state - m) }
            };
            *with = (0..count).map(|other| self.constants[(c, other)] * of(other)).sum();
            axpy(*with, self.sensitivity.column(c).as_slice(), leading);
        }
    }

    /// Covariance of all states, with all that is uncertain: (n, n).
    pub(super) fn covariance(&self, p: &UdFactors) -> DMatrix<f64> {
        let (m, count) = self.sensitivity.shape();
        let mut covariance = match (&self.steady, self.phase) {
            (Some(steady), Phase::Settled | Phase::Within(_)) => steady.covariance.clone(),
            _ => p.covariance(),
        };
        let cross = product(&self.sensitivity, &self.constants);
        let mut leading = covariance.view_mut((0, 0), (m, m));
        leading += product(&cross, &self.sensitivity.transpose());
        covariance.view_mut((0, m), (m, count)).copy_from(&cross);
        covariance.view_mut((m, 0), (count, m)).copy_from(&cross.transpose());
        covariance.view_mut((m, m), (count, count)).copy_from(&self.constants);
        covariance
    }
}

fn is_same(interval_s: f64, other_s: f64) -> bool {
    (interval_s - other_s).abs() <= SAME_INTERVAL * other_s
}

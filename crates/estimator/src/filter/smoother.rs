//! Smoothing: the state at each time given the samples before and after it.
//!
//! Modified Bryson-Frazier recursion, backwards from the last sample with `lambda = 0`, `Lambda = 0`. At a scalar
//! update with gain `K`, innovation `nu` and its variance `S`, with `C = I - K h^T`:
//!
//! `lambda <- C^T lambda - h nu / S`, `Lambda <- C^T Lambda C + h h^T / S`,
//!
//! at a transition `lambda <- F^T lambda`, `Lambda <- F^T Lambda F`, and after each update `x_s = x - P lambda`,
//! `P_s = P - P Lambda P`. Nothing is inverted: constants, states without noise and singular covariances are no
//! exceptions. On a nonlinear process this smooths about the filter's trajectory.
//!
//! Source: Bierman 1973; Bryson and Ho 1969.
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector};

use super::dense::{add_product, symmetrise, transposed_product};
use super::kernel::{axpy, column, dot};
use super::record::StepRecord;

/// A smoothed state.
#[derive(Clone, Debug, PartialEq)]
pub struct Smoothed {
    /// State: (n).
    pub x: DVector<f64>,
    /// Its covariance: (n, n).
    pub p: DMatrix<f64>,
}

/// Smooth a recorded pass over its whole interval; `records` in the order of time, the start first.
///
/// The last smoothed state is that of the filter.
pub fn smooth(records: &[StepRecord]) -> Vec<Smoothed> {
    let Some(last) = records.last() else { return Vec::new() };
    let mut backward = Backward::new(last.x.len());
    let mut smoothed = Vec::with_capacity(records.len());
    for record in records.iter().rev() {
        let mut at_step = Smoothed { x: record.x.clone(), p: record.p.clone() };
        backward.estimate(record, &mut at_step);
        smoothed.push(at_step);
        backward.pass_step(record);
    }
    smoothed.reverse();
    smoothed
}

/// What the samples after a time say about the state at that time.
#[derive(Clone, Debug)]
pub(crate) struct Backward {
    /// `lambda`: (n).
    adjoint: Vec<f64>,
    /// `Lambda`: (n, n).
    information: Vec<f64>,
    /// Memory: (n), (n, n), (n, n).
    vector: Vec<f64>,
    product: Vec<f64>,
    product_2: Vec<f64>,
}

impl Backward {
    pub(crate) fn new(n: usize) -> Self {
        Self {
            adjoint: vec![0.0; n],
            information: vec![0.0; n * n],
            vector: vec![0.0; n],
            product: vec![0.0; n * n],
            product_2: vec![0.0; n * n],
        }
    }

    /// No samples.
    pub(crate) fn clear(&mut self) {
        self.adjoint.fill(0.0);
        self.information.fill(0.0);
    }

    /// Smoothed state after the update of `step`.
    pub(crate) fn estimate(&mut self, step: &StepRecord, smoothed: &mut Smoothed) {
        let (n, p) = (step.x.len(), step.p.as_slice());
        smoothed.x.copy_from(&step.x);
        add_product(smoothed.x.as_mut_slice(), -1.0, p, &self.adjoint, n);
        self.product.fill(0.0);
        add_product(&mut self.product, 1.0, &self.information, p, n);
        smoothed.p.copy_from(&step.p);
        add_product(smoothed.p.as_mut_slice(), -1.0, p, &self.product, n);
        symmetrise(smoothed.p.as_mut_slice(), n);
    }

    /// From after a step to after the step before it.
    pub(crate) fn pass_step(&mut self, step: &StepRecord) {
        if step.replaced {
            self.clear();
            return;
        }
        for &(state, force) in &step.bounded {
            self.push(state, force);
        }
        for output in (0..step.used.len()).rev() {
            if step.used[output] {
                self.pass_update(step, output);
            }
            step.freed_by.iter().filter(|(by, _)| *by == output).for_each(|(_, state)| self.forget(*state));
        }
        step.freed.iter().for_each(|&state| self.forget(state));
        for (state, &factor) in step.relaxed.iter().enumerate().filter(|(_, factor)| **factor != 1.0) {
            self.scale(state, factor);
        }
        if step.interval_s > 0.0 {
            self.pass_transition(&step.phi);
        }
        symmetrise(&mut self.information, step.x.len());
    }

    /// State `i` became `factor` times itself.
    fn scale(&mut self, i: usize, factor: f64) {
        let n = self.adjoint.len();
        self.adjoint[i] *= factor;
        self.information[i * n..(i + 1) * n].iter_mut().for_each(|value| *value *= factor);
        self.information[i..].iter_mut().step_by(n).for_each(|value| *value *= factor);
    }

    /// The estimate was moved by `force P e_i`, its covariance stayed: smoothed estimates of before know nothing of that.
    fn push(&mut self, i: usize, force: f64) {
        self.adjoint[i] -= force;
    }

    /// State `i` was made independent of its past: what comes after says nothing of what it was before.
    fn forget(&mut self, i: usize) {
        let n = self.adjoint.len();
        self.adjoint[i] = 0.0;
        self.information[i * n..(i + 1) * n].fill(0.0);
        self.information[i..].iter_mut().step_by(n).for_each(|value| *value = 0.0);
    }

    fn pass_update(&mut self, step: &StepRecord, output: usize) {
        let n = step.x.len();
        let (h, gain) = (column(step.h.as_slice(), n, output), column(step.gain.as_slice(), n, output));
        let variance = step.variance[output];
        let c = dot(gain, &self.adjoint) + step.innovation[output] / variance;
        axpy(-c, h, &mut self.adjoint);
        self.vector.fill(0.0);
        add_product(&mut self.vector, 1.0, &self.information, gain, n);
        let square = dot(gain, &self.vector) + 1.0 / variance;
        for (j, column) in self.information.chunks_exact_mut(n).enumerate() {
            axpy(square * h[j] - self.vector[j], h, column);
            axpy(-h[j], &self.vector, column);
        }
    }

    /// `lambda <- F^T lambda`, `Lambda <- F^T Lambda F` with `F = [phi; 0 I]`.
    fn pass_transition(&mut self, phi: &DMatrix<f64>) {
        let (m, n) = phi.shape();
        if m == 0 {
            return;
        }
        let phi = phi.as_slice();
        self.product.fill(0.0);
        add_product(&mut self.product, 1.0, &self.information[..n * m], phi, n);
        for j in m..n {
            axpy(1.0, column(&self.information, n, j), &mut self.product[j * n..(j + 1) * n]);
        }
        for (moved, rows) in self.product_2.chunks_exact_mut(n).zip(self.product.chunks_exact(n)) {
            transposed_product(moved, phi, &rows[..m], m);
            axpy(1.0, &rows[m..], &mut moved[m..]);
        }
        core::mem::swap(&mut self.information, &mut self.product_2);
        transposed_product(&mut self.vector, phi, &self.adjoint[..m], m);
        axpy(1.0, &self.adjoint[m..], &mut self.vector[m..]);
        core::mem::swap(&mut self.adjoint, &mut self.vector);
    }
}

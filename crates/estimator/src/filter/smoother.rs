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
use nalgebra::{DMatrix, DVector};

use super::dense::{add_product, symmetrise, transposed_product};
use super::gate::Outcome;
use super::kalman::ExtendedKalman;
use super::kernel::{axpy, column, dot};
use super::state_space::StateSpace;

/// One step of a filter as the smoother needs it: plain data.
#[derive(Clone, Debug, PartialEq)]
pub struct PassStep {
    /// Interval since the step before, s.
    pub interval_s: f64,
    /// Leading rows of the transition from the step before: (leading, n).
    pub phi: DMatrix<f64>,
    /// Gradients of the outputs, in the order of their updates: (n, outputs).
    pub h: DMatrix<f64>,
    /// Gains of the outputs: (n, outputs).
    pub gain: DMatrix<f64>,
    /// Innovations: (outputs).
    pub innovation: DVector<f64>,
    /// Their variances: (outputs).
    pub variance: DVector<f64>,
    /// Which outputs were used.
    pub used: Vec<bool>,
    /// State after the update: (n).
    pub x: DVector<f64>,
    /// Covariance after the update: (n, n).
    pub p: DMatrix<f64>,
}

impl PassStep {
    /// A step that tells nothing: `n` states of which `leading` move, and so many outputs.
    pub fn zeros(n: usize, leading: usize, outputs: usize) -> Self {
        Self {
            interval_s: 0.0,
            phi: DMatrix::zeros(leading, n),
            h: DMatrix::zeros(n, outputs),
            gain: DMatrix::zeros(n, outputs),
            innovation: DVector::zeros(outputs),
            variance: DVector::zeros(outputs),
            used: vec![false; outputs],
            x: DVector::zeros(n),
            p: DMatrix::zeros(n, n),
        }
    }

    /// Become as another step of the same filter, without allocating.
    pub fn copy_from(&mut self, other: &Self) {
        self.interval_s = other.interval_s;
        self.phi.copy_from(&other.phi);
        self.h.copy_from(&other.h);
        self.gain.copy_from(&other.gain);
        self.innovation.copy_from(&other.innovation);
        self.variance.copy_from(&other.variance);
        self.used.clone_from(&other.used);
        self.x.copy_from(&other.x);
        self.p.copy_from(&other.p);
    }
}

/// A smoothed state.
#[derive(Clone, Debug, PartialEq)]
pub struct Smoothed {
    /// State: (n).
    pub x: DVector<f64>,
    /// Its covariance: (n, n).
    pub p: DMatrix<f64>,
}

impl<M: StateSpace> ExtendedKalman<M> {
    /// Record the last step, or the start if there was none.
    pub fn record(&self) -> PassStep {
        let (n, outputs, leading) = (self.state().len(), self.innovations().len(), self.model().leading());
        let mut step = PassStep::zeros(n, leading, outputs);
        let work = self.work();
        step.interval_s = work.dt_s;
        if work.dt_s > 0.0 {
            step.phi.copy_from(&work.linear.phi);
        } else {
            step.phi.fill_with_identity();
        }
        step.h.as_mut_slice().copy_from_slice(&work.h);
        step.gain.as_mut_slice().copy_from_slice(&work.gain);
        for (j, innovation) in self.innovations().iter().enumerate() {
            (step.innovation[j], step.variance[j]) = (innovation.nu, innovation.s);
            step.used[j] = innovation.outcome == Outcome::Accepted;
        }
        step.x.as_mut_slice().copy_from_slice(self.state());
        self.factors().write_covariance(step.p.as_mut_slice());
        step
    }
}

/// Smooth a recorded pass over its whole interval; `steps` as recorded, the start first.
///
/// The last smoothed state is that of the filter.
pub fn smooth_fixed_interval(steps: &[PassStep]) -> Vec<Smoothed> {
    let Some(last) = steps.last() else { return Vec::new() };
    let mut backward = Backward::new(last.x.len());
    let mut smoothed = Vec::with_capacity(steps.len());
    for step in steps.iter().rev() {
        let mut at_step = Smoothed { x: step.x.clone(), p: step.p.clone() };
        backward.estimate(step, &mut at_step);
        smoothed.push(at_step);
        backward.pass(step);
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
    pub fn new(n: usize) -> Self {
        Self {
            adjoint: vec![0.0; n],
            information: vec![0.0; n * n],
            vector: vec![0.0; n],
            product: vec![0.0; n * n],
            product_2: vec![0.0; n * n],
        }
    }

    /// No samples.
    pub fn clear(&mut self) {
        self.adjoint.fill(0.0);
        self.information.fill(0.0);
    }

    /// Smoothed state after the update of `step`.
    pub fn estimate(&mut self, step: &PassStep, smoothed: &mut Smoothed) {
        let (n, p) = (step.x.len(), step.p.as_slice());
        smoothed.x.copy_from(&step.x);
        add_product(smoothed.x.as_mut_slice(), -1.0, p, &self.adjoint, n);
        self.product.fill(0.0);
        add_product(&mut self.product, 1.0, &self.information, p, n);
        smoothed.p.copy_from(&step.p);
        add_product(smoothed.p.as_mut_slice(), -1.0, p, &self.product, n);
        symmetrise(smoothed.p.as_mut_slice(), n);
    }

    /// From after the update of `step` to after the update of the step before.
    pub fn pass(&mut self, step: &PassStep) {
        for (j, used) in step.used.iter().enumerate().rev() {
            if *used {
                self.pass_update(step, j);
            }
        }
        self.pass_interval(step);
    }

    /// From before the update of `step` to after the update of the step before.
    pub fn pass_interval(&mut self, step: &PassStep) {
        if step.interval_s > 0.0 {
            self.pass_transition(&step.phi);
        }
        symmetrise(&mut self.information, step.x.len());
    }

    /// State `i` became `factor` times itself.
    pub fn scale(&mut self, i: usize, factor: f64) {
        let n = self.adjoint.len();
        self.adjoint[i] *= factor;
        self.information[i * n..(i + 1) * n].iter_mut().for_each(|value| *value *= factor);
        self.information[i..].iter_mut().step_by(n).for_each(|value| *value *= factor);
    }

    /// The estimate was moved by `force P e_i`, its covariance stayed: smoothed estimates of before know nothing of that.
    pub fn push(&mut self, i: usize, force: f64) {
        self.adjoint[i] -= force;
    }

    /// State `i` was made independent of its past: what comes after says nothing of what it was before.
    pub fn forget(&mut self, i: usize) {
        let n = self.adjoint.len();
        self.adjoint[i] = 0.0;
        self.information[i * n..(i + 1) * n].fill(0.0);
        self.information[i..].iter_mut().step_by(n).for_each(|value| *value = 0.0);
    }

    pub fn pass_update(&mut self, step: &PassStep, output: usize) {
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
        std::mem::swap(&mut self.information, &mut self.product_2);
        transposed_product(&mut self.vector, phi, &self.adjoint[..m], m);
        axpy(1.0, &self.adjoint[m..], &mut self.vector[m..]);
        std::mem::swap(&mut self.adjoint, &mut self.vector);
    }
}

//! Extended Kalman filter on a [`StateSpace`], with [factors](UdFactors) of its covariance.
//!
//! Prediction: `x <- f(x, dt)`, `P <- F P F^T + G diag(q) G^T`. Update: all outputs are linearised at the prediction
//! and then taken one by one, which equals the vector update, as their noises are independent:
//! `nu = z_j - h_j(x-) - H_j (x - x-)`, `S = H_j P H_j^T + R_j`, `K = P H_j^T / S`, `x <- x + K nu`.
use super::failure::{StepError, check_length, check_linearisation, check_output, check_sample, check_state};
use super::gate::{Innovation, Outcome};
use super::kernel::{axpy, dot};
use super::state_space::{Linearisation, StateSpace};
use super::ud::UdFactors;
use crate::EstimatorError;
use alloc::vec::Vec;

/// Extended Kalman filter.
#[derive(Clone, Debug)]
pub struct ExtendedKalman<M> {
    model: M,
    x: Vec<f64>,
    p: UdFactors,
    innovations: Vec<Innovation>,
    work: Work,
}

/// Memory of a step.
#[derive(Clone, Debug)]
struct Work {
    linear: Linearisation,
    /// Outputs at the prediction, their gradients (n each) and noise variances.
    y: Vec<f64>,
    h: Vec<f64>,
    r: Vec<f64>,
    /// Gain, prediction, and departure from it: (n) each.
    gain: Vec<f64>,
    predicted: Vec<f64>,
    departure: Vec<f64>,
}

impl<M: StateSpace> ExtendedKalman<M> {
    /// Filter of `model` that starts at the state `x` (n) with the covariance `p`.
    ///
    /// # Errors
    /// Lengths differ, or the state is not finite.
    pub fn try_new(model: M, x: &[f64], mut p: UdFactors) -> Result<Self, EstimatorError> {
        let (n, outputs) = (model.states(), model.outputs());
        check_length(x.len(), n)?;
        check_length(p.states(), n)?;
        check_state(x)?;
        p.reserve(model.leading(), model.noises());
        let work = Work {
            linear: Linearisation::zeros(n, model.leading(), model.noises()),
            y: vec![0.0; outputs],
            h: vec![0.0; outputs * n],
            r: vec![0.0; outputs],
            gain: vec![0.0; n],
            predicted: vec![0.0; n],
            departure: vec![0.0; n],
        };
        Ok(Self { x: x.to_vec(), p, innovations: vec![Innovation::MISSING; outputs], work, model })
    }

    /// State `x`: (n).
    pub fn state(&self) -> &[f64] {
        &self.x
    }

    /// Covariance `P`.
    pub fn factors(&self) -> &UdFactors {
        &self.p
    }

    /// The process.
    pub fn model(&self) -> &M {
        &self.model
    }

    /// The process, e.g. to set its known inputs.
    pub fn model_mut(&mut self) -> &mut M {
        &mut self.model
    }

    /// Innovation of each output in the last step, given the outputs used before it: those of one step are uncorrelated.
    pub fn innovations(&self) -> &[Innovation] {
        &self.innovations
    }

    /// Advance by `dt_s`, s, and use the readings `z` (one per output, NaN where there is none).
    ///
    /// # Errors
    /// An argument, the process or an output is unusable; the filter is then as it was before.
    pub fn step(&mut self, dt_s: f64, z: &[f64]) -> Result<&[Innovation], StepError<M::Error>> {
        check_sample(dt_s, z.len(), self.model.outputs())?;
        self.propagate(dt_s)?;
        self.linearise(z)?;
        if dt_s > 0.0 {
            self.p.predict(&self.work.linear);
        }
        self.x.copy_from_slice(&self.work.predicted);
        for (j, z) in z.iter().enumerate() {
            self.innovations[j] = if z.is_finite() { self.correct(j, *z) } else { Innovation::MISSING };
        }
        Ok(&self.innovations)
    }

    /// Predicted state and transition, not yet those of the filter.
    fn propagate(&mut self, dt_s: f64) -> Result<(), StepError<M::Error>> {
        let work = &mut self.work;
        work.predicted.copy_from_slice(&self.x);
        if dt_s > 0.0 {
            let linear = Some(&mut work.linear);
            self.model.propagate(&mut work.predicted, dt_s, linear).map_err(StepError::Model)?;
            check_state(&work.predicted)?;
            check_linearisation(&work.linear)?;
        }
        Ok(())
    }

    /// Outputs and gradients at the prediction, for the readings that are there.
    fn linearise(&mut self, z: &[f64]) -> Result<(), StepError<M::Error>> {
        let (n, work) = (self.x.len(), &mut self.work);
        for (j, h) in work.h.chunks_exact_mut(n).enumerate().filter(|(j, _)| z[*j].is_finite()) {
            work.y[j] = self.model.output(j, &work.predicted, Some(h)).map_err(StepError::Model)?;
            work.r[j] = self.model.noise_variance(j, &work.predicted);
            check_output(j, work.y[j], h, work.r[j])?;
        }
        Ok(())
    }

    /// Scalar update by the reading `z` of output `j`.
    fn correct(&mut self, j: usize, z: f64) -> Innovation {
        let (n, work) = (self.x.len(), &mut self.work);
        let (h, gain) = (&work.h[j * n..(j + 1) * n], &mut work.gain);
        for (d, (x, predicted)) in work.departure.iter_mut().zip(self.x.iter().zip(&work.predicted)) {
            *d = x - predicted;
        }
        let nu = z - work.y[j] - dot(h, &work.departure);
        let s = self.p.update(h, work.r[j], gain);
        axpy(nu, gain, &mut self.x);
        Innovation { nu, s, outcome: Outcome::Accepted }
    }
}

#[cfg(test)]
mod tests;

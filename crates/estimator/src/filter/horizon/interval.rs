//! One interval of a window with the sample at its end, linearised along a trajectory.
//!
//! With `x_i = xhat_i + delta_i`, `w_i = sqrt(q) omega_i` and `x_0 = xbar + S xi` every term of the cost is a square
//! of unit weight: `|xi|^2 + sum |omega_i|^2 + sum |r_ij - a_ij^T delta_i|^2`, subject to
//! `delta_{i+1} = F_i delta_i + G_i sqrt(q) omega_i + c_i` with the defect `c_i = f(xhat_i) - xhat_{i+1}`.
use nalgebra::{DMatrix, DVector};

use super::outcome::HorizonError;
use super::settings::Loss;
use crate::filter::kernel::axpy;
use crate::filter::{Linearisation, StateSpace};

/// One interval, the sample at its end, and both linearised along the trajectory.
#[derive(Clone, Debug)]
pub(super) struct Interval {
    pub dt_s: f64,
    /// Readings, NaN where there is none: (outputs).
    pub z: Vec<f64>,
    /// Transition from the interval's start.
    pub linear: Linearisation,
    /// `G diag(sqrt(q))`: (leading, k).
    pub noise_input: DMatrix<f64>,
    /// `f(xhat_i)`: (n).
    pub advanced: DVector<f64>,
    /// The readings that are there.
    pub readings: Vec<Reading>,
    /// Gradients over the noise's standard deviation, one column per output: (n, outputs).
    pub gradient: DMatrix<f64>,
}

/// A reading, linearised.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reading {
    pub output: usize,
    /// Standard deviation of its noise.
    pub sd: f64,
    /// `r = (z - h(xhat)) / sd`.
    pub residual: f64,
    /// Weight of `r^2` in the quadratic cost; below 1 for an outlier.
    pub weight: f64,
}

impl Interval {
    /// A sample still to be linearised.
    pub(super) fn new<M: StateSpace>(model: &M, dt_s: f64, z: &[f64]) -> Self {
        let (n, leading, k) = (model.states(), model.leading(), model.noises());
        Self {
            dt_s,
            z: z.to_vec(),
            linear: Linearisation::zeros(n, leading, k),
            noise_input: DMatrix::zeros(leading, k),
            advanced: DVector::zeros(n),
            readings: Vec::with_capacity(z.len()),
            gradient: DMatrix::zeros(n, z.len()),
        }
    }

    /// Advance `x` over the interval. No time leaves the state where it is.
    pub(super) fn advance<M: StateSpace>(
        &self,
        model: &mut M,
        x: &mut [f64],
    ) -> Result<(), HorizonError<M::Error>> {
        if self.dt_s > 0.0 {
            model.propagate(x, self.dt_s, None).map_err(HorizonError::Model)?;
        }
        finite(x)
    }

    /// Linearise the transition at `from` and the readings at `to`.
    pub(super) fn linearise<M: StateSpace>(
        &mut self,
        model: &mut M,
        from: &DVector<f64>,
        to: &DVector<f64>,
        loss: Loss,
    ) -> Result<(), HorizonError<M::Error>> {
        self.linearise_transition(model, from)?;
        self.linearise_readings(model, to, loss)
    }

    fn linearise_transition<M: StateSpace>(
        &mut self,
        model: &mut M,
        from: &DVector<f64>,
    ) -> Result<(), HorizonError<M::Error>> {
        self.advanced.copy_from(from);
        if self.dt_s > 0.0 {
            let x = self.advanced.as_mut_slice();
            model.propagate(x, self.dt_s, Some(&mut self.linear)).map_err(HorizonError::Model)?;
        } else {
            self.linear.phi.fill_with_identity();
            self.linear.g.fill(0.0);
            self.linear.q.fill(0.0);
        }
        self.noise_input.copy_from(&self.linear.g);
        for (mut column, q) in self.noise_input.column_iter_mut().zip(&self.linear.q) {
            column *= q.sqrt();
        }
        finite(self.advanced.as_slice())?;
        finite(self.linear.phi.as_slice())?;
        finite(self.noise_input.as_slice())
    }

    fn linearise_readings<M: StateSpace>(
        &mut self,
        model: &mut M,
        to: &DVector<f64>,
        loss: Loss,
    ) -> Result<(), HorizonError<M::Error>> {
        self.readings.clear();
        for (output, &z) in self.z.iter().enumerate().filter(|(_, z)| !z.is_nan()) {
            let variance = model.noise_variance(output, to.as_slice());
            if !(variance > 0.0 && variance.is_finite()) {
                return Err(HorizonError::NoiseVariance { output, variance });
            }
            let sd = variance.sqrt();
            let mut column = self.gradient.column_mut(output);
            let h = column.as_mut_slice();
            let reading = model.output(output, to.as_slice(), Some(&mut *h)).map_err(HorizonError::Model)?;
            h.iter_mut().for_each(|h| *h /= sd);
            let residual = (z - reading) / sd;
            finite(h)?;
            finite(&[residual])?;
            self.readings.push(Reading { output, sd, residual, weight: loss.weight(residual) });
        }
        Ok(())
    }

    /// Residual of a reading after the change `delta` of the state at its sample, linearised.
    pub(super) fn residual_after(&self, reading: &Reading, delta: &DVector<f64>) -> f64 {
        reading.residual - self.gradient.column(reading.output).dot(delta)
    }

    /// Cost of the readings at `x`, with their noise as linearised.
    pub(super) fn reading_cost<M: StateSpace>(
        &self,
        model: &mut M,
        x: &DVector<f64>,
        loss: Loss,
    ) -> Result<f64, HorizonError<M::Error>> {
        let mut cost = 0.0;
        for reading in &self.readings {
            let h = model.output(reading.output, x.as_slice(), None).map_err(HorizonError::Model)?;
            cost += loss.value((self.z[reading.output] - h) / reading.sd);
        }
        Ok(cost)
    }

    /// Add the noise `omega` to the moving states of `x`.
    pub(super) fn add_noise(&self, omega: &DVector<f64>, x: &mut DVector<f64>) {
        for (column, w) in self.noise_input.column_iter().zip(omega) {
            axpy(*w, column.as_slice(), x.as_mut_slice());
        }
    }
}

fn finite<E>(values: &[f64]) -> Result<(), HorizonError<E>> {
    if values.iter().all(|v| v.is_finite()) { Ok(()) } else { Err(HorizonError::NotFinite) }
}

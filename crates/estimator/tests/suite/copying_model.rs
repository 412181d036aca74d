//! A linear process that costs next to nothing: what is left is the filter.
use std::convert::Infallible;

use cylwatch_estimator::filter::{Dimensions, Linearisation, StateSpace};
use nalgebra::DMatrix;

/// A dense, stable process with constant matrices, whatever the interval. It does not allocate in a step.
#[derive(Clone, Debug)]
pub(crate) struct CopyingModel {
    pub linear: Linearisation,
    moved: Vec<f64>,
    /// Gradients of the outputs, one per column.
    pub h: DMatrix<f64>,
    /// Variance of each reading.
    r: f64,
}

impl CopyingModel {
    pub(crate) fn new(states: usize, leading: usize, noises: usize, outputs: usize) -> Self {
        let mut linear = Linearisation::zeros(states, leading, noises);
        let weak = |i: usize, j: usize| 0.1 / (1 + i + 2 * j) as f64;
        linear.phi = DMatrix::from_fn(leading, states, |i, j| if i == j { 0.9 } else { weak(i, j) });
        linear.g = DMatrix::from_fn(leading, noises, |i, j| if i == j % leading { 1.0 } else { 0.05 });
        linear.q.fill(0.01);
        let h =
            DMatrix::from_fn(states, outputs, |i, j| if i == (2 * j) % states { 1.0 } else { weak(j, i) });
        Self::of(linear, h, 0.1)
    }

    /// Of these matrices, with one variance of all readings.
    pub(crate) fn of(linear: Linearisation, h: DMatrix<f64>, r: f64) -> Self {
        Self { moved: vec![0.0; linear.phi.nrows()], linear, h, r }
    }
}

impl StateSpace for CopyingModel {
    type Error = Infallible;

    fn dimensions(&self) -> Dimensions {
        Dimensions {
            states: self.h.nrows(),
            leading: self.moved.len(),
            noises: self.linear.q.len(),
            outputs: self.h.ncols(),
        }
    }

    fn propagate(
        &mut self,
        x: &mut [f64],
        _dt_s: f64,
        linear: Option<&mut Linearisation>,
    ) -> Result<(), Infallible> {
        self.moved.fill(0.0);
        for (phi, x) in self.linear.phi.as_slice().chunks_exact(self.moved.len()).zip(x.iter()) {
            self.moved.iter_mut().zip(phi).for_each(|(moved, phi)| *moved += phi * x);
        }
        x[..self.moved.len()].copy_from_slice(&self.moved);
        if let Some(linear) = linear {
            linear.phi.copy_from(&self.linear.phi);
            linear.g.copy_from(&self.linear.g);
            linear.q.copy_from(&self.linear.q);
        }
        Ok(())
    }

    fn output(&mut self, j: usize, x: &[f64], h: Option<&mut [f64]>) -> Result<f64, Infallible> {
        let gradient = &self.h.as_slice()[j * x.len()..(j + 1) * x.len()];
        if let Some(h) = h {
            h.copy_from_slice(gradient);
        }
        Ok(gradient.iter().zip(x).map(|(h, x)| h * x).sum())
    }

    fn noise_variance(&self, _j: usize, _x: &[f64]) -> f64 {
        self.r
    }
}

//! The cylinder linearised where it stands, read at regular intervals.
use nalgebra::DMatrix;

use super::Cylinder;
use crate::EstimatorError;
use crate::filter::{Linearisation, StateSpace};

/// Transition and outputs at a state.
#[derive(Clone, Debug)]
pub(crate) struct LinearCylinder {
    /// Transition of the leading states over the interval: (leading, n).
    pub phi: DMatrix<f64>,
    /// Covariance of its noise: (leading, leading).
    pub q: DMatrix<f64>,
    /// Gradients of the outputs: (n, sensors).
    pub h: DMatrix<f64>,
    /// Noise variance of each sensor that is read as often.
    pub r: Vec<f64>,
}

impl Cylinder {
    /// Linearised at a state (n), for samples every `interval_s`, s.
    ///
    /// # Errors
    /// The process refuses the state.
    pub(crate) fn linear_at(
        &mut self,
        point: &[f64],
        interval_s: f64,
    ) -> Result<LinearCylinder, EstimatorError> {
        let (n, sensors) = (self.states(), self.outputs());
        let mut linear = Linearisation::zeros(n, self.leading(), self.noises());
        self.propagate(&mut point.to_vec(), interval_s, Some(&mut linear))?;
        let mut h = DMatrix::zeros(n, sensors);
        for (sensor, mut column) in h.column_iter_mut().enumerate() {
            self.output(sensor, point, Some(column.as_mut_slice()))?;
        }
        let noise = |sensor: usize| {
            let present_s = self.interval_s(sensor);
            self.set_interval_s(sensor, interval_s);
            let variance = self.noise_variance(sensor, point);
            self.set_interval_s(sensor, present_s);
            variance
        };
        let r = (0..sensors).map(noise).collect();
        let q = &linear.g * DMatrix::from_diagonal(&linear.q) * linear.g.transpose();
        Ok(LinearCylinder { phi: linear.phi, q, h, r })
    }
}

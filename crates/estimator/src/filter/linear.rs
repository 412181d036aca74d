//! A plant linearised where it stands, read at regular intervals.
use alloc::vec::Vec;
use nalgebra::DMatrix;

use super::dense::add_product_transposed;
use super::plant::Plant;
use super::state_space::Linearisation;

/// Transition and outputs at a state.
#[derive(Clone, Debug)]
pub(crate) struct LinearSystem {
    /// Transition of the leading states over the interval: (leading, n).
    pub phi: DMatrix<f64>,
    /// Covariance of its noise: (leading, leading).
    pub q: DMatrix<f64>,
    /// Gradients of the outputs: (n, outputs).
    pub h: DMatrix<f64>,
    /// Noise variance of each output that is read as often.
    pub r: Vec<f64>,
}

impl LinearSystem {
    /// `plant` linearised at a state (n), for samples every `interval_s`, s.
    ///
    /// # Errors
    /// The process refuses the state.
    pub(crate) fn at<P: Plant>(plant: &mut P, point: &[f64], interval_s: f64) -> Result<Self, P::Error> {
        let (n, outputs) = (plant.states(), plant.outputs());
        let mut linear = Linearisation::zeros(n, plant.leading(), plant.noises());
        plant.propagate(&mut point.to_vec(), interval_s, Some(&mut linear))?;
        let mut h = DMatrix::zeros(n, outputs);
        for (output, mut column) in h.column_iter_mut().enumerate() {
            plant.output(output, point, Some(column.as_mut_slice()))?;
        }
        let r = (0..outputs).map(|j| plant.noise_variance_at_interval(j, point, interval_s)).collect();
        let (leading, g) = (plant.leading(), linear.g.as_slice());
        let mut q = DMatrix::zeros(leading, leading);
        add_product_transposed(q.as_mut_slice(), g, |noise| linear.q[noise], g, leading, leading);
        Ok(Self { phi: linear.phi, q, h, r })
    }
}

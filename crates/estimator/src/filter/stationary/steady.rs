//! The steady state given the constants.
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector};

use crate::filter::linear::LinearSystem;
use crate::filter::plant::Plant;
use crate::filter::riccati::steady_state;
use crate::filter::ud::UdFactors;

/// Noise variances of the steady state, in those at the point of linearisation.
const MARGIN: f64 = 2.0;

/// The linearised process in its steady state. Covariances are (n, n) with zeros where the constants are.
#[derive(Clone, Debug)]
pub(super) struct Steady {
    /// Gradients of the outputs: (n, outputs).
    pub h: DMatrix<f64>,
    /// Noise variance of each output.
    pub r: Vec<f64>,
    /// Gain of each output when those before it have been used: (n, outputs).
    pub gain: DMatrix<f64>,
    /// Variance of each output's innovation without its noise.
    pub known: Vec<f64>,
    /// Covariance before a sample.
    pub predicted: UdFactors,
    /// Covariance after a sample.
    pub updated: UdFactors,
    /// The same.
    pub covariance: DMatrix<f64>,
}

impl Steady {
    /// Steady state at the state `point` (n) for samples every `interval_s`, s; `None` where the process refuses the state, or the
    /// outputs do not see every state that walks.
    pub(super) fn solve<P: Plant>(plant: &mut P, point: &[f64], interval_s: f64) -> Option<Self> {
        let (n, m, outputs) = (plant.states(), plant.leading(), plant.outputs());
        let LinearSystem { phi, q, h, r } = LinearSystem::at(plant, point, interval_s).ok()?;
        let r: Vec<f64> = r.iter().map(|variance| MARGIN * variance).collect();
        let f = phi.columns(0, m).into_owned();
        let seen = h.rows(0, m).transpose();
        let solution = steady_state(&f, &seen, &q, &DVector::from_column_slice(&r)).ok()?;
        let mut covariance = DMatrix::zeros(n, n);
        covariance.view_mut((0, 0), (m, m)).copy_from(&solution.predicted);
        // A state without noise is known; the solution has rounding errors there.
        for known in (0..m).filter(|&i| q[(i, i)] == 0.0) {
            covariance.row_mut(known).fill(0.0);
            covariance.column_mut(known).fill(0.0);
        }
        let predicted = UdFactors::from_covariance(&covariance).ok()?;
        let mut updated = predicted.clone();
        let mut gain = DMatrix::zeros(n, outputs);
        let update = |(output, r): (usize, &f64)| {
            let mut column = gain.column_mut(output);
            updated.update(h.column(output).as_slice(), *r, column.as_mut_slice()) - r
        };
        let known = r.iter().enumerate().map(update).collect();
        let covariance = updated.covariance();
        Some(Self { h, r, gain, known, predicted, updated, covariance })
    }

    /// Whether no covariance of `p` among the `m` leading states differs by more than a share `tolerance` of the
    /// standard deviations; `now`: (n, n) is memory.
    pub(super) fn is_close(&self, p: &UdFactors, m: usize, tolerance: f64, now: &mut DMatrix<f64>) -> bool {
        let steady = &self.covariance;
        // Variances first: they are cheap, and mostly decide.
        if !(0..m).all(|i| (p.variance(i) - steady[(i, i)]).abs() <= tolerance * steady[(i, i)]) {
            return false;
        }
        p.covariance_into(now);
        (0..m).all(|j| {
            (0..j).all(|i| {
                let scale = libm::sqrt(steady[(i, i)] * steady[(j, j)]);
                (now[(i, j)] - steady[(i, j)]).abs() <= tolerance * scale
            })
        })
    }
}

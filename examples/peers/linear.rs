//! A linear process with constant matrices: what is left of an estimator's time is the estimator.
use cylwatch::estimator::filter::{Dimensions, Linearisation, StateSpace};
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};
use std::convert::Infallible;

/// `x <- F x + w`, `w ~ N(0, G diag(q) G^T)`, `z = H x + v`, `v ~ N(0, diag(R))`, a prior `N(0, P)`, and samples.
///
/// The first rows of `F` are `phi`, the others those of the identity; rows of matrices are lists.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Inputs {
    /// Names of the states.
    pub names: Vec<String>,
    /// Time between samples, s.
    pub interval_s: f64,
    /// Leading rows of `F`: (leading, n).
    pub phi: Vec<Vec<f64>>,
    /// `G`: (leading, k).
    pub g: Vec<Vec<f64>>,
    /// Variances of the noise sources: (k).
    pub q: Vec<f64>,
    /// `H`: (outputs, n).
    pub h: Vec<Vec<f64>>,
    /// Variances of the readings: (outputs).
    pub r: Vec<f64>,
    /// Covariance of the prior: (n, n).
    pub prior: Vec<Vec<f64>>,
    /// Readings by sample: (samples, outputs).
    pub readings: Vec<Vec<f64>>,
}

/// Rows of a matrix.
pub(crate) fn rows(of: &DMatrix<f64>) -> Vec<Vec<f64>> {
    of.row_iter().map(|row| row.iter().copied().collect()).collect()
}

/// Matrix of rows.
pub(crate) fn matrix(rows: &[Vec<f64>]) -> DMatrix<f64> {
    let columns = rows.first().map_or(0, Vec::len);
    DMatrix::from_fn(rows.len(), columns, |i, j| rows[i][j])
}

/// The process of the inputs.
#[derive(Clone, Debug)]
pub(crate) struct Process {
    linear: Linearisation,
    h: Vec<Vec<f64>>,
    r: Vec<f64>,
    moved: Vec<f64>,
}

impl Process {
    /// Of the inputs' matrices.
    pub(crate) fn new(inputs: &Inputs) -> Self {
        let (phi, g) = (matrix(&inputs.phi), matrix(&inputs.g));
        Self {
            moved: vec![0.0; phi.nrows()],
            linear: Linearisation { phi, g, q: inputs.q.clone().into() },
            h: inputs.h.clone(),
            r: inputs.r.clone(),
        }
    }

    /// Standard deviations of the noise sources.
    pub(crate) fn noise_sd(&self) -> Vec<f64> {
        self.linear.q.iter().map(|q| q.sqrt()).collect()
    }

    /// Add `G w` to the leading states.
    pub(crate) fn disturb(&self, x: &mut [f64], w: &[f64]) {
        for (column, w) in self.linear.g.column_iter().zip(w) {
            x.iter_mut().zip(column.iter()).for_each(|(x, g)| *x += g * w);
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl StateSpace for Process {
    type Error = Infallible;

    fn dimensions(&self) -> Dimensions {
        Dimensions {
            states: self.linear.phi.ncols(),
            leading: self.moved.len(),
            noises: self.linear.q.len(),
            outputs: self.h.len(),
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
        if let Some(h) = h {
            h.copy_from_slice(&self.h[j]);
        }
        Ok(dot(&self.h[j], x))
    }

    fn noise_variance(&self, j: usize, _x: &[f64]) -> f64 {
        self.r[j]
    }
}

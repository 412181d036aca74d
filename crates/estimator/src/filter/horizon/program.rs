//! The small quadratic program behind constraints and outliers.
//!
//! In the posterior `delta = optimum + T eta` the cost of leaving the unconstrained optimum is `|eta|^2 / 2`. Only the
//! span of the derivatives `T^T c` of the rows and readings in problem can lower anything, so `eta = B v` with an
//! orthonormal basis `B` of that span, and with rows scaled to unit standard deviation the problem is
//!
//! `min |v|^2/2 + sum_j [(s_j^2 + (1 - omega_j) t_j^2)/2 - s_j t_j + delta |s_j|]`, `t = r - L v`, subject to `C v <= gap`,
//!
//! with `r` the readings' residuals at the optimum, `omega` the weights that they had there and the slack `s_j` the part of
//! a residual in the linear branch of Huber's loss: `rho(t) = min_s (t - s)^2/2 + delta |s|`. It is convex, since
//! `L^T diag(omega) L <= I`. Without outliers it is the projection on the constraints in the posterior's metric.
use nalgebra::{DMatrix, DVector};

use crate::filter::kernel::{axpy, dot};

/// Orthonormal basis of derivatives `T^T c`, grown as rows come.
#[derive(Clone, Debug, Default)]
pub(super) struct Basis {
    vectors: Vec<Vec<f64>>,
}

/// Share of a derivative outside the basis below which it counts as inside: rounding of two projections.
const DEPENDENCE_TOLERANCE: f64 = 1e-10;

impl Basis {
    pub(super) fn rank(&self) -> usize {
        self.vectors.len()
    }

    /// Coordinates of `t`, after growing the basis if `t` is not in its span. Later vectors have coordinate zero.
    pub(super) fn coordinates(&mut self, t: &[f64]) -> Vec<f64> {
        let mut rest = t.to_vec();
        let mut coordinates = vec![0.0; self.vectors.len()];
        // The second pass removes what rounding of the first left behind.
        for _ in 0..2 {
            for (c, b) in coordinates.iter_mut().zip(&self.vectors) {
                let along = dot(b, &rest);
                axpy(-along, b, &mut rest);
                *c += along;
            }
        }
        let left = dot(&rest, &rest).sqrt();
        if left > DEPENDENCE_TOLERANCE * dot(t, t).sqrt() {
            rest.iter_mut().for_each(|r| *r /= left);
            self.vectors.push(rest);
            coordinates.push(left);
        }
        coordinates
    }

    /// What of `t` is orthogonal to the basis.
    pub(super) fn reject(&self, t: &[f64]) -> Vec<f64> {
        let mut rest = t.to_vec();
        for _ in 0..2 {
            for b in &self.vectors {
                axpy(-dot(b, &rest), b, &mut rest);
            }
        }
        rest
    }

    /// `eta = B v`, of length `drives`.
    pub(super) fn combine(&self, v: &[f64], drives: usize) -> Vec<f64> {
        let mut eta = vec![0.0; drives];
        for (v, b) in v.iter().zip(&self.vectors) {
            axpy(*v, b, &mut eta);
        }
        eta
    }
}

/// A constraint row in coordinates of the basis, scaled to unit posterior standard deviation.
#[derive(Clone, Debug)]
pub(super) struct Row {
    pub coordinates: Vec<f64>,
    /// How far the optimum is inside, standard deviations.
    pub gap: f64,
}

/// A reading that may be an outlier, in coordinates of the basis.
#[derive(Clone, Debug)]
pub(super) struct Suspect {
    pub coordinates: Vec<f64>,
    /// Residual at the optimum without constraints.
    pub residual: f64,
    /// Weight that it has in that optimum.
    pub weight: f64,
}

/// The program; sizes: rank of the basis, rows, suspects.
#[derive(Clone, Debug)]
pub(super) struct Program {
    pub rank: usize,
    pub rows: Vec<Row>,
    pub suspects: Vec<Suspect>,
    /// Bend of Huber's loss; infinite without one.
    pub delta: f64,
}

/// Its solution.
#[derive(Clone, Debug)]
pub(super) struct Optimum {
    /// Coordinates: (rank).
    pub v: DVector<f64>,
    /// Multipliers of the scaled rows, not negative: (rows).
    pub multipliers: DVector<f64>,
    /// Slacks `s`: (suspects).
    pub slacks: DVector<f64>,
}

impl Program {
    /// `C`: (rows, rank).
    pub(super) fn row_matrix(&self) -> DMatrix<f64> {
        dense(self.rank, self.rows.iter().map(|r| r.coordinates.as_slice()))
    }

    /// `L`: (suspects, rank).
    pub(super) fn suspect_matrix(&self) -> DMatrix<f64> {
        dense(self.rank, self.suspects.iter().map(|s| s.coordinates.as_slice()))
    }

    pub(super) fn gaps(&self) -> DVector<f64> {
        DVector::from_iterator(self.rows.len(), self.rows.iter().map(|r| r.gap))
    }

    pub(super) fn residuals(&self) -> DVector<f64> {
        DVector::from_iterator(self.suspects.len(), self.suspects.iter().map(|s| s.residual))
    }

    /// `1 - omega`: (suspects).
    pub(super) fn missing_weights(&self) -> DVector<f64> {
        DVector::from_iterator(self.suspects.len(), self.suspects.iter().map(|s| 1.0 - s.weight))
    }

    /// Hessian with `v`: `I + L^T diag(1 - omega) L`.
    pub(super) fn hessian(&self, l: &DMatrix<f64>, missing: &DVector<f64>) -> DMatrix<f64> {
        DMatrix::identity(self.rank, self.rank) + l.tr_mul(&(DMatrix::from_diagonal(missing) * l))
    }
}

fn dense<'a>(columns: usize, rows: impl ExactSizeIterator<Item = &'a [f64]>) -> DMatrix<f64> {
    let mut matrix = DMatrix::zeros(rows.len(), columns);
    for (i, row) in rows.enumerate() {
        for (j, value) in row.iter().enumerate() {
            matrix[(i, j)] = *value;
        }
    }
    matrix
}

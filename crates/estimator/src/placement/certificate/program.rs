//! Linear and second-order cone programs on Clarabel.
//!
//! `min 1/2 x^T P x + q^T x` under `A x = b`, `A x <= b` and `|v| <= u` for affine `(u, v)`.
use clarabel::solver::{
    DefaultSolver, IPSolver, NonnegativeConeT, SecondOrderConeT, SolverStatus, SupportedConeT, ZeroConeT,
};

use crate::EstimatorError;
use crate::cone::{settings, sparse};

/// `sum of factors times variables` against a number.
#[derive(Clone, Debug)]
pub(super) struct Row {
    pub factors: Vec<(usize, f64)>,
    pub bound: f64,
}

impl Row {
    pub(super) fn new(factors: Vec<(usize, f64)>, bound: f64) -> Self {
        Self { factors, bound }
    }
}

/// A program.
#[derive(Clone, Debug)]
pub(super) struct ConeProgram {
    variables: usize,
    /// Upper triangle of `P`: row, column, value.
    pub quadratic: Vec<(usize, usize, f64)>,
    pub linear: Vec<f64>,
    pub equal: Vec<Row>,
    pub at_most: Vec<Row>,
    /// Each cone: rows that stand for `factors x + bound`, the first one at least as large as the rest together.
    pub cones: Vec<Vec<Row>>,
}

/// A solution.
#[derive(Clone, Debug)]
pub(super) struct Solved {
    pub x: Vec<f64>,
    /// Value of the dual program: not above the optimum.
    pub dual: f64,
}

impl ConeProgram {
    pub(super) fn new(variables: usize) -> Self {
        Self {
            variables,
            quadratic: Vec::new(),
            linear: vec![0.0; variables],
            equal: Vec::new(),
            at_most: Vec::new(),
            cones: Vec::new(),
        }
    }

    /// Solve it.
    pub(super) fn solve(&self) -> Result<Solved, EstimatorError> {
        let mut entries = Vec::new();
        let mut b = Vec::new();
        let mut put = |row: &Row, sign: f64, b: &mut Vec<f64>| {
            entries.extend(row.factors.iter().map(|(column, value)| (b.len(), *column, sign * value)));
            b.push(row.bound);
        };
        self.equal.iter().chain(&self.at_most).for_each(|row| put(row, 1.0, &mut b));
        // In Clarabel's form `b - A x` lies in the cone.
        self.cones.iter().flatten().for_each(|row| put(row, -1.0, &mut b));
        let mut cones: Vec<SupportedConeT<f64>> =
            vec![ZeroConeT(self.equal.len()), NonnegativeConeT(self.at_most.len())];
        cones.extend(self.cones.iter().map(|rows| SecondOrderConeT(rows.len())));
        let p = sparse(self.variables, self.variables, self.quadratic.clone());
        let a = sparse(b.len(), self.variables, entries);
        let mut solver = DefaultSolver::new(&p, &self.linear, &a, &b, &cones, settings())
            .map_err(|_| EstimatorError::PlacementProgram { what: "it could not be set up" })?;
        solver.solve();
        let solution = &solver.solution;
        match solution.status {
            SolverStatus::Solved | SolverStatus::AlmostSolved => {
                Ok(Solved { x: solution.x.clone(), dual: solution.obj_val_dual })
            }
            SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => {
                let what = "number, groups, distances and budget cannot all be met".to_owned();
                Err(EstimatorError::PlacementConstraints { what })
            }
            _ => Err(EstimatorError::PlacementProgram { what: "the solver did not come to an end" }),
        }
    }
}

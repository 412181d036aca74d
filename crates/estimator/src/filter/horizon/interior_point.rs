//! The small program on Clarabel, an interior-point solver.
//!
//! Variables `[v, s+, s-]` with `s = s+ - s-`, all in standard deviations, so that the solver's tolerances are relative
//! to what matters. It has no warm start; the program is small instead.
use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus};
use nalgebra::{DMatrix, DVector};

use super::outcome::FallbackReason;
use super::program::{Optimum, Program};
use crate::cone::{settings, sparse};

/// What the solver returns.
#[derive(Clone, Debug)]
pub(super) struct Solved {
    pub optimum: Optimum,
    pub iterations: usize,
    /// Ended at the solver's reduced accuracy.
    pub almost: bool,
}

/// Solve the program; the optimum is polished afterwards.
///
/// # Errors
/// Why there is no solution.
pub(super) fn solve(program: &Program) -> Result<Solved, FallbackReason> {
    let scale = scale(program);
    let (hessian, q) = objective(program, scale);
    let (a, b) = inequalities(program, scale);
    let settings = DefaultSettings { presolve_enable: false, ..settings() };
    let cones = [NonnegativeConeT(b.len())];
    let mut solver = DefaultSolver::new(&upper_csc(&hessian), &q, &csc(&a), &b, &cones, settings)
        .map_err(|_| FallbackReason::Solver)?;
    solver.solve();
    let solution = &solver.solution;
    let almost = match solution.status {
        SolverStatus::Solved => false,
        SolverStatus::AlmostSolved => true,
        SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => {
            return Err(FallbackReason::Infeasible);
        }
        _ => return Err(FallbackReason::Solver),
    };
    let (rank, suspects) = (program.rank, program.suspects.len());
    let (v, split) = solution.x.split_at(rank);
    let (plus, minus) = split.split_at(suspects);
    let optimum = Optimum {
        v: DVector::from_column_slice(v) * scale,
        multipliers: DVector::from_column_slice(&solution.z[..program.rows.len()]) * scale,
        slacks: DVector::from_iterator(suspects, plus.iter().zip(minus).map(|(p, m)| (p - m) * scale)),
    };
    Ok(Solved { optimum, iterations: solution.iterations as usize, almost })
}

/// Size of the solution: the program is solved in these units, since the solver's tests of feasibility are made for
/// unknowns of order one.
fn scale(program: &Program) -> f64 {
    let gaps = program.rows.iter().map(|row| -row.gap);
    gaps.chain(program.suspects.iter().map(|s| s.residual.abs())).fold(1.0, f64::max)
}

/// Hessian and gradient over `[v, s+, s-] / scale`.
fn objective(program: &Program, scale: f64) -> (DMatrix<f64>, Vec<f64>) {
    let (rank, m) = (program.rank, program.suspects.len());
    let (l, missing, r) = (program.suspect_matrix(), program.missing_weights(), program.residuals() / scale);
    let mut hessian = DMatrix::zeros(rank + 2 * m, rank + 2 * m);
    hessian.view_mut((0, 0), (rank, rank)).copy_from(&program.hessian(&l, &missing));
    hessian.view_mut((0, rank), (rank, m)).copy_from(&l.transpose());
    hessian.view_mut((0, rank + m), (rank, m)).copy_from(&(-l.transpose()));
    for j in rank..rank + m {
        hessian[(j, j)] = 1.0;
        hessian[(j + m, j + m)] = 1.0;
        hessian[(j, j + m)] = -1.0;
    }
    let mut q = (-l.tr_mul(&missing.component_mul(&r))).as_slice().to_vec();
    q.extend(r.iter().map(|r| program.delta / scale - r));
    q.extend(r.iter().map(|r| program.delta / scale + r));
    (hessian, q)
}

/// `A [v, s+, s-] <= b`: the rows, then `s+, s- >= 0`.
fn inequalities(program: &Program, scale: f64) -> (DMatrix<f64>, Vec<f64>) {
    let (rank, m, rows) = (program.rank, program.suspects.len(), program.rows.len());
    let mut a = DMatrix::zeros(rows + 2 * m, rank + 2 * m);
    a.view_mut((0, 0), (rows, rank)).copy_from(&program.row_matrix());
    a.view_mut((rows, rank), (2 * m, 2 * m)).fill_diagonal(-1.0);
    let mut b = (program.gaps() / scale).as_slice().to_vec();
    b.resize(rows + 2 * m, 0.0);
    (a, b)
}

fn csc(a: &DMatrix<f64>) -> CscMatrix<f64> {
    compressed(a, |_, _| true)
}

fn upper_csc(a: &DMatrix<f64>) -> CscMatrix<f64> {
    compressed(a, |i, j| i <= j)
}

/// Sparse form of the entries that count.
fn compressed(a: &DMatrix<f64>, counts: impl Fn(usize, usize) -> bool) -> CscMatrix<f64> {
    let entries = (0..a.ncols()).flat_map(|j| (0..a.nrows()).map(move |i| (i, j)));
    let counted = entries.filter(|&(i, j)| counts(i, j)).map(|(i, j)| (i, j, a[(i, j)]));
    sparse(a.nrows(), a.ncols(), counted.collect())
}

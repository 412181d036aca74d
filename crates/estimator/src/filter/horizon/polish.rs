//! The interior-point solution taken to rounding error: with the active rows and the outliers' signs known, the
//! optimum is the solution of one linear system.
use nalgebra::{DMatrix, DVector};

use super::program::{Basis, Optimum, Program};

/// Largest violation of the optimality conditions that still counts as none, standard deviations.
const ROUNDING: f64 = 1e-9;

/// The optimum with the active set of `rough`, or `None` if that does not satisfy the optimality conditions: the set
/// was not clear yet, or the wrong ones of dependent rows were taken to carry the multipliers.
pub(super) fn polish(program: &Program, rough: &Optimum) -> Option<Optimum> {
    let sets = Sets::of(program, rough);
    let optimum = sets.solve(program)?;
    sets.confirm(program, &optimum).then_some(optimum)
}

/// Rows that hold with equality, and outliers with the sign of their residual.
struct Sets {
    active: Vec<usize>,
    outliers: Vec<(usize, f64)>,
}

impl Sets {
    /// Of two complementary quantities the larger is the one that is not zero. Of active rows that depend on each
    /// other, as bounds on a state that no noise moves, those before the dependence carry the multipliers.
    fn of(program: &Program, rough: &Optimum) -> Self {
        let distance = program.gaps() - program.row_matrix() * &rough.v;
        let mut basis = Basis::default();
        let mut independent = |a: &usize| {
            let rank = basis.rank();
            let mut coordinates = program.rows[*a].coordinates.clone();
            coordinates.resize(program.rank, 0.0);
            basis.coordinates(&coordinates);
            basis.rank() > rank
        };
        let pushing = (0..distance.len()).filter(|&a| rough.multipliers[a] > distance[a]);
        let active = pushing.filter(|a| independent(a)).collect();
        let residual = program.residuals() - program.suspect_matrix() * &rough.v;
        let outliers = (0..residual.len())
            .filter(|&j| residual[j].abs() > program.delta)
            .map(|j| (j, residual[j].signum()))
            .collect();
        Self { active, outliers }
    }

    /// Stationarity with `v`, the slacks of the outliers, and the active rows as equalities.
    fn solve(&self, program: &Program) -> Option<Optimum> {
        let (rank, o, a) = (program.rank, self.outliers.len(), self.active.len());
        let (l, c) = (program.suspect_matrix(), program.row_matrix());
        let (missing, r, gaps) = (program.missing_weights(), program.residuals(), program.gaps());
        let mut matrix = DMatrix::zeros(rank + o + a, rank + o + a);
        let mut rhs = DVector::zeros(rank + o + a);
        matrix.view_mut((0, 0), (rank, rank)).copy_from(&program.hessian(&l, &missing));
        rhs.rows_mut(0, rank).copy_from(&l.tr_mul(&missing.component_mul(&r)));
        for (i, &(j, sign)) in self.outliers.iter().enumerate() {
            matrix.view_mut((rank + i, 0), (1, rank)).copy_from(&l.row(j));
            matrix.view_mut((0, rank + i), (rank, 1)).copy_from(&l.row(j).transpose());
            matrix[(rank + i, rank + i)] = 1.0;
            rhs[rank + i] = r[j] - program.delta * sign;
        }
        for (i, &row) in self.active.iter().enumerate() {
            matrix.view_mut((rank + o + i, 0), (1, rank)).copy_from(&c.row(row));
            matrix.view_mut((0, rank + o + i), (rank, 1)).copy_from(&c.row(row).transpose());
            rhs[rank + o + i] = gaps[row];
        }
        let solution = matrix.lu().solve(&rhs)?;
        let mut optimum = Optimum {
            v: solution.rows(0, rank).into_owned(),
            multipliers: DVector::zeros(program.rows.len()),
            slacks: DVector::zeros(program.suspects.len()),
        };
        self.outliers.iter().enumerate().for_each(|(i, &(j, _))| optimum.slacks[j] = solution[rank + i]);
        self.active.iter().enumerate().for_each(|(i, &k)| optimum.multipliers[k] = solution[rank + o + i]);
        Some(optimum)
    }

    /// Whether signs and inequalities are as assumed.
    fn confirm(&self, program: &Program, optimum: &Optimum) -> bool {
        let scale = ROUNDING * (1.0 + optimum.v.amax());
        let feasible = (program.row_matrix() * &optimum.v - program.gaps()).iter().all(|e| *e <= scale);
        let pushing = optimum.multipliers.iter().all(|m| *m >= -scale);
        let outside = self.outliers.iter().all(|&(j, sign)| sign * optimum.slacks[j] >= -scale);
        let residual = program.residuals() - program.suspect_matrix() * &optimum.v;
        let inside = (0..residual.len())
            .filter(|&j| self.outliers.iter().all(|&(k, _)| k != j))
            .all(|j| residual[j].abs() <= program.delta + scale);
        feasible && pushing && outside && inside
    }
}

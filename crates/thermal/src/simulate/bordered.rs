//! Linear solver for a sparse block with a narrow dense border.
//!
//! The wall's cells couple to their neighbours only, but gas, mean wall temperature and ledger sum over all
//! of them: their rows are dense. A general sparse factorisation orders such rows badly and fills (time grew with the
//! 2.4th power of the cells). Block elimination keeps the cost linear: with the matrix `[B E; C D]`, `B` the
//! block of wall and valve, `X = B^-1 E` and the Schur complement `S = D - C X`,
//! `x_2 = S^-1 (r_2 - C B^-1 r_1)`, `x_1 = B^-1 r_1 - X x_2`. Columns of `E` that are empty (the ledger's) cost nothing.
//! `B` is diagonally dominant, so that eliminating it first is stable; it goes to faer's sparse LU, `S` to nalgebra's.
//! A matrix of at most [`DENSE`] rows is all border: a sparse factorisation costs more than it saves there.
use diffsol_la::error::LaError;
use diffsol_la::linear_solver::LinearSolver;
use diffsol_la::matrix::sparsity::{MatrixSparsity, MatrixSparsityRef};
use diffsol_la::{FaerContext, FaerSparseLU, FaerSparseMat, FaerVec, LinearOp, Matrix, MatrixCommon, Vector};
use nalgebra::{DMatrix, DVector, Dyn, LU};

type M = FaerSparseMat<f64>;
type V = FaerVec<f64>;

/// Rows up to which a matrix is factorised as a dense one, by measurement.
const MAX_DENSE_ROWS: usize = 16;

/// Where an entry of the whole matrix belongs, in the order of its values.
#[derive(Clone, Copy, Debug)]
enum Place {
    /// Next value of the sparse block.
    Block,
    /// Border column (index among the non-empty ones), row.
    Right { column: usize, row: usize },
    /// Border row, column.
    Below { row: usize, column: usize },
    /// Corner.
    Corner { row: usize, column: usize },
}

/// The sparse block as an operator that a [`FaerSparseLU`] can read.
struct Block(M);

impl LinearOp for Block {
    type T = f64;
    type V = V;
    type M = M;
    type C = FaerContext;
    fn nrows(&self) -> usize {
        MatrixCommon::nrows(&self.0)
    }
    fn ncols(&self) -> usize {
        MatrixCommon::ncols(&self.0)
    }
    fn context(&self) -> &FaerContext {
        Matrix::context(&self.0)
    }
    fn matrix_inplace(&self, y: &mut M) {
        y.copy_from(&self.0);
    }
    fn sparsity(&self) -> Option<<M as Matrix>::Sparsity> {
        self.0.sparsity().map(|sparsity| MatrixSparsityRef::<M>::to_owned(&sparsity))
    }
}

/// Everything that depends on the pattern.
struct Parts {
    whole: M,
    block: Block,
    places: Vec<Place>,
    /// Border columns that touch the block, as indices into the border.
    touching: Vec<usize>,
    /// `E`, one dense column for each touching border column.
    right: Vec<V>,
    /// `C` as (row, column, value).
    below: Vec<(usize, usize, f64)>,
    corner: DMatrix<f64>,
    schur: Option<LU<f64, Dyn, Dyn>>,
}

/// Sparse block with a dense border; `Default` has no border.
#[derive(Default)]
pub(super) struct BorderedLu {
    border: usize,
    block: FaerSparseLU<f64>,
    parts: Option<Parts>,
}

impl BorderedLu {
    /// For matrices whose last `border` rows and columns are dense.
    pub(super) fn new(border: usize) -> Self {
        Self { border, ..Self::default() }
    }
}

impl Parts {
    fn new(whole: M, border: usize, context: FaerContext) -> Option<Self> {
        let n = MatrixCommon::ncols(&whole) - border;
        let inner = &whole.inner()[0];
        let (starts, rows) = (inner.col_ptr(), inner.row_idx());
        let entries: Vec<(usize, usize)> = (0..n + border)
            .flat_map(|column| rows[starts[column]..starts[column + 1]].iter().map(move |&row| (row, column)))
            .collect();
        let mut touching: Vec<usize> =
            entries.iter().filter(|&&(row, column)| row < n && column >= n).map(|&(_, c)| c - n).collect();
        touching.dedup();
        let places = entries
            .iter()
            .map(|&(row, column)| match (row < n, column < n) {
                (true, true) => Place::Block,
                (true, false) => {
                    let index = touching.partition_point(|&c| c < column - n);
                    Place::Right { column: index, row }
                }
                (false, true) => Place::Below { row: row - n, column },
                (false, false) => Place::Corner { row: row - n, column: column - n },
            })
            .collect();
        let inside = entries.iter().copied().filter(|&(row, column)| row < n && column < n).collect();
        let pattern = <<M as Matrix>::Sparsity as MatrixSparsity<M>>::try_from_indices(n, n, inside).ok()?;
        Some(Self {
            block: Block(M::new_from_sparsity(n, n, Some(pattern), context)),
            right: touching.iter().map(|_| V::zeros(n, context)).collect(),
            touching,
            below: Vec::new(),
            corner: DMatrix::zeros(border, border),
            schur: None,
            whole,
            places,
        })
    }

    fn has_block(&self) -> bool {
        MatrixCommon::ncols(&self.block.0) > 0
    }

    /// Distribute the values of the whole matrix.
    fn scatter(&mut self) {
        self.below.clear();
        self.corner.fill(0.0);
        for column in &mut self.right {
            column.fill(0.0);
        }
        let values = self.whole.inner()[0].val();
        let block = self.block.0.inner_mut()[0].val_mut();
        let mut next = 0;
        for (&value, &place) in values.iter().zip(&self.places) {
            match place {
                Place::Block => {
                    block[next] = value;
                    next += 1;
                }
                Place::Right { column, row } => self.right[column].set_index(row, value),
                Place::Below { row, column } => self.below.push((row, column, value)),
                Place::Corner { row, column } => self.corner[(row, column)] = value,
            }
        }
    }
}

impl LinearSolver<M> for BorderedLu {
    fn set_sparsity<C: LinearOp<V = V, T = f64, M = M, C = FaerContext>>(&mut self, op: &C) {
        let context = *op.context();
        let whole = M::new_from_sparsity(op.nrows(), op.ncols(), op.sparsity(), context);
        if op.nrows() <= MAX_DENSE_ROWS {
            self.border = op.nrows();
        }
        self.parts = Parts::new(whole, self.border, context);
        if let Some(parts) = self.parts.as_ref().filter(|parts| parts.has_block()) {
            self.block.set_sparsity(&parts.block);
        }
    }

    fn set_linearisation<C: LinearOp<V = V, T = f64, M = M, C = FaerContext>>(&mut self, op: &C) {
        let Some(parts) = &mut self.parts else { return };
        op.matrix_inplace(&mut parts.whole);
        parts.scatter();
        if parts.has_block() {
            self.block.set_linearisation(&parts.block);
        }
        let mut schur = parts.corner.clone();
        for (column, &border_column) in parts.right.iter_mut().zip(&parts.touching) {
            // X = B^-1 E in place; a failing solve leaves a column that Newton will not like.
            if self.block.solve_in_place(column).is_err() {
                column.fill(f64::NAN);
            }
            for &(row, inner, value) in &parts.below {
                schur[(row, border_column)] -= value * column.get_index(inner);
            }
        }
        parts.schur = Some(schur.lu());
    }

    fn solve_in_place(&self, x: &mut V) -> Result<(), LaError> {
        let unset = || LaError::Other("the bordered matrix has not been factorised".into());
        let parts = self.parts.as_ref().ok_or_else(unset)?;
        let schur = parts.schur.as_ref().ok_or_else(unset)?;
        let n = MatrixCommon::ncols(&parts.block.0);
        let mut first = V::zeros(n, *x.context());
        for i in 0..n {
            first.set_index(i, x.get_index(i));
        }
        if parts.has_block() {
            self.block.solve_in_place(&mut first)?;
        }
        let mut second = DVector::from_fn(self.border, |i, _| x.get_index(n + i));
        for &(row, column, value) in &parts.below {
            second[row] -= value * first.get_index(column);
        }
        if !schur.solve_mut(&mut second) {
            return Err(LaError::Other("the border's Schur complement is singular".into()));
        }
        for (column, &border_column) in parts.right.iter().zip(&parts.touching) {
            first.axpy(-second[border_column], column, 1.0);
        }
        for i in 0..n {
            x.set_index(i, first.get_index(i));
        }
        for i in 0..self.border {
            x.set_index(n + i, second[i]);
        }
        Ok(())
    }

    /// The solvers here never ask for the transposed problem (adjoints).
    fn solve_transpose_in_place(&self, _x: &mut V) -> Result<(), LaError> {
        Err(LaError::Other("transposed systems are not solved".into()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tridiagonal block with two dense rows and columns and one row without a column.
    fn example(n: usize) -> (Block, DMatrix<f64>) {
        let border = 3;
        let dense = DMatrix::from_fn(n + border, n + border, |i, j| match (i < n, j < n) {
            (true, true) if i == j => 4.0 + i as f64,
            (true, true) if i.abs_diff(j) == 1 => -1.0 - 0.1 * j as f64,
            (true, true) => 0.0,
            (true, false) if j == n + 2 => 0.0,
            (false, false) if i == j => 3.0,
            (false, false) if j == n + 2 => 0.0,
            _ => ((3 * i + 5 * j) % 7) as f64 * 0.3 - 1.0,
        });
        let mut entries = Vec::new();
        for j in 0..n + border {
            entries.extend((0..n + border).filter(|&i| dense[(i, j)] != 0.0).map(|i| (i, j)));
        }
        let pattern = <<M as Matrix>::Sparsity as MatrixSparsity<M>>::try_from_indices(
            n + border,
            n + border,
            entries.clone(),
        );
        let mut matrix = M::new_from_sparsity(n + border, n + border, pattern.ok(), FaerContext::default());
        for (value, &(i, j)) in matrix.inner_mut()[0].val_mut().iter_mut().zip(&entries) {
            *value = dense[(i, j)];
        }
        (Block(matrix), dense)
    }

    #[test]
    fn bordered_solve_is_the_dense_solve() {
        for (n, border) in [(MAX_DENSE_ROWS, 3), (MAX_DENSE_ROWS, 4), (MAX_DENSE_ROWS - 3, 3)] {
            let (op, dense) = example(n);
            let right = DVector::from_fn(n + 3, |i, _| (i as f64).sin() + 0.3);
            let expected = dense.lu().solve(&right).unwrap();
            let mut solver = BorderedLu::new(border);
            solver.set_sparsity(&op);
            solver.set_linearisation(&op);
            let mut x = V::from_vec(right.as_slice().to_vec(), FaerContext::default());
            solver.solve_in_place(&mut x).unwrap();
            for i in 0..n + 3 {
                approx::assert_relative_eq!(
                    x.get_index(i),
                    expected[i],
                    max_relative = 1e-12,
                    epsilon = 1e-13
                );
            }
        }
    }

    #[test]
    fn unset_solver_and_transposed_systems_are_errors() {
        let mut x = V::zeros(3, FaerContext::default());
        assert!(BorderedLu::new(1).solve_in_place(&mut x).is_err());
        assert!(BorderedLu::new(1).solve_transpose_in_place(&mut x).is_err());
    }
}

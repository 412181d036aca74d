//! Clarabel, an interior-point solver for convex programs with cones: how it is set up. What is solved stands where it is stated.
use clarabel::algebra::CscMatrix;
use clarabel::solver::DefaultSettings;

/// Relative accuracy asked for.
const TOLERANCE: f64 = 1e-9;

/// Quiet, on one thread, with the same answer on every machine.
pub(crate) fn settings() -> DefaultSettings<f64> {
    DefaultSettings {
        verbose: false,
        max_threads: 1,
        direct_solve_method: "qdldl".to_string(),
        tol_gap_abs: TOLERANCE,
        tol_gap_rel: TOLERANCE,
        tol_feas: TOLERANCE,
        ..DefaultSettings::default()
    }
}

/// Sparse matrix by columns from entries (row, column, value), of which those at one place are summed and zeros left out.
pub(crate) fn sparse(rows: usize, columns: usize, mut entries: Vec<(usize, usize, f64)>) -> CscMatrix<f64> {
    entries.retain(|(.., value)| *value != 0.0);
    entries.sort_by_key(|(row, column, _)| (*column, *row));
    let (mut starts, mut at, mut values) = (vec![0; columns + 1], Vec::new(), Vec::new());
    let mut last = None;
    for (row, column, value) in entries {
        if last == Some((row, column)) {
            if let Some(sum) = values.last_mut() {
                *sum += value;
            }
            continue;
        }
        last = Some((row, column));
        at.push(row);
        values.push(value);
        starts[column + 1] = at.len();
    }
    for column in 0..columns {
        starts[column + 1] = starts[column + 1].max(starts[column]);
    }
    CscMatrix::new(rows, columns, starts, at, values)
}

//! Dense linear algebra on column-major slices, without allocation; what is zero by structure is left out of products. Sums run in the same order on every machine: products of
//! nalgebra's large matrices do not.
use super::kernel::{axpy, column, dot};
use nalgebra::DMatrix;

/// `A B`.
pub(crate) fn product(a: &DMatrix<f64>, b: &DMatrix<f64>) -> DMatrix<f64> {
    let mut c = DMatrix::zeros(a.nrows(), b.ncols());
    add_product(c.as_mut_slice(), 1.0, a.as_slice(), b.as_slice(), a.nrows());
    c
}

/// `C <- C + c A B`; `A`: (rows, inner), `B`: (inner, columns), `C`: (rows, columns).
pub(crate) fn add_product(c: &mut [f64], factor: f64, a: &[f64], b: &[f64], rows: usize) {
    if rows == 0 || a.is_empty() {
        return;
    }
    let inner = a.len() / rows;
    for (c, b) in c.chunks_exact_mut(rows).zip(b.chunks_exact(inner)) {
        for (a, b) in a.chunks_exact(rows).zip(b).filter(|(_, b)| **b != 0.0) {
            axpy(factor * b, a, c);
        }
    }
}

/// `C <- C + A diag(w) B^T`; `A`: (rows, inner), `B`: (columns, inner), `w`: (inner), `C`: (rows, columns).
pub(crate) fn add_product_transposed(
    c: &mut [f64],
    a: &[f64],
    w: impl Fn(usize) -> f64,
    b: &[f64],
    rows: usize,
    columns: usize,
) {
    if rows == 0 || columns == 0 {
        return;
    }
    for (l, (a, b)) in a.chunks_exact(rows).zip(b.chunks_exact(columns)).enumerate() {
        for (c, b) in c.chunks_exact_mut(rows).zip(b).filter(|(_, b)| **b != 0.0) {
            axpy(w(l) * b, a, c);
        }
    }
}

/// `C <- A^T B`; `A`: (inner, rows), `B`: (inner, columns), `C`: (rows, columns).
pub(crate) fn transposed_product(c: &mut [f64], a: &[f64], b: &[f64], inner: usize) {
    if inner == 0 {
        c.fill(0.0);
        return;
    }
    let rows = a.len() / inner;
    for (c, b) in c.chunks_exact_mut(rows).zip(b.chunks_exact(inner)) {
        for (c, a) in c.iter_mut().zip(a.chunks_exact(inner)) {
            *c = dot(a, b);
        }
    }
}

/// Factors of a square matrix with row exchanges, in place: `L` below the diagonal, `U` on and above it.
///
/// Returns whether the matrix has an inverse; `exchanges`: (n).
#[inline(always)]
pub(crate) fn factor_lu(a: &mut [f64], n: usize, exchanges: &mut [usize]) -> bool {
    for j in 0..n {
        let (left, right) = a.split_at_mut((j + 1) * n);
        let pivot = &mut left[j * n..];
        let largest = (j..n).fold(j, |best, i| if pivot[i].abs() > pivot[best].abs() { i } else { best });
        exchanges[j] = largest;
        let value = pivot[largest];
        if value == 0.0 || !value.is_finite() {
            return false;
        }
        pivot.swap(j, largest);
        pivot[j + 1..].iter_mut().for_each(|l| *l /= value);
        for other in right.chunks_exact_mut(n) {
            other.swap(j, largest);
            axpy(-other[j], &pivot[j + 1..], &mut other[j + 1..]);
        }
        for other in left[..j * n].chunks_exact_mut(n) {
            other.swap(j, largest);
        }
    }
    true
}

/// Solve `R x = b` in place of `b`, for the upper triangle `R` of a column-major matrix (n, n).
pub(crate) fn solve_upper(r: &[f64], n: usize, b: &mut [f64]) {
    for j in (0..n).rev() {
        let r = column(r, n, j);
        b[j] /= r[j];
        let x = b[j];
        axpy(-x, &r[..j], &mut b[..j]);
    }
}

/// Solve `R^T x = b` in place of `b`, for the upper triangle `R` of a column-major matrix (n, n).
pub(crate) fn solve_upper_transposed(r: &[f64], n: usize, b: &mut [f64]) {
    for j in 0..n {
        let r = column(r, n, j);
        b[j] = (b[j] - dot(&r[..j], &b[..j])) / r[j];
    }
}

/// Cholesky factor `R` of `A = R^T R` in place of the upper triangle; `false` if `A` is not positive definite.
pub(crate) fn factor_cholesky(a: &mut [f64], n: usize) -> bool {
    for j in 0..n {
        let (before, rest) = a.split_at_mut(j * n);
        let r = &mut rest[..=j];
        for i in 0..j {
            let other = column(before, n, i);
            r[i] = (r[i] - dot(&other[..i], &r[..i])) / other[i];
        }
        let left = r[j] - dot(&r[..j], &r[..j]);
        if left.is_nan() || left <= 0.0 {
            return false;
        }
        r[j] = libm::sqrt(left);
    }
    true
}

/// Symmetric part of a column-major matrix (n, n).
pub(crate) fn symmetrise(a: &mut [f64], n: usize) {
    for j in 0..n {
        for i in 0..j {
            let mean = 0.5 * (a[j * n + i] + a[i * n + j]);
            a[j * n + i] = mean;
            a[i * n + j] = mean;
        }
    }
}

//! Householder triangularisation of a small dense matrix, in place.
use nalgebra::DMatrix;

use crate::filter::kernel::{axpy, dot};

/// Upper-triangularise the first `pivots` columns of the first `rows` rows by reflections, applied to all columns.
///
/// What is left below the diagonal of those columns is zero. Signs of the diagonal are of no matter here.
pub(super) fn triangularise(a: &mut DMatrix<f64>, rows: usize, pivots: usize) {
    let height = a.nrows();
    let data = a.as_mut_slice();
    for pivot in 0..pivots.min(rows) {
        let (done, rest) = data.split_at_mut((pivot + 1) * height);
        let v = &mut done[pivot * height + pivot..pivot * height + rows];
        let below = dot(&v[1..], &v[1..]);
        if below == 0.0 {
            continue;
        }
        let norm = v[0].hypot(below.sqrt());
        let diagonal = if v[0] > 0.0 { -norm } else { norm };
        v[0] -= diagonal;
        let scale = -2.0 / (v[0] * v[0] + below);
        for column in rest.chunks_exact_mut(height) {
            let column = &mut column[pivot..rows];
            let along = dot(v, column);
            axpy(scale * along, v, column);
        }
        v.fill(0.0);
        v[0] = diagonal;
    }
}

/// `B <- B R^{-1}` for the upper triangle `R` in the leading columns of `r`, whose diagonal must not vanish.
pub(super) fn divide_right(b: &mut DMatrix<f64>, r: &DMatrix<f64>) {
    let rows = b.nrows();
    for j in 0..b.ncols() {
        let (before, rest) = b.as_mut_slice().split_at_mut(j * rows);
        let column = &mut rest[..rows];
        for (i, before) in before.chunks_exact(rows).enumerate() {
            axpy(-r[(i, j)], before, column);
        }
        column.iter_mut().for_each(|b| *b /= r[(j, j)]);
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::dmatrix;

    use super::*;

    #[test]
    fn triangularising_keeps_the_gram_matrix_and_clears_below_the_diagonal() {
        let a = dmatrix![1.0, 2.0, -1.0; 0.0, 0.0, 3.0; 4.0, -2.0, 0.5; -1.0, 7.0, 2.0; 9.0, 9.0, 9.0];
        let mut r = a.clone();
        triangularise(&mut r, 4, 2);
        let top = |m: &DMatrix<f64>| m.rows(0, 4).into_owned();
        let gram = |m: &DMatrix<f64>| m.tr_mul(m);
        assert!((gram(&top(&r)) - gram(&top(&a))).amax() < 1e-12);
        assert!((1..4).all(|i| r[(i, 0)] == 0.0) && (2..4).all(|i| r[(i, 1)] == 0.0));
        assert_eq!(r.row(4), a.row(4), "rows beyond the given ones are none of its business");
    }

    #[test]
    fn columns_without_content_are_left_alone() {
        let mut r = dmatrix![0.0, 1.0; 0.0, 2.0];
        triangularise(&mut r, 2, 1);
        assert_eq!(r, dmatrix![0.0, 1.0; 0.0, 2.0]);
    }

    #[test]
    fn dividing_from_the_right_undoes_the_product() {
        let r = dmatrix![2.0, -1.0, 3.0; 0.0, -4.0, 0.5; 0.0, 0.0, 1.5];
        let b = dmatrix![1.0, 2.0, 3.0; -4.0, 5.0, 6.0];
        let mut product = &b * &r;
        divide_right(&mut product, &r);
        assert!((product - b).amax() < 1e-14);
    }
}

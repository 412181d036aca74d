//! Loops over contiguous columns that every covariance form is made of.
//!
//! Sums run in four interleaved partial sums, so that the compiler may use vector registers; the order of
//! summation depends on the length alone, never on the machine.

/// `sum a_i b_i` over the shorter of the two.
#[inline]
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len().min(b.len());
    let (a4, a1) = a[..n].as_chunks::<4>();
    let (b4, b1) = b[..n].as_chunks::<4>();
    let mut sum = [0.0; 4];
    for (x, y) in a4.iter().zip(b4) {
        for lane in 0..4 {
            sum[lane] += x[lane] * y[lane];
        }
    }
    let tail: f64 = a1.iter().zip(b1).map(|(x, y)| x * y).sum();
    (sum[0] + sum[2]) + (sum[1] + sum[3]) + tail
}

/// `sum h_i (a_i - b_i)` over the shortest of the three.
#[inline]
pub(crate) fn dot_difference(h: &[f64], a: &[f64], b: &[f64]) -> f64 {
    let n = h.len().min(a.len()).min(b.len());
    let ((h4, h1), (a4, a1), (b4, b1)) =
        (h[..n].as_chunks::<4>(), a[..n].as_chunks::<4>(), b[..n].as_chunks::<4>());
    let mut sum = [0.0; 4];
    for ((h, a), b) in h4.iter().zip(a4).zip(b4) {
        for lane in 0..4 {
            sum[lane] += h[lane] * (a[lane] - b[lane]);
        }
    }
    let tail: f64 = h1.iter().zip(a1).zip(b1).map(|((h, a), b)| h * (a - b)).sum();
    (sum[0] + sum[2]) + (sum[1] + sum[3]) + tail
}

/// `y <- y + c x`.
#[inline(always)]
pub(crate) fn axpy(c: f64, x: &[f64], y: &mut [f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += c * x;
    }
}

/// Column `j` of a column-major matrix with `rows` rows.
#[inline]
pub(crate) fn column(a: &[f64], rows: usize, j: usize) -> &[f64] {
    &a[j * rows..(j + 1) * rows]
}

/// Column `j` of a column-major matrix with `rows` rows.
#[inline]
pub(crate) fn column_mut(a: &mut [f64], rows: usize, j: usize) -> &mut [f64] {
    &mut a[j * rows..(j + 1) * rows]
}

/// Smallest multiple of four that holds `n`: the leading dimension of padded work arrays.
#[inline]
pub(crate) fn padded(n: usize) -> usize {
    n.next_multiple_of(4)
}

/// `y <- A x` for `A` with `rows` rows, a multiple of four, and as many columns as `x` has entries.
///
/// Eight rows at a time, then four, stay in registers over all columns.
#[inline]
pub(crate) fn multiply(a: &[f64], rows: usize, x: &[f64], y: &mut [f64]) {
    let (eights, four) = y[..rows].as_chunks_mut::<8>();
    let done = 8 * eights.len();
    for (block, y) in eights.iter_mut().enumerate() {
        *y = multiply_rows(a, rows, 8 * block, x);
    }
    if let Some(y) = four.first_chunk_mut::<4>() {
        *y = multiply_rows(a, rows, done, x);
    }
}

/// `N` rows of `A x` from row `first` on.
#[inline]
pub(crate) fn multiply_rows<const N: usize>(a: &[f64], rows: usize, first: usize, x: &[f64]) -> [f64; N] {
    let mut sum = [0.0; N];
    for (column, c) in a.chunks_exact(rows).zip(x) {
        if let Some(values) = column[first..].first_chunk::<N>() {
            for lane in 0..N {
                sum[lane] += c * values[lane];
            }
        }
    }
    sum
}

/// Four numbers side by side.
pub(crate) type Group = [f64; 4];

/// `sum a_i b_i` over groups.
#[inline(always)]
pub(crate) fn dot_groups(a: &[Group], b: &[Group]) -> f64 {
    let mut sum = [0.0; 4];
    for (x, y) in a.iter().zip(b) {
        for lane in 0..4 {
            sum[lane] += x[lane] * y[lane];
        }
    }
    (sum[0] + sum[2]) + (sum[1] + sum[3])
}

//! Loops over contiguous columns that every covariance form is made of.
//!
//! Sums run in four interleaved partial sums, so that the compiler may use vector registers; the order of
//! summation depends on the length alone, never on the machine.

/// `sum a_i b_i` over the shorter of the two.
#[inline(always)]
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

/// Columns of a product that are summed up together.
const GROUP: usize = 4;

/// `C <- A B` of matrices (n, n) that have `high` rows, a multiple of four, of which those of `B` beyond `n` do not count.
///
/// Each element is summed up in the order of the columns of `A`; a block of rows and columns stays in registers meanwhile.
#[inline(always)]
pub(crate) fn multiply_columns(a: &[f64], b: &[f64], high: usize, n: usize, c: &mut [f64]) {
    let mut groups = c.chunks_exact_mut(GROUP * high);
    let mut first = 0;
    for group in &mut groups {
        let mut columns = group.chunks_exact_mut(high);
        if let [Some(c0), Some(c1), Some(c2), Some(c3)] = core::array::from_fn(|_| columns.next()) {
            let b = core::array::from_fn(|k| &column(b, high, first + k)[..n]);
            multiply_group::<GROUP>(a, high, b, [c0, c1, c2, c3]);
        }
        first += GROUP;
    }
    for (c, b) in groups.into_remainder().chunks_exact_mut(high).zip(b[first * high..].chunks_exact(high)) {
        multiply_group::<1>(a, high, [&b[..n]], [c]);
    }
}

/// `Y <- A X` for `A` with `high` rows and columns `X` and `Y`.
#[inline(always)]
fn multiply_group<const N: usize>(a: &[f64], high: usize, x: [&[f64]; N], mut y: [&mut [f64]; N]) {
    for first in (0..high / 8 * 8).step_by(8) {
        multiply_block::<N, 8>(a, high, first, x, &mut y);
    }
    if !high.is_multiple_of(8) {
        multiply_block::<N, 4>(a, high, high / 8 * 8, x, &mut y);
    }
}

/// `ROWS` rows of it from row `first` on.
#[inline(always)]
fn multiply_block<const N: usize, const ROWS: usize>(
    a: &[f64],
    high: usize,
    first: usize,
    x: [&[f64]; N],
    y: &mut [&mut [f64]; N],
) {
    let mut sum = [[0.0; ROWS]; N];
    let n = x[0].len();
    let x = x.map(|x| &x[..n]);
    for (i, column) in a.chunks_exact(high).take(n).enumerate() {
        if let Some(values) = column[first..].first_chunk::<ROWS>() {
            for k in 0..N {
                let c = x[k][i];
                for lane in 0..ROWS {
                    sum[k][lane] += c * values[lane];
                }
            }
        }
    }
    for (y, sum) in y.iter_mut().zip(sum) {
        y[first..first + ROWS].copy_from_slice(&sum);
    }
}

/// `y <- y - A x` for `A` with as many rows as `y`, a multiple of eight; the shorter of `x` and the columns counts.
#[inline(always)]
pub(crate) fn subtract_columns(y: &mut [f64], a: &[f64], x: &[f64]) {
    let rows = y.len();
    let (blocks, rest) = y.as_chunks_mut::<16>();
    let done = 16 * blocks.len();
    for (block, y) in blocks.iter_mut().enumerate() {
        subtract_rows(y, a, rows, 16 * block, x);
    }
    if let Some(y) = rest.first_chunk_mut::<8>() {
        subtract_rows(y, a, rows, done, x);
    }
}

/// `N` rows of it from row `first` on.
#[inline(always)]
fn subtract_rows<const N: usize>(y: &mut [f64; N], a: &[f64], rows: usize, first: usize, x: &[f64]) {
    let mut left = *y;
    for (column, x) in a.chunks_exact(rows).zip(x) {
        if let Some(values) = column[first..].first_chunk::<N>() {
            for lane in 0..N {
                left[lane] -= x * values[lane];
            }
        }
    }
    *y = left;
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

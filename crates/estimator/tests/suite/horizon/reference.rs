//! Dense computations that share nothing with the estimator: the plain Kalman filter, and the window's problem with all
//! states eliminated.
use nalgebra::{DMatrix, DVector};

use super::problems::Linear;

/// Mean and covariance by the textbook Kalman filter with a joint (not sequential) Joseph update.
pub(crate) struct Kalman {
    pub x: DVector<f64>,
    pub p: DMatrix<f64>,
}

impl Kalman {
    pub(crate) fn step(&mut self, problem: &Linear, dt_s: f64, z: &DVector<f64>) {
        let (f, u) = problem.transition(dt_s);
        let noise = problem.noise_input(dt_s);
        self.x = &f * &self.x + u;
        self.p = &f * &self.p * f.transpose() + &noise * noise.transpose();
        let there: Vec<usize> = (0..z.len()).filter(|&j| !z[j].is_nan()).collect();
        if there.is_empty() {
            return;
        }
        let h = problem.h.select_rows(&there);
        let r = DMatrix::from_diagonal(&problem.r.select_rows(&there));
        let s = &h * &self.p * h.transpose() + &r;
        let gain = &self.p * h.transpose() * s.try_inverse().expect("noise is positive");
        self.x += &gain * (z.select_rows(&there) - &h * &self.x);
        let left = DMatrix::identity(self.x.len(), self.x.len()) - &gain * &h;
        self.p = &left * &self.p * left.transpose() + &gain * r * gain.transpose();
    }
}

/// The window's problem over `y = (xi, omega_0, ...)`: `x_i = map_i y + offset_i`, cost `|y|^2/2 + sum rho`.
pub(crate) struct Condensed {
    pub maps: Vec<DMatrix<f64>>,
    pub offsets: Vec<DVector<f64>>,
    /// Readings that are there, over their standard deviations: rows and values.
    pub rows: DMatrix<f64>,
    pub values: DVector<f64>,
}

impl Condensed {
    /// All samples `(dt_s, z)` in one window, from the prior with covariance `root root^T`.
    pub(crate) fn new(
        problem: &Linear,
        mean: &DVector<f64>,
        root: &DMatrix<f64>,
        samples: &[(f64, DVector<f64>)],
    ) -> Self {
        let (n, k) = (mean.len(), problem.q.len());
        let size = root.ncols() + samples.len() * k;
        let mut map = DMatrix::zeros(n, size);
        map.columns_mut(0, root.ncols()).copy_from(root);
        let (mut maps, mut offsets) = (vec![map], vec![mean.clone()]);
        let (mut rows, mut values) = (Vec::new(), Vec::new());
        for (i, (dt_s, z)) in samples.iter().enumerate() {
            let (f, u) = problem.transition(*dt_s);
            let mut map = &f * &maps[i];
            let mut entry = map.columns_mut(root.ncols() + i * k, k);
            entry += problem.noise_input(*dt_s);
            let offset = f * &offsets[i] + u;
            for j in (0..z.len()).filter(|&j| !z[j].is_nan()) {
                let sd = problem.r[j].sqrt();
                rows.push(problem.h.row(j) * &map / sd);
                values.push((z[j] - (problem.h.row(j) * &offset)[0]) / sd);
            }
            maps.push(map);
            offsets.push(offset);
        }
        let rows = if rows.is_empty() { DMatrix::zeros(0, size) } else { DMatrix::from_rows(&rows) };
        Self { maps, offsets, rows, values: DVector::from_vec(values) }
    }

    pub(crate) fn hessian(&self) -> DMatrix<f64> {
        DMatrix::identity(self.rows.ncols(), self.rows.ncols()) + self.rows.tr_mul(&self.rows)
    }

    /// State `i` at `y`.
    pub(crate) fn state(&self, i: usize, y: &DVector<f64>) -> DVector<f64> {
        &self.maps[i] * y + &self.offsets[i]
    }

    /// Covariance of the newest state when `equalities y` is known: projection by the KKT matrix's inverse.
    pub(crate) fn newest_covariance(&self, equalities: &DMatrix<f64>) -> DMatrix<f64> {
        let (size, m) = (self.rows.ncols(), equalities.nrows());
        let inverse = kkt(&self.hessian(), equalities).try_inverse().expect("independent equalities");
        let map = self.maps.last().expect("there is a state");
        assert_eq!(inverse.nrows(), size + m);
        map * inverse.view((0, 0), (size, size)) * map.transpose()
    }

    /// The minimum of the quadratic cost subject to `c y <= gap`, by trying every active set of at most `most` rows.
    pub(crate) fn constrained(&self, c: &DMatrix<f64>, gap: &DVector<f64>, most: usize) -> Optimum {
        let mut found = Vec::new();
        let rhs = self.rows.tr_mul(&self.values);
        for active in subsets(c.nrows(), most) {
            let rows = c.select_rows(&active);
            let mut right = DVector::zeros(rhs.len() + active.len());
            right.rows_mut(0, rhs.len()).copy_from(&rhs);
            right.rows_mut(rhs.len(), active.len()).copy_from(&gap.select_rows(&active));
            let Some(solution) = kkt(&self.hessian(), &rows).lu().solve(&right) else { continue };
            let (y, multipliers) = (solution.rows(0, rhs.len()), solution.rows(rhs.len(), active.len()));
            let feasible = (c * y - gap).iter().all(|excess| *excess < 1e-9);
            if feasible && multipliers.iter().all(|m| *m > -1e-9) {
                found.push(Optimum { y: y.into_owned(), multipliers: multipliers.into_owned(), active });
            }
        }
        assert!(!found.is_empty(), "some active set satisfies the optimality conditions");
        assert!(found.iter().all(|o| (&o.y - &found[0].y).amax() < 1e-6), "the optimum is unique");
        found.swap_remove(0)
    }
}

/// Optimum of a quadratic program with its active rows.
pub(crate) struct Optimum {
    pub y: DVector<f64>,
    pub multipliers: DVector<f64>,
    pub active: Vec<usize>,
}

fn kkt(hessian: &DMatrix<f64>, rows: &DMatrix<f64>) -> DMatrix<f64> {
    let (size, m) = (hessian.nrows(), rows.nrows());
    let mut matrix = DMatrix::zeros(size + m, size + m);
    matrix.view_mut((0, 0), (size, size)).copy_from(hessian);
    matrix.view_mut((size, 0), (m, size)).copy_from(rows);
    matrix.view_mut((0, size), (size, m)).copy_from(&rows.transpose());
    matrix
}

/// Every set of at most `most` of `count` things, small sets first.
fn subsets(count: usize, most: usize) -> Vec<Vec<usize>> {
    let mut all: Vec<Vec<usize>> = (0..1u32 << count)
        .filter(|bits| bits.count_ones() as usize <= most)
        .map(|bits| (0..count).filter(|i| bits >> i & 1 == 1).collect())
        .collect();
    all.sort_by_key(Vec::len);
    all
}

/// Largest difference of two matrices relative to the larger one's largest entry.
pub(crate) fn difference(a: &DMatrix<f64>, b: &DMatrix<f64>) -> f64 {
    (a - b).amax() / a.amax().max(b.amax()).max(f64::MIN_POSITIVE)
}

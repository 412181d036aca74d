//! Linear estimation problems, drawn at random or written down.
use std::convert::Infallible;

use cylwatch_estimator::filter::{Dimensions, Linearisation, StateSpace};
use nalgebra::{DMatrix, DVector};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

/// `x <- x + dt [a x + u; 0] + noise of variance dt q through g`, `z = h x + noise of variance r`.
#[derive(Clone, Debug)]
pub(crate) struct Linear {
    /// Rates of the moving states: (leading, n).
    pub a: DMatrix<f64>,
    /// Known input of the moving states: (leading).
    pub u: DVector<f64>,
    /// Noise input: (leading, k).
    pub g: DMatrix<f64>,
    /// Variance rates: (k).
    pub q: DVector<f64>,
    /// Outputs: (outputs, n).
    pub h: DMatrix<f64>,
    /// Noise variances: (outputs).
    pub r: DVector<f64>,
}

impl Linear {
    /// A stable random problem with `k` noise sources, of which the last is silent where there are two or more.
    pub(crate) fn random(rng: &mut ChaCha8Rng, n: usize, leading: usize, k: usize, outputs: usize) -> Self {
        let mut a = normal_matrix(rng, leading, n) * 0.2;
        (0..leading).for_each(|i| a[(i, i)] -= 0.6);
        let mut q = DVector::from_fn(k, |_, _| rng.random_range(0.05..2.0));
        if k > 1 {
            q[k - 1] = 0.0;
        }
        Self {
            a,
            u: normal(rng, leading),
            g: normal_matrix(rng, leading, k),
            q,
            h: normal_matrix(rng, outputs, n),
            r: DVector::from_fn(outputs, |_, _| rng.random_range(0.01..1.0)),
        }
    }

    /// Transition matrix and input over `dt_s`: (n, n) and (n).
    pub(crate) fn transition(&self, dt_s: f64) -> (DMatrix<f64>, DVector<f64>) {
        let (leading, n) = self.a.shape();
        let mut f = DMatrix::identity(n, n);
        let mut u = DVector::zeros(n);
        for i in 0..leading {
            u[i] = dt_s * self.u[i];
            for j in 0..n {
                f[(i, j)] += dt_s * self.a[(i, j)];
            }
        }
        (f, u)
    }

    /// `G diag(sqrt(q))` with a row for every state: (n, k).
    pub(crate) fn noise_input(&self, dt_s: f64) -> DMatrix<f64> {
        let (leading, n) = self.a.shape();
        DMatrix::from_fn(n, self.q.len(), |i, j| {
            if i < leading { self.g[(i, j)] * (dt_s * self.q[j]).sqrt() } else { 0.0 }
        })
    }

    /// Let the process run and be read; a reading is missing with the given probability.
    pub(crate) fn sample(
        &self,
        rng: &mut ChaCha8Rng,
        x: &mut DVector<f64>,
        dt_s: f64,
        missing: f64,
    ) -> DVector<f64> {
        let (f, u) = self.transition(dt_s);
        *x = f * &*x + u + self.noise_input(dt_s) * normal(rng, self.q.len());
        let noise = self.r.map(f64::sqrt).component_mul(&normal(rng, self.r.len()));
        (&self.h * &*x + noise).map(|z| if rng.random_bool(missing) { f64::NAN } else { z })
    }
}

impl StateSpace for Linear {
    type Error = Infallible;

    fn dimensions(&self) -> Dimensions {
        Dimensions {
            states: self.a.ncols(),
            leading: self.a.nrows(),
            noises: self.q.len(),
            outputs: self.r.len(),
        }
    }

    fn propagate(
        &mut self,
        x: &mut [f64],
        dt_s: f64,
        linear: Option<&mut Linearisation>,
    ) -> Result<(), Infallible> {
        let (f, u) = self.transition(dt_s);
        let next = &f * DVector::from_column_slice(x) + u;
        x.copy_from_slice(next.as_slice());
        if let Some(linear) = linear {
            linear.phi.copy_from(&f.rows(0, self.leading()));
            linear.g.copy_from(&self.g);
            linear.q.copy_from(&(&self.q * dt_s));
        }
        Ok(())
    }

    fn output(&mut self, j: usize, x: &[f64], h: Option<&mut [f64]>) -> Result<f64, Infallible> {
        if let Some(h) = h {
            h.iter_mut().zip(self.h.row(j).iter()).for_each(|(h, a)| *h = *a);
        }
        Ok(self.h.row(j).iter().zip(x).map(|(a, x)| a * x).sum())
    }

    fn noise_variance(&self, j: usize, _x: &[f64]) -> f64 {
        self.r[j]
    }
}

/// Mass that leaks: states mass and leak rate, `mass' = -leak`, both with a random walk; the mass is read.
pub(crate) fn leaking_mass(mass_variance_rate: f64, leak_variance_rate: f64, r: f64) -> Linear {
    Linear {
        a: DMatrix::from_row_slice(2, 2, &[0.0, -1.0, 0.0, 0.0]),
        u: DVector::zeros(2),
        g: DMatrix::identity(2, 2),
        q: DVector::from_vec(vec![mass_variance_rate, leak_variance_rate]),
        h: DMatrix::from_row_slice(1, 2, &[1.0, 0.0]),
        r: DVector::from_element(1, r),
    }
}

/// Independent standard normal numbers.
pub(crate) fn normal(rng: &mut ChaCha8Rng, n: usize) -> DVector<f64> {
    DVector::from_fn(n, |_, _| rng.sample(StandardNormal))
}

/// A matrix of independent standard normal numbers.
pub(crate) fn normal_matrix(rng: &mut ChaCha8Rng, rows: usize, columns: usize) -> DMatrix<f64> {
    DMatrix::from_fn(rows, columns, |_, _| rng.sample(StandardNormal))
}

/// A random covariance of the given rank.
pub(crate) fn covariance(rng: &mut ChaCha8Rng, n: usize, rank: usize) -> DMatrix<f64> {
    let root = normal_matrix(rng, n, rank);
    &root * root.transpose()
}

//! A continuous linear process over one interval: `dx = A x dt + G dw`, `dw ~ N(0, Q_c dt)`.
//!
//! `Phi = exp(A T)` and `Q_d = int_0^T exp(A s) G Q_c G^T exp(A^T s) ds` are blocks of one matrix exponential (Van Loan
//! 1978): `exp([-A, G Q_c G^T; 0, A^T] T) = [., Phi^-1 Q_d; 0, Phi^T]`. For a stiff process the block of `-A`
//! overflows; here both series are summed over `T / 2^s`, where `A` is small, and doubled `s` times:
//! `Q_d <- Q_d + Phi Q_d Phi^T`, `Phi <- Phi^2`. Nothing grows that the process does not grow, and `Q_d` stays
//! symmetric and positive semi-definite up to rounding.
use nalgebra::{DMatrix, DVector};

use super::dense::symmetrise;
use super::factor::factor_udu;
use super::state_space::Linearisation;
use crate::EstimatorError;

/// Largest 1-norm of `A` times the base interval.
const BASE_NORM: f64 = 0.25;

/// Terms of the series at the base interval. The norm of `X -> A X + X A^T` is at most 1/2 there: the first term
/// left out is below `0.5^16 / 17! = 4e-20` of the first.
const TERMS: usize = 16;

/// A process over one interval.
#[derive(Clone, Debug, PartialEq)]
pub struct Discrete {
    /// Transition `Phi`: (n, n).
    pub phi: DMatrix<f64>,
    /// Covariance `Q_d` of the noise collected: (n, n).
    pub noise: DMatrix<f64>,
}

/// Transition and noise over `interval_s`, s, of a process with the matrices `a` (n, n), `g` (n, k) and the noise
/// intensity `q_c` (k, k), per s.
///
/// # Errors
/// Sizes differ, the interval is negative, or the result is not finite.
pub fn discretise(
    a: &DMatrix<f64>,
    g: &DMatrix<f64>,
    q_c: &DMatrix<f64>,
    interval_s: f64,
) -> Result<Discrete, EstimatorError> {
    let n = a.nrows();
    for (length, expected) in
        [(a.ncols(), n), (g.nrows(), n), (q_c.nrows(), g.ncols()), (q_c.ncols(), g.ncols())]
    {
        super::failure::check_length(length, expected)?;
    }
    super::failure::check_sample(interval_s, 0, 0)?;
    let scaled = a * interval_s;
    let norm = scaled.column_iter().map(|c| c.lp_norm(1)).fold(0.0, f64::max);
    if !norm.is_finite() {
        return Err(EstimatorError::LinearisationUnusable);
    }
    let halvings = (norm / BASE_NORM).log2().ceil().max(0.0) as i32;
    let scale = 0.5_f64.powi(halvings);
    let mut process = series(&(scaled * scale), &(g * q_c * g.transpose() * (interval_s * scale)));
    for _ in 0..halvings {
        process.noise += &process.phi * &process.noise * process.phi.transpose();
        symmetrise(process.noise.as_mut_slice(), n);
        process.phi = &process.phi * &process.phi;
    }
    if process.phi.iter().chain(process.noise.iter()).all(|value| value.is_finite()) {
        Ok(process)
    } else {
        Err(EstimatorError::LinearisationUnusable)
    }
}

/// Both series for a small `a`, which includes the interval, as `intensity` does.
fn series(a: &DMatrix<f64>, intensity: &DMatrix<f64>) -> Discrete {
    let n = a.nrows();
    let (mut power, mut phi) = (DMatrix::identity(n, n), DMatrix::identity(n, n));
    let (mut term, mut noise) = (intensity.clone(), intensity.clone());
    for i in 1..=TERMS {
        power = a * power / i as f64;
        phi += &power;
        let half = a * &term / (i + 1) as f64;
        term = &half + half.transpose();
        noise += &term;
    }
    symmetrise(noise.as_mut_slice(), n);
    Discrete { phi, noise }
}

impl Discrete {
    /// The same as the linearised transition of the `leading` states: noise enters as `U diag(d) U^T = Q_d`.
    ///
    /// # Errors
    /// The noise intensity was not positive semi-definite, or there are not so many states.
    pub fn linearisation(&self, leading: usize) -> Result<Linearisation, EstimatorError> {
        let n = self.phi.nrows();
        if leading > n {
            return Err(EstimatorError::StateLength { length: leading, states: n });
        }
        let mut g = self.noise.view((0, 0), (leading, leading)).into_owned();
        let mut q = DVector::zeros(leading);
        factor_udu(g.as_mut_slice(), q.as_mut_slice())?;
        Ok(Linearisation { phi: self.phi.rows(0, leading).into_owned(), g, q })
    }
}

#[cfg(test)]
mod tests;

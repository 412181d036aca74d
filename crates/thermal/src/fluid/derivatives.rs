//! The reduced Helmholtz energy with its derivatives, which every equation of state gives.
use super::Real;

/// Below this exponent a Gaussian term is below 1e-26 and left out.
pub(super) const NEGLIGIBLE: f64 = -60.0;

/// `alpha` and its scaled derivatives. `d`: `rho d/d(rho)`, `t`: `-T d/dT` (in `tau`: `tau d/d(tau)`); second ones are
/// `delta^2 d2/d(delta)^2`, `delta tau d2/d(delta)d(tau)`, `tau^2 d2/d(tau)^2`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reduced<D> {
    /// Value.
    pub a: D,
    /// First derivative in density.
    pub d: D,
    /// First derivative in inverse temperature.
    pub t: D,
    /// Second derivative in density.
    pub dd: D,
    /// Mixed derivative.
    pub dt: D,
    /// Second derivative in inverse temperature.
    pub tt: D,
}

impl<D: Real> Reduced<D> {
    /// All zero: the ideal gas's residual part.
    pub(crate) fn zero() -> Self {
        let zero = D::from(0.0);
        Self { a: zero, d: zero, t: zero, dd: zero, dt: zero, tt: zero }
    }

    pub(super) fn add(&mut self, other: &Self) {
        self.a += other.a;
        self.d += other.d;
        self.t += other.t;
        self.dd += other.dd;
        self.dt += other.dt;
        self.tt += other.tt;
    }
}

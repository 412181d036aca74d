//! Terms that few equations of state have, each with its scaled derivatives: those about the critical point of Span and Wagner (1996),
//! departure functions of mixtures (Kunz and Wagner 2012), and power terms for which the tables have no place.
use super::Real;
use super::data::terms::{DepartureTerm, NonanalyticTerm, PowerTerm};
use super::derivatives::{NEGLIGIBLE, Reduced};

/// Least distance of `delta` from 1 in a non-analytic term, whose powers have no derivative there.
const SHIFT: f64 = 1e-10;

/// A term about the critical point, from the logarithmic derivatives of `delta Delta^b Psi`.
pub(super) fn nonanalytic<D: Real>(term: &NonanalyticTerm, delta: D, tau: D) -> Reduced<D> {
    let (mut u, v) = (delta - 1.0, tau - 1.0);
    if u.re().abs() < SHIFT {
        u += SHIFT - u.re();
    }
    let exponent = u * u * (-term.eta) - v * v * term.decay;
    if exponent.re() < NEGLIGIBLE {
        return Reduced::zero();
    }
    let (square, p) = (u * u, 0.5 / term.beta);
    // theta and Delta with their derivatives in delta; those in tau are -1 and -2 theta, 2.
    let bend = square.powf(p - 1.0) * (2.0 * p * term.amplitude);
    let theta = square.powf(p) * term.amplitude - v;
    let (theta_d, theta_dd) = (bend * u, bend * (2.0 * p - 1.0));
    let wide = square.powf(term.a - 1.0) * (2.0 * term.a * term.width);
    let distance = theta * theta + square.powf(term.a) * term.width;
    let distance_d = theta * theta_d * 2.0 + wide * u;
    let distance_dd = (theta_d * theta_d + theta * theta_dd) * 2.0 + wide * (2.0 * term.a - 1.0);
    let (by_d, by_t) = (distance_d / distance, -theta * 2.0 / distance);
    let x = delta * (by_d * term.b - u * (2.0 * term.eta)) + 1.0;
    let y = tau * (by_t * term.b - v * (2.0 * term.decay));
    let c = delta * distance.powf(term.b) * exponent.exp() * term.n;
    let curved = (distance_dd / distance - by_d * by_d) * term.b - 2.0 * term.eta;
    let mixed = (-theta_d * 2.0 / distance - by_d * by_t) * term.b;
    let bent = (distance.recip() * 2.0 - by_t * by_t) * term.b - 2.0 * term.decay;
    Reduced {
        a: c,
        d: c * x,
        t: c * y,
        dd: c * (x * x - 1.0 + delta * delta * curved),
        dt: c * (x * y + delta * tau * mixed),
        tt: c * (y * y + tau * tau * bent),
    }
}

/// A power term by itself.
pub(super) fn power<D: Real>(term: &PowerTerm, delta: D, ln_tau: D) -> Reduced<D> {
    let (d, l, t) = (f64::from(term.d), f64::from(term.l), term.t);
    let decay = if term.l == 0 { D::from(0.0) } else { delta.powi(i32::from(term.l)) };
    let c = delta.powi(i32::from(term.d)) * (ln_tau * t - decay).exp() * term.n;
    let x = decay * (-l) + d;
    Reduced {
        a: c,
        d: c * x,
        t: c * t,
        dd: c * (x * (x - 1.0) - decay * (l * l)),
        dt: c * x * t,
        tt: c * (t * (t - 1.0)),
    }
}

/// A term of a departure function.
pub(super) fn departure<D: Real>(term: &DepartureTerm, delta: D, ln_tau: D) -> Reduced<D> {
    let (u, d) = (delta - term.epsilon, f64::from(term.d));
    let exponent = ln_tau * term.t - u * u * term.eta - (delta - term.gamma) * term.beta;
    let c = delta.powi(i32::from(term.d)) * exponent.exp() * term.n;
    let x = delta * (-(u * (2.0 * term.eta)) - term.beta) + d;
    Reduced {
        a: c,
        d: c * x,
        t: c * term.t,
        dd: c * (x * x - delta * delta * (2.0 * term.eta) - d),
        dt: c * x * term.t,
        tt: c * (term.t * (term.t - 1.0)),
    }
}

#[cfg(test)]
mod tests {
    use crate::real::Dual;

    use super::*;
    use crate::fluid::Fluid;

    /// Each scaled derivative against the exact derivative of the one before it.
    fn derivatives_hold(what: &str, term: impl Fn(Dual<1>, Dual<1>) -> Reduced<Dual<1>>) {
        for (delta, tau) in [(0.2, 0.7), (0.9, 0.98), (1.0, 1.02), (1.1, 1.0), (1.8, 1.3), (2.6, 0.8)] {
            let fixed = |value: f64| Dual::<1>::from(value);
            let by_d = term(Dual::variable(delta, 0), fixed(tau));
            let by_t = term(fixed(delta), Dual::variable(tau, 0));
            let pairs = [
                (by_d.d.re, delta * by_d.a.eps[0]),
                (by_t.t.re, tau * by_t.a.eps[0]),
                (by_d.dd.re + by_d.d.re, delta * by_d.d.eps[0]),
                (by_t.dt.re, tau * by_t.d.eps[0]),
                (by_d.dt.re, delta * by_d.t.eps[0]),
                (by_t.tt.re + by_t.t.re, tau * by_t.t.eps[0]),
            ];
            for (k, (value, exact)) in pairs.into_iter().enumerate() {
                let size = exact.abs().max(by_d.a.re.abs());
                assert!((value - exact).abs() <= 1e-9 * size, "{what} {delta} {tau}, {k}: {value} {exact}");
            }
        }
    }

    #[test]
    fn scaled_derivatives_are_derivatives() {
        let about_critical = NonanalyticTerm {
            n: -0.67,
            b: 0.875,
            a: 3.5,
            beta: 0.3,
            amplitude: 0.7,
            width: 0.3,
            eta: 10.0,
            decay: 275.0,
        };
        derivatives_hold("critical", |delta, tau| nonanalytic(&about_critical, delta, tau));
        let mixed = DepartureTerm { n: 0.7, d: 2, t: 3.75, eta: 0.25, epsilon: 0.5, beta: 3.0, gamma: 0.5 };
        derivatives_hold("departure", |delta, tau| departure(&mixed, delta, tau.ln()));
        for l in [0, 1, 4] {
            let term = PowerTerm { n: -1.3, d: 3, t: 1.85, l };
            derivatives_hold("power", |delta, tau| power(&term, delta, tau.ln()));
        }
    }

    /// At the critical density the powers of the distance have no derivative, at the critical point no property is regular.
    #[test]
    fn carbon_dioxide_is_smooth_across_its_critical_density() {
        let fluid = Fluid::named("carbon-dioxide").unwrap();
        let rho: f64 = 10_624.906_3 * 0.044_009_8;
        for t in [304.1282_f64, 304.2, 310.0, 350.0] {
            let [below, at, above] =
                [rho * (1.0 - 1e-7), rho, rho * (1.0 + 1e-7)].map(|rho| fluid.state(rho, t));
            assert!(at.pressure_pa.is_finite() && at.cv_j_kg_k.is_finite(), "{t} K: {at:?}");
            assert!((at.pressure_pa / below.pressure_pa - 1.0).abs() < 1e-6);
            if t > 304.15 {
                let middle = 0.5 * (below.cv_j_kg_k + above.cv_j_kg_k);
                assert!((at.cv_j_kg_k / middle - 1.0).abs() < 1e-6, "{t} K: {} {middle}", at.cv_j_kg_k);
            }
        }
    }
}

//! Reduced Helmholtz energy `alpha = a / (R T)` of a fluid and its exact first and second derivatives.
//!
//! `alphar(delta, tau) = sum n delta^d tau^t exp(-delta^l) + sum n delta^d tau^t exp(-eta (delta-epsilon)^2 - beta (tau-gamma)^2)`
//! with `delta = rho / rho_r`, `tau = T_r / T`. Derivatives are carried in the scaled form
//! `delta d/d(delta) = rho d/d(rho)`, `tau d/d(tau) = -T d/dT`, which does not depend on the reducing values,
//! so that every equation of state speaks the same language ([`HelmholtzEnergy`]).
//!
//! Speed: terms are grouped by `l`, so that each exponential is taken once; powers of `delta` and of
//! `tau` come from tables where the exponents allow it (multiples of 1/8 from three square roots); Gaussian terms
//! that are negligible are skipped. At a given temperature the power terms collapse into polynomials in `delta` ([`Isotherm`]).
use std::sync::LazyLock;

use super::Real;
use super::data::{ALL, FluidData, GaussianTerm, PowerTerm};

/// `alpha` and its scaled derivatives. `d`: `rho d/d(rho)`, `t`: `-T d/dT` (in `tau`: `tau d/d(tau)`); second ones are
/// `delta^2 d2/d(delta)^2`, `delta tau d2/d(delta)d(tau)`, `tau^2 d2/d(tau)^2`.
#[derive(Clone, Copy, Debug)]
pub struct Reduced<D> {
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
    pub fn zero() -> Self {
        let zero = D::from(0.0);
        Self { a: zero, d: zero, t: zero, dd: zero, dt: zero, tt: zero }
    }
}

/// An equation of state: its residual reduced Helmholtz energy.
pub trait HelmholtzEnergy {
    /// Residual part at a density, kg/m³, and temperature, K.
    fn residual<D: Real>(&self, density_kg_m3: D, temperature_k: D) -> Reduced<D>;

    /// `rho d(alphar)/d(rho)` and `rho^2 d2(alphar)/d(rho)^2` alone, for the pressure and its slope along an isotherm.
    fn residual_density_slopes(&self, density_kg_m3: f64, temperature_k: f64) -> (f64, f64) {
        let r = self.residual(density_kg_m3, temperature_k);
        (r.d, r.dd)
    }
}

/// Largest exponent of `delta` in any term.
const MAX_D: usize = 16;
/// Below this exponent a Gaussian term is below 1e-26 and left out.
const NEGLIGIBLE: f64 = -60.0;

/// How the power of `tau` of a term is found.
#[derive(Clone, Copy, Debug)]
enum TauPower {
    /// `tau^whole * tau^(eighth/8)`.
    Table { whole: u8, eighth: u8 },
    /// Index into the list of other exponents.
    Listed(u8),
}

#[derive(Clone, Copy, Debug)]
struct Term {
    n: f64,
    d: u8,
    t: f64,
    tau: TauPower,
}

/// Terms with the same `l`.
#[derive(Clone, Debug)]
struct Group {
    l: u8,
    terms: Vec<Term>,
}

/// A multiparameter equation of state, prepared for evaluation.
#[derive(Debug)]
pub struct Multiparameter {
    data: &'static FluidData,
    groups: Vec<Group>,
    gaussian: Vec<(GaussianTerm, TauPower)>,
    /// Exponents of `tau` that are no multiples of 1/8.
    listed: Vec<f64>,
    /// Largest whole exponent of `tau`.
    wholes: usize,
    reducing_density_kg_m3: f64,
}

/// Prepared equations, in the order of [`ALL`].
pub static PREPARED: LazyLock<Vec<Multiparameter>> =
    LazyLock::new(|| ALL.iter().map(|data| Multiparameter::new(data)).collect());

/// Powers of `delta` and `tau` that the terms share.
struct Powers<D> {
    delta: [D; MAX_D + 1],
    whole: [D; 33],
    eighth: [D; 8],
    listed: [D; 32],
}

impl Multiparameter {
    fn new(data: &'static FluidData) -> Self {
        let mut listed: Vec<f64> = Vec::new();
        let mut wholes = 0;
        let mut classify = |t: f64| {
            let eighths = 8.0 * t;
            if eighths.fract() == 0.0 && t <= 32.0 {
                wholes = wholes.max(t as usize);
                return TauPower::Table { whole: t as u8, eighth: (eighths as usize % 8) as u8 };
            }
            let index = listed.iter().position(|&known| known == t).unwrap_or_else(|| {
                listed.push(t);
                listed.len() - 1
            });
            TauPower::Listed(index as u8)
        };
        let mut groups: Vec<Group> = Vec::new();
        for &PowerTerm { n, d, t, l } in data.power {
            let term = Term { n, d, t, tau: classify(t) };
            match groups.iter_mut().find(|group| group.l == l) {
                Some(group) => group.terms.push(term),
                None => groups.push(Group { l, terms: vec![term] }),
            }
        }
        let gaussian = data.gaussian.iter().map(|&term| (term, classify(term.t))).collect();
        Self {
            groups,
            gaussian,
            wholes,
            listed,
            data,
            reducing_density_kg_m3: data.reducing_density_mol_m3 * data.molar_mass_kg_mol,
        }
    }

    /// The data it was made from.
    pub fn data(&self) -> &'static FluidData {
        self.data
    }

    fn tau_powers<D: Real>(&self, tau: D) -> Powers<D> {
        let one = D::from(1.0);
        let mut p = Powers { delta: [one; MAX_D + 1], whole: [one; 33], eighth: [one; 8], listed: [one; 32] };
        for i in 1..=self.wholes {
            p.whole[i] = p.whole[i - 1] * tau;
        }
        let root = tau.sqrt().sqrt().sqrt();
        for i in 1..8 {
            p.eighth[i] = p.eighth[i - 1] * root;
        }
        if !self.listed.is_empty() {
            let ln_tau = tau.ln();
            for (power, &t) in p.listed.iter_mut().zip(&self.listed) {
                *power = (ln_tau * t).exp();
            }
        }
        p
    }

    fn delta_powers<D: Real>(delta: D, powers: &mut [D; MAX_D + 1]) {
        for i in 1..=MAX_D {
            powers[i] = powers[i - 1] * delta;
        }
    }

    /// Collapse the power terms at a temperature.
    pub fn isotherm(&self, temperature_k: f64) -> Isotherm<'_> {
        let tau = self.data.reducing_temperature_k / temperature_k;
        let powers = self.tau_powers(tau);
        let groups = self
            .groups
            .iter()
            .map(|group| {
                let mut coefficients = [0.0; MAX_D + 1];
                for term in &group.terms {
                    coefficients[usize::from(term.d)] += term.n * powers.tau(term.tau);
                }
                let degree = group.terms.iter().map(|term| usize::from(term.d)).max().unwrap_or(0);
                (group.l, degree, coefficients)
            })
            .collect();
        let gaussian = self
            .gaussian
            .iter()
            .filter_map(|(g, tau_power)| {
                let exponent = -g.beta * (tau - g.gamma).powi(2);
                (exponent > NEGLIGIBLE).then(|| (*g, g.n * powers.tau(*tau_power) * exponent.exp()))
            })
            .collect();
        Isotherm { equation: self, groups, gaussian }
    }
}

impl<D: Real> Powers<D> {
    fn tau(&self, power: TauPower) -> D {
        match power {
            TauPower::Table { whole, eighth: 0 } => self.whole[usize::from(whole)],
            TauPower::Table { whole, eighth } => {
                self.whole[usize::from(whole)] * self.eighth[usize::from(eighth)]
            }
            TauPower::Listed(index) => self.listed[usize::from(index)],
        }
    }
}

impl HelmholtzEnergy for Multiparameter {
    fn residual<D: Real>(&self, density_kg_m3: D, temperature_k: D) -> Reduced<D> {
        let delta = density_kg_m3 / self.reducing_density_kg_m3;
        let tau = temperature_k.recip() * self.data.reducing_temperature_k;
        let mut powers = self.tau_powers(tau);
        Self::delta_powers(delta, &mut powers.delta);
        let mut sum = Reduced::zero();
        for group in &self.groups {
            let mut s = Reduced::<D>::zero();
            for term in &group.terms {
                let (d, t) = (f64::from(term.d), term.t);
                let c = powers.delta[usize::from(term.d)] * powers.tau(term.tau) * term.n;
                s.a += c;
                s.d += c * d;
                s.t += c * t;
                s.dd += c * (d * d);
                s.dt += c * (d * t);
                s.tt += c * (t * t - t);
            }
            if group.l == 0 {
                sum.a += s.a;
                sum.d += s.d;
                sum.t += s.t;
                sum.dd += s.dd - s.d;
                sum.dt += s.dt;
                sum.tt += s.tt;
                continue;
            }
            let l = f64::from(group.l);
            let power = powers.delta[usize::from(group.l)];
            let decay = (-power).exp();
            // delta d/d(delta) of delta^d exp(-delta^l) multiplies by d - l delta^l.
            let shift = power * l;
            sum.a += decay * s.a;
            sum.d += decay * (s.d - shift * s.a);
            sum.t += decay * s.t;
            sum.dd += decay * (s.dd - s.d + shift * ((shift + (1.0 - l)) * s.a - s.d * 2.0));
            sum.dt += decay * (s.dt - shift * s.t);
            sum.tt += decay * s.tt;
        }
        for (g, tau_power) in &self.gaussian {
            let (u, v) = (delta - g.epsilon, tau - g.gamma);
            let exponent = u * u * (-g.eta) - v * v * g.beta;
            if exponent.re() < NEGLIGIBLE {
                continue;
            }
            let c = powers.delta[usize::from(g.d)] * powers.tau(*tau_power) * exponent.exp() * g.n;
            let x = delta * u * (-2.0 * g.eta) + f64::from(g.d);
            let y = tau * v * (-2.0 * g.beta) + g.t;
            sum.a += c;
            sum.d += c * x;
            sum.t += c * y;
            sum.dd += c * (x * x - delta * delta * (2.0 * g.eta) - f64::from(g.d));
            sum.dt += c * x * y;
            sum.tt += c * (y * y - tau * tau * (2.0 * g.beta) - g.t);
        }
        sum
    }

    fn residual_density_slopes(&self, density_kg_m3: f64, temperature_k: f64) -> (f64, f64) {
        self.isotherm(temperature_k).slopes(density_kg_m3)
    }
}

/// The equation at one temperature: polynomials in density times exponentials.
pub struct Isotherm<'a> {
    equation: &'a Multiparameter,
    /// Exponent, degree and coefficients of each group.
    groups: Vec<(u8, usize, [f64; MAX_D + 1])>,
    gaussian: Vec<(GaussianTerm, f64)>,
}

impl Isotherm<'_> {
    /// `delta d(alphar)/d(delta)` and `delta^2 d2(alphar)/d(delta)^2`.
    pub fn slopes(&self, density_kg_m3: f64) -> (f64, f64) {
        let delta = density_kg_m3 / self.equation.reducing_density_kg_m3;
        let (mut first, mut second) = (0.0, 0.0);
        for (l, degree, coefficients) in &self.groups {
            // Horner for sum c, sum d c, sum d (d-1) c.
            let (mut s0, mut s1, mut s2) = (0.0, 0.0, 0.0);
            for d in (0..=*degree).rev() {
                s2 = s2 * delta + 2.0 * s1;
                s1 = s1 * delta + s0;
                s0 = s0 * delta + coefficients[d];
            }
            let (s1, s2) = (s1 * delta, s2 * delta * delta);
            if *l == 0 {
                first += s1;
                second += s2;
                continue;
            }
            let power = delta.powi(i32::from(*l));
            let decay = (-power).exp();
            let l = f64::from(*l);
            let shift = l * power;
            first += decay * (s1 - shift * s0);
            second += decay * (s2 + shift * ((shift + (1.0 - l)) * s0 - 2.0 * s1));
        }
        for (g, coefficient) in &self.gaussian {
            let u = delta - g.epsilon;
            let c = coefficient * delta.powi(i32::from(g.d)) * (-g.eta * u * u).exp();
            let x = f64::from(g.d) - 2.0 * g.eta * delta * u;
            first += c * x;
            second += c * (x * x - 2.0 * g.eta * delta * delta - f64::from(g.d));
        }
        (first, second)
    }
}

/// Ideal part `alpha0(delta, tau)` of a fluid.
pub fn ideal<D: Real>(data: &FluidData, density_kg_m3: D, temperature_k: D) -> Reduced<D> {
    let delta = density_kg_m3 / (data.reducing_density_mol_m3 * data.molar_mass_kg_mol);
    let tau = temperature_k.recip() * data.reducing_temperature_k;
    let ln_tau = tau.ln();
    let mut sum = Reduced {
        a: delta.ln() + tau * data.ideal_tau + ln_tau * data.ideal_ln_tau + data.ideal_constant,
        d: D::from(1.0),
        t: tau * data.ideal_tau + data.ideal_ln_tau,
        dd: D::from(-1.0),
        dt: D::from(0.0),
        tt: D::from(-data.ideal_ln_tau),
    };
    for &(n, t) in data.ideal_power {
        let term = if t.fract() == 0.0 { tau.powi(t as i32) } else { (ln_tau * t).exp() } * n;
        sum.a += term;
        sum.t += term * t;
        sum.tt += term * (t * (t - 1.0));
    }
    for &(n, t) in data.ideal_einstein {
        let x = tau * t;
        let decay = (-x).exp();
        let rest = -decay + 1.0;
        sum.a += rest.ln() * n;
        sum.t += x * decay / rest * n;
        sum.tt -= x * x * decay / (rest * rest) * n;
    }
    for &(n, t, c, d) in data.ideal_general {
        let x = tau * t;
        let grown = x.exp() * d;
        let total = grown + c;
        sum.a += total.ln() * n;
        sum.t += x * grown / total * n;
        sum.tt += x * x * grown / (total * total) * (n * c);
    }
    sum
}

//! Reduced Helmholtz energy `alpha = a / (R T)` of a fluid and its exact first and second derivatives.
//!
//! `alphar(delta, tau) = sum n delta^d tau^t exp(-delta^l) + sum n delta^d tau^t exp(-eta (delta-epsilon)^2 - beta (tau-gamma)^2)`
//! with `delta = rho / rho_r`, `tau = T_r / T`; few equations have the terms of [`super::special`], too. Derivatives are carried in the scaled form
//! `delta d/d(delta) = rho d/d(rho)`, `tau d/d(tau) = -T d/dT`, which does not depend on the reducing values,
//! so that every equation of state speaks the same language ([`HelmholtzEnergy`]).
//!
//! Speed: terms are grouped by `l`, so that each exponential is taken once; each distinct power of `tau` is taken once,
//! from tables where the exponent allows it (multiples of 1/8 from three square roots); Gaussian terms that are
//! negligible are skipped. At a given temperature the power terms collapse into polynomials in `delta` ([`Isotherm`]).
//! Arrays have a fixed size: nothing is allocated.
use alloc::vec::Vec;
use core::ops::Range;
use once_cell::race::OnceBox;

use super::data::terms::{FluidData, GaussianTerm, PowerTerm};
use super::derivatives::{NEGLIGIBLE, Reduced};
use super::special::{departure, nonanalytic, power};
use super::{Real, Saturation};

/// An equation of state: its residual reduced Helmholtz energy.
pub(super) trait HelmholtzEnergy {
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

/// Most pairs of (`l`, `d`), distinct exponents of `tau` and Gaussian terms of any equation.
const MAX_SLOTS: usize = 40;
const MAX_TAU: usize = 32;
const MAX_GAUSSIAN: usize = 16;

/// Temperatures at which a saturation is kept.
pub(super) const SATURATIONS: usize = 64;

#[derive(Clone, Copy, Debug)]
struct Term {
    n: f64,
    t: f64,
    /// Index of `tau^t` among the distinct powers of `tau`.
    tau: usize,
}

/// Terms with the same `l` and `d`.
#[derive(Clone, Debug)]
struct Slot {
    d: usize,
    terms: Range<usize>,
}

/// Slots with the same `l`.
#[derive(Clone, Debug)]
struct Group {
    l: usize,
    slots: Range<usize>,
}

/// A multiparameter equation of state, prepared for evaluation.
#[derive(Debug)]
pub(super) struct Multiparameter {
    pub data: FluidData,
    groups: Vec<Group>,
    /// Sorted by `l`, then `d`, as the groups and slots refer to them.
    terms: Vec<Term>,
    slots: Vec<Slot>,
    /// Terms with the index of their power of `tau`.
    gaussian: Vec<(GaussianTerm, usize)>,
    /// Distinct powers of `tau` as `tau^whole tau^(eighth/8)`, (whole, eighth).
    tau: Vec<(usize, usize)>,
    /// Those that are no such product: index among them and exponent.
    tau_others: Vec<(usize, f64)>,
    /// Largest whole exponent of `tau` and exponent of `delta`.
    highest_whole: usize,
    highest_d: usize,
    reducing_density_kg_m3: f64,
    /// Power terms of a mixture for which the tables have no place.
    overflow: Vec<PowerTerm>,
    /// Neither terms about the critical point nor a departure function nor an overflow.
    plain: bool,
    /// Saturation at a few temperatures from the lowest to the highest that is resolved, found when one is asked for.
    pub saturation: [OnceBox<Option<Saturation>>; SATURATIONS],
}

impl Multiparameter {
    pub(super) fn new(data: FluidData) -> Self {
        let mut exponents: Vec<f64> = Vec::new();
        let mut tau_index = |t: f64| {
            let known = exponents.iter().position(|&known| known == t);
            known.or_else(|| {
                (exponents.len() < MAX_TAU).then(|| exponents.push(t)).map(|()| exponents.len() - 1)
            })
        };
        assert!(data.gaussian.len() <= MAX_GAUSSIAN, "{}: too many Gaussian terms", data.name);
        let powers =
            |&term: &GaussianTerm| (term, tau_index(term.t).expect("more powers than Gaussian terms"));
        let gaussian: Vec<_> = data.gaussian.iter().map(powers).collect();
        let mut sorted: Vec<PowerTerm> = data.power.to_vec();
        sorted.sort_by_key(|term| (term.l, term.d));
        let (mut groups, mut slots, mut terms): (Vec<Group>, Vec<Slot>, Vec<Term>) = Default::default();
        let mut overflow = Vec::new();
        for &term in &sorted {
            let PowerTerm { n, t, .. } = term;
            let (l, d, i) = (usize::from(term.l), usize::from(term.d), terms.len());
            let Some(tau) = tau_index(t).filter(|_| slots.len() < MAX_SLOTS) else {
                overflow.push(term);
                continue;
            };
            terms.push(Term { n, t, tau });
            match groups.last_mut() {
                Some(group) if group.l == l => match slots.last_mut() {
                    Some(slot) if slot.d == d => slot.terms.end = i + 1,
                    _ => {
                        slots.push(Slot { d, terms: i..i + 1 });
                        group.slots.end = slots.len();
                    }
                },
                _ => {
                    slots.push(Slot { d, terms: i..i + 1 });
                    groups.push(Group { l, slots: slots.len() - 1..slots.len() });
                }
            }
        }
        let in_table = |t: f64| libm::trunc(8.0 * t) == 8.0 * t && (0.0..=32.0).contains(&t);
        let product = |&t: &f64| if in_table(t) { (t as usize, (8.0 * t) as usize % 8) } else { (0, 0) };
        let tau: Vec<(usize, usize)> = exponents.iter().map(product).collect();
        let tau_others = exponents.iter().copied().enumerate().filter(|&(_, t)| !in_table(t)).collect();
        Self {
            highest_whole: tau.iter().map(|&(whole, _)| whole).max().unwrap_or(0),
            highest_d: sorted
                .iter()
                .map(|term| term.d.max(term.l))
                .chain(data.gaussian.iter().map(|term| term.d))
                .max()
                .map_or(0, usize::from),
            reducing_density_kg_m3: data.reducing_density_mol_m3 * data.molar_mass_kg_mol,
            saturation: [const { OnceBox::new() }; SATURATIONS],
            plain: data.nonanalytic.is_empty() && data.departure.is_empty() && overflow.is_empty(),
            overflow,
            groups,
            terms,
            slots,
            gaussian,
            tau,
            tau_others,
            data,
        }
    }

    /// The distinct powers of `tau`.
    #[inline(always)]
    fn tau_powers<D: Real>(&self, tau: D) -> [D; MAX_TAU] {
        let one = D::from(1.0);
        let whole: [D; 33] = powers(tau, self.highest_whole);
        let half = tau.sqrt();
        let quarter = half.sqrt();
        let root = quarter.sqrt();
        let low = quarter * root;
        let eighth = [one, root, quarter, low, half, half * root, half * quarter, half * low];
        let mut found = [one; MAX_TAU];
        for (power, &(i, j)) in found.iter_mut().zip(&self.tau) {
            *power = whole[i] * eighth[j];
        }
        if !self.tau_others.is_empty() {
            let ln_tau = tau.ln();
            for &(i, t) in &self.tau_others {
                found[i] = (ln_tau * t).exp();
            }
        }
        found
    }

    /// Terms that few equations have. Out of line, so that the others do not pay for them.
    #[cold]
    #[inline(never)]
    fn special<D: Real>(&self, delta: D, tau: D) -> Reduced<D> {
        let mut sum = Reduced::zero();
        for term in self.data.nonanalytic.iter() {
            sum.add(&nonanalytic(term, delta, tau));
        }
        if !(self.data.departure.is_empty() && self.overflow.is_empty()) {
            let ln_tau = tau.ln();
            for term in self.data.departure.iter() {
                sum.add(&departure(term, delta, ln_tau));
            }
            for term in &self.overflow {
                sum.add(&power(term, delta, ln_tau));
            }
        }
        sum
    }

    /// Collapse the power terms at a temperature.
    #[inline]
    pub(crate) fn isotherm(&self, temperature_k: f64) -> Isotherm<'_> {
        let tau = self.data.reducing_temperature_k / temperature_k;
        let powers = self.tau_powers(tau);
        let mut coefficients = [0.0; MAX_SLOTS];
        for (coefficient, slot) in coefficients.iter_mut().zip(&self.slots) {
            *coefficient = self.collapsed(slot, &powers);
        }
        let mut gaussian = [0.0; MAX_GAUSSIAN];
        for (i, factor) in gaussian.iter_mut().enumerate().take(self.gaussian.len()) {
            *factor = self.gaussian_factor(i, tau, &powers);
        }
        Isotherm { equation: self, tau, coefficients, gaussian }
    }

    /// Sum of `n tau^t` of a slot.
    #[inline(always)]
    fn collapsed(&self, slot: &Slot, tau_powers: &[f64; MAX_TAU]) -> f64 {
        let mut sum = 0.0;
        for term in &self.terms[slot.terms.clone()] {
            sum += term.n * tau_powers[term.tau];
        }
        sum
    }

    /// The part of a Gaussian term that depends on temperature; zero if negligible.
    #[inline(always)]
    fn gaussian_factor(&self, index: usize, tau: f64, tau_powers: &[f64; MAX_TAU]) -> f64 {
        let (g, power) = &self.gaussian[index];
        let v = tau - g.gamma;
        let exponent = -g.beta * v * v;
        if exponent > NEGLIGIBLE { g.n * tau_powers[*power] * libm::exp(exponent) } else { 0.0 }
    }

    /// `delta d(alphar)/d(delta)` and `delta^2 d2(alphar)/d(delta)^2`, given the slots' coefficients and the factors of the
    /// Gaussian terms by index.
    #[inline(always)]
    fn slopes(
        &self,
        density_kg_m3: f64,
        tau: f64,
        coefficient: impl Fn(usize) -> f64,
        gaussian: impl Fn(usize) -> f64,
    ) -> (f64, f64) {
        let delta = density_kg_m3 / self.reducing_density_kg_m3;
        let powers: [f64; MAX_D + 1] = powers(delta, self.highest_d);
        let (mut first, mut second) = (0.0, 0.0);
        for group in &self.groups {
            let (mut s0, mut s1, mut s2) = (0.0, 0.0, 0.0);
            for i in group.slots.clone() {
                let degree = self.slots[i].d;
                let d = degree as f64;
                let c = coefficient(i) * powers[degree];
                let c1 = c * d;
                s0 += c;
                s1 += c1;
                s2 += c1 * (d - 1.0);
            }
            if group.l == 0 {
                first += s1;
                second += s2;
                continue;
            }
            let power = powers[group.l];
            let decay = libm::exp(-power);
            let l = group.l as f64;
            let shift = l * power;
            first += decay * (s1 - shift * s0);
            second += decay * (s2 + shift * ((shift + (1.0 - l)) * s0 - 2.0 * s1));
        }
        for (i, (g, _)) in self.gaussian.iter().enumerate() {
            let factor = gaussian(i);
            if factor == 0.0 {
                continue;
            }
            let u = delta - g.epsilon;
            let d = f64::from(g.d);
            let c = factor * powers[usize::from(g.d)] * libm::exp(-g.eta * u * u);
            let x = d - 2.0 * g.eta * delta * u;
            first += c * x;
            second += c * (x * x - 2.0 * g.eta * delta * delta - d);
        }
        if !self.plain {
            let part = self.special(delta, tau);
            first += part.d;
            second += part.dd;
        }
        (first, second)
    }
}

/// `1, x, x^2, ...` up to an exponent, by halves: a chain of products would wait for each before the next.
#[inline(always)]
fn powers<D: Real, const N: usize>(x: D, highest: usize) -> [D; N] {
    let mut powers = [D::from(1.0); N];
    powers[1] = x;
    for i in 2..=highest {
        powers[i] = powers[i / 2] * powers[i - i / 2];
    }
    powers
}

impl HelmholtzEnergy for Multiparameter {
    fn residual<D: Real>(&self, density_kg_m3: D, temperature_k: D) -> Reduced<D> {
        let delta = density_kg_m3 / self.reducing_density_kg_m3;
        let tau = temperature_k.recip() * self.data.reducing_temperature_k;
        let tau_powers = self.tau_powers(tau);
        let delta_powers: [D; MAX_D + 1] = powers(delta, self.highest_d);
        let mut sum = Reduced::zero();
        for group in &self.groups {
            let mut s = Reduced::<D>::zero();
            for slot in &self.slots[group.slots.clone()] {
                let (mut c0, mut c1, mut c2) = (D::from(0.0), D::from(0.0), D::from(0.0));
                for term in &self.terms[slot.terms.clone()] {
                    let c = tau_powers[term.tau] * term.n;
                    let ct = c * term.t;
                    c0 += c;
                    c1 += ct;
                    c2 += ct * (term.t - 1.0);
                }
                let (power, d) = (delta_powers[slot.d], slot.d as f64);
                let (c, ct) = (c0 * power, c1 * power);
                s.a += c;
                s.d += c * d;
                s.t += ct;
                s.dd += c * (d * d);
                s.dt += ct * d;
                s.tt += c2 * power;
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
            let l = group.l as f64;
            let power = delta_powers[group.l];
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
            let c = delta_powers[usize::from(g.d)] * tau_powers[*tau_power] * exponent.exp() * g.n;
            let x = delta * u * (-2.0 * g.eta) + f64::from(g.d);
            let y = tau * v * (-2.0 * g.beta) + g.t;
            sum.a += c;
            sum.d += c * x;
            sum.t += c * y;
            sum.dd += c * (x * x - delta * delta * (2.0 * g.eta) - f64::from(g.d));
            sum.dt += c * x * y;
            sum.tt += c * (y * y - tau * tau * (2.0 * g.beta) - g.t);
        }
        if !self.plain {
            sum.add(&self.special(delta, tau));
        }
        sum
    }

    // Inlined so that the pressure alone does not pay for the second slope.
    #[inline(always)]
    fn residual_density_slopes(&self, density_kg_m3: f64, temperature_k: f64) -> (f64, f64) {
        let tau = self.data.reducing_temperature_k / temperature_k;
        let powers = self.tau_powers(tau);
        self.slopes(
            density_kg_m3,
            tau,
            |i| self.collapsed(&self.slots[i], &powers),
            |i| self.gaussian_factor(i, tau, &powers),
        )
    }
}

/// The equation at one temperature: polynomials in density times exponentials.
pub(super) struct Isotherm<'a> {
    equation: &'a Multiparameter,
    tau: f64,
    /// Coefficient of each pair of `l` and `d`.
    coefficients: [f64; MAX_SLOTS],
    /// Factor of each Gaussian term; zero for those left out.
    gaussian: [f64; MAX_GAUSSIAN],
}

impl Isotherm<'_> {
    /// `delta d(alphar)/d(delta)` and `delta^2 d2(alphar)/d(delta)^2`.
    #[inline]
    pub(crate) fn slopes(&self, density_kg_m3: f64) -> (f64, f64) {
        self.equation.slopes(density_kg_m3, self.tau, |i| self.coefficients[i], |i| self.gaussian[i])
    }
}

/// Ideal part `alpha0(delta, tau)` of a fluid.
pub(super) fn ideal<D: Real>(data: &FluidData, density_kg_m3: D, temperature_k: D) -> Reduced<D> {
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
    for &(n, t) in data.ideal_power.iter() {
        let term = if libm::trunc(t) == t { tau.powi(t as i32) } else { (ln_tau * t).exp() } * n;
        sum.a += term;
        sum.t += term * t;
        sum.tt += term * (t * (t - 1.0));
    }
    for &(n, t) in data.ideal_einstein.iter() {
        let x = tau * t;
        let decay = (-x).exp();
        let rest = -decay + 1.0;
        sum.a += rest.ln() * n;
        sum.t += x * decay / rest * n;
        sum.tt -= x * x * decay / (rest * rest) * n;
    }
    for &(n, t, c, d) in data.ideal_general.iter() {
        let x = tau * t;
        let grown = x.exp() * d;
        let total = grown + c;
        sum.a += total.ln() * n;
        sum.t += x * grown / total * n;
        sum.tt += x * x * grown / (total * total) * (n * c);
    }
    sum
}

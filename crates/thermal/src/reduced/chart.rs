//! Compressibility and heat capacity of the gas as polynomials on cells of the plane of temperature and density.
//!
//! An observer asks for the same gas some ten times a sample, within a kelvin of the last time, and an equation of state with its
//! third derivatives costs more than all the rest of the model. So `Z = p / (rho R T)` and `c_v` are interpolated at the
//! Chebyshev nodes of a cell, 4 K wide and a 128th of the densest state high, by polynomials of degree 5 in each
//! direction; their derivatives are those of the polynomials. Which polynomial holds depends on the state alone, never on what was
//! asked before. A cell whose polynomials miss the equation between the nodes by more than 1e-9 (near saturation and the critical
//! point) and states outside the fluid's domain are left to the equation itself.
//!
//! Source: interpolation at Chebyshev nodes, Trefethen 2013, chapters 2 and 15.
use crate::real::powi;
use core::f64::consts::PI;

use crate::real::Dual;
use nalgebra::SMatrix;

use crate::cache::GridCache;
use crate::fluid::Fluid;

/// Coefficients in each direction.
const ORDER: usize = 6;
/// Width of a cell, K.
const WIDTH_K: f64 = 4.0;
/// Cells up to the densest state that the equation knows, a liquid at some four times the critical density.
const CELLS_PER_DENSEST: f64 = 128.0;
/// Relative error between the nodes up to which polynomials are used.
const LARGEST_ERROR: f64 = 1e-9;
/// Cells kept at a time, along temperature and density.
const CACHED_CELLS: (i32, i32) = (8, 2);

type Coefficients = SMatrix<f64, ORDER, ORDER>;
/// Value and derivatives `[f, f_T, f_rho, f_TT, f_Trho, f_rhorho]`.
type Expansion = [f64; 6];

/// A property with its derivatives by temperature and density.
#[derive(Clone, Copy, Debug)]
pub(super) struct Property {
    pub value: f64,
    pub by_t: f64,
    pub by_rho: f64,
}

/// Properties of the gas.
#[derive(Clone, Copy, Debug)]
pub(super) struct Properties {
    /// Pressure, Pa.
    pub p: Property,
    /// Isochoric heat capacity, J/(kg K).
    pub cv: Property,
    /// `(dp/dT)_rho`, Pa/K.
    pub p_t: Property,
    /// `(dp/drho)_T`, Pa m³/kg.
    pub p_rho: Property,
}

/// Polynomials of one cell in the coordinates `(rho - rho_c) / h_rho` (down a column) and `(T - T_c) / h_T` (along a row).
#[derive(Clone, Debug)]
struct Polynomials {
    /// Temperature, K, and density, kg/m³, of the cell's middle.
    middle: (f64, f64),
    z: Coefficients,
    cv: Coefficients,
}

/// The cells of one fluid that were needed lately.
#[derive(Clone, Debug)]
pub(super) struct Chart {
    fluid: Fluid,
    gas_constant_j_kg_k: f64,
    height_kg_m3: f64,
    /// Nodes of the interpolation on [-1, 1], and the matrix from values there to coefficients.
    nodes: [f64; ORDER],
    to_coefficients: Coefficients,
    /// Without polynomials where they are not good enough.
    cells: GridCache<Option<Polynomials>>,
}

/// Pressure along an isotherm within a cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Isotherm {
    middle_kg_m3: f64,
    half_kg_m3: f64,
    rt: f64,
    coefficients: [f64; ORDER],
}

impl Isotherm {
    /// Whether a density, kg/m³, is within the cell.
    #[inline]
    pub(super) fn holds(&self, rho: f64) -> bool {
        (rho - self.middle_kg_m3).abs() <= self.half_kg_m3
    }

    /// Pressure, Pa, and its slope by density, Pa m³/kg.
    #[inline]
    pub(super) fn pressure(&self, rho: f64) -> (f64, f64) {
        let b = (rho - self.middle_kg_m3) / self.half_kg_m3;
        let (mut z, mut slope) = (0.0, 0.0);
        for coefficient in self.coefficients.iter().rev() {
            slope = slope * b + z;
            z = z * b + coefficient;
        }
        (rho * self.rt * z, self.rt * (z + rho * slope / self.half_kg_m3))
    }
}

/// `A B`, summed up in the same order on every machine.
fn product(a: &Coefficients, b: &Coefficients) -> Coefficients {
    Coefficients::from_fn(|i, j| (0..ORDER).map(|k| a[(i, k)] * b[(k, j)]).sum())
}

impl Chart {
    pub(super) fn new(fluid: Fluid) -> Self {
        let nodes: [f64; ORDER] = core::array::from_fn(|k| libm::cos(PI * (k as f64 + 0.5) / ORDER as f64));
        let powers = Coefficients::from_fn(|node, power| powi(nodes[node], power as i32));
        Self {
            gas_constant_j_kg_k: fluid.specific_gas_constant_j_kg_k(),
            height_kg_m3: fluid.domain().highest_density_kg_m3 / CELLS_PER_DENSEST,
            nodes,
            to_coefficients: powers.try_inverse().expect("the nodes differ"),
            cells: GridCache::new(CACHED_CELLS),
            fluid,
        }
    }

    pub(super) fn fluid(&self) -> &Fluid {
        &self.fluid
    }

    /// All properties at a density, kg/m³, and temperature, K.
    pub(super) fn properties(&mut self, rho: f64, t: f64) -> Properties {
        let (half, r) = ((0.5 * WIDTH_K, 0.5 * self.height_kg_m3), self.gas_constant_j_kg_k);
        let Some(Polynomials { middle, z, cv }) = self.polynomials(rho, t) else {
            return self.exact(rho, t);
        };
        let at = ((t - middle.0) / half.0, (rho - middle.1) / half.1);
        let [z, z_t, z_r, z_tt, z_tr, z_rr] = expand(z, at, half);
        let [cv, cv_t, cv_r, ..] = expand(cv, at, half);
        let (p_t, p_rho) = (rho * r * (z + t * z_t), r * t * (z + rho * z_r));
        let p_trho = r * (z + t * z_t + rho * z_r + rho * t * z_tr);
        Properties {
            p: Property { value: rho * r * t * z, by_t: p_t, by_rho: p_rho },
            cv: Property { value: cv, by_t: cv_t, by_rho: cv_r },
            p_t: Property { value: p_t, by_t: rho * r * (2.0 * z_t + t * z_tt), by_rho: p_trho },
            p_rho: Property { value: p_rho, by_t: p_trho, by_rho: r * t * (2.0 * z_r + rho * z_rr) },
        }
    }

    /// Pressure at a density, kg/m³, and temperature, K, with its derivatives.
    pub(super) fn pressure(&mut self, rho: f64, t: f64) -> Property {
        let (half, r) = ((0.5 * WIDTH_K, 0.5 * self.height_kg_m3), self.gas_constant_j_kg_k);
        let Some(Polynomials { middle, z, .. }) = self.polynomials(rho, t) else {
            return self.exact(rho, t).p;
        };
        let [z, z_t, z_r, ..] = expand(z, ((t - middle.0) / half.0, (rho - middle.1) / half.1), half);
        Property { value: rho * r * t * z, by_t: rho * r * (z + t * z_t), by_rho: r * t * (z + rho * z_r) }
    }

    /// The same without derivatives, Pa.
    pub(super) fn pressure_pa(&mut self, rho: f64, t: f64) -> f64 {
        match self.isotherm(rho, t) {
            Some(isotherm) => isotherm.pressure(rho).0,
            None => self.exact(rho, t).p.value,
        }
    }

    /// Pressure about a density, kg/m³, at a temperature, K; `None` where the equation itself is to be used.
    pub(super) fn isotherm(&mut self, rho: f64, t: f64) -> Option<Isotherm> {
        let (half_kg_m3, rt) = (0.5 * self.height_kg_m3, self.gas_constant_j_kg_k * t);
        let Polynomials { middle, z, .. } = self.polynomials(rho, t)?;
        let a = (t - middle.0) / (0.5 * WIDTH_K);
        let mut coefficients = [0.0; ORDER];
        for row in (0..ORDER).rev() {
            for (power, coefficient) in coefficients.iter_mut().enumerate() {
                *coefficient = *coefficient * a + z[(power, row)];
            }
        }
        Some(Isotherm { middle_kg_m3: middle.1, half_kg_m3, rt, coefficients })
    }

    /// Polynomials of a state's cell, found or made.
    fn polynomials(&mut self, rho: f64, t: f64) -> Option<&Polynomials> {
        // Both are positive inside the domain; what is outside of it is not looked up.
        let index = ((t / WIDTH_K) as i32, (rho / self.height_kg_m3) as i32);
        if self.cells.get(index).is_none() {
            let domain = self.fluid.domain();
            let known = t >= domain.lowest_temperature_k
                && t <= domain.highest_temperature_k
                && rho > 0.0
                && rho <= domain.highest_density_kg_m3;
            if !known {
                return None;
            }
            let middle =
                ((f64::from(index.0) + 0.5) * WIDTH_K, (f64::from(index.1) + 0.5) * self.height_kg_m3);
            let polynomials = self.interpolate(middle);
            self.cells.put(index, polynomials);
        }
        self.cells.get(index)?.as_ref()
    }

    /// Polynomials of a cell; `None` where they are not good enough.
    fn interpolate(&self, middle: (f64, f64)) -> Option<Polynomials> {
        let half = (0.5 * WIDTH_K, 0.5 * self.height_kg_m3);
        let state = |a: f64, b: f64| {
            let state = self.fluid.state(middle.1 + b * half.1, middle.0 + a * half.0);
            (state.compressibility, state.cv_j_kg_k)
        };
        let values: [[(f64, f64); ORDER]; ORDER] = self.nodes.map(|a| self.nodes.map(|b| state(a, b)));
        // Stored by density along a column, so that a loop over it is one over neighbours.
        let coefficients = |of: fn((f64, f64)) -> f64| {
            let values = Coefficients::from_fn(|b, a| of(values[a][b]));
            product(&product(&self.to_coefficients, &values), &self.to_coefficients.transpose())
        };
        let (z, cv) = (coefficients(|(z, _)| z), coefficients(|(_, cv)| cv));
        let between = [(0.0, 0.0), (0.5, -0.9), (-0.9, 0.5), (0.95, 0.95), (-0.45, -1.0)];
        let good = between.iter().all(|&(a, b)| {
            let (z_exact, cv_exact) = state(a, b);
            let close = |found: Expansion, exact: f64| (found[0] / exact - 1.0).abs() < LARGEST_ERROR;
            close(expand(&z, (a, b), half), z_exact) && close(expand(&cv, (a, b), half), cv_exact)
        });
        good.then_some(Polynomials { middle, z, cv })
    }

    /// By the equation of state itself.
    fn exact(&self, rho: f64, t: f64) -> Properties {
        let seed = |value: f64, index: usize| Dual::<2>::variable(value, index);
        let state = self.fluid.state(seed(rho, 1), seed(t, 0));
        let property = |dual: Dual<2>| {
            let [by_t, by_rho]: [f64; 2] = dual.eps;
            Property { value: dual.re, by_t, by_rho }
        };
        Properties {
            p: property(state.pressure_pa),
            cv: property(state.cv_j_kg_k),
            p_t: property(state.dp_dt_pa_k),
            p_rho: property(state.dp_drho_pa_m3_kg),
        }
    }
}

/// A polynomial with its first and second derivatives at a point of the cell, half as wide and high as `half`. Inlined, so that
/// derivatives that are not asked for cost nothing.
#[inline(always)]
fn expand(coefficients: &Coefficients, (a, b): (f64, f64), half: (f64, f64)) -> Expansion {
    // Horner's rule along the temperature for all powers of the density at once; second derivatives are halves.
    let (mut f, mut d, mut dd) = ([0.0; ORDER], [0.0; ORDER], [0.0; ORDER]);
    for column in coefficients.column_iter().rev() {
        for (power, coefficient) in column.iter().enumerate() {
            dd[power] = dd[power] * a + d[power];
            d[power] = d[power] * a + f[power];
            f[power] = f[power] * a + coefficient;
        }
    }
    let (mut sum, mut by_a, mut by_b) = (0.0, 0.0, 0.0);
    let (mut by_aa, mut by_ab, mut by_bb) = (0.0, 0.0, 0.0);
    for power in (0..ORDER).rev() {
        by_bb = by_bb * b + by_b;
        by_b = by_b * b + sum;
        by_ab = by_ab * b + by_a;
        sum = sum * b + f[power];
        by_a = by_a * b + d[power];
        by_aa = by_aa * b + dd[power];
    }
    [
        sum,
        by_a / half.0,
        by_b / half.1,
        2.0 * by_aa / (half.0 * half.0),
        by_ab / (half.0 * half.1),
        2.0 * by_bb / (half.1 * half.1),
    ]
}

#[cfg(test)]
mod tests;

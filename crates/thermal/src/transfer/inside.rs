//! Film between the inner surface and the gas: natural convection `Nu_L = c Ra_L^n` with properties at the
//! film temperature, in a form that keeps the derivative finite where wall and gas are equally warm:
//!
//! `q = c k L^(3n-1) R^n (theta^2 + theta_0^2)^(n/2) theta`, `theta = T_s - T_g`, `R = g beta rho^2 c_p / (mu k)`.
//!
//! With `n = 1/3` the length cancels and the law is local. The two property groups `ln k` and `ln R` are
//! functions of film temperature and pressure; evaluating them costs a density solve and two transport
//! correlations (about 1.3 µs), so they are interpolated on a grid that is filled only where a run goes.
//! Interpolation is bicubic (Catmull-Rom) and continuously differentiable, its error below 1e-5 of the film; for carbon dioxide 1e-4,
//! and in the cell beside its saturation line (4 K, 5 % of the pressure) 1 % and more.
//!
//! Sources: McAdams, Heat Transmission (1954), 0.13 Ra^(1/3); Daney, Cryogenics 16 (1976) 345, 0.104 Ra^0.352
//! for enclosed vessels; Woodfield et al., J. Thermal Sci. Tech. 2 (2007) 180, jet term 0.56 Re_in^0.67 / H;
//! Sreenivasan, Phys. Fluids 10 (1998) 528; Skrbek and Stalp, Phys. Fluids 12 (2000) 1997; Touil, Bertoglio and Shao,
//! J. Turbulence 3 (2002) 049.
use core::array::from_fn;
use core::cell::{Cell, RefCell};

use crate::ThermalError;
use crate::cache::{GridCache, GridIndex};
use crate::fluid::Fluid;
#[cfg(feature = "simulate")]
use crate::fluid::Real;
#[cfg(feature = "simulate")]
use crate::transfer::{FilmSeries, LAST_STEP_K};
use crate::vessel::InsideFilm;
use crate::wall::mesh::Facing;

/// Standard gravity, m/s².
pub(crate) const GRAVITY_M_S2: f64 = 9.806_65;
/// Temperature difference below which the film coefficient becomes constant, K.
const FLAT_BELOW_K: f64 = 0.01;
/// Reynolds number of stirred gas below which its film becomes linear in it.
#[cfg(feature = "simulate")]
const LINEAR_BELOW_RE: f64 = 10.0;
/// Factor and exponent of a plate that stirs the gas (hot floor, cold ceiling) and of one that does not, length D/4.
const PLATE_STIRRED: (f64, f64) = (0.15, 1.0 / 3.0);
const PLATE_RESTING: (f64, f64) = (0.27, 0.25);
/// Plates count with a quarter of the length.
const LN_QUARTER: f64 = -2.0 * core::f64::consts::LN_2;
/// How far the series of a film holds to 1e-12, parts of the difference of the temperatures, and K, by its groups.
#[cfg(feature = "simulate")]
const HOLDS: f64 = 5e-3;
#[cfg(feature = "simulate")]
const GROUPS_HOLD_K: f64 = 0.01;
/// Spacing of the grid in temperature, K.
const STEP_K: f64 = 4.0;
/// Spacing of the grid in the logarithm of the pressure.
const STEP_LN_P: f64 = 0.05;

/// Nodes and patches that are kept, along temperature and pressure.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Kept {
    nodes: GridIndex,
    patches: GridIndex,
}

impl Kept {
    /// For surfaces of many temperatures: nodes of 128 K and a third of the pressure.
    #[cfg(feature = "simulate")]
    pub(crate) const OF_MANY_SURFACES: Self = Self { nodes: (32, 8), patches: (8, 2) };
    /// For one surface, whose film is at one temperature at a time.
    pub(crate) const OF_ONE_SURFACE: Self = Self { nodes: (8, 8), patches: (4, 2) };
}

/// `ln k` and `ln R` with their derivatives along temperature and logarithm of pressure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FilmGroups {
    /// `[ln k, d/dT, d/d ln p]`, k in W/(m K).
    pub ln_k: [f64; 3],
    /// `[ln R, d/dT, d/d ln p]`, R in 1/(m³ K).
    pub ln_r: [f64; 3],
}

/// Exact property groups at a temperature and pressure, without the grid.
///
/// # Errors
/// The state is outside the fluid's domain.
pub fn film_groups_exact(
    fluid: &Fluid,
    temperature_k: f64,
    pressure_pa: f64,
) -> Result<(f64, f64), ThermalError> {
    let rho = fluid.density_from_pressure_temperature(pressure_pa, temperature_k)?;
    let state = fluid.state(rho, temperature_k);
    let k = fluid.conductivity_w_m_k(rho, temperature_k);
    let mu = fluid.viscosity_pa_s(rho, temperature_k);
    let r = GRAVITY_M_S2 * state.expansion_per_k * rho * rho * state.cp_j_kg_k / (mu * k);
    Ok((libm::log(k), libm::log(r)))
}

/// Weights of the four-point Catmull-Rom interpolation and of its derivative at `u` in [0, 1].
fn catmull_rom(u: f64) -> ([f64; 4], [f64; 4]) {
    let (u2, u3) = (u * u, u * u * u);
    (
        [
            -0.5 * u3 + u2 - 0.5 * u,
            1.5 * u3 - 2.5 * u2 + 1.0,
            -1.5 * u3 + 2.0 * u2 + 0.5 * u,
            0.5 * (u3 - u2),
        ],
        [-1.5 * u2 + 2.0 * u - 0.5, 4.5 * u2 - 5.0 * u, -4.5 * u2 + 4.0 * u + 0.5, 1.5 * u2 - u],
    )
}

fn dot(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3])
}

/// Whole part, rounded down, and the rest. Without a call of the library for the floor, which costs as much as the interpolation.
fn cell_of(x: f64) -> (i32, f64) {
    let truncated = x as i32;
    let index = if f64::from(truncated) > x { truncated.saturating_sub(1) } else { truncated };
    (index, x - f64::from(index))
}

/// Node of a stencil about a cell: the one before it first. Beyond the end of the numbers there is no gas either.
fn beside(cell: i32, node: usize) -> i32 {
    cell.saturating_add(node as i32 - 1)
}

/// `[group][temperature][pressure]`
type Patch = [[[f64; 4]; 4]; 2];

/// The grid of film property groups of one fluid, filled where it is asked.
#[derive(Clone, Debug)]
pub(crate) struct FilmGrid {
    fluid: Fluid,
    nodes: RefCell<GridCache<[f64; 2]>>,
    patches: RefCell<GridCache<Patch>>,
    /// Last pressure, Pa, and its logarithm.
    last_pressure: Cell<(f64, f64)>,
}

impl FilmGrid {
    /// An empty grid.
    pub(crate) fn new(fluid: Fluid, kept: Kept) -> Self {
        Self {
            fluid,
            nodes: RefCell::new(GridCache::new(kept.nodes)),
            patches: RefCell::new(GridCache::new(kept.patches)),
            last_pressure: Cell::new((1.0, 0.0)),
        }
    }

    /// Interpolated property groups. NaN where the fluid has no single phase within 40 K above the state.
    pub(crate) fn groups(&self, temperature_k: f64, pressure_pa: f64) -> FilmGroups {
        let (i, u) = cell_of(temperature_k / STEP_K);
        let (j, v) = cell_of(self.ln_pressure(pressure_pa) / STEP_LN_P);
        let ((wt, dt), (wp, dp)) = (catmull_rom(u), catmull_rom(v));
        // First along the temperature, four pressures side by side.
        let interpolate = |values: &[[f64; 4]; 4]| {
            let (mut value, mut slope) = ([0.0; 4], [0.0; 4]);
            for ((row, w), d) in values.iter().zip(wt).zip(dt) {
                for b in 0..4 {
                    value[b] += w * row[b];
                    slope[b] += d * row[b];
                }
            }
            [dot(&value, &wp), dot(&slope, &wp) / STEP_K, dot(&value, &dp) / STEP_LN_P]
        };
        self.on_patch((i, j), |[ln_k, ln_r]| FilmGroups { ln_k: interpolate(ln_k), ln_r: interpolate(ln_r) })
    }

    /// `ln k` and `ln R` with their first two derivatives along temperature, 1/K and 1/K², and how far it is to the next cell, where the second one
    /// jumps, K.
    #[cfg(feature = "simulate")]
    fn along_temperature(&self, temperature_k: f64, pressure_pa: f64) -> ([[f64; 3]; 2], f64) {
        let (i, u) = cell_of(temperature_k / STEP_K);
        let (j, v) = cell_of(self.ln_pressure(pressure_pa) / STEP_LN_P);
        let ((wt, dt), (wp, _)) = (catmull_rom(u), catmull_rom(v));
        let second = [2.0 - 3.0 * u, 9.0 * u - 5.0, 4.0 - 9.0 * u, 3.0 * u - 1.0];
        let groups = self.on_patch((i, j), |patch| {
            patch.map(|group| {
                let at_pressure = group.map(|row| dot(&row, &wp));
                [
                    dot(&at_pressure, &wt),
                    dot(&at_pressure, &dt) / STEP_K,
                    dot(&at_pressure, &second) / (STEP_K * STEP_K),
                ]
            })
        });
        (groups, STEP_K * u.min(1.0 - u))
    }

    fn on_patch<T>(&self, index: GridIndex, read: impl FnOnce(&Patch) -> T) -> T {
        let mut patches = self.patches.borrow_mut();
        if patches.get(index).is_none() {
            patches.put(index, self.patch(index));
        }
        let Some(patch) = patches.get(index) else { unreachable!("the patch was just put in") };
        read(patch)
    }

    /// Surfaces of one vessel ask for one pressure, one after the other.
    fn ln_pressure(&self, pressure_pa: f64) -> f64 {
        let (known_pa, ln) = self.last_pressure.get();
        if pressure_pa == known_pa {
            return ln;
        }
        let ln = libm::log(pressure_pa);
        self.last_pressure.set((pressure_pa, ln));
        ln
    }

    fn patch(&self, (i, j): GridIndex) -> Patch {
        let nodes: [[[f64; 2]; 4]; 4] = from_fn(|a| from_fn(|b| self.node((beside(i, a), beside(j, b)))));
        [0, 1].map(|group| nodes.map(|row| row.map(|node| node[group])))
    }

    fn node(&self, index: GridIndex) -> [f64; 2] {
        if let Some(known) = self.nodes.borrow().get(index) {
            return *known;
        }
        let pressure = libm::exp(f64::from(index.1) * STEP_LN_P);
        // Beside the saturation line a stencil reaches into the liquid: take the nearest warmer gas.
        let node = (0..10)
            .find_map(|up| {
                let temperature = f64::from(index.0.saturating_add(up)) * STEP_K;
                film_groups_exact(&self.fluid, temperature, pressure).ok()
            })
            .map_or([f64::NAN; 2], |(ln_k, ln_r)| [ln_k, ln_r]);
        *self.nodes.borrow_mut().put(index, node)
    }
}

/// Heat flux into the gas with its partial derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct InsideFlux {
    /// Heat flux from the surface to the gas, W/m².
    pub flux_w_m2: f64,
    /// Derivative with the surface temperature, W/(m² K).
    pub per_surface_k: f64,
    /// Derivative with the gas temperature, W/(m² K).
    pub per_gas_k: f64,
    /// Derivative with the pressure, W/(m² Pa).
    pub per_pressure: f64,
}

/// A film law bound to a length and to the property grid of a gas.
#[derive(Clone, Debug)]
pub(crate) struct InsideConvection {
    law: InsideFilm,
    ln_length: f64,
    grid: FilmGrid,
}

impl InsideConvection {
    /// Film law `law` of a vessel of characteristic length `length_m` (its inner diameter; irrelevant for n = 1/3).
    pub(crate) fn new(law: InsideFilm, length_m: f64, fluid: Fluid, kept: Kept) -> Self {
        Self { law, ln_length: libm::log(length_m), grid: FilmGrid::new(fluid, kept) }
    }

    /// Heat flux from a surface at `surface_k` to gas at `gas_k` and `pressure_pa`, with `jet_w_m2_k` added for
    /// forced convection. A floor or ceiling has its own law: it stirs the gas or lets it rest.
    pub(crate) fn flux(
        &self,
        facing: Facing,
        surface_k: f64,
        gas_k: f64,
        pressure_pa: f64,
        jet_w_m2_k: f64,
    ) -> InsideFlux {
        let theta = surface_k - gas_k;
        let natural = match self.natural_law(facing, theta) {
            NaturalLaw::Coefficient(film_w_m2_k) => InsideFlux {
                flux_w_m2: film_w_m2_k * theta,
                per_surface_k: film_w_m2_k,
                per_gas_k: -film_w_m2_k,
                per_pressure: 0.0,
            },
            NaturalLaw::Rayleigh(law) => self.natural(law, theta, surface_k, pressure_pa),
        };
        InsideFlux {
            flux_w_m2: natural.flux_w_m2 + jet_w_m2_k * theta,
            per_surface_k: natural.per_surface_k + jet_w_m2_k,
            per_gas_k: natural.per_gas_k - jet_w_m2_k,
            per_pressure: natural.per_pressure,
        }
    }

    /// The same about a surface temperature, for a square metre, W, W/K, W/K², W/K³.
    #[cfg(feature = "simulate")]
    pub(crate) fn series(
        &self,
        facing: Facing,
        surface_k: f64,
        gas_k: f64,
        pressure_pa: f64,
        jet_w_m2_k: f64,
    ) -> FilmSeries {
        let theta = surface_k - gas_k;
        let mut series = match self.natural_law(facing, theta) {
            NaturalLaw::Coefficient(film_w_m2_k) => FilmSeries::linear(film_w_m2_k * theta, film_w_m2_k),
            NaturalLaw::Rayleigh(law) => {
                let series = self.natural_series(law, theta, surface_k, pressure_pa);
                // A plate has another law on the other side of the gas.
                let side_k = if facing == Facing::Side { f64::INFINITY } else { theta.abs() };
                FilmSeries { holds_k: series.holds_k.min(side_k), ..series }
            }
        };
        series.heat_w[0] += jet_w_m2_k * theta;
        series.heat_w[1] += jet_w_m2_k;
        series
    }

    /// What a surface has that is so much warmer than the gas.
    fn natural_law(&self, facing: Facing, theta: f64) -> NaturalLaw {
        let InsideFilm::Rayleigh { factor, exponent, multiplier } = self.law else {
            let InsideFilm::Coefficient { film_w_m2_k } = self.law else { unreachable!("two laws") };
            return NaturalLaw::Coefficient(film_w_m2_k);
        };
        let (factor, n, ln_length) = match facing {
            Facing::Side => (factor, exponent, self.ln_length),
            plate => {
                let stirs = (theta > 0.0) == (plate == Facing::Floor);
                let (factor, exponent) = if stirs { PLATE_STIRRED } else { PLATE_RESTING };
                (factor, exponent, self.ln_length + LN_QUARTER)
            }
        };
        NaturalLaw::Rayleigh(Rayleigh { factor: multiplier * factor, n, ln_length })
    }

    /// `c k L^(3n-1) R^n (theta^2 + theta_0^2)^(n/2) theta` and its derivatives.
    fn natural(&self, law: Rayleigh, theta: f64, surface_k: f64, pressure_pa: f64) -> InsideFlux {
        let n = law.n;
        let groups = self.grid.groups(surface_k - 0.5 * theta, pressure_pa);
        let square = theta * theta + FLAT_BELOW_K * FLAT_BELOW_K;
        let film = law.film_w_m2_k(groups.ln_k[0], groups.ln_r[0], square);
        let flux_w_m2 = film * theta;
        let per_theta = film * (1.0 + n * theta * theta / square);
        let per_film_k = flux_w_m2 * (groups.ln_k[1] + n * groups.ln_r[1]);
        InsideFlux {
            flux_w_m2,
            per_surface_k: per_theta + 0.5 * per_film_k,
            per_gas_k: -per_theta + 0.5 * per_film_k,
            per_pressure: flux_w_m2 * (groups.ln_k[2] + n * groups.ln_r[2]) / pressure_pa,
        }
    }

    /// The same as a series: `phi(theta) e^(a x + b x²/2)` with `phi = (theta^2 + theta_0^2)^(n/2) theta` and what the groups add, at half the
    /// change of the surface. The fifth derivative of `phi` is below 8 `phi' / (theta^2 + theta_0^2)^2`.
    #[cfg(feature = "simulate")]
    fn natural_series(&self, law: Rayleigh, theta: f64, surface_k: f64, pressure_pa: f64) -> FilmSeries {
        let n = law.n;
        let ([ln_k, ln_r], room_k) = self.grid.along_temperature(surface_k - 0.5 * theta, pressure_pa);
        let square = theta * theta + FLAT_BELOW_K * FLAT_BELOW_K;
        let film = law.film_w_m2_k(ln_k[0], ln_r[0], square);
        let (a, b) = (0.5 * (ln_k[1] + n * ln_r[1]), 0.25 * (ln_k[2] + n * ln_r[2]));
        let (part, t2) = (theta / square, theta * theta / square);
        let phi = [
            theta,
            1.0 + n * t2,
            n * part * (3.0 + (n - 2.0) * t2),
            n / square * (3.0 + (n - 2.0) * t2 * (6.0 + (n - 4.0) * t2)),
            n * (n - 2.0) * part / square * (15.0 + (n - 4.0) * t2 * (10.0 + (n - 6.0) * t2)),
        ];
        let e = [a, a * a + b, a * (a * a + 3.0 * b), a * a * (a * a + 6.0 * b) + 3.0 * b * b];
        let by = [
            phi[0],
            phi[1] + phi[0] * e[0],
            phi[2] + 2.0 * phi[1] * e[0] + phi[0] * e[1],
            phi[3] + 3.0 * (phi[2] * e[0] + phi[1] * e[1]) + phi[0] * e[2],
            phi[4] + 4.0 * (phi[3] * e[0] + phi[1] * e[2]) + 6.0 * phi[2] * e[1] + phi[0] * e[3],
        ];
        // The film's temperature moves half as far as the surface.
        let holds_k = (HOLDS * libm::sqrt(square)).min(GROUPS_HOLD_K).min(2.0 * room_k).max(LAST_STEP_K);
        FilmSeries { heat_w: by.map(|value| film * value), holds_k }
    }
}

/// The law of a surface.
enum NaturalLaw {
    /// Film coefficient, W/(m² K).
    Coefficient(f64),
    Rayleigh(Rayleigh),
}

/// `Nu = factor Ra^n`.
#[derive(Clone, Copy)]
struct Rayleigh {
    factor: f64,
    n: f64,
    ln_length: f64,
}

impl Rayleigh {
    /// Film coefficient, W/(m² K), of groups and `theta^2 + theta_0^2`, K².
    fn film_w_m2_k(self, ln_k: f64, ln_r: f64, square: f64) -> f64 {
        let Self { factor, n, ln_length } = self;
        let ln_film = ln_k + n * ln_r + (3.0 * n - 1.0) * ln_length + 0.5 * n * libm::log(square);
        factor * libm::exp(ln_film)
    }
}

/// Film of gas that jets stir, `h = 0.56 k / H Re^0.67`, W/(m² K), by the Reynolds number of the jet that keeps it in its motion.
///
/// `H` is the height of the gas. The law is one Nusselt number, `h H / k = 0.56 Re_d^0.67 + 0.104 Ra_H^0.352`, so both terms have one length.
///
/// # References
/// Woodfield et al. 2007, measured while filling hydrogen, nitrogen and argon into a standing vessel.
#[cfg(feature = "simulate")]
pub(crate) fn jet_film_w_m2_k<D: Real>(conductivity_w_m_k: D, reynolds: D, gas_height_m: f64) -> D {
    // Re^0.67, but linear where the motion dies.
    let power = reynolds * (reynolds * reynolds + LINEAR_BELOW_RE * LINEAR_BELOW_RE).powf(-0.165);
    power * conductivity_w_m_k * (0.56 / gas_height_m)
}

/// Rate per square of a Reynolds number, 1/s, at which stirred gas follows its jet and comes to rest without one:
/// `dRe/dt = B (Re_in² - Re²)`, `B = sqrt(pi)/2 nu / (3 D²)`.
///
/// The jet's momentum `rho u² D²` moves the gas at `u = sqrt(pi)/2 nu Re/D`. Turbulence whose eddies fill a vessel of half its diameter `l`
/// loses `epsilon = u³/(2 l)`, so that `du/dt = -u²/(3 D)`: the energy falls as `t^-2`.
///
/// # References
/// `epsilon` with the factor 1/2: Sreenivasan 1998; `t^-2` in a vessel: Skrbek and Stalp 2000 (measured), Touil et al. 2002 (simulated).
#[cfg(feature = "simulate")]
pub(crate) fn stirring_rate_per_s<D: Real>(viscosity_pa_s: D, density_kg_m3: D, vessel_diameter_m: f64) -> D {
    let per_viscosity =
        0.5 * libm::sqrt(core::f64::consts::PI) / (3.0 * vessel_diameter_m * vessel_diameter_m);
    viscosity_pa_s / density_kg_m3 * per_viscosity
}

#[cfg(test)]
mod tests {
    use super::*;

    const MCADAMS: InsideFilm = InsideFilm::Rayleigh { factor: 0.13, exponent: 1.0 / 3.0, multiplier: 1.0 };

    fn film(fluid: &str) -> InsideConvection {
        InsideConvection::new(MCADAMS, 0.19, Fluid::named(fluid).expect("known"), Kept::OF_ONE_SURFACE)
    }

    /// Coefficients computed with CoolProp for nitrogen (project reference "peers", section 6), printed without decimals.
    #[test]
    fn mcadams_film_has_the_published_coefficients() {
        let film = film("nitrogen");
        for (film_k, bar, theta, h) in [
            (288.0, 200.0, 0.1, 33.0),
            (288.0, 200.0, 1.0, 72.0),
            (288.0, 200.0, 10.0, 155.0),
            (288.0, 100.0, 1.0, 42.0),
            (288.0, 20.0, 10.0, 26.0),
            (253.0, 200.0, 1.0, 90.0),
        ] {
            let (warm, cold) = (film_k + 0.5 * theta, film_k - 0.5 * theta);
            let flux = film.flux(Facing::Side, warm, cold, bar * 1e5, 0.0).flux_w_m2;
            assert!((flux / theta - h).abs() < 0.02 * h + 0.5, "{bar} bar, {theta} K: {}", flux / theta);
        }
    }

    #[test]
    fn interpolated_groups_agree_with_exact_ones() {
        for name in Fluid::names() {
            let fluid = Fluid::named(name).expect("known");
            let grid = FilmGrid::new(fluid.clone(), Kept::OF_ONE_SURFACE);
            let mut worst = [0.0_f64; 2];
            // Nearer to the critical point the groups bend more than the grid follows.
            let domain = fluid.domain();
            let coldest_k =
                202.3_f64.max(1.35 * domain.critical_temperature_k).max(domain.lowest_temperature_k + 8.7);
            for i in 0..40 {
                let (t, p) = (coldest_k + 5.1 * f64::from(i), 1.7e5 * 1.127_f64.powi(i));
                let (ln_k, ln_r) = film_groups_exact(&fluid, t, p).expect("inside the domain");
                let groups = grid.groups(t, p);
                worst[0] = worst[0].max((groups.ln_k[0] - ln_k).abs());
                worst[1] = worst[1].max((groups.ln_r[0] - ln_r).abs());
            }
            assert!(worst[0] < 1e-5 && worst[1] < 1e-5, "{name}: {worst:?}");
        }
    }

    #[test]
    fn film_is_an_odd_function_with_a_finite_slope_at_rest() {
        let film = film("nitrogen");
        let rest = film.flux(Facing::Side, 288.0, 288.0, 2e7, 0.0);
        assert!(rest.flux_w_m2 == 0.0 && rest.per_surface_k > 10.0 && rest.per_surface_k < 20.0);
    }

    /// Against Newton's method on the film itself, to the last step: behind metal and behind plastic, from rest to a large difference.
    #[cfg(feature = "simulate")]
    #[test]
    fn one_expansion_gives_the_heat_of_the_film_to_its_bound() {
        use crate::transfer::{HalfCell, solve_surface, solve_surface_from};
        for fluid in ["nitrogen", "carbon-dioxide", "hydrogen"] {
            let film = film(fluid);
            for facing in [Facing::Side, Facing::Floor, Facing::Ceiling] {
                for (conductance_w_k, k) in
                    [60_000.0, 15_000.0, 300.0, 20.0].iter().flat_map(|g| (0..60).map(move |k| (*g, k)))
                {
                    let theta = (k as f64 / 3.0 - 14.0).exp2() * if k % 2 == 0 { 1.0 } else { -1.0 };
                    let half =
                        HalfCell { node_k: 320.0 + theta, conductance_w_k, conductance_slope_w_k2: 0.0 };
                    let count = Cell::new(0);
                    let found = solve_surface(&half, |surface_k| {
                        count.set(count.get() + 1);
                        film.series(facing, surface_k, 320.0, 3e6, 1.5)
                    });
                    let newton = |start_k| {
                        let film_w = |surface_k| {
                            let flux = film.flux(facing, surface_k, 320.0, 3e6, 1.5);
                            (flux.flux_w_m2, flux.per_surface_k, ())
                        };
                        solve_surface_from(&half, start_k, film_w).0
                    };
                    let exact = newton(newton(half.node_k).surface_k);
                    // The rounding of 320 K times a film of 100 W/(m² K) is 6e-12 W.
                    approx::assert_relative_eq!(
                        found.heat_w,
                        exact.heat_w,
                        max_relative = 1e-11,
                        epsilon = 1e-11
                    );
                    approx::assert_relative_eq!(found.film_factor, exact.film_factor, max_relative = 1e-6);
                    if conductance_w_k == 60_000.0 && theta.abs() < 2.0 {
                        assert_eq!(count.get(), 1, "{fluid}, {theta} K");
                    }
                }
            }
        }
    }

    #[test]
    fn hot_floor_stirs_more_than_a_hot_ceiling() {
        let film = film("nitrogen");
        let flux = |facing| film.flux(facing, 298.0, 288.0, 2e7, 0.0).flux_w_m2;
        assert!(
            flux(Facing::Floor) > 2.0 * flux(Facing::Ceiling) && flux(Facing::Floor) > flux(Facing::Side)
        );
    }
}

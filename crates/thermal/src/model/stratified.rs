//! The gas as stacked cells of (nearly) common pressure: what the spread inside the gas and sensor placement need.
//!
//! Each cell is a [`super::well_mixed`] node with mass `m_i` and energy `U_i`; what flows between neighbours
//! leaves one and enters the other, so mass and energy are conserved by construction.
//! * **Core flow** `C = K (p_i - p_(i+1))` with a conductance so large that neighbours differ by some 1e-5 of the
//!   pressure where a minute empties the vessel: the low-Mach limit, without an algebraic equation. It carries the enthalpy of the cell it leaves.
//! * **Boundary layer** along the side wall, marched upwards over heated cells and downwards over cooled ones. Mass
//!   flow by Eckert and Jackson, `m = 0.0979 P mu Gr_z^0.4 Pr^(-8/15) (1 + 0.494 Pr^(2/3))^(-0.4)`, limited by
//!   its buoyancy, `m (h_next - h_i) <= H`. It takes up the wall's heat and gives its excess `H` back to the core over
//!   the exchange length: `H` falls by `exp(-dz/(lambda D))` per cell; a layer that shrinks leaves at its own enthalpy.
//! * **Overturn** of inverted cells with mixing length `D/2`, `m_x = rho A l² sqrt(g beta dT/dz)/dz`.
//! * **Core mixing** `D_t = c w* D`, `w* = (g beta |q| D / (rho cp))^(1/3)`, beside molecular conduction.
//! * **End plates**: `0.15 Ra^(1/3)` where they destabilise, `0.27 Ra^(1/4)` where they do not, length D/4.
//!
//! # Validity
//! `lambda` (exchange length) and `c` (core mixing) are **uncertain**: they were fitted to one measured blowdown (run I1). In two discharges that they
//! were not fitted to, warmest and coldest gas differ by 1.5 times what two thermometers did (standing), and by a tenth of it (lying, where the wall
//! here has one temperature around its circumference). The end cells' temperatures depend on the cell count unless `c > 0`.
//! Mean temperature and pressure are as good with one node. 20 cells are the default; the book states what other counts change.
//! What flows in mixes with the cell at the valve alone, whatever its jet, so `simulate` refuses refills unless its settings want them.
//!
//! # References
//! Eckert and Jackson, NACA TN 2207 (1950); end plates: McAdams (1954) as in Incropera et al.
use crate::real::Dual;
use nalgebra::DMatrix;

use super::boundary::{Boundary, Exchange};
use super::grid::{GasCell, GasGrid};
use super::node::{Node, Rates};
use super::well_mixed::WellMixed;
use crate::ThermalError;
use crate::fluid::Real;
use crate::transfer::inside::GRAVITY_M_S2;
use crate::vessel::{InnerVolume, Stratification, Vessel};

/// Time in which a pressure difference between neighbours dies out, s: shorter than that of sound through a cell. And the sound speed that scales it, m/s.
const EQUALISATION_S: f64 = 1e-4;
const SOUND_M_S: f64 = 350.0;
/// Largest part of its content that the cell at the valve may exchange with the outside within [`EQUALISATION_S`]: about what its pressure differs by.
const LARGEST_EXCHANGE: f64 = 0.3;
/// Smoothing of sign changes: heat flow W, temperature difference K, enthalpy J/kg, mass flow kg/s.
const SMOOTH_W: f64 = 0.05;
const SMOOTH_K: f64 = 2e-2;
const SMOOTH_J_KG: f64 = 1.0;
const SMOOTH_KG_S: f64 = 1e-8;

/// Smooth positive part.
fn positive<D: Real>(x: D, width: f64) -> D {
    (x + (x * x + width * width).sqrt()) * 0.5
}

/// Smooth minimum of two positive numbers, `(a^-4 + b^-4)^(-1/4)`: 16 % below the smaller one where they are equal.
fn smaller<D: Real>(a: D, b: D) -> D {
    let (low, high) = if a.re() < b.re() { (a, b) } else { (b, a) };
    low * ((low / high).powi(4) + 1.0).powf(-0.25)
}

/// What the flow network needs of a cell.
#[derive(Clone, Copy, Debug)]
struct Core<D> {
    temperature_k: D,
    pressure_pa: D,
    density: D,
    enthalpy: D,
    cp: D,
    expansion: D,
    viscosity: D,
    conductivity: D,
}

impl<D: Real> Core<D> {
    fn map<E>(&self, f: impl Fn(D) -> E) -> Core<E> {
        Core {
            temperature_k: f(self.temperature_k),
            pressure_pa: f(self.pressure_pa),
            density: f(self.density),
            enthalpy: f(self.enthalpy),
            cp: f(self.cp),
            expansion: f(self.expansion),
            viscosity: f(self.viscosity),
            conductivity: f(self.conductivity),
        }
    }
}

/// What the wall does to the cells.
#[derive(Clone, Debug, Default)]
pub(super) struct WallAction<D> {
    /// Heat from the side wall into each cell, W.
    pub side_w: Vec<D>,
    /// Heat from plates into each cell, W.
    pub plate_w: Vec<D>,
    /// Mean temperature of the side wall's surface at each cell, K.
    pub surface_k: Vec<D>,
}

/// Net flows into each cell from its neighbours.
struct Network<D> {
    mass_kg_s: Vec<D>,
    enthalpy_w: Vec<D>,
}

/// The stacked gas of one vessel.
#[derive(Debug)]
pub(super) struct Stratified {
    nodes: Vec<WellMixed>,
    cells: Vec<GasCell>,
    outlet: usize,
    diameter_m: f64,
    constants: Stratification,
}

/// Derivatives of temperature and pressure of one cell with its (mass, energy, mean wall).
type CellGradients = ([f64; 3], [f64; 3]);

type Dual3 = Dual<3>;
/// Columns differentiated in one pass.
const LANES: usize = 8;
type Dual8 = Dual<LANES>;

fn gradient3(value: Dual3) -> [f64; 3] {
    let g = value.eps;
    [g[0], g[1], g[2]]
}

/// A number with the given derivatives.
fn dual8(value: f64, lanes: &[f64; LANES]) -> Dual8 {
    Dual { re: value, eps: *lanes }
}

impl Stratified {
    /// The stacked gas of a vessel, started near a temperature.
    pub(crate) fn new(
        vessel: &Vessel,
        grid: &GasGrid,
        constants: Stratification,
        temperature_k: f64,
    ) -> Self {
        let nodes = grid
            .cells
            .iter()
            .map(|cell| {
                let volume = InnerVolume {
                    volume_m3: vessel.volume.volume_m3 * cell.volume_fraction,
                    ..vessel.volume
                };
                WellMixed::new(vessel.fluid.clone(), volume, temperature_k)
            })
            .collect();
        Self {
            nodes,
            cells: grid.cells.clone(),
            outlet: grid.outlet,
            diameter_m: vessel.geometry.inner_diameter_m,
            constants,
        }
    }

    /// The node at the valve.
    pub(crate) fn outlet_node(&self) -> &WellMixed {
        &self.nodes[self.outlet]
    }

    /// States of all cells.
    ///
    /// # Errors
    /// A cell has no state.
    pub(crate) fn nodes(
        &self,
        mass_kg: &[f64],
        energy_j: &[f64],
        wall_k: f64,
    ) -> Result<Vec<Node<f64>>, ThermalError> {
        self.nodes
            .iter()
            .zip(mass_kg.iter().zip(energy_j))
            .map(|(node, (&m, &u))| node.node(m, u, wall_k))
            .collect()
    }

    fn core<D: Real>(&self, node: &Node<D>) -> Core<D> {
        let s = &node.state;
        let fluid = self.nodes[0].fluid();
        Core {
            temperature_k: s.temperature_k,
            pressure_pa: s.pressure_pa,
            density: s.density_kg_m3,
            enthalpy: s.enthalpy_j_kg,
            cp: s.cp_j_kg_k,
            expansion: s.expansion_per_k,
            viscosity: fluid.viscosity_pa_s(s.density_kg_m3, s.temperature_k),
            conductivity: fluid.conductivity_w_m_k(s.density_kg_m3, s.temperature_k),
        }
    }

    /// Rates of every cell and of the whole, for the wall's action and the rate of the mean wall temperature.
    ///
    /// # Errors
    /// An orifice without a throat state, or more flow than the cell at the valve can bear.
    pub(crate) fn rates(
        &self,
        nodes: &[Node<f64>],
        boundary: &Boundary<'_>,
        wall: &WallAction<f64>,
        wall_rate_k_s: f64,
    ) -> Result<(Vec<Rates<f64>>, Exchange<f64>), ThermalError> {
        let cores: Vec<Core<f64>> = nodes.iter().map(|node| self.core(node)).collect();
        let network = self.network(&cores, wall);
        let exchange = boundary.exchange(self.nodes[0].fluid(), &nodes[self.outlet].state)?;
        self.check_exchange(exchange.mass_kg_s.abs(), &nodes[self.outlet])?;
        let rates = nodes
            .iter()
            .enumerate()
            .map(|(i, node)| {
                let (mut mass, mut enthalpy) = (network.mass_kg_s[i], network.enthalpy_w[i]);
                if i == self.outlet {
                    mass += exchange.mass_kg_s;
                    enthalpy += exchange.enthalpy_w;
                }
                node.balance(mass, enthalpy, wall.side_w[i] + wall.plate_w[i], wall_rate_k_s)
            })
            .collect();
        Ok((rates, exchange))
    }

    fn check_exchange(&self, flow_kg_s: f64, outlet: &Node<f64>) -> Result<(), ThermalError> {
        let mass_kg = outlet.state.density_kg_m3 * outlet.volume_m3;
        let room = LARGEST_EXCHANGE * mass_kg / (flow_kg_s * EQUALISATION_S);
        if room >= 1.0 {
            return Ok(());
        }
        let cells = self.nodes.len();
        let at_most = ((0.8 * cells as f64 * room) as usize).max(1);
        Err(ThermalError::GasCellTooSmall { flow_kg_s, mass_kg, cells, at_most })
    }

    fn network<D: Real>(&self, cores: &[Core<D>], wall: &WallAction<D>) -> Network<D> {
        let n = cores.len();
        let zero = D::from(0.0);
        let mut flows = Network { mass_kg_s: vec![zero; n], enthalpy_w: vec![zero; n] };
        self.boundary_layer(cores, wall, true, &mut flows);
        self.boundary_layer(cores, wall, false, &mut flows);
        let mixing = self.core_diffusivity(cores, wall);
        for low in 0..n - 1 {
            let (a, b) = (&cores[low], &cores[low + 1]);
            let area = self.cells[low].face_above_m2;
            let dz = 0.5 * (self.cells[low].height_m + self.cells[low + 1].height_m);
            let conductance = area * dz / (SOUND_M_S * SOUND_M_S * EQUALISATION_S);
            let core = (a.pressure_pa - b.pressure_pa) * conductance;
            let magnitude = (core * core + SMOOTH_KG_S * SMOOTH_KG_S).sqrt();
            let difference = a.enthalpy - b.enthalpy;
            let carried = core * (a.enthalpy + b.enthalpy) * 0.5 + magnitude * difference * 0.5;
            let density = (a.density + b.density) * 0.5;
            let inverted = positive(a.temperature_k - b.temperature_k, 0.25 * SMOOTH_K);
            let overturn = density
                * (a.expansion * inverted * (GRAVITY_M_S2 / dz)).sqrt()
                * (area * (0.5 * self.diameter_m).powi(2) / dz);
            let molecular = (a.conductivity + b.conductivity) * 0.5 * (a.temperature_k - b.temperature_k);
            let heat = overturn * difference + (density * mixing * difference + molecular) * (area / dz);
            flows.mass_kg_s[low] -= core;
            flows.mass_kg_s[low + 1] += core;
            flows.enthalpy_w[low] -= carried + heat;
            flows.enthalpy_w[low + 1] += carried + heat;
        }
        flows
    }

    /// Core diffusivity `c w* D`, m²/s.
    fn core_diffusivity<D: Real>(&self, cores: &[Core<D>], wall: &WallAction<D>) -> D {
        let total: D = wall.side_w.iter().chain(&wall.plate_w).fold(D::from(0.0), |sum, &q| sum + q);
        let area: f64 = self.cells.iter().map(|cell| cell.side_m2).sum();
        let flux = (total * total + SMOOTH_W * SMOOTH_W).sqrt() / area;
        let middle = &cores[cores.len() / 2];
        let speed = (middle.expansion * flux / (middle.density * middle.cp)
            * (GRAVITY_M_S2 * self.diameter_m))
            .cbrt();
        speed * (self.constants.core_mixing * self.diameter_m)
    }

    /// March one boundary layer: upwards along cells the wall heats, downwards along cells it cools.
    fn boundary_layer<D: Real>(
        &self,
        cores: &[Core<D>],
        wall: &WallAction<D>,
        upwards: bool,
        flows: &mut Network<D>,
    ) {
        let n = cores.len();
        let sign = if upwards { 1.0 } else { -1.0 };
        let kept =
            (-self.cells[0].height_m / (self.constants.exchange_length_diameters * self.diameter_m)).exp();
        let zero = D::from(0.0);
        let (mut mass, mut enthalpy, mut run) = (zero, zero, zero);
        for step in 0..n - 1 {
            let (i, next) = if upwards { (step, step + 1) } else { (n - 1 - step, n - 2 - step) };
            let core = &cores[i];
            let heat = positive(wall.side_w[i] * sign, SMOOTH_W);
            let share = heat / ((wall.side_w[i] * wall.side_w[i] + 4.0 * SMOOTH_W * SMOOTH_W).sqrt());
            run = (run + self.cells[i].height_m) * share;
            // Excess enthalpy of the layer over this core, positive in the direction of its buoyancy.
            let excess = positive((enthalpy - mass * core.enthalpy) * sign + heat, SMOOTH_W);
            let theta = positive((wall.surface_k[i] - core.temperature_k) * sign, SMOOTH_K);
            let perimeter = self.cells[i].side_m2 / self.cells[i].height_m;
            let free = eckert_jackson(core, theta, run, perimeter);
            let step_up = positive((cores[next].enthalpy - core.enthalpy) * sign, SMOOTH_J_KG);
            let out = smaller(free, excess / step_up);
            let mut left = excess * kept;
            if out.re() < mass.re() {
                left = left * out / mass;
            }
            let carried = out * core.enthalpy + left * sign;
            flows.mass_kg_s[i] += mass - out;
            flows.enthalpy_w[i] += enthalpy - carried;
            (mass, enthalpy) = (out, carried);
        }
        let last = if upwards { n - 1 } else { 0 };
        flows.mass_kg_s[last] += mass;
        flows.enthalpy_w[last] += enthalpy;
        // The wall's heat itself enters the cell in `balance`; the march only moves it on.
    }

    /// Exact derivatives of [`Stratified::rates`], by dual numbers: once per cell for the equation of state, in
    /// passes of eight columns for the flow network. Shapes as in `GasBlock`.
    ///
    /// # Errors
    /// As [`Stratified::rates`].
    pub(crate) fn jacobian(
        &self,
        mass_kg: &[f64],
        energy_j: &[f64],
        wall_k: f64,
        boundary: &Boundary<'_>,
        wall: &WallAction<f64>,
        wall_rate_k_s: f64,
    ) -> Result<(DMatrix<f64>, Vec<CellGradients>), ThermalError> {
        let n = self.nodes.len();
        let seed = |value: f64, index: usize| Dual3::variable(value, index);
        let nodes: Vec<Node<Dual3>> = (0..n)
            .map(|i| self.nodes[i].differentiated(seed(mass_kg[i], 0), seed(energy_j[i], 1), seed(wall_k, 2)))
            .collect::<Result<_, _>>()?;
        let exchange = boundary.exchange(self.nodes[0].fluid(), &nodes[self.outlet].state)?;
        let cores: Vec<Core<Dual3>> = nodes.iter().map(|node| self.core(node)).collect();
        let columns = 5 * n + 2;
        let mut matrix = DMatrix::zeros(2 * n + 3, columns);
        for first in (0..columns).step_by(LANES) {
            // Derivatives of the value of cell `i` along the lanes of this pass.
            let lift = |value: Dual3, i: usize| {
                let g = gradient3(value);
                let mut lanes = [0.0; LANES];
                for (lane, slot) in lanes.iter_mut().enumerate() {
                    *slot = match first + lane {
                        c if c == i => g[0],
                        c if c == n + i => g[1],
                        c if c == 2 * n => g[2],
                        _ => 0.0,
                    };
                }
                dual8(value.re, &lanes)
            };
            let input = |value: f64, column: usize| {
                let mut lanes = [0.0; LANES];
                if let Some(lane) = column.checked_sub(first).filter(|&lane| lane < LANES) {
                    lanes[lane] = 1.0;
                }
                dual8(value, &lanes)
            };
            let vector = |values: &[f64], offset: usize| -> Vec<Dual8> {
                values.iter().enumerate().map(|(i, &value)| input(value, offset + i)).collect()
            };
            let wall8 = WallAction {
                side_w: vector(&wall.side_w, 2 * n + 2),
                plate_w: vector(&wall.plate_w, 3 * n + 2),
                surface_k: vector(&wall.surface_k, 4 * n + 2),
            };
            let rate8 = input(wall_rate_k_s, 2 * n + 1);
            let cores8: Vec<Core<Dual8>> =
                cores.iter().enumerate().map(|(i, core)| core.map(|value| lift(value, i))).collect();
            let network = self.network(&cores8, &wall8);
            let (mass_in, enthalpy_in) =
                (lift(exchange.mass_kg_s, self.outlet), lift(exchange.enthalpy_w, self.outlet));
            let mut work = Dual8::from(0.0);
            let mut write = |row: usize, value: Dual8| {
                let g = value.eps;
                for lane in 0..LANES.min(columns - first) {
                    matrix[(row, first + lane)] = g[lane];
                }
            };
            for (i, node) in nodes.iter().enumerate() {
                let node = node.map(|value| lift(value, i));
                let (mut mass, mut enthalpy) = (network.mass_kg_s[i], network.enthalpy_w[i]);
                if i == self.outlet {
                    mass += mass_in;
                    enthalpy += enthalpy_in;
                }
                let rates = node.balance(mass, enthalpy, wall8.side_w[i] + wall8.plate_w[i], rate8);
                write(i, rates.mass_kg_s);
                write(n + i, rates.energy_w);
                work += rates.work_w;
            }
            write(2 * n, mass_in);
            write(2 * n + 1, enthalpy_in);
            write(2 * n + 2, work);
        }
        let cells =
            cores.iter().map(|core| (gradient3(core.temperature_k), gradient3(core.pressure_pa))).collect();
        Ok((matrix, cells))
    }
}

/// Mass flow of the turbulent boundary layer on a vertical wall after a run of length `run`, kg/s.
fn eckert_jackson<D: Real>(core: &Core<D>, theta_k: D, run_m: D, perimeter_m: f64) -> D {
    let prandtl = core.cp * core.viscosity / core.conductivity;
    let kinematic = core.viscosity / core.density;
    let grashof = core.expansion * theta_k * run_m.powi(3) / (kinematic * kinematic) * GRAVITY_M_S2;
    let profile = (prandtl.powf(2.0 / 3.0) * 0.494 + 1.0).powf(-0.4);
    core.viscosity * (grashof + 1.0).powf(0.4) * prandtl.powf(-8.0 / 15.0) * profile * (0.0979 * perimeter_m)
}

//! The coupled model: wall cells, valve, gas and ledger as one system of ordinary differential equations.
//!
//! * Wall and valve cells: `C dx/dt = sum of heat flows`, conduction by [`crate::wall::conduction`].
//! * Inner faces: film to the gas cells in contact, outer faces: film, radiation and sun, both through half
//!   a wall cell whose surface temperature is solved ([`crate::transfer`]).
//! * Gas: [`well_mixed`] (one node) or [`stratified`] (stacked cells).
//! * Ledger: heat, enthalpy, mass and work that cross the boundary, integrated beside the states.
//!
//! Every flow leaves one balance and enters another with the same number, so mass and energy are conserved by
//! construction: `d(wall + valve + gas)/dt = heat in + enthalpy in - work out` holds exactly at every
//! evaluation, and exactly too for the Jacobian, so that an implicit integrator keeps it to rounding.
pub mod grid;
pub mod inputs;
mod jacobian;
pub mod layout;
mod output;
pub mod stratified;
pub mod well_mixed;

use std::cell::RefCell;

use crate::ThermalError;
use crate::flow::{Flow, FlowKind};
use crate::fluid::Fluid;
use crate::scenario::{Fill, Initial, Scenario, Sun};
use crate::transfer::inside::{InsideConvection, InsideFlux};
use crate::transfer::outside::{Body, convection_w_m2_k, radiation_w_m2};
use crate::transfer::{HalfCell, SurfaceBalance, solve_surface};
use crate::vessel::{GasResolution, Surface, Valve, Vessel};
use crate::wall::conduction::link_flow;
use crate::wall::material::Material;
use crate::wall::mesh::{Facing, Mesh};
use grid::{Contact, GasGrid};
use inputs::{FilmInput, Inputs};
use layout::Layout;
use stratified::{Stratified, WallAction};
use well_mixed::{Boundary, Node, WellMixed, jet_film};

pub use jacobian::Assembly;
pub use output::Output;

/// The system of equations of one vessel with one set of flows.
#[derive(Debug)]
pub struct Model {
    mesh: Mesh,
    layout: Layout,
    /// Heat capacity of each wall cell at the reference temperature, J/K.
    capacity_j_k: Vec<f64>,
    wall_capacity_j_k: f64,
    /// Mixture of the wall's materials by capacity: turns the mean wall state into a temperature.
    mean_material: Material,
    valve: Option<Valve>,
    surface: Surface,
    body: Body,
    valve_body: Body,
    /// Sunlit, absorbing area of each column, m².
    absorbing_m2: Vec<f64>,
    valve_absorbing_m2: f64,
    inside: InsideConvection,
    fluid: Fluid,
    gas: Gas,
    grid: GasGrid,
    inner_diameter_m: f64,
    flows: Vec<Flow>,
    source_enthalpy_j_kg: Vec<f64>,
    scratch: RefCell<Scratch>,
}

/// How the gas is resolved.
#[derive(Debug)]
enum Gas {
    WellMixed(Box<WellMixed>),
    Stratified(Stratified),
}

/// Reused memory of one evaluation.
#[derive(Debug, Default)]
struct Scratch {
    temperature_k: Vec<f64>,
    points: Vec<GasPoint>,
    wall: WallAction<f64>,
}

/// What the film needs of a gas cell.
#[derive(Clone, Copy, Debug)]
struct GasPoint {
    temperature_k: f64,
    pressure_pa: f64,
}

impl From<&Node<f64>> for GasPoint {
    fn from(node: &Node<f64>) -> Self {
        Self { temperature_k: node.state.temperature_k, pressure_pa: node.state.pressure_pa }
    }
}

/// States of the gas cells and the film of a refill's jet.
#[derive(Debug)]
enum GasNodes {
    One(Node<f64>),
    Many(Vec<Node<f64>>),
}

impl GasNodes {
    fn as_slice(&self) -> &[Node<f64>] {
        match self {
            Self::One(node) => std::slice::from_ref(node),
            Self::Many(nodes) => nodes,
        }
    }
}

impl Model {
    /// The model of a vessel under a scenario's flows and sun.
    ///
    /// # Errors
    /// The source of a refill is outside the fluid's domain.
    pub fn new(vessel: &Vessel, scenario: &Scenario) -> Result<Self, ThermalError> {
        let mesh = Mesh::new(&vessel.geometry);
        let capacity_j_k: Vec<f64> = (0..mesh.cells())
            .map(|cell| {
                let material = &mesh.materials[mesh.material[cell]];
                mesh.volume_m3[cell] * material.density_kg_m3 * material.heat_capacity_j_kg_k
            })
            .collect();
        let geometry = &vessel.geometry;
        let outer_diameter_m = geometry.inner_diameter_m + 2.0 * geometry.thickness_m();
        let height_m = geometry.outer_height_m();
        let grid = GasGrid::new(vessel, &mesh);
        let layout = Layout::new(mesh.cells(), vessel.valve.is_some(), grid.cells.len());
        let start_k = scenario.initial.gas_temperature_k;
        let absorptivity = vessel.surface.solar_absorptivity;
        let sun = scenario.surroundings.sun.as_ref();
        Ok(Self {
            absorbing_m2: lit_area_m2(&mesh, sun).iter().map(|area| area * absorptivity).collect(),
            valve_absorbing_m2: match (&vessel.valve, sun) {
                (Some(valve), Some(Sun { valve: true, .. })) => {
                    absorptivity * valve.area_m2 / std::f64::consts::PI
                }
                _ => 0.0,
            },
            layout,
            mean_material: capacity_mixture(&mesh, &capacity_j_k),
            wall_capacity_j_k: capacity_j_k.iter().sum(),
            capacity_j_k,
            valve: vessel.valve.clone(),
            surface: vessel.surface,
            body: Body { orientation: geometry.orientation, diameter_m: outer_diameter_m, height_m },
            valve_body: vessel.valve.as_ref().map_or(
                Body { orientation: geometry.orientation, diameter_m: outer_diameter_m, height_m },
                |valve| Body {
                    orientation: geometry.orientation,
                    diameter_m: valve.diameter_m,
                    height_m: valve.diameter_m,
                },
            ),
            inside: InsideConvection::new(
                vessel.inside_film,
                geometry.inner_diameter_m,
                vessel.fluid.clone(),
            ),
            gas: match vessel.gas {
                GasResolution::Stratified(constants) if grid.cells.len() > 1 => {
                    Gas::Stratified(Stratified::new(vessel, &grid, constants, start_k))
                }
                _ => Gas::WellMixed(Box::new(WellMixed::new(vessel.fluid.clone(), vessel.volume, start_k))),
            },
            fluid: vessel.fluid.clone(),
            grid,
            inner_diameter_m: geometry.inner_diameter_m,
            source_enthalpy_j_kg: source_enthalpies(vessel, &scenario.flows)?,
            flows: scenario.flows.clone(),
            mesh,
            scratch: RefCell::default(),
        })
    }

    /// Where each quantity stands in the state vector.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// The wall's mesh.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// State vector at time 0.
    ///
    /// # Errors
    /// The fill is outside the fluid's domain, two-phase included.
    pub fn initial_state(&self, vessel: &Vessel, initial: &Initial) -> Result<Vec<f64>, ThermalError> {
        let mut x = vec![0.0; self.layout.states];
        for (cell, value) in x[..self.layout.wall].iter_mut().enumerate() {
            *value = self.mesh.materials[self.mesh.material[cell]].energy_state_k(initial.wall_temperature_k);
        }
        if let (Some(index), Some(valve)) = (self.layout.valve, &self.valve) {
            x[index] = valve.material.energy_state_k(initial.wall_temperature_k);
        }
        x[self.layout.mean_wall] =
            self.capacity_j_k.iter().zip(&x).map(|(c, x)| c * x).sum::<f64>() / self.wall_capacity_j_k;
        let fluid = &vessel.fluid;
        let volume = |wall_k: f64, p: f64| vessel.volume.volume_m3(wall_k, p);
        let mean_wall_k = self.mean_wall_k(&x);
        let mass = match initial.fill {
            Fill::Mass { mass_kg } => mass_kg,
            Fill::Settled { pressure_pa, temperature_k } => {
                fluid.density_from_pressure_temperature(pressure_pa, temperature_k)?
                    * volume(temperature_k, pressure_pa)
            }
            Fill::Pressure { pressure_pa } => {
                fluid.density_from_pressure_temperature(pressure_pa, initial.gas_temperature_k)?
                    * volume(mean_wall_k, pressure_pa)
            }
        };
        // The volume answers to the pressure, which answers to the volume: a contraction by about 0.003.
        let mut v = vessel.volume.volume_m3;
        for _ in 0..30 {
            v = volume(mean_wall_k, fluid.pressure_pa(mass / v, initial.gas_temperature_k));
        }
        let state = fluid.checked_state(mass / v, initial.gas_temperature_k)?;
        for (i, cell) in self.grid.cells.iter().enumerate() {
            x[self.layout.mass + i] = mass * cell.volume_fraction;
            x[self.layout.energy + i] = mass * cell.volume_fraction * state.internal_energy_j_kg;
        }
        Ok(x)
    }

    /// Right-hand side `dx/dt`. Lengths of `x` and `rate`: the number of states.
    ///
    /// # Errors
    /// The gas has no state for its mass and energy, or an orifice no throat.
    pub fn rate(
        &self,
        x: &[f64],
        inputs: &Inputs,
        open: &[bool],
        rate: &mut [f64],
    ) -> Result<(), ThermalError> {
        let layout = &self.layout;
        let scratch = &mut *self.scratch.borrow_mut();
        self.node_temperatures(x, &mut scratch.temperature_k);
        let temperature_k = &scratch.temperature_k;
        rate.fill(0.0);
        for link in &self.mesh.links {
            let heat = link_flow(&self.mesh, link, temperature_k).heat_w;
            rate[link.a] -= heat;
            rate[link.b] += heat;
        }
        let nodes = self.gas_nodes(x)?;
        let jet = self.jet_w_m2_k(&nodes, open);
        scratch.points.clear();
        scratch.points.extend(nodes.as_slice().iter().map(GasPoint::from));
        let (points, wall) = (&scratch.points, &mut scratch.wall);
        self.reset_action(wall);
        let (mut to_gas, mut from_outside, mut through_valve) = (0.0, 0.0, 0.0);
        for column in 0..self.mesh.columns.len() {
            let inner = self.inner_face(column, temperature_k, points, jet);
            rate[self.mesh.inner_cell(column)] -= inner.heat_w;
            to_gas += inner.heat_w;
            self.act(column, inner.surface_k, inner.heat_w, points, jet, wall);
            let outer = self.outer_face(column, temperature_k, inputs).heat_w;
            rate[self.mesh.outer_cell(column)] -= outer;
            from_outside -= outer;
        }
        self.finish_action(wall);
        let mut valve_outside = 0.0;
        if let (Some(index), Some(valve)) = (layout.valve, &self.valve) {
            let contact = self.contact_cell();
            let valve_k = valve.material.temperature_k(x[index]);
            through_valve = valve.contact_w_k * (valve_k - temperature_k[contact]);
            rate[contact] += through_valve;
            valve_outside = -self.valve_loss(valve, valve_k, inputs).0;
            rate[index] = (valve_outside - through_valve) / valve.capacity_j_k();
        }
        for (value, capacity) in rate[..layout.wall].iter_mut().zip(&self.capacity_j_k) {
            *value /= capacity;
        }
        let mean_rate = (from_outside + through_valve - to_gas) / self.wall_capacity_j_k;
        rate[layout.mean_wall] = mean_rate;
        rate[layout.heat_in] = from_outside + valve_outside;
        let mean_rate_k_s = self.mean_material.temperature_slope(x[layout.mean_wall]) * mean_rate;
        self.gas_rates(&nodes, open, to_gas, wall, mean_rate_k_s, rate)
    }

    /// Mean wall temperature, K: the one that a uniform wall of the same energy would have.
    fn mean_wall_k(&self, x: &[f64]) -> f64 {
        self.mean_material.temperature_k(x[self.layout.mean_wall])
    }

    /// Rates of the gas and of its ledger entries.
    fn gas_rates(
        &self,
        nodes: &GasNodes,
        open: &[bool],
        to_gas_w: f64,
        wall: &WallAction<f64>,
        mean_rate_k_s: f64,
        rate: &mut [f64],
    ) -> Result<(), ThermalError> {
        let layout = &self.layout;
        let boundary = self.boundary(open);
        match (&self.gas, nodes) {
            (Gas::WellMixed(gas), GasNodes::One(node)) => {
                let gas = gas.rates(node, &boundary, to_gas_w, mean_rate_k_s)?;
                rate[layout.mass] = gas.mass_kg_s;
                rate[layout.energy] = gas.energy_w;
                rate[layout.enthalpy_in] = gas.enthalpy_w;
                rate[layout.mass_in] = gas.mass_kg_s;
                rate[layout.work_out] = gas.work_w;
            }
            (Gas::Stratified(gas), nodes) => {
                let (cells, exchange) = gas.rates(nodes.as_slice(), &boundary, wall, mean_rate_k_s)?;
                let mut work = 0.0;
                for (i, cell) in cells.iter().enumerate() {
                    rate[layout.mass + i] = cell.mass_kg_s;
                    rate[layout.energy + i] = cell.energy_w;
                    work += cell.work_w;
                }
                rate[layout.enthalpy_in] = exchange.enthalpy_w;
                rate[layout.mass_in] = exchange.mass_kg_s;
                rate[layout.work_out] = work;
            }
            (Gas::WellMixed(_), GasNodes::Many(_)) => unreachable!("a well-mixed gas has one node"),
        }
        Ok(())
    }

    fn gas_nodes(&self, x: &[f64]) -> Result<GasNodes, ThermalError> {
        let layout = &self.layout;
        let mean = self.mean_wall_k(x);
        match &self.gas {
            Gas::WellMixed(gas) => Ok(GasNodes::One(gas.node(x[layout.mass], x[layout.energy], mean)?)),
            Gas::Stratified(gas) => {
                let (mass, rest) = x[layout.mass..].split_at(layout.gas);
                Ok(GasNodes::Many(gas.nodes(mass, &rest[..layout.gas], mean)?))
            }
        }
    }

    fn jet_w_m2_k(&self, nodes: &GasNodes, open: &[bool]) -> f64 {
        let outlet = &nodes.as_slice()[self.grid.outlet];
        jet_film(&self.fluid, outlet, &self.flows, open, self.inner_diameter_m)
    }

    fn reset_action(&self, wall: &mut WallAction<f64>) {
        for values in [&mut wall.side_w, &mut wall.plate_w, &mut wall.surface_k] {
            values.clear();
            values.resize(self.layout.gas, 0.0);
        }
    }

    /// Add what a column does to the cells it touches; a single cell takes the column's heat as it is.
    fn act(
        &self,
        column: usize,
        surface_k: f64,
        heat_w: f64,
        points: &[GasPoint],
        jet_w_m2_k: f64,
        wall: &mut WallAction<f64>,
    ) {
        if let Gas::WellMixed(_) = self.gas {
            wall.side_w[0] += heat_w;
            return;
        }
        for contact in &self.grid.contacts[column] {
            let heat = contact.area_m2 * self.contact_flux(contact, surface_k, points, jet_w_m2_k).flux_w_m2;
            if contact.facing == Facing::Side {
                wall.side_w[contact.cell] += heat;
                wall.surface_k[contact.cell] += contact.area_m2 * surface_k;
            } else {
                wall.plate_w[contact.cell] += heat;
            }
        }
    }

    /// Turn the area-weighted sums of surface temperatures into means.
    fn finish_action(&self, wall: &mut WallAction<f64>) {
        for (surface_k, cell) in wall.surface_k.iter_mut().zip(&self.grid.cells) {
            *surface_k /= cell.side_m2;
        }
    }

    fn contact_flux(
        &self,
        contact: &Contact,
        surface_k: f64,
        points: &[GasPoint],
        jet_w_m2_k: f64,
    ) -> InsideFlux {
        let gas = &points[contact.cell];
        self.inside.flux(contact.facing, surface_k, gas.temperature_k, gas.pressure_pa, jet_w_m2_k)
    }

    fn boundary<'a>(&'a self, open: &'a [bool]) -> Boundary<'a> {
        Boundary { flows: &self.flows, open, source_enthalpy_j_kg: &self.source_enthalpy_j_kg }
    }

    fn node_temperatures(&self, x: &[f64], temperature_k: &mut Vec<f64>) {
        temperature_k.clear();
        temperature_k.extend(
            x[..self.layout.wall]
                .iter()
                .zip(&self.mesh.material)
                .map(|(&x, &material)| self.mesh.materials[material].temperature_k(x)),
        );
    }

    /// Wall cell that the valve sits on.
    fn contact_cell(&self) -> usize {
        self.mesh.outer_cell(self.mesh.columns.len() - 1)
    }

    fn half_cell(&self, cell: usize, shape_m: f64, node_k: f64) -> HalfCell {
        let material = &self.mesh.materials[self.mesh.material[cell]];
        HalfCell {
            node_k,
            conductance_w_k: shape_m * material.conductivity_at_w_m_k(node_k),
            conductance_slope_w_k2: shape_m * material.conductivity_w_m_k * material.conductivity_slope_per_k,
        }
    }

    fn inner_face(
        &self,
        column: usize,
        temperature_k: &[f64],
        points: &[GasPoint],
        jet_w_m2_k: f64,
    ) -> SurfaceBalance {
        let cell = self.mesh.inner_cell(column);
        let half = self.half_cell(cell, self.mesh.columns[column].inner_shape_m, temperature_k[cell]);
        solve_surface(&half, |surface_k| {
            self.grid.contacts[column].iter().fold((0.0, 0.0), |(heat, slope), contact| {
                let flux = self.contact_flux(contact, surface_k, points, jet_w_m2_k);
                (heat + contact.area_m2 * flux.flux_w_m2, slope + contact.area_m2 * flux.per_surface_k)
            })
        })
    }

    fn outer_face(&self, column: usize, temperature_k: &[f64], inputs: &Inputs) -> SurfaceBalance {
        let geometry = &self.mesh.columns[column];
        let cell = self.mesh.outer_cell(column);
        let half = self.half_cell(cell, geometry.outer_shape_m, temperature_k[cell]);
        let sun = self.absorbing_m2[column] * inputs.irradiance_w_m2;
        solve_surface(&half, |surface_k| {
            let (heat, slope) = self.loss(&self.body, 1.0, surface_k, inputs);
            (geometry.outer_area_m2 * heat - sun, geometry.outer_area_m2 * slope)
        })
    }

    /// Heat flux from a surface to the surroundings without sun, W/m², and its derivative with the surface temperature.
    fn loss(&self, body: &Body, film_factor: f64, surface_k: f64, inputs: &Inputs) -> (f64, f64) {
        let difference = surface_k - inputs.air_k;
        let (mut heat, mut slope) = match inputs.film {
            FilmInput::Coefficient(film) => (film_factor * film * difference, film_factor * film),
            FilmInput::Convection { wind_m_s, multiplier } => {
                let surface = num_dual::Dual64::from(surface_k).derivative();
                let flux = convection_w_m2_k(body, surface, inputs.air_k, wind_m_s)
                    * (surface - inputs.air_k)
                    * multiplier;
                (flux.re, flux.eps)
            }
        };
        if let Some(enclosure_k) = inputs.radiation_k {
            let surface = num_dual::Dual64::from(surface_k).derivative();
            let flux = radiation_w_m2(self.surface.emissivity, surface, enclosure_k);
            heat += flux.re;
            slope += flux.eps;
        }
        (heat, slope)
    }

    /// Heat flow from the valve to the surroundings, W, and its derivative with the valve's temperature.
    fn valve_loss(&self, valve: &Valve, valve_k: f64, inputs: &Inputs) -> (f64, f64) {
        let (heat, slope) = self.loss(&self.valve_body, valve.film_factor, valve_k, inputs);
        let sun = self.valve_absorbing_m2 * inputs.irradiance_w_m2;
        (valve.area_m2 * heat - sun, valve.area_m2 * slope)
    }
}

/// One material with the whole wall's heat capacity and its slope.
fn capacity_mixture(mesh: &Mesh, capacity_j_k: &[f64]) -> Material {
    let mut parts: Vec<(&Material, f64)> = mesh.materials.iter().map(|material| (material, 0.0)).collect();
    for (cell, &material) in mesh.material.iter().enumerate() {
        let solid = &mesh.materials[material];
        parts[material].1 += capacity_j_k[cell] / (solid.density_kg_m3 * solid.heat_capacity_j_kg_k);
    }
    Material::mixture(&parts)
}

/// Projected area of each column in the sun, m²: its outer area over pi, times the lit part of its height.
fn lit_area_m2(mesh: &Mesh, sun: Option<&Sun>) -> Vec<f64> {
    let Some(sun) = sun else { return vec![0.0; mesh.columns.len()] };
    let top = mesh.columns.iter().map(|c| c.inner_height_m.1).fold(0.0, f64::max);
    let (from, to) = (sun.from_fraction * top, sun.to_fraction * top);
    mesh.columns
        .iter()
        .map(|column| {
            let (low, high) = column.inner_height_m;
            let lit = if high > low {
                ((high.min(to) - low.max(from)) / (high - low)).max(0.0)
            } else {
                f64::from(u8::from(from <= low && low <= to))
            };
            lit * column.outer_area_m2 / std::f64::consts::PI
        })
        .collect()
}

fn source_enthalpies(vessel: &Vessel, flows: &[Flow]) -> Result<Vec<f64>, ThermalError> {
    flows
        .iter()
        .map(|flow| match flow.kind {
            FlowKind::Refill { source_temperature_k: t, source_pressure_pa: p, .. } => {
                let rho = vessel.fluid.density_from_pressure_temperature(p, t)?;
                Ok(vessel.fluid.checked_state(rho, t)?.enthalpy_j_kg)
            }
            _ => Ok(0.0),
        })
        .collect()
}

#[cfg(test)]
mod tests;

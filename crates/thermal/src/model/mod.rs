//! The coupled model: wall cells, valve, gas and ledger as one system of ordinary differential equations.
//!
//! * Wall and valve cells: `C dx/dt = sum of heat flows`, conduction by `wall::conduction`.
//! * Inner faces: film to the gas cells in contact, outer faces: film, radiation and sun, both through half
//!   a wall cell whose surface temperature is solved ([`crate::transfer`]).
//! * Gas: `well_mixed` (one node) or `stratified` (stacked cells).
//! * Ledger: heat, enthalpy, mass and work that cross the boundary, integrated beside the states.
//!
//! Every flow leaves one balance and enters another with the same number, so mass and energy are conserved by
//! construction: `d(wall + valve + gas)/dt = heat in + enthalpy in - work out` holds exactly at every
//! evaluation, and exactly too for the Jacobian, so that an implicit integrator keeps it to rounding.
mod boundary;
mod coefficients;
mod faces;
mod gas;
mod grid;
mod initial;
pub mod inputs;
mod jacobian;
pub mod layout;
mod node;
mod output;
mod stratified;
mod supply;
mod well_mixed;

use std::cell::RefCell;

use crate::ThermalError;
use crate::flow::Flow;
use crate::fluid::Fluid;
use crate::scenario::{Scenario, Sun};
use crate::transfer::inside::{InsideConvection, Kept};
use crate::transfer::outside::Body;
use crate::vessel::{GasResolution, Surface, Valve, Vessel};
use crate::wall::conduction::link_flow;
use crate::wall::material::Material;
use crate::wall::mesh::Mesh;
use gas::{Gas, GasPoint};
use grid::GasGrid;
use inputs::Inputs;
use layout::Layout;
use stratified::{Stratified, WallAction};
use supply::{Supply, supplies};
use well_mixed::WellMixed;

pub(crate) use boundary::Margins;
pub use coefficients::{ConvertedCoefficient, with_real_gas_coefficients};
pub(crate) use output::Output;

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
    /// How much above the middle each column lies, as a fraction of the height: -1/2 to 1/2.
    above_middle: Vec<f64>,
    film_slope: f64,
    /// Sunlit, absorbing area of each column, m².
    absorbing_m2: Vec<f64>,
    valve_absorbing_m2: f64,
    inside: InsideConvection,
    fluid: Fluid,
    gas: Gas,
    grid: GasGrid,
    inner_diameter_m: f64,
    gas_height_m: f64,
    jet_film_factor: f64,
    flows: Vec<Flow>,
    supplies: Vec<Option<Supply>>,
    scratch: RefCell<Scratch>,
}

/// Reused memory of one evaluation.
#[derive(Debug, Default)]
struct Scratch {
    temperature_k: Vec<f64>,
    points: Vec<GasPoint>,
    wall: WallAction<f64>,
}

/// Area of each column that absorbs the sun, m².
fn absorbing_m2(mesh: &Mesh, sun: Option<&Sun>, absorptivity: f64) -> Vec<f64> {
    let Some(sun) = sun else { return vec![0.0; mesh.columns.len()] };
    let lit_m2 = mesh.lit_area_m2((sun.from_fraction, sun.to_fraction));
    lit_m2.iter().map(|area| area * absorptivity).collect()
}

impl Model {
    /// The model of a vessel under a scenario's flows and sun.
    ///
    /// # Errors
    /// The source of a refill is outside the fluid's domain.
    pub fn new(vessel: &Vessel, scenario: &Scenario) -> Result<Self, ThermalError> {
        Self::on_mesh(Mesh::new(&vessel.geometry), vessel, scenario)
    }

    /// The model on a mesh that was made for this vessel, e.g. a coarse one.
    ///
    /// # Errors
    /// As [`Model::new`].
    pub(crate) fn on_mesh(mesh: Mesh, vessel: &Vessel, scenario: &Scenario) -> Result<Self, ThermalError> {
        let capacity_j_k: Vec<f64> = (0..mesh.cells())
            .map(|cell| {
                let material = &mesh.materials[mesh.material[cell]];
                mesh.volume_m3[cell] * material.density_kg_m3 * material.heat_capacity_j_kg_k
            })
            .collect();
        let geometry = &vessel.geometry;
        let outer_diameter_m = geometry.inner_diameter_m + 2.0 * geometry.thickness_m();
        let body = Body {
            orientation: geometry.orientation,
            diameter_m: outer_diameter_m,
            height_m: geometry.outer_height_m(),
        };
        let grid = GasGrid::new(vessel, &mesh);
        let flows = coefficients::real_gas_flows(vessel, scenario)?;
        let (supplies, sources) = supplies(&vessel.fluid, &flows)?;
        let jets = flows.iter().any(|flow| flow.kind.has_jet());
        let layout = Layout::new(mesh.cells(), vessel.valve.is_some(), grid.cells.len(), sources, jets);
        let start_k = scenario.initial.gas_temperature_k;
        let absorptivity = vessel.surface.solar_absorptivity;
        let sun = scenario.surroundings.sun.as_ref();
        Ok(Self {
            above_middle: mesh.above_middle(),
            film_slope: scenario.surroundings.axial.film_slope,
            absorbing_m2: absorbing_m2(&mesh, sun, absorptivity),
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
            body,
            valve_body: vessel.valve.as_ref().map_or(body, |valve| Body {
                diameter_m: valve.diameter_m,
                height_m: valve.diameter_m,
                ..body
            }),
            inside: InsideConvection::new(
                vessel.inside_film,
                geometry.inner_diameter_m,
                vessel.fluid.clone(),
                Kept::OF_MANY_SURFACES,
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
            gas_height_m: geometry.gas_height_m(),
            jet_film_factor: vessel.jet_film_factor,
            supplies,
            flows,
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
        let boundary = self.boundary(x, inputs, open);
        let jet = self.jet_w_m2_k(&nodes, x);
        scratch.points.clear();
        scratch.points.extend(nodes.as_slice().iter().map(GasPoint::from));
        let (points, wall) = (&scratch.points, &mut scratch.wall);
        self.reset_action(wall);
        let (mut to_gas, mut from_outside, mut through_valve) = (0.0, 0.0, 0.0);
        for column in 0..self.mesh.columns.len() {
            let inner = self.inner_face(column, temperature_k, points, jet);
            let given_w = self.act(column, inner.surface_k, inner.heat_w, points, jet, wall);
            rate[self.mesh.inner_cell(column)] -= given_w;
            to_gas += given_w;
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
        if let Some(stirring) = layout.stirring {
            let outlet = &nodes.as_slice()[self.grid.outlet];
            let diameter_m = self.inner_diameter_m;
            rate[stirring] = boundary.stirring_per_s(&self.fluid, outlet, diameter_m, x[stirring], None)?;
        }
        self.gas_rates(&nodes, &boundary, to_gas, wall, mean_rate_k_s, rate)
    }

    /// Mean wall temperature, K: the one that a uniform wall of the same energy would have.
    fn mean_wall_k(&self, x: &[f64]) -> f64 {
        self.mean_material.temperature_k(x[self.layout.mean_wall])
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

#[cfg(test)]
mod tests;

//! The model's gas side: states of the gas cells, what the wall does to them, their rates.
use super::Model;
use super::boundary::Boundary;
use super::grid::Contact;
use super::inputs::Inputs;
use super::node::Node;
use super::stratified::{Stratified, WallAction};
use super::supply::{SourceVessel, Supply};
use super::well_mixed::WellMixed;
use crate::ThermalError;
use crate::fluid::Real;
use crate::transfer::FilmSeries;
use crate::transfer::inside::{InsideFlux, jet_film_w_m2_k};
use crate::wall::mesh::Facing;

/// How the gas is resolved.
#[derive(Debug)]
pub(super) enum Gas {
    WellMixed(Box<WellMixed>),
    Stratified(Stratified),
}

/// What the film needs of a gas cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct GasPoint {
    pub temperature_k: f64,
    pub pressure_pa: f64,
}

impl From<&Node<f64>> for GasPoint {
    fn from(node: &Node<f64>) -> Self {
        Self { temperature_k: node.state.temperature_k, pressure_pa: node.state.pressure_pa }
    }
}

/// States of the gas cells.
#[derive(Debug)]
pub(super) enum GasNodes {
    One(Node<f64>),
    Many(Vec<Node<f64>>),
}

impl GasNodes {
    pub(super) fn as_slice(&self) -> &[Node<f64>] {
        match self {
            Self::One(node) => std::slice::from_ref(node),
            Self::Many(nodes) => nodes,
        }
    }
}

impl Model {
    /// Rates of the gas, of its ledger entries and of its sources.
    pub(super) fn gas_rates(
        &self,
        nodes: &GasNodes,
        boundary: &Boundary<'_>,
        to_gas_w: f64,
        wall: &WallAction<f64>,
        mean_rate_k_s: f64,
        rate: &mut [f64],
    ) -> Result<(), ThermalError> {
        let layout = &self.layout;
        match (&self.gas, nodes) {
            (Gas::WellMixed(gas), GasNodes::One(node)) => {
                let gas = gas.rates(node, boundary, to_gas_w, mean_rate_k_s)?;
                rate[layout.mass] = gas.mass_kg_s;
                rate[layout.energy] = gas.energy_w;
                rate[layout.enthalpy_in] = gas.enthalpy_w;
                rate[layout.mass_in] = gas.mass_kg_s;
                rate[layout.work_out] = gas.work_w;
            }
            (Gas::Stratified(gas), nodes) => {
                let (cells, exchange) = gas.rates(nodes.as_slice(), boundary, wall, mean_rate_k_s)?;
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
        let outlet = &nodes.as_slice()[self.grid.outlet].state;
        for (index, vessel) in self.source_vessels() {
            let drawn = boundary.drawn_kg[vessel.place];
            if boundary.open[index] {
                rate[layout.drawn + vessel.place] =
                    boundary.of_flow(index, &self.fluid, outlet, drawn)?.mass_kg_s;
            }
        }
        Ok(())
    }

    pub(super) fn gas_nodes(&self, x: &[f64]) -> Result<GasNodes, ThermalError> {
        let layout = &self.layout;
        let mean = self.mean_wall_k(x);
        match &self.gas {
            Gas::WellMixed(gas) => Ok(GasNodes::One(gas.node(x[layout.mass], x[layout.energy], mean)?)),
            Gas::Stratified(gas) => {
                let (mass, energy) = layout.gas_of(x);
                Ok(GasNodes::Many(gas.nodes(mass, energy, mean)?))
            }
        }
    }

    /// Source vessels with the indices of their flows.
    pub(super) fn source_vessels(&self) -> impl Iterator<Item = (usize, &SourceVessel)> {
        self.supplies.iter().enumerate().filter_map(|(index, supply)| match supply {
            Some(Supply::Vessel(vessel)) => Some((index, vessel)),
            _ => None,
        })
    }

    /// Film of the gas that jets stir, W/(m² K), 0 without one; properties of the outlet's cell.
    pub(super) fn jet_w_m2_k(&self, nodes: &GasNodes, x: &[f64]) -> f64 {
        let Some(stirring) = self.layout.stirring else { return 0.0 };
        self.jet_film(&nodes.as_slice()[self.grid.outlet], x[stirring])
    }

    pub(super) fn jet_film<D: Real>(&self, outlet: &Node<D>, reynolds: D) -> D {
        let state = &outlet.state;
        let k = self.fluid.conductivity_w_m_k(state.density_kg_m3, state.temperature_k);
        jet_film_w_m2_k(k, reynolds, self.gas_height_m) * self.jet_film_factor
    }

    pub(super) fn reset_action(&self, wall: &mut WallAction<f64>) {
        for values in [&mut wall.side_w, &mut wall.plate_w, &mut wall.surface_k] {
            values.clear();
            values.resize(self.layout.gas, 0.0);
        }
    }

    /// Add what a column does to the cells it touches and return the heat it gives, W, so that wall and gas book the
    /// same number; a single cell takes the column's heat as it is.
    pub(super) fn act(
        &self,
        column: usize,
        surface_k: f64,
        heat_w: f64,
        points: &[GasPoint],
        jet_w_m2_k: f64,
        wall: &mut WallAction<f64>,
    ) -> f64 {
        if let Gas::WellMixed(_) = self.gas {
            wall.side_w[0] += heat_w;
            return heat_w;
        }
        let mut given_w = 0.0;
        for contact in &self.grid.contacts[column] {
            let heat = contact.area_m2 * self.contact_flux(contact, surface_k, points, jet_w_m2_k).flux_w_m2;
            given_w += heat;
            if contact.facing == Facing::Side {
                wall.side_w[contact.cell] += heat;
                wall.surface_k[contact.cell] += contact.area_m2 * surface_k;
            } else {
                wall.plate_w[contact.cell] += heat;
            }
        }
        given_w
    }

    /// Turn the area-weighted sums of surface temperatures into means.
    pub(super) fn finish_action(&self, wall: &mut WallAction<f64>) {
        for (surface_k, cell) in wall.surface_k.iter_mut().zip(&self.grid.cells) {
            *surface_k /= cell.side_m2;
        }
    }

    pub(super) fn contact_flux(
        &self,
        contact: &Contact,
        surface_k: f64,
        points: &[GasPoint],
        jet_w_m2_k: f64,
    ) -> InsideFlux {
        let gas = &points[contact.cell];
        self.inside.flux(contact.facing, surface_k, gas.temperature_k, gas.pressure_pa, jet_w_m2_k)
    }

    pub(super) fn contact_series(
        &self,
        contact: &Contact,
        surface_k: f64,
        points: &[GasPoint],
        jet_w_m2_k: f64,
    ) -> FilmSeries {
        let gas = &points[contact.cell];
        self.inside.series(contact.facing, surface_k, gas.temperature_k, gas.pressure_pa, jet_w_m2_k)
    }

    pub(super) fn boundary<'a>(&'a self, x: &'a [f64], inputs: &Inputs, open: &'a [bool]) -> Boundary<'a> {
        Boundary {
            flows: &self.flows,
            open,
            supplies: &self.supplies,
            moment: inputs.moment,
            drawn_kg: &x[self.layout.drawn..],
        }
    }
}

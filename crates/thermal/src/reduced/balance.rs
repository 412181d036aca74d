//! Heat balances of the reduced model's nodes with their derivatives.
//!
//! Until [`ReducedModel::divide_by_capacities`] the rows of rate and Jacobian hold heat flows into the nodes, W, and the gas
//! row the heat flow into the gas; then they hold rates, K/s.
use crate::real::powi;
use nalgebra::DMatrix;

use super::gas::{GasState, Slope};
use super::{ReducedModel, Unknowns, capacity_ratio};
use crate::transfer::{HalfCell, solve_surface_from};
use crate::wall::conduction::link_flow;
use crate::wall::mesh::{Facing, TOP};

type Jacobian<'a> = Option<&'a mut DMatrix<f64>>;

impl ReducedModel {
    pub(super) fn add_conduction(&self, x: &[f64], rate: &mut [f64], jacobian: Jacobian<'_>) {
        let mut jacobian = jacobian;
        for link in &self.mesh.links {
            let flow = link_flow(&self.mesh, link, x);
            rate[link.a] -= flow.heat_w;
            rate[link.b] += flow.heat_w;
            if let Some(j) = jacobian.as_deref_mut() {
                j[(link.a, link.a)] -= flow.per_a_k;
                j[(link.a, link.b)] -= flow.per_b_k;
                j[(link.b, link.a)] += flow.per_a_k;
                j[(link.b, link.b)] += flow.per_b_k;
            }
        }
    }

    pub(super) fn add_inner_faces(
        &mut self,
        x: &[f64],
        unknowns: &Unknowns,
        gas: &GasState<Slope>,
        rate: &mut [f64],
        mut jacobian: Jacobian<'_>,
    ) {
        let (gas_row, mass) = (self.gas_index(), self.mass_index());
        let (gas_k, pressure_pa) = (x[gas_row], gas.pressure_pa.value);
        let multiplier = libm::exp(unknowns.ln_inside_film);
        let inside_column = self.states() + Unknowns::INSIDE;
        for node in 0..self.wall_nodes() {
            let column = &self.mesh.columns[node];
            let area = column.inner_area_m2 * multiplier;
            let half = self.half_cell(x[node], column.inner_shape_m);
            let (face, flux) = solve_surface_from(&half, x[node] - self.skin_k[node], |surface_k| {
                let flux = self.inside.flux(Facing::Side, surface_k, gas_k, pressure_pa, 0.0);
                (area * flux.flux_w_m2, area * flux.per_surface_k, flux)
            });
            let skin_k = x[node] - face.surface_k;
            // A start for the next solve, which must not inherit what went wrong in this one.
            self.skin_k[node] = if skin_k.is_finite() { skin_k } else { 0.0 };
            rate[node] -= face.heat_w;
            rate[gas_row] += face.heat_w;
            let Some(j) = jacobian.as_deref_mut() else { continue };
            let per_pressure = face.film_factor * area * flux.per_pressure;
            let [p_gas, p_mass, p_wall] = gas.pressure_pa.by;
            let mut add = |column: usize, by: f64| {
                j[(node, column)] -= by;
                j[(gas_row, column)] += by;
            };
            add(node, face.heat_per_node_k);
            add(gas_row, face.film_factor * area * flux.per_gas_k + per_pressure * p_gas);
            add(mass, per_pressure * p_mass);
            add(inside_column, face.film_factor * face.heat_w);
            for other in 0..self.mesh.columns.len() {
                add(other, per_pressure * p_wall * self.mean_wall_by[other]);
            }
        }
    }

    pub(super) fn add_outer_faces(
        &self,
        x: &[f64],
        unknowns: &Unknowns,
        film_w_m2_k: f64,
        rate: &mut [f64],
        mut jacobian: Jacobian<'_>,
    ) {
        let n = self.states();
        for (node, column) in self.mesh.columns.iter().enumerate() {
            let lit = self.spread.lit[node];
            let sun_w = lit * unknowns.sun_w;
            let height = self.above_middle[node];
            let everywhere = column.outer_area_m2 * film_w_m2_k;
            let slope = everywhere * (1.0 + unknowns.film_slope * height);
            let half = self.half_cell(x[node], column.outer_shape_m);
            let film = |surface_k: f64| (slope * (surface_k - unknowns.air_k) - sun_w, slope, ());
            let (face, ()) = solve_surface_from(&half, x[node], film);
            rate[node] -= face.heat_w;
            let Some(j) = jacobian.as_deref_mut() else { continue };
            j[(node, node)] -= face.heat_per_node_k;
            j[(node, n + Unknowns::AIR)] += face.film_factor * slope;
            j[(node, n + Unknowns::OUTSIDE)] -= face.film_factor * slope * (face.surface_k - unknowns.air_k);
            j[(node, n + Unknowns::SLOPE)] -=
                face.film_factor * everywhere * height * (face.surface_k - unknowns.air_k);
            j[(node, n + Unknowns::SUN)] += lit * face.film_factor;
        }
    }

    pub(super) fn add_valve(
        &self,
        x: &[f64],
        unknowns: &Unknowns,
        film_w_m2_k: f64,
        rate: &mut [f64],
        jacobian: Jacobian<'_>,
    ) {
        let (Some(index), Some(valve)) = (self.valve_index(), &self.valve) else { return };
        let conductance_w_k = self.spread.conductance_w_k;
        let sun_rise_k_w = self.spread.top_rise_k_w;
        let (top, n) = (index - 1, self.states());
        let everywhere = valve.area_m2 * valve.film_factor * film_w_m2_k;
        let slope = everywhere * (1.0 + unknowns.film_slope * TOP);
        let contact_w = conductance_w_k * (x[index] - x[top] - sun_rise_k_w * unknowns.sun_w);
        rate[top] += contact_w;
        rate[index] = unknowns.valve_sun * unknowns.sun_w - contact_w - slope * (x[index] - unknowns.air_k);
        let Some(j) = jacobian else { return };
        j[(top, index)] += conductance_w_k;
        j[(top, top)] -= conductance_w_k;
        j[(index, top)] += conductance_w_k;
        j[(index, index)] -= conductance_w_k + slope;
        j[(index, n + Unknowns::AIR)] += slope;
        j[(index, n + Unknowns::OUTSIDE)] -= slope * (x[index] - unknowns.air_k);
        j[(index, n + Unknowns::SLOPE)] -= everywhere * TOP * (x[index] - unknowns.air_k);
        j[(index, n + Unknowns::SUN)] += unknowns.valve_sun + conductance_w_k * sun_rise_k_w;
        j[(index, n + Unknowns::VALVE_SUN)] = unknowns.sun_w;
        j[(top, n + Unknowns::SUN)] -= conductance_w_k * sun_rise_k_w;
    }

    /// From heat flows to rates of wall and valve; keeps the rate of the mean wall temperature with its derivatives.
    pub(super) fn divide_by_capacities(
        &mut self,
        x: &[f64],
        unknowns: &Unknowns,
        rate: &mut [f64],
        jacobian: Jacobian<'_>,
    ) {
        let (nodes, n) = (self.wall_nodes(), self.states());
        let width = n + Unknowns::COUNT;
        let stretch = libm::exp(unknowns.ln_capacity);
        let mean_state = self.mean_energy_state_k(x);
        let material = &self.mesh.materials[0];
        let mean_slope = material.temperature_slope(mean_state);
        let scale = mean_slope / (self.wall_capacity_j_k * stretch);
        let mean_energy_rate: f64 = rate[..nodes].iter().sum::<f64>() / (self.wall_capacity_j_k * stretch);
        self.mean_rate_k_s = mean_slope * mean_energy_rate;
        if let Some(j) = jacobian {
            for (by, column) in self.mean_rate_by[..width].iter_mut().zip(j.as_slice().chunks_exact(n)) {
                *by = scale * column[..nodes].iter().sum::<f64>();
            }
            self.mean_rate_by[n + Unknowns::CAPACITY] = -self.mean_rate_k_s;
            // The slope itself falls as the wall warms: d slope = -a slope^3 dx.
            let curvature = -material.heat_capacity_slope_per_k * powi(mean_slope, 3) * mean_energy_rate;
            for (node, &temperature_k) in x.iter().enumerate().take(nodes) {
                self.mean_rate_by[node] +=
                    curvature * self.weight(node) * capacity_ratio(material, temperature_k);
            }
            for node in 0..self.gas_index() {
                let (capacity, ln_slope) = self.node_capacity(node, x[node]);
                let value = rate[node] / (capacity * stretch);
                let inverse = 1.0 / (capacity * stretch);
                j.as_mut_slice()[node..].iter_mut().step_by(n).for_each(|by| *by *= inverse);
                j[(node, node)] -= value * ln_slope;
                j[(node, n + Unknowns::CAPACITY)] = -value;
            }
        }
        for node in 0..self.gas_index() {
            rate[node] /= self.node_capacity(node, x[node]).0 * stretch;
        }
    }

    pub(super) fn close_gas(
        &self,
        unknowns: &Unknowns,
        gas: &GasState<Slope>,
        rate: &mut [f64],
        jacobian: Jacobian<'_>,
    ) {
        let (row, mass, n) = (self.gas_index(), self.mass_index(), self.states());
        let outflow = unknowns.outflow_kg_s;
        let capacity = gas.capacity_j_k.value;
        let heat_w =
            rate[row] - gas.per_wall_j_k.value * self.mean_rate_k_s - gas.per_outflow_j_kg.value * outflow;
        rate[row] = heat_w / capacity;
        rate[mass] = -outflow;
        let Some(j) = jacobian else { return };
        for (to, by) in j.as_mut_slice()[row..].iter_mut().step_by(n).zip(&self.mean_rate_by) {
            *to -= gas.per_wall_j_k.value * by;
        }
        j[(row, n + Unknowns::OUTFLOW)] -= gas.per_outflow_j_kg.value;
        j[(mass, n + Unknowns::OUTFLOW)] = -1.0;
        // What depends on the gas state itself: by gas temperature, mass, mean wall temperature.
        let own = |i: usize| {
            gas.per_wall_j_k.by[i] * self.mean_rate_k_s
                + gas.per_outflow_j_kg.by[i] * outflow
                + gas.capacity_j_k.by[i] * rate[row]
        };
        j[(row, row)] -= own(0);
        j[(row, mass)] -= own(1);
        for node in 0..self.wall_nodes() {
            j[(row, node)] -= own(2) * self.mean_wall_by[node];
        }
        let inverse = 1.0 / capacity;
        j.as_mut_slice()[row..].iter_mut().step_by(n).for_each(|by| *by *= inverse);
    }

    fn half_cell(&self, node_k: f64, shape_m: f64) -> HalfCell {
        let material = &self.mesh.materials[0];
        HalfCell {
            node_k,
            conductance_w_k: shape_m * material.conductivity_at_w_m_k(node_k),
            conductance_slope_w_k2: shape_m * material.conductivity_w_m_k * material.conductivity_slope_per_k,
        }
    }

    /// Heat capacity of a wall node or the valve, J/K, and its logarithmic derivative by temperature, 1/K.
    fn node_capacity(&self, node: usize, temperature_k: f64) -> (f64, f64) {
        let (material, at_reference) = match (&self.valve, self.capacity_j_k.get(node)) {
            (_, Some(&capacity)) => (&self.mesh.materials[0], capacity),
            (Some(valve), None) => (&valve.material, valve.capacity_j_k()),
            (None, None) => unreachable!("a node is of the wall or the valve"),
        };
        let ratio = capacity_ratio(material, temperature_k);
        (at_reference * ratio, material.heat_capacity_slope_per_k / ratio)
    }
}

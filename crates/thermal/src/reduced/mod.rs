//! The reduced model: a few wall nodes, the valve and one well-mixed gas node, in temperatures and gas mass.
//!
//! The same equations as [`crate::model::Model`] on a coarse wall (`Mesh::coarse`), with the same conduction, films and
//! equation of state, but in the variables an observer estimates, with the inputs an observer does not know
//! (air, sun, multipliers on films and capacity, outflow), and without allocation. States
//! `x = [T_w,1 .. T_w,N | T_valve | T_gas | m]`:
//!
//! * wall node `i`: `e^c C_i(T_i) dT_i/dt = -e^i q_in,i - e^o q_out,i + conduction + contact + sun`
//! * valve: `e^c C_v dT_v/dt = contact - e^o q_out + sun`
//! * gas: `gas` (this folder); `dm/dt = -r`
//!
//! The exponents `o, i, c` are the logarithms of multipliers ([`Unknowns`]). Outside there is one film coefficient for
//! convection and radiation together. [`ReducedModel::rates`] also gives the exact Jacobian with all states
//! and unknowns.
mod balance;
mod chart;
mod gas;
mod spread;

use alloc::vec::Vec;
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use crate::ThermalError;
use crate::fluid::Fluid;
use crate::sensor::SurfacePlace;
use crate::transfer::inside::{InsideConvection, Kept};
use crate::vessel::{Valve, Vessel};
use crate::wall::geometry::Geometry;
use crate::wall::material::{Material, REFERENCE_TEMPERATURE_K};
use crate::wall::mesh::Mesh;
use gas::GasNode;
use spread::Spread;

/// What acts on the cylinder and what is uncertain about it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unknowns {
    /// Temperature of the surroundings, K.
    pub air_k: f64,
    /// Logarithm of the multiplier on the outside film.
    pub ln_outside_film: f64,
    /// Logarithm of the multiplier on the inside film.
    pub ln_inside_film: f64,
    /// Logarithm of the multiplier on the heat capacity of wall and valve.
    pub ln_capacity: f64,
    /// Sun absorbed by the upper quarter of the wall, W, on each node in proportion to what of it is lit; the valve absorbs [`Unknowns::valve_sun`] of it beside.
    pub sun_w: f64,
    /// Part of the sun on the wall that the valve absorbs beside, usually [`ReducedModel::VALVE_SUN`]; 0 in the shade.
    pub valve_sun: f64,
    /// Change of the outside film from bottom to top relative to that in the middle.
    pub film_slope: f64,
    /// Mass flow out, kg/s.
    pub outflow_kg_s: f64,
}

impl Unknowns {
    /// Number of unknowns: columns of the Jacobian behind the states, in the order of the fields.
    pub const COUNT: usize = 8;
    /// Column of [`Unknowns::air_k`] behind the states.
    pub(crate) const AIR: usize = 0;
    /// Column of [`Unknowns::ln_outside_film`].
    pub(crate) const OUTSIDE: usize = 1;
    /// Column of [`Unknowns::ln_inside_film`].
    pub(crate) const INSIDE: usize = 2;
    /// Column of [`Unknowns::ln_capacity`].
    pub(crate) const CAPACITY: usize = 3;
    /// Column of [`Unknowns::sun_w`].
    pub(crate) const SUN: usize = 4;
    /// Column of [`Unknowns::valve_sun`].
    pub(crate) const VALVE_SUN: usize = 5;
    /// Column of [`Unknowns::film_slope`].
    pub(crate) const SLOPE: usize = 6;
    /// Column of [`Unknowns::outflow_kg_s`].
    pub(crate) const OUTFLOW: usize = 7;

    /// Nothing but surroundings of a temperature, K.
    pub fn still(air_k: f64) -> Self {
        Self {
            air_k,
            ln_outside_film: 0.0,
            ln_inside_film: 0.0,
            ln_capacity: 0.0,
            sun_w: 0.0,
            valve_sun: ReducedModel::VALVE_SUN,
            film_slope: 0.0,
            outflow_kg_s: 0.0,
        }
    }
}

/// Pressure with its derivatives by gas temperature, mass and mean wall temperature.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pressure {
    /// Pressure, Pa.
    pub pressure_pa: f64,
    /// By gas temperature, Pa/K.
    pub per_gas_k: f64,
    /// By mass, Pa/kg.
    pub per_mass_kg: f64,
    /// By mean wall temperature, Pa/K.
    pub per_wall_k: f64,
}

/// Start of the iterations inside a [`ReducedModel`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WarmStart {
    volumes_m3: [f64; 2],
    skin_k: Vec<f64>,
}

/// Temperature of a place on the surface, `T = x_state + valve_share (x_valve - x_top) + sun_rise Q_sun` with the topmost
/// wall node and the sun on it ([`Unknowns::sun_w`]).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceState {
    /// Index of its wall node or of the valve.
    pub state: usize,
    /// Share of the valve's departure from the topmost node.
    pub valve_share: f64,
    /// Rise over the node in the sun, K/W.
    pub sun_rise_k_w: f64,
}

/// The reduced model of one vessel.
#[derive(Clone, Debug)]
pub struct ReducedModel {
    mesh: Mesh,
    node_of_column: Vec<usize>,
    geometry: Geometry,
    fine: Mesh,
    /// Heat capacity of each wall node at the reference temperature, J/K.
    capacity_j_k: Vec<f64>,
    wall_capacity_j_k: f64,
    /// Height of each wall node above the middle as a fraction of the inner height.
    above_middle: Vec<f64>,
    valve: Option<Valve>,
    /// How the heat of valve and sun spreads in the wall.
    spread: Spread,
    film_w_m2_k: f64,
    inside: InsideConvection,
    gas: GasNode,
    /// Last difference between each wall node and its inner surface, K: where the next solve starts.
    skin_k: Vec<f64>,
    /// Derivative of the mean wall temperature with that of each wall node at the last evaluation.
    mean_wall_by: Vec<f64>,
    /// Rate of the mean wall temperature at the last evaluation, K/s.
    mean_rate_k_s: f64,
    /// Its derivatives.
    mean_rate_by: Vec<f64>,
}

impl ReducedModel {
    /// Part of the sun on the wall that a valve usually absorbs beside.
    pub const VALVE_SUN: f64 = 0.25;

    /// A vessel's model with so many wall nodes (at most as many as its wall has columns) and an outside film
    /// coefficient for convection and radiation together, W/(m² K).
    pub fn new(vessel: &Vessel, nodes: usize, film_w_m2_k: f64) -> Self {
        let (mesh, node_of_column) = Mesh::coarse(&vessel.geometry, nodes);
        let capacity_j_k: Vec<f64> = mesh
            .volume_m3
            .iter()
            .zip(&mesh.material)
            .map(|(volume, &m)| {
                volume * mesh.materials[m].density_kg_m3 * mesh.materials[m].heat_capacity_j_kg_k
            })
            .collect();
        let nodes = mesh.columns.len();
        let fine = Mesh::of_mixture(&vessel.geometry);
        let contact_w_k = vessel.valve.as_ref().map_or(0.0, |valve| valve.contact_w_k);
        let spread = Spread::new(&fine, &node_of_column, contact_w_k, film_w_m2_k);
        Self {
            geometry: vessel.geometry.clone(),
            fine,
            spread,
            node_of_column,
            wall_capacity_j_k: capacity_j_k.iter().sum(),
            capacity_j_k,
            above_middle: mesh.above_middle(),
            valve: vessel.valve.clone(),
            film_w_m2_k,
            inside: InsideConvection::new(
                vessel.inside_film,
                vessel.geometry.inner_diameter_m,
                vessel.fluid.clone(),
                Kept::OF_ONE_SURFACE,
            ),
            gas: GasNode::new(vessel.fluid.clone(), vessel.volume),
            skin_k: vec![0.0; nodes],
            mean_wall_by: vec![0.0; nodes],
            mean_rate_k_s: 0.0,
            mean_rate_by: vec![0.0; nodes + 3 + Unknowns::COUNT],
            mesh,
        }
    }

    /// Number of wall nodes.
    pub fn wall_nodes(&self) -> usize {
        self.mesh.columns.len()
    }

    /// The gas.
    pub fn fluid(&self) -> &Fluid {
        self.gas.fluid()
    }

    /// Mass of the densest gas that the equation of state knows, kg, at the reference volume.
    pub fn highest_mass_kg(&self) -> f64 {
        self.fluid().domain().highest_density_kg_m3 * self.gas.reference_volume_m3()
    }

    /// Where the iterative solutions of the next evaluation start. The solutions depend on it in their last digits, so
    /// a computation that must repeat to the last digit starts from the same.
    pub fn warm_start(&self) -> WarmStart {
        let (volumes_m3, skin_k) = self.warm_start_parts();
        WarmStart { volumes_m3, skin_k: skin_k.to_vec() }
    }

    /// The same where it is, to be serialised without a copy.
    pub fn warm_start_parts(&self) -> ([f64; 2], &[f64]) {
        (self.gas.guesses_m3(), &self.skin_k)
    }

    /// The same, in the memory of another one.
    pub fn write_warm_start(&self, start: &mut WarmStart) {
        start.volumes_m3 = self.gas.guesses_m3();
        start.skin_k.clone_from(&self.skin_k);
    }

    /// Start the next evaluation as another one did.
    pub fn set_warm_start(&mut self, start: &WarmStart) {
        self.gas.set_guesses_m3(start.volumes_m3);
        self.skin_k.clone_from(&start.skin_k);
    }

    /// Whether a start can be one of this model's: of as many nodes, with volumes that this vessel may have.
    pub fn fits_warm_start(&self, start: &WarmStart) -> bool {
        let reference_m3 = self.gas.reference_volume_m3();
        let volumes = 0.1 * reference_m3..=10.0 * reference_m3;
        start.skin_k.len() == self.skin_k.len()
            && start.skin_k.iter().all(|skin_k| skin_k.is_finite())
            && start.volumes_m3.iter().all(|volume_m3| volumes.contains(volume_m3))
    }

    /// Index of the valve's temperature, if there is a valve.
    pub fn valve_index(&self) -> Option<usize> {
        self.valve.as_ref().map(|_| self.wall_nodes())
    }

    /// Index of the gas temperature.
    pub(crate) fn gas_index(&self) -> usize {
        self.wall_nodes() + usize::from(self.valve.is_some())
    }

    /// Index of the gas mass.
    pub(crate) fn mass_index(&self) -> usize {
        self.gas_index() + 1
    }

    /// Number of states.
    pub fn states(&self) -> usize {
        self.gas_index() + 2
    }

    /// How the states give the temperature of a place on the surface; `None` where the vessel has no such place.
    pub fn surface(&self, place: &SurfacePlace) -> Option<SurfaceState> {
        if *place == SurfacePlace::Valve {
            return self.valve_index().map(|state| SurfaceState {
                state,
                valve_share: 0.0,
                sun_rise_k_w: 0.0,
            });
        }
        let column = place.column(&self.geometry, &self.fine)?;
        Some(SurfaceState {
            state: self.node_of_column[column],
            valve_share: self.spread.share[column],
            sun_rise_k_w: self.spread.rise_k_w[column],
        })
    }

    /// Pressure at a state.
    ///
    /// # Errors
    /// The state has no gas: mass or temperature not positive.
    pub fn pressure(&mut self, x: &[f64]) -> Result<Pressure, ThermalError> {
        let wall_k = self.mean_wall_k(x);
        self.gas.pressure(x[self.gas_index()], x[self.mass_index()], wall_k)
    }

    /// Pressure at a state without derivatives, Pa.
    ///
    /// # Errors
    /// As [`ReducedModel::pressure`].
    pub fn pressure_pa(&mut self, x: &[f64]) -> Result<f64, ThermalError> {
        let wall_k = self.mean_wall_k(x);
        self.gas.pressure_pa(x[self.gas_index()], x[self.mass_index()], wall_k)
    }

    /// Pressure at which the gas mass of a state would settle with wall and gas at one temperature, Pa.
    ///
    /// # Errors
    /// As [`ReducedModel::pressure`].
    pub fn settled_pressure_pa(&mut self, mass_kg: f64, temperature_k: f64) -> Result<f64, ThermalError> {
        self.gas.settled_pressure_pa(temperature_k, mass_kg)
    }

    /// Mean wall temperature, K: that of a uniform wall of the same energy.
    pub fn mean_wall_k(&self, x: &[f64]) -> f64 {
        self.material().temperature_k(self.mean_energy_state_k(x))
    }

    /// Derivative of the mean wall temperature with that of a wall node.
    pub fn mean_wall_per_node(&self, x: &[f64], node: usize) -> f64 {
        let material = self.material();
        material.temperature_slope(self.mean_energy_state_k(x))
            * self.weight(node)
            * capacity_ratio(material, x[node])
    }

    fn material(&self) -> &Material {
        &self.mesh.materials[0]
    }

    fn weight(&self, node: usize) -> f64 {
        self.capacity_j_k[node] / self.wall_capacity_j_k
    }

    fn mean_energy_state_k(&self, x: &[f64]) -> f64 {
        let sum: f64 =
            x.iter().zip(&self.capacity_j_k).map(|(&t, c)| self.material().energy_state_k(t) * c).sum();
        sum / self.wall_capacity_j_k
    }

    /// Rates of change of all states; where `jacobian` is given, also their exact derivatives.
    ///
    /// # Shapes
    /// `x`, `rate`: (n); `jacobian`: (n, n + [`Unknowns::COUNT`]), states first.
    ///
    /// # Errors
    /// As [`ReducedModel::pressure`].
    pub fn rates(
        &mut self,
        x: &[f64],
        unknowns: &Unknowns,
        rate: &mut [f64],
        mut jacobian: Option<&mut DMatrix<f64>>,
    ) -> Result<(), ThermalError> {
        let gas = self.gas.at(
            x[self.gas_index()],
            x[self.mass_index()],
            self.mean_wall_k(x),
            jacobian.is_some(),
        )?;
        if let Some(jacobian) = jacobian.as_deref_mut() {
            jacobian.as_mut_slice().fill(0.0);
            for node in 0..self.wall_nodes() {
                self.mean_wall_by[node] = self.mean_wall_per_node(x, node);
            }
        }
        rate.fill(0.0);
        self.add_conduction(x, rate, jacobian.as_deref_mut());
        self.add_inner_faces(x, unknowns, &gas, rate, jacobian.as_deref_mut());
        let film_w_m2_k = self.film_w_m2_k * libm::exp(unknowns.ln_outside_film);
        self.add_outer_faces(x, unknowns, film_w_m2_k, rate, jacobian.as_deref_mut());
        self.add_valve(x, unknowns, film_w_m2_k, rate, jacobian.as_deref_mut());
        self.divide_by_capacities(x, unknowns, rate, jacobian.as_deref_mut());
        self.close_gas(unknowns, &gas, rate, jacobian);
        Ok(())
    }
}

/// `c(T) / c_20` of a material.
fn capacity_ratio(material: &Material, temperature_k: f64) -> f64 {
    1.0 + material.heat_capacity_slope_per_k * (temperature_k - REFERENCE_TEMPERATURE_K)
}

#[cfg(test)]
mod tests;

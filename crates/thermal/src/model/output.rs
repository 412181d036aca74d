//! What a state vector means: temperatures, pressure, flows, balances.
use super::Model;
use super::boundary::Margins;
use super::gas::GasPoint;
use super::inputs::Inputs;
use crate::ThermalError;

/// Everything that is reported of one instant. SI.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Output {
    /// Mass-weighted mean gas temperature, K.
    pub gas_mean_k: f64,
    /// Temperature of each gas cell, K.
    pub gas_cells_k: Vec<f64>,
    /// Outer surface temperature of each column, K.
    pub wall_outer_k: Vec<f64>,
    /// Inner surface temperature of each column, K.
    pub wall_inner_k: Vec<f64>,
    /// Mean wall temperature, K: that of a uniform wall of the same energy.
    pub wall_mean_k: f64,
    /// Mean temperature of the inner surface, K, by area.
    pub wall_inner_mean_k: f64,
    /// Mean temperature of the innermost layer, K, by heat capacity, if the wall has several.
    pub liner_mean_k: Option<f64>,
    /// Valve temperature, K.
    pub valve_k: Option<f64>,
    /// Gas pressure, Pa.
    pub pressure_pa: f64,
    /// Gas mass, kg.
    pub mass_kg: f64,
    /// Net mass flow out, kg/s.
    pub outflow_kg_s: f64,
    /// Heat flow from wall to gas, W.
    pub heat_to_gas_w: f64,
    /// Temperature, K, and pressure, Pa, of each source vessel.
    pub sources: Vec<(f64, f64)>,
}

/// Mean of values, the second of each pair, by weights, the first.
fn mean_by(pairs: impl Iterator<Item = (f64, f64)>) -> f64 {
    let (weights, sum) = pairs.fold((0.0, 0.0), |(w, s), (weight, value)| (w + weight, s + weight * value));
    sum / weights
}

impl Model {
    /// Evaluate everything at a state.
    ///
    /// # Errors
    /// As [`Model::rate`].
    pub(crate) fn output(&self, x: &[f64], inputs: &Inputs, open: &[bool]) -> Result<Output, ThermalError> {
        let layout = &self.layout;
        let nodes = self.gas_nodes(x)?;
        let points: Vec<GasPoint> = nodes.as_slice().iter().map(GasPoint::from).collect();
        let outlet = &nodes.as_slice()[self.grid.outlet];
        let (gas_mean_k, pressure_pa) = self.mean_state(x, &points);
        let mut temperature_k = Vec::new();
        self.node_temperatures(x, &mut temperature_k);
        let boundary = self.boundary(x, inputs, open);
        let jet = self.jet_w_m2_k(&nodes, x);
        let columns = self.mesh.columns.len();
        let inner: Vec<_> = (0..columns).map(|j| self.inner_face(j, &temperature_k, &points, jet)).collect();
        Ok(Output {
            gas_mean_k,
            gas_cells_k: points.iter().map(|point| point.temperature_k).collect(),
            wall_outer_k: (0..columns)
                .map(|j| self.outer_face(j, &temperature_k, inputs).surface_k)
                .collect(),
            wall_inner_k: inner.iter().map(|face| face.surface_k).collect(),
            wall_mean_k: self.mean_wall_k(x),
            wall_inner_mean_k: mean_by(
                self.mesh
                    .columns
                    .iter()
                    .map(|c| c.inner_area_m2)
                    .zip(inner.iter().map(|face| face.surface_k)),
            ),
            liner_mean_k: (self.mesh.materials.len() > 1).then(|| {
                let cells = (0..layout.wall).filter(|&cell| self.mesh.material[cell] == 0);
                mean_by(cells.map(|cell| (self.capacity_j_k[cell], temperature_k[cell])))
            }),
            valve_k: layout
                .valve
                .zip(self.valve.as_ref())
                .map(|(index, valve)| valve.material.temperature_k(x[index])),
            pressure_pa,
            mass_kg: self.mass_kg(x),
            outflow_kg_s: -boundary.exchange(&self.fluid, &outlet.state)?.mass_kg_s,
            heat_to_gas_w: inner.iter().map(|face| face.heat_w).sum(),
            sources: self
                .source_vessels()
                .map(|(_, vessel)| {
                    let state = vessel.state(&self.fluid, x[layout.drawn + vessel.place])?;
                    Ok((state.temperature_k, state.pressure_pa))
                })
                .collect::<Result<_, ThermalError>>()?,
        })
    }

    /// Mean gas temperature, K, and gas pressure, Pa, of a state.
    ///
    /// # Errors
    /// As [`Model::rate`].
    pub(crate) fn gas_state(&self, x: &[f64]) -> Result<(f64, f64), ThermalError> {
        let nodes = self.gas_nodes(x)?;
        let points: Vec<GasPoint> = nodes.as_slice().iter().map(GasPoint::from).collect();
        Ok(self.mean_state(x, &points))
    }

    /// Mass-weighted temperature, K, and volume-weighted pressure, Pa.
    fn mean_state(&self, x: &[f64], points: &[GasPoint]) -> (f64, f64) {
        let (masses, _) = self.layout.gas_of(x);
        let temperature: f64 = points.iter().zip(masses).map(|(p, m)| p.temperature_k * m).sum();
        let pressure =
            points.iter().zip(&self.grid.cells).map(|(p, cell)| p.pressure_pa * cell.volume_fraction).sum();
        (temperature / self.mass_kg(x), pressure)
    }

    /// Heat capacity of the wall at the reference temperature, J/K.
    pub(crate) fn wall_capacity_j_k(&self) -> f64 {
        self.wall_capacity_j_k
    }

    /// How far a flow through an opening is from its changes of regime; `None` for other flows.
    ///
    /// # Errors
    /// As [`Model::rate`].
    pub(crate) fn margins(
        &self,
        x: &[f64],
        inputs: &Inputs,
        open: &[bool],
        flow: usize,
    ) -> Result<Option<Margins>, ThermalError> {
        let nodes = self.gas_nodes(x)?;
        let outlet = &nodes.as_slice()[self.grid.outlet].state;
        self.boundary(x, inputs, open).margins(flow, &self.fluid, outlet)
    }

    /// Energy of gas, wall and valve, J, up to a constant.
    pub(crate) fn energy_j(&self, x: &[f64]) -> f64 {
        let layout = &self.layout;
        let wall: f64 = x[..layout.wall].iter().zip(&self.capacity_j_k).map(|(x, c)| x * c).sum();
        let valve = layout.valve.zip(self.valve.as_ref()).map_or(0.0, |(i, v)| x[i] * v.capacity_j_k());
        wall + valve + layout.gas_of(x).1.iter().sum::<f64>()
    }

    /// Gas mass, kg.
    pub fn mass_kg(&self, x: &[f64]) -> f64 {
        self.layout.gas_of(x).0.iter().sum()
    }

    /// The domain check of the gas state.
    ///
    /// # Errors
    /// The gas is two-phase or outside the range of its equation of state.
    pub(crate) fn check_gas(&self, x: &[f64]) -> Result<(), ThermalError> {
        let nodes = self.gas_nodes(x)?;
        nodes
            .as_slice()
            .iter()
            .try_for_each(|node| self.fluid.check(node.state.density_kg_m3, node.state.temperature_k))?;
        for (index, vessel) in self.source_vessels() {
            let state = vessel.state(&self.fluid, x[self.layout.drawn + vessel.place])?;
            self.fluid.check(state.density_kg_m3, state.temperature_k).map_err(|cause| {
                ThermalError::Source { flow: self.flows[index].name.clone(), cause: Box::new(cause) }
            })?;
        }
        Ok(())
    }

    /// Names of the refills that draw from a vessel, in the order of [`Output::sources`].
    pub(crate) fn source_names(&self) -> impl Iterator<Item = &str> {
        self.source_vessels().map(|(index, _)| self.flows[index].name.as_str())
    }

    /// Mass in the source vessels at time 0, kg.
    pub(crate) fn source_masses_kg(&self) -> impl Iterator<Item = f64> {
        self.source_vessels().map(|(_, vessel)| vessel.mass_kg)
    }
}

//! Exact Jacobian of the model as a fixed sequence of entries.
//!
//! Wall, films and surfaces are differentiated by hand; the gas by dual numbers in its own inputs ([`GasBlock`]),
//! chained with the derivatives of those inputs. The sequence of `(row, column)` pairs depends on mesh and
//! layout alone, never on the state, so that a sparsity pattern taken once holds for the whole run; a pair may
//! occur more than once, and its values add.
use crate::real::Dual;
use nalgebra::DMatrix;

use super::boundary::Boundary;
use super::gas::{Gas, GasNodes, GasPoint};
use super::inputs::Inputs;
use super::node::Node;
use super::well_mixed::WellMixed;
use super::{Model, WallAction};
use crate::ThermalError;
use crate::transfer::inside::stirring_rate_per_s;
use crate::wall::conduction::link_flow;
use crate::wall::mesh::Facing;

/// Receiver of `(row, column, value)` entries that add.
pub(super) type Assembly<'a> = dyn FnMut(usize, usize, f64) + 'a;

/// Derivatives of the gas of `n` cells.
///
/// # Shapes
/// `matrix`: (2n + 3, 5n + 2). Rows: mass rates, energy rates, mass in, enthalpy in, work out. Columns: masses,
/// energies, mean wall state, its rate, side heats, plate heats, side surface temperatures.
#[derive(Debug)]
pub(super) struct GasBlock {
    /// The matrix.
    pub matrix: DMatrix<f64>,
    /// Temperature and pressure of each cell with its (mass, energy, mean wall).
    pub cells: Vec<([f64; 3], [f64; 3])>,
    /// Film of the stirred gas with the (mass, energy, mean wall) of the outlet's cell.
    jet: [f64; 3],
    /// What the motion of the gas does, if it is a state.
    stirring: Option<StirringGradients>,
    /// What the mass drawn from each source vessel does.
    pub sources: Vec<SourceGradients>,
}

/// Derivatives of and by the mass drawn from a source vessel.
#[derive(Debug)]
pub(super) struct SourceGradients {
    /// Its rate with the (mass, energy, mean wall) of the outlet's cell.
    rate: [f64; 3],
    /// With the drawn mass: rates of mass, energy, enthalpy in and work out of the outlet's cell.
    by_drawn: [f64; 4],
    /// Rate of the stirring with the drawn mass.
    stirring: f64,
}

/// Derivatives of and by the motion of the gas.
#[derive(Debug)]
struct StirringGradients {
    /// Its rate with the (mass, energy, mean wall) of the outlet's cell.
    rate: [f64; 3],
    /// Its rate with itself.
    own: f64,
    /// Film with it.
    film: f64,
}

impl GasBlock {
    /// From derivatives with the mean wall temperature to derivatives with its state.
    fn scale_mean_wall(&mut self, slope: f64) {
        for (temperature, pressure) in &mut self.cells {
            temperature[2] *= slope;
            pressure[2] *= slope;
        }
        self.jet[2] *= slope;
        if let Some(stirring) = &mut self.stirring {
            stirring.rate[2] *= slope;
        }
        for source in &mut self.sources {
            source.rate[2] *= slope;
        }
        let mut column = self.matrix.column_mut(2 * self.cells.len());
        column *= slope;
    }
}

type Dual5 = Dual<5>;
type Dual3 = Dual<3>;

fn gradient<const N: usize>(value: Dual<N>) -> [f64; N] {
    value.eps
}

/// Local columns of the gas's chain rule: gas states first, then inner cells, outer cells, valve, stirring.
struct LocalColumns {
    /// State index of each local column.
    state: Vec<usize>,
    inner: usize,
    outer: usize,
    valve: usize,
}

impl Model {
    fn gas_block(
        &self,
        x: &[f64],
        boundary: &Boundary<'_>,
        nodes: &GasNodes,
        wall: &WallAction<f64>,
        wall_rate: f64,
    ) -> Result<GasBlock, ThermalError> {
        let layout = &self.layout;
        let ((mass, energy), mean) = (layout.gas_of(x), self.mean_wall_k(x));
        let outlet = self.grid.outlet;
        let seed = |value: f64, index: usize| Dual3::variable(value, index);
        let jet_and_sources = |gas: &WellMixed| -> Result<_, ThermalError> {
            if layout.states == layout.drawn {
                return Ok(([0.0; 3], None, Vec::new()));
            }
            let fixed = &nodes.as_slice()[outlet];
            let node = gas.differentiated(seed(mass[outlet], 0), seed(energy[outlet], 1), seed(mean, 2))?;
            let reynolds = layout.stirring.map(|index| x[index]);
            let (mut jet, mut stirring) = ([0.0; 3], None);
            if let Some(reynolds) = reynolds {
                jet = gradient(self.jet_film(&node, Dual3::from(reynolds)));
                let rate =
                    boundary.stirring_per_s(&self.fluid, &node, self.inner_diameter_m, reynolds, None)?;
                let state = &fixed.state;
                let mu = self.fluid.viscosity_pa_s(state.density_kg_m3, state.temperature_k);
                let per_s = stirring_rate_per_s(mu, state.density_kg_m3, self.inner_diameter_m);
                stirring = Some(StirringGradients {
                    rate: gradient(rate),
                    own: -2.0 * reynolds.abs() * per_s,
                    film: self.jet_film(&fixed.map(Dual::<1>::from), Dual::<1>::variable(reynolds, 0)).eps[0],
                });
            }
            let sources = self.source_gradients(boundary, fixed, &node, reynolds)?;
            Ok((jet, stirring, sources))
        };
        match &self.gas {
            Gas::WellMixed(gas) => {
                let seed = |value: f64, index: usize| Dual5::variable(value, index);
                let node = gas.differentiated(seed(mass[0], 0), seed(energy[0], 1), seed(mean, 2))?;
                let rates = gas.rates(&node, boundary, seed(wall.side_w[0], 4), seed(wall_rate, 3))?;
                let mut matrix = DMatrix::zeros(5, 7);
                let rows = [rates.mass_kg_s, rates.energy_w, rates.mass_kg_s, rates.enthalpy_w, rates.work_w];
                for (row, value) in rows.into_iter().enumerate() {
                    for (column, derivative) in gradient(value).into_iter().enumerate() {
                        matrix[(row, column)] = derivative;
                    }
                }
                let three = |value: Dual5| {
                    let g = gradient(value);
                    [g[0], g[1], g[2]]
                };
                let cells = vec![(three(node.state.temperature_k), three(node.state.pressure_pa))];
                let (jet, stirring, sources) = jet_and_sources(gas)?;
                Ok(GasBlock { matrix, cells, jet, stirring, sources })
            }
            Gas::Stratified(gas) => {
                let (matrix, cells) = gas.jacobian(mass, energy, mean, boundary, wall, wall_rate)?;
                let (jet, stirring, sources) = jet_and_sources(gas.outlet_node())?;
                Ok(GasBlock { matrix, cells, jet, stirring, sources })
            }
        }
    }

    /// Source vessels at the outlet's node, as a number and with derivatives.
    fn source_gradients(
        &self,
        boundary: &Boundary<'_>,
        outlet: &Node<f64>,
        differentiated: &Node<Dual3>,
        reynolds: Option<f64>,
    ) -> Result<Vec<SourceGradients>, ThermalError> {
        let fixed = outlet.map(Dual::<1>::from);
        let mut all = Vec::new();
        for (index, vessel) in self.source_vessels() {
            if !boundary.open[index] {
                all.push(SourceGradients { rate: [0.0; 3], by_drawn: [0.0; 4], stirring: 0.0 });
                continue;
            }
            let drawn = boundary.drawn_kg[vessel.place];
            let rate =
                boundary.of_flow(index, &self.fluid, &differentiated.state, Dual3::from(drawn))?.mass_kg_s;
            let seeded = Dual::<1>::variable(drawn, 0);
            let by = boundary.of_flow(index, &self.fluid, &fixed.state, seeded)?;
            // The node's rates are linear in what flows in.
            let rates = outlet.balance(by.mass_kg_s.eps[0], by.enthalpy_w.eps[0], 0.0, 0.0);
            let stirring = reynolds.map_or(Ok(0.0), |reynolds| {
                let drawn = Some((index, seeded));
                let diameter_m = self.inner_diameter_m;
                boundary
                    .stirring_per_s(&self.fluid, &fixed, diameter_m, reynolds, drawn)
                    .map(|rate| rate.eps[0])
            })?;
            let by_drawn = [rates.mass_kg_s, rates.energy_w, rates.enthalpy_w, rates.work_w];
            all.push(SourceGradients { rate: gradient(rate), by_drawn, stirring });
        }
        Ok(all)
    }

    fn local_columns(&self) -> LocalColumns {
        let layout = &self.layout;
        let columns = self.mesh.columns.len();
        let mut state: Vec<usize> = (layout.mass..layout.mass + 2 * layout.gas).collect();
        state.push(layout.mean_wall);
        let inner = state.len();
        state.extend((0..columns).map(|j| self.mesh.inner_cell(j)));
        let outer = state.len();
        state.extend((0..columns).map(|j| self.mesh.outer_cell(j)));
        let valve = state.len();
        state.extend(layout.valve);
        // Last, since the film depends on it.
        state.extend(layout.stirring);
        LocalColumns { state, inner, outer, valve }
    }

    /// Emit every entry of `d(dx/dt)/dx`.
    ///
    /// # Errors
    /// As [`Model::rate`]. Nothing has been emitted then.
    pub fn jacobian(
        &self,
        x: &[f64],
        inputs: &Inputs,
        open: &[bool],
        emit: &mut Assembly<'_>,
    ) -> Result<(), ThermalError> {
        let layout = &self.layout;
        let mut rate = vec![0.0; layout.states];
        self.rate(x, inputs, open, &mut rate)?;
        let nodes = self.gas_nodes(x)?;
        let boundary = self.boundary(x, inputs, open);
        let jet = self.jet_w_m2_k(&nodes, x);
        let points: Vec<GasPoint> = nodes.as_slice().iter().map(GasPoint::from).collect();
        let wall = self.scratch.borrow().wall.clone();
        // The gas sees the wall's mean temperature; the state behind it is an energy.
        let mean_slope = self.mean_material.temperature_slope(x[layout.mean_wall]);
        let mean_rate = rate[layout.mean_wall];
        let mut gas = self.gas_block(x, &boundary, &nodes, &wall, mean_slope * mean_rate)?;
        gas.scale_mean_wall(mean_slope);
        let mut temperature_k = Vec::with_capacity(layout.wall);
        self.node_temperatures(x, &mut temperature_k);
        let slope: Vec<f64> = (0..layout.wall)
            .map(|cell| self.mesh.materials[self.mesh.material[cell]].temperature_slope(x[cell]))
            .collect();

        self.emit_conduction(&temperature_k, &slope, emit);
        self.emit_sources(&gas, emit);
        let local = self.local_columns();
        // Derivatives of the gas's inputs with the local columns.
        let mut chain = DMatrix::zeros(5 * layout.gas + 2, local.state.len());
        for i in 0..=2 * layout.gas {
            chain[(i, i)] = 1.0;
        }
        let mut wall_heat = vec![0.0; local.state.len()];
        for column in 0..self.mesh.columns.len() {
            let point = FacePoint { temperature_k: &temperature_k, points: &points, jet, slope: &slope };
            self.chain_inner_face(column, &point, &gas, &local, &mut chain, &mut wall_heat, emit);
            let cell = self.mesh.outer_cell(column);
            let by_cell = self.outer_face(column, &temperature_k, inputs).heat_per_node_k * slope[cell];
            emit(cell, cell, -by_cell / self.capacity_j_k[cell]);
            emit(layout.heat_in, cell, -by_cell);
            wall_heat[local.outer + column] -= by_cell;
        }
        self.chain_valve(x, inputs, &slope, &local, &mut wall_heat, emit);
        let rate_row = 2 * layout.gas + 1;
        for (index, (&state, heat)) in local.state.iter().zip(&wall_heat).enumerate() {
            emit(layout.mean_wall, state, heat / self.wall_capacity_j_k);
            chain[(rate_row, index)] = mean_slope * heat / self.wall_capacity_j_k;
        }
        let curvature = -self.mean_material.heat_capacity_slope_per_k * mean_slope.powi(3);
        chain[(rate_row, 2 * layout.gas)] += curvature * mean_rate;
        let product = &gas.matrix * &chain;
        let rows = (layout.mass..layout.mass + 2 * layout.gas).chain([
            layout.mass_in,
            layout.enthalpy_in,
            layout.work_out,
        ]);
        for (row, state_row) in rows.enumerate() {
            for (index, &state) in local.state.iter().enumerate() {
                emit(state_row, state, product[(row, index)]);
            }
        }
        Ok(())
    }

    fn emit_sources(&self, gas: &GasBlock, emit: &mut Assembly<'_>) {
        let (layout, outlet) = (&self.layout, self.grid.outlet);
        let cell = [layout.mass + outlet, layout.energy + outlet, layout.mean_wall];
        if let (Some(index), Some(stirring)) = (layout.stirring, &gas.stirring) {
            cell.into_iter().zip(stirring.rate).for_each(|(state, value)| emit(index, state, value));
            emit(index, index, stirring.own);
            for (place, source) in gas.sources.iter().enumerate() {
                emit(index, layout.drawn + place, source.stirring);
            }
        }
        for (place, source) in gas.sources.iter().enumerate() {
            let drawn = layout.drawn + place;
            for (state, value) in cell.into_iter().zip(source.rate) {
                emit(drawn, state, value);
            }
            let [mass, energy, enthalpy, work] = source.by_drawn;
            emit(drawn, drawn, mass);
            emit(cell[0], drawn, mass);
            emit(cell[1], drawn, energy);
            emit(layout.mass_in, drawn, mass);
            emit(layout.enthalpy_in, drawn, enthalpy);
            emit(layout.work_out, drawn, work);
        }
    }

    fn emit_conduction(&self, temperature_k: &[f64], slope: &[f64], emit: &mut Assembly<'_>) {
        let c = &self.capacity_j_k;
        for link in &self.mesh.links {
            let flow = link_flow(&self.mesh, link, temperature_k);
            let (by_a, by_b) = (flow.per_a_k * slope[link.a], flow.per_b_k * slope[link.b]);
            emit(link.a, link.a, -by_a / c[link.a]);
            emit(link.a, link.b, -by_b / c[link.a]);
            emit(link.b, link.a, by_a / c[link.b]);
            emit(link.b, link.b, by_b / c[link.b]);
        }
    }

    /// Derivatives of one inner face: of its heat flows to each contact and of its surface temperature, with its
    /// wall cell and with the states of the gas cells it touches.
    #[allow(clippy::too_many_arguments)]
    fn chain_inner_face(
        &self,
        column: usize,
        at: &FacePoint<'_>,
        gas: &GasBlock,
        local: &LocalColumns,
        chain: &mut DMatrix<f64>,
        wall_heat: &mut [f64],
        emit: &mut Assembly<'_>,
    ) {
        let n = self.layout.gas;
        let cell = self.mesh.inner_cell(column);
        let capacity = self.capacity_j_k[cell];
        let contacts = &self.grid.contacts[column];
        let balance = self.inner_face(column, at.temperature_k, at.points, at.jet);
        let half = self.half_cell(cell, self.mesh.columns[column].inner_shape_m, at.temperature_k[cell]);
        let fluxes: Vec<_> = contacts
            .iter()
            .map(|contact| self.contact_flux(contact, balance.surface_k, at.points, at.jet))
            .collect();
        let film: f64 = contacts.iter().zip(&fluxes).map(|(c, f)| c.area_m2 * f.per_surface_k).sum();
        let total = half.conductance_w_k + film;
        let surface_by_cell =
            (half.conductance_w_k + half.conductance_slope_w_k2 * (half.node_k - balance.surface_k)) / total
                * at.slope[cell];
        // Direct derivative of contact `k`'s heat with the three states behind gas cell `contact.cell`.
        let direct = |k: usize| -> [f64; 3] {
            let (contact, flux) = (&contacts[k], &fluxes[k]);
            let (temperature, pressure) = &gas.cells[contact.cell];
            std::array::from_fn(|i| {
                contact.area_m2 * (flux.per_gas_k * temperature[i] + flux.per_pressure * pressure[i])
            })
        };
        let jet_area: f64 =
            contacts.iter().map(|c| c.area_m2 * (balance.surface_k - at.points[c.cell].temperature_k)).sum();
        let state_columns = |gas_cell: usize| [gas_cell, n + gas_cell, 2 * n];
        let mut entries =
            vec![FaceEntry { column: local.inner + column, surface: surface_by_cell, own: None }];
        for (k, contact) in contacts.iter().enumerate() {
            for (state, value) in state_columns(contact.cell).into_iter().zip(direct(k)) {
                entries.push(FaceEntry { column: state, surface: -value / total, own: Some((k, value)) });
            }
        }
        let by_jet = state_columns(self.grid.outlet).into_iter().zip(gas.jet);
        let by_stirring = gas.stirring.iter().map(|stirring| (local.state.len() - 1, stirring.film));
        for (state, jet) in by_jet.chain(by_stirring) {
            entries.push(FaceEntry { column: state, surface: -jet_area * jet / total, own: None });
            for (k, contact) in contacts.iter().enumerate() {
                let own = contact.area_m2 * (balance.surface_k - at.points[contact.cell].temperature_k) * jet;
                entries.push(FaceEntry { column: state, surface: 0.0, own: Some((k, own)) });
            }
        }
        for FaceEntry { column: index, surface, own } in entries {
            let mut heat = 0.0;
            for (k, (contact, flux)) in contacts.iter().zip(&fluxes).enumerate() {
                let mut by = contact.area_m2 * flux.per_surface_k * surface;
                if let Some((_, value)) = own.filter(|&(of, _)| of == k) {
                    by += value;
                }
                heat += by;
                let side = contact.facing == Facing::Side;
                let input = 2 * n + 2 + if side { contact.cell } else { n + contact.cell };
                chain[(input, index)] += by;
                if side {
                    let weight = contact.area_m2 / self.grid.cells[contact.cell].side_m2;
                    chain[(4 * n + 2 + contact.cell, index)] += weight * surface;
                }
            }
            wall_heat[index] -= heat;
            emit(cell, local.state[index], -heat / capacity);
        }
    }

    #[allow(clippy::too_many_arguments)]
    fn chain_valve(
        &self,
        x: &[f64],
        inputs: &Inputs,
        slope: &[f64],
        local: &LocalColumns,
        wall_heat: &mut [f64],
        emit: &mut Assembly<'_>,
    ) {
        let layout = &self.layout;
        let (Some(index), Some(valve)) = (layout.valve, &self.valve) else { return };
        let contact = self.contact_cell();
        let valve_slope = valve.material.temperature_slope(x[index]);
        let valve_k = valve.material.temperature_k(x[index]);
        let by_valve = valve.contact_w_k * valve_slope;
        let by_contact = -valve.contact_w_k * slope[contact];
        let loss = self.valve_loss(valve, valve_k, inputs).1 * valve_slope;
        let c = self.capacity_j_k[contact];
        emit(contact, index, by_valve / c);
        emit(contact, contact, by_contact / c);
        emit(index, index, (-loss - by_valve) / valve.capacity_j_k());
        emit(index, contact, -by_contact / valve.capacity_j_k());
        emit(layout.heat_in, index, -loss);
        wall_heat[local.valve] += by_valve;
        wall_heat[local.outer + self.mesh.columns.len() - 1] += by_contact;
    }
}

/// What one local column does to an inner face.
struct FaceEntry {
    /// Local column.
    column: usize,
    /// Derivative of the surface temperature.
    surface: f64,
    /// Contact whose heat depends on the column directly, and by how much.
    own: Option<(usize, f64)>,
}

/// Where a face is differentiated.
struct FacePoint<'a> {
    temperature_k: &'a [f64],
    points: &'a [GasPoint],
    jet: f64,
    slope: &'a [f64],
}

//! The result of a simulation: sampled states, events, ledger, solver statistics. Plain data, SI.
use crate::scenario::Scenario;
use crate::vessel::Vessel;

/// A simulated run. Every vector of samples has the length of [`Trajectory::time_s`].
#[derive(Clone, Debug)]
pub struct Trajectory {
    /// The vessel that was simulated.
    pub vessel: Vessel,
    /// What happened to it.
    pub scenario: Scenario,
    /// Sample times, s, increasing, from 0 to the end.
    pub time_s: Vec<f64>,
    /// Air temperature, K (continued from the right at a jump).
    pub ambient_k: Vec<f64>,
    /// Mass-weighted mean gas temperature, K.
    pub gas_mean_k: Vec<f64>,
    /// Temperature of each gas cell, K; `gas_cells_k[sample][cell]`, cell 0 at the bottom; one cell when well mixed.
    pub gas_cells_k: Vec<Vec<f64>>,
    /// Outer surface temperature of each axial wall cell, K; `wall_outer_k[sample][axial]`, from the bottom up.
    pub wall_outer_k: Vec<Vec<f64>>,
    /// Inner surface temperature of each axial wall cell, K; `wall_inner_k[sample][axial]`.
    pub wall_inner_k: Vec<Vec<f64>>,
    /// Mean wall temperature, K: that of a uniform wall of the same energy.
    pub wall_mean_k: Vec<f64>,
    /// Mean temperature of the inner surface, K, by area.
    pub wall_inner_mean_k: Vec<f64>,
    /// Mean temperature of the innermost layer, K, by heat capacity, if the wall has several.
    pub liner_mean_k: Option<Vec<f64>>,
    /// Valve temperature, K, if the vessel has a valve.
    pub valve_k: Option<Vec<f64>>,
    /// Gas pressure, Pa absolute.
    pub pressure_pa: Vec<f64>,
    /// Gas mass, kg.
    pub mass_kg: Vec<f64>,
    /// Net mass flow out of the cylinder, kg/s (negative during a refill).
    pub outflow_kg_s: Vec<f64>,
    /// Heat flow from the wall to the gas, W.
    pub heat_to_gas_w: Vec<f64>,
    /// The vessels that refills draw from.
    pub sources: Vec<SourceCourse>,
    /// Names of places and the axial wall cell each stands for: bottom, middle, shoulder, neck.
    pub places: Vec<Place>,
    /// What happened, in order of time.
    pub events: Vec<Event>,
    /// Mass and energy balance at the end.
    pub ledger: Ledger,
    /// What the solver did.
    pub statistics: SolverStatistics,
}

/// The gas of a vessel that a refill draws from.
#[derive(Clone, Debug, PartialEq)]
pub struct SourceCourse {
    /// Name of the refill.
    pub flow: String,
    /// Temperature, K.
    pub temperature_k: Vec<f64>,
    /// Pressure, Pa absolute.
    pub pressure_pa: Vec<f64>,
}

/// A named place on the wall.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// Name, e.g. `shoulder`.
    pub name: &'static str,
    /// Axial wall cell, 0 at the bottom.
    pub axial_cell: usize,
}

impl Trajectory {
    /// Inner surface temperature at a named place against time, K.
    pub fn inner_surface_k(&self, place: &str) -> Option<Vec<f64>> {
        let cell = self.places.iter().find(|p| p.name == place)?.axial_cell;
        Some(self.wall_inner_k.iter().map(|sample| sample[cell]).collect())
    }

    /// Outer surface temperature at a named place against time, K; `valve` is the valve body.
    pub fn surface_k(&self, place: &str) -> Option<Vec<f64>> {
        if place == "valve" {
            return self.valve_k.clone();
        }
        let cell = self.places.iter().find(|p| p.name == place)?.axial_cell;
        Some(self.wall_outer_k.iter().map(|sample| sample[cell]).collect())
    }
}

/// Something that happened at one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// When, s.
    pub time_s: f64,
    /// What.
    pub kind: EventKind,
    /// Gas pressure at that time, Pa.
    pub pressure_pa: f64,
    /// Mean gas temperature at that time, K.
    pub gas_mean_k: f64,
}

/// What happened.
#[derive(Clone, Debug, PartialEq)]
pub enum EventKind {
    /// The pressure crossed a limit, or began below it (at time 0, falling).
    PressureLimit {
        /// The limit, Pa.
        limit_pa: f64,
        /// True: it fell below.
        falling: bool,
    },
    /// A flow opened.
    FlowOpened {
        /// Its name.
        flow: String,
    },
    /// A flow closed.
    FlowClosed {
        /// Its name.
        flow: String,
    },
    /// A choked orifice flow became subsonic.
    Unchoked {
        /// Name of the flow.
        flow: String,
    },
}

/// Mass and energy balance over the run. Both residuals are what is left when everything is counted.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ledger {
    /// Gas mass at the start, kg.
    pub mass_start_kg: f64,
    /// Gas mass at the end, kg.
    pub mass_end_kg: f64,
    /// Mass that flowed in, net, kg.
    pub mass_in_kg: f64,
    /// Energy of gas, wall and valve at the start, J.
    pub energy_start_j: f64,
    /// Energy of gas, wall and valve at the end, J.
    pub energy_end_j: f64,
    /// Heat received from outside: films, radiation, sun, J.
    pub heat_in_j: f64,
    /// Enthalpy that flowed in with the gas, net, J.
    pub enthalpy_in_j: f64,
    /// Work of the gas on the expanding vessel, J.
    pub work_out_j: f64,
    /// Sum of the magnitudes of all energy turned over, J: what the residual is compared with.
    pub energy_scale_j: f64,
}

impl Ledger {
    /// Mass residual relative to the larger of the start and end mass.
    pub fn mass_residual(&self) -> f64 {
        (self.mass_end_kg - self.mass_start_kg - self.mass_in_kg) / self.mass_start_kg.max(self.mass_end_kg)
    }

    /// Energy residual relative to the energy turned over.
    pub fn energy_residual(&self) -> f64 {
        (self.energy_end_j - self.energy_start_j - self.heat_in_j - self.enthalpy_in_j + self.work_out_j)
            / self.energy_scale_j
    }
}

/// What the solver did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SolverStatistics {
    /// Accepted steps.
    pub steps: usize,
    /// Steps that failed the error test.
    pub error_test_failures: usize,
    /// Newton iterations.
    pub newton_iterations: usize,
    /// Steps on which Newton did not converge.
    pub newton_failures: usize,
    /// Factorisations of the Jacobian.
    pub linear_solver_setups: usize,
    /// Segments between edges of the inputs.
    pub segments: usize,
    /// Number of states.
    pub states: usize,
}

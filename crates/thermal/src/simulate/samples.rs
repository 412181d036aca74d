//! The output samples of a run: at multiples of the sample time, and at the end.
use crate::model::{Model, Output};
use crate::scenario::Scenario;
use crate::trajectory::{Ledger, Place, SolverStatistics, SourceCourse, Trajectory};
use crate::vessel::Vessel;

/// The samples taken so far.
pub(super) struct Samples {
    interval_s: f64,
    duration_s: f64,
    /// Times, s.
    pub time_s: Vec<f64>,
    /// Air temperatures, K.
    pub ambient_k: Vec<f64>,
    /// Everything else.
    pub outputs: Vec<Output>,
}

impl Samples {
    /// None yet.
    pub(super) fn new(scenario: &Scenario) -> Self {
        Self {
            interval_s: scenario.sample_time_s,
            duration_s: scenario.duration_s,
            time_s: Vec::new(),
            ambient_k: Vec::new(),
            outputs: Vec::new(),
        }
    }

    /// Time of the next sample if it lies before `until` (or at it when `inclusive`), s. The end is always a sample.
    pub(super) fn next_time(&self, until: f64, inclusive: bool) -> Option<f64> {
        if self.time_s.last().is_some_and(|&last| last >= self.duration_s) {
            return None;
        }
        let t = (self.time_s.len() as f64 * self.interval_s).min(self.duration_s);
        (t < until || (inclusive && t <= until)).then_some(t)
    }

    /// Add a sample.
    pub(super) fn push(&mut self, time_s: f64, ambient_k: f64, output: Output) {
        self.time_s.push(time_s);
        self.ambient_k.push(ambient_k);
        self.outputs.push(output);
    }

    /// The samples of a vessel's run, so far without events and balance.
    pub(super) fn into_trajectory(self, vessel: &Vessel, scenario: &Scenario, model: &Model) -> Trajectory {
        let Self { time_s, ambient_k, outputs, .. } = self;
        let pick = |value: fn(&Output) -> f64| outputs.iter().map(value).collect::<Vec<f64>>();
        let places = ["bottom", "middle", "shoulder", "neck"]
            .into_iter()
            .filter_map(|name| Some(Place { name, axial_cell: model.mesh().column_of(name)? }))
            .collect();
        let of_source = |k: usize, flow: &str| SourceCourse {
            flow: flow.to_owned(),
            temperature_k: outputs.iter().map(|o| o.sources[k].0).collect(),
            pressure_pa: outputs.iter().map(|o| o.sources[k].1).collect(),
        };
        let mut trajectory = Trajectory {
            vessel: vessel.clone(),
            scenario: scenario.clone(),
            gas_mean_k: pick(|o| o.gas_mean_k),
            wall_mean_k: pick(|o| o.wall_mean_k),
            wall_inner_mean_k: pick(|o| o.wall_inner_mean_k),
            liner_mean_k: outputs.iter().map(|o| o.liner_mean_k).collect(),
            sources: model.source_names().enumerate().map(|(k, flow)| of_source(k, flow)).collect(),
            valve_k: outputs.iter().map(|o| o.valve_k).collect(),
            pressure_pa: pick(|o| o.pressure_pa),
            mass_kg: pick(|o| o.mass_kg),
            outflow_kg_s: pick(|o| o.outflow_kg_s),
            heat_to_gas_w: pick(|o| o.heat_to_gas_w),
            gas_cells_k: Vec::with_capacity(outputs.len()),
            wall_outer_k: Vec::with_capacity(outputs.len()),
            wall_inner_k: Vec::with_capacity(outputs.len()),
            time_s,
            ambient_k,
            places,
            events: Vec::new(),
            ledger: Ledger::default(),
            statistics: SolverStatistics::default(),
        };
        for output in outputs {
            trajectory.gas_cells_k.push(output.gas_cells_k);
            trajectory.wall_outer_k.push(output.wall_outer_k);
            trajectory.wall_inner_k.push(output.wall_inner_k);
        }
        trajectory
    }
}

//! Samples of a simulation, of which only what sensors and truths need is kept.
use cylwatch_thermal::trajectory::Trajectory;

/// Samples of a simulation at even times from 0 on.
#[derive(Clone, Debug, Default)]
pub(super) struct Samples {
    pub interval_s: f64,
    pub gas_mean_k: Vec<f64>,
    pub mass_kg: Vec<f64>,
    pub pressure_pa: Vec<f64>,
    pub outflow_kg_s: Vec<f64>,
    pub wall_mean_k: Vec<f64>,
    pub shoulder_k: Vec<f64>,
    pub valve_k: Vec<f64>,
}

impl Samples {
    /// A column at a time of the simulation, s, linear between samples.
    pub(super) fn at(&self, column: &[f64], t_s: f64) -> f64 {
        let place = (t_s / self.interval_s).max(0.0);
        let knot = (place.floor() as usize).min(column.len() - 2);
        let weight = (place - knot as f64).min(1.0);
        column[knot] + weight * (column[knot + 1] - column[knot])
    }

    /// Times of the samples, s.
    pub(super) fn times_s(&self) -> impl Iterator<Item = f64> + '_ {
        (0..self.mass_kg.len()).map(|sample| sample as f64 * self.interval_s)
    }

    /// What is kept of a trajectory.
    pub(super) fn of(trajectory: Trajectory, interval_s: f64) -> Self {
        let shoulder_k = trajectory.surface_k("shoulder").unwrap_or_default();
        let Trajectory { gas_mean_k, mass_kg, pressure_pa, outflow_kg_s, wall_mean_k, valve_k, .. } =
            trajectory;
        let valve_k = valve_k.unwrap_or_else(|| shoulder_k.clone());
        Self { interval_s, gas_mean_k, mass_kg, pressure_pa, outflow_kg_s, wall_mean_k, shoulder_k, valve_k }
    }
}

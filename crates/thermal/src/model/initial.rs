//! The model's state at time 0, from what is known of the fill.
use super::Model;
use crate::ThermalError;
use crate::scenario::Initial;
use crate::vessel::Fill;
use crate::vessel::Vessel;

impl Model {
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
}

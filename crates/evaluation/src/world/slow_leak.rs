//! Slow leaks, laid over a finished simulation by the balance of mass and the equation of state.
//!
//! With `m(t)` of the simulation and a leak of `r` from `t_0` on, the mass is `m - r (t - t_0)` and the pressure
//! `p + p_eos(m - r (t - t_0), T) - p_eos(m, T)` at the simulated temperature of the gas. What is left out is the cooling of the gas by
//! its expansion, `r p/rho` over the conductance of the film, and the smaller heat capacity of less gas.
use super::simulation::Simulated;
use super::truth::Truth;
use super::{Request, SteadyLeak};
use cylwatch_thermal::units::HOUR_S;

impl SteadyLeak {
    /// That of a request, if it is to be laid over.
    pub(super) fn laid_over(simulated: &Simulated, request: &Request) -> Option<Self> {
        let leak = request.overlay.leak()?;
        if request.overlay.is_simulated(request.length_s) {
            return None;
        }
        let mass_kg = simulated.samples.mass_kg[0];
        Some(Self { rate_kg_s: leak.part_per_h * mass_kg / HOUR_S, onset_s: leak.onset_s })
    }

    /// Take the gas out of a truth without it, whose masses are absolute.
    pub(super) fn apply(&self, simulated: &Simulated, truth: &mut Truth) {
        let vessel = &simulated.vessel;
        for row in 0..truth.time_s.len() {
            let lost_kg = self.lost_kg(truth.time_s[row]);
            if lost_kg == 0.0 {
                continue;
            }
            let (gas_k, wall_k) = (truth.gas_mean_k[row], truth.wall_mean_k[row]);
            let (mass_kg, before_pa) = (truth.mass_absolute_kg[row], truth.pressure_pa[row]);
            let pressure_of = |mass_kg: f64| {
                let mut pressure_pa = before_pa;
                for _ in 0..3 {
                    pressure_pa = vessel
                        .fluid
                        .pressure_pa(mass_kg / vessel.volume.volume_m3(wall_k, pressure_pa), gas_k);
                }
                pressure_pa
            };
            truth.pressure_pa[row] = before_pa + pressure_of(mass_kg - lost_kg) - pressure_of(mass_kg);
            truth.mass_absolute_kg[row] = mass_kg - lost_kg;
            truth.outflow_kg_s[row] += self.rate_kg_s;
        }
    }
}

//! What the surroundings do at a time.
use cylwatch_thermal::scenario::Surroundings;

use super::simulation::Simulated;
use super::truth::Regime;

/// Time after the beginning of a jump that counts as its mouth, s.
const MOUTH_S: f64 = 900.0;
const SUNNY_W_M2: f64 = 50.0;
/// Time after which the heat of a heater has gone from the air, s.
const HEATED_S: f64 = 300.0;
/// Largest change of calm air, K, and the time it is looked at, s.
const CALM_K: f64 = 1.0;
const CALM_S: f64 = 600.0;

impl Simulated {
    /// Regimes at times of the log, s.
    pub(super) fn regimes(&self, time_s: &[f64]) -> Vec<Regime> {
        time_s.iter().map(|t| self.regime(t + self.drawn.fill.lead_s)).collect()
    }

    /// Regime at a time of the simulation, s.
    fn regime(&self, t_s: f64) -> Regime {
        let around: &Surroundings = &self.surroundings;
        let next = self.jumps_s.partition_point(|&jump| jump <= t_s);
        if next > 0 && t_s - self.jumps_s[next - 1] < MOUTH_S {
            return Regime::Mouth;
        }
        if around.sun.as_ref().is_some_and(|sun| sun.irradiance_w_m2.at(t_s) > SUNNY_W_M2) {
            return Regime::Sun;
        }
        let next = self.heated_s.partition_point(|(begin_s, _)| *begin_s <= t_s);
        if next > 0 && t_s < self.heated_s[next - 1].1 + HEATED_S {
            return Regime::Heater;
        }
        let change_k = around.air_k.at(t_s) - around.air_k.at(t_s - CALM_S);
        let film = around.film.signal().at(t_s);
        if change_k.abs() < CALM_K && film < self.calm_flow { Regime::Calm } else { Regime::Other }
    }
}

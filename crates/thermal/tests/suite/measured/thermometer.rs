//! What a thermometer in the gas reads, where the measurement shows its lag.
use cylwatch_thermal::trajectory::Trajectory;
use cylwatch_thermal::vessel::Vessel;

use super::{Curve, score};

/// Steps between two samples.
const STEPS: usize = 20;

/// Reading of a thermocouple whose sheath holds `capacity` J/m²/K: `c dT/dt = h (T_gas - T)`, with the film of the wall at the
/// same moment, `h ~ |dT|^(1/3)`. A steel sheath of diameter d has `rho c d/4`, 1000 J/m²/K for each millimetre.
pub(super) fn sheathed(vessel: &Vessel, run: &Trajectory, capacity: f64) -> Vec<f64> {
    let g = &vessel.geometry;
    let area_m2 =
        std::f64::consts::PI * g.inner_diameter_m * (g.cylinder_length_m + 0.5 * g.inner_diameter_m);
    let mut reading = vec![run.gas_mean_k[0]];
    for k in 1..run.time_s.len() {
        let step_s = (run.time_s[k] - run.time_s[k - 1]) / STEPS as f64;
        let mut sheath_k = reading[k - 1];
        for j in 0..STEPS {
            let weight = (j as f64 + 0.5) / STEPS as f64;
            let between = |x: &[f64]| x[k - 1] + weight * (x[k] - x[k - 1]);
            let gas_k = between(&run.gas_mean_k);
            let wall_k = (between(&run.wall_inner_mean_k) - gas_k).abs().max(0.1);
            let wall_film = (between(&run.heat_to_gas_w).abs() / (area_m2 * wall_k)).max(1.0);
            let film = wall_film * ((sheath_k - gas_k).abs() / wall_k).cbrt();
            sheath_k += step_s * film * (gas_k - sheath_k) / capacity;
        }
        reading.push(sheath_k);
    }
    reading
}

/// The capacity that fits a record best, J/m²/K, and the root mean square that is left, K. **Fitted to that record.**
pub(super) fn fit(vessel: &Vessel, run: &Trajectory, points: &Curve) -> (f64, f64) {
    (0..=40)
        .map(|i| 20.0 * 1.16_f64.powi(i))
        .map(|c| (c, score(&run.time_s, &sheathed(vessel, run, c), points).1))
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .unwrap()
}

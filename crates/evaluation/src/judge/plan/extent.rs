//! How much a plan asks for, and about how long it takes.
use cylwatch_thermal::units::YEAR_S;

use super::Plan;
use crate::world::GasKind;

/// What a core takes for a row of the monitor, s.
const ROW_S: f64 = 6e-5;

/// What a core takes for a simulated year, s: a metro takes twice as long, a workshop half as long.
const fn year_s(gas: GasKind) -> f64 {
    match gas {
        GasKind::Mixed => 10.0,
        GasKind::FullMesh => 15.0,
        GasKind::Stratified | GasKind::AxialExchange => 45.0,
    }
}

/// How much a plan asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// Worlds.
    pub worlds: usize,
    /// Cylinder-years of all worlds.
    pub cylinder_years: f64,
    /// Rows of all worlds.
    pub rows: f64,
    /// Simulations.
    pub simulations: usize,
    /// Years of all simulations.
    pub simulated_years: f64,
    /// About how long one core takes, s.
    pub core_s: f64,
}

impl Plan {
    /// How much it asks for.
    pub fn extent(&self) -> Extent {
        let units = self.units();
        let rows =
            self.tasks.iter().map(|task| task.request.length_s / task.request.family.rows.interval_s()).sum();
        let simulated =
            || units.iter().map(|unit| (unit.simulated.family.gas, unit.simulated.length_s / YEAR_S));
        Extent {
            worlds: self.tasks.len(),
            cylinder_years: self.tasks.iter().map(|task| task.request.length_s / YEAR_S).sum(),
            rows,
            simulations: units.len(),
            simulated_years: simulated().map(|(_, years)| years).sum(),
            core_s: ROW_S * rows + simulated().map(|(gas, years)| years * year_s(gas)).sum::<f64>(),
        }
    }
}

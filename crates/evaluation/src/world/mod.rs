//! Worlds that judge: a vessel, a climate, a gas, sensors and rows, drawn by seed, and what really happened in them.
//!
//! A [`Request`] decides a [`World`] on every machine, around the nominal vessel of its kind or around an own one ([`NominalVessel`]): the cylinder and what surrounds it are drawn and simulated ([`Simulated`]), then
//! sensors, rows, slow leaks and faults are laid over the simulation. The truth is the finite-volume simulation of
//! [`cylwatch_thermal`], never the reduced model of an observer. A candidate is given [`OperatorData`] and the rows of the log, one by one.
//!
//! Published cases, whose air changes at stated times, have their cylinders in [`chamber`].
pub mod chamber;
mod climate;
mod compose;
mod cylinder_fault;
mod data_fault;
mod disturbance;
mod error;
mod family;
mod fill;
mod flows;
mod gas;
mod operator_data;
mod overlay;
mod process;
mod reading;
mod regime;
mod rows;
mod samples;
mod sensors;
mod simulation;
mod slow_leak;
#[cfg(test)]
pub(crate) mod statistics;
mod truth;
mod vessel;

#[cfg(test)]
mod tests;

use cylwatch_estimator::log::Log;
use serde::{Deserialize, Serialize};

use crate::fault::Fault;
pub use crate::fault::Snapshot;

pub use error::WorldError;
pub use family::{Climate, Family, GasKind, RowPattern, SensorClass, VesselKind};
pub use fill::FillDraw;
pub use flows::SteadyLeak;
pub use gas::GasDraw;
pub use operator_data::OperatorData;
pub use overlay::{FaultRow, Leak, Overlay};
pub use sensors::{SensorDraw, Thermometer, Transmitter};
pub(crate) use simulation::Run;
pub use simulation::{CylinderDraw, Simulated, SimulationKey};
pub use truth::{Regime, Truth, WorldEvent, WorldEventKind};
pub use vessel::{NominalVessel, VesselDraw};

/// Everything that decides a world.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Request {
    /// One of each axis.
    pub family: Family,
    /// Seed of the cylinder and its surroundings.
    pub seed: u64,
    /// Which set of sensors and rows is laid over the simulation; sets of one simulation are not independent of each other.
    pub set: u64,
    /// Length of the log, s.
    pub length_s: f64,
    /// What is laid over it.
    pub overlay: Overlay,
}

impl Request {
    /// A tight cylinder with the first set of sensors.
    pub const fn tight(family: Family, seed: u64, length_s: f64) -> Self {
        Self { family, seed, set: 0, length_s, overlay: Overlay::Nothing }
    }

    /// The same with something laid over it.
    pub const fn with(self, overlay: Overlay) -> Self {
        Self { overlay, ..self }
    }
}

/// A world: what a candidate is given, and what really happened.
#[derive(Clone, Debug)]
pub struct World {
    /// What was asked for.
    pub request: Request,
    /// The simulation behind it: worlds with equal keys are not independent of each other.
    pub simulation: SimulationKey,
    /// What a candidate may know beforehand.
    pub operator_data: OperatorData,
    /// Rows in the order in which they arrive, with their stamps: channels `shoulder`, `valve`, `pressure`.
    pub log: Log,
    /// Rows that say that they are replayed from a store, by index; empty unless a fault replays.
    pub historical: Vec<usize>,
    /// Power cycles, each after a row of this index, and the snapshot that the monitor finds.
    pub(crate) power_cycles: Vec<(usize, Snapshot)>,
    /// The fault of data that is in the rows.
    pub fault: Option<Fault>,
    /// What really happened at every row of the log.
    pub truth: Truth,
    /// What was done, in the order of its beginning.
    pub events: Vec<WorldEvent>,
    /// What was drawn.
    pub drawn: Drawn,
}

/// What was drawn for a world.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Drawn {
    /// Cylinder, gas and fill.
    pub cylinder: CylinderDraw,
    /// Sensors.
    pub sensors: SensorDraw,
}

/// The world of a request.
///
/// # Errors
/// A request out of range, or a simulation that fails.
pub fn generate(request: &Request) -> Result<World, WorldError> {
    Simulated::run(request)?.world(request)
}

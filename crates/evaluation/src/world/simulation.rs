//! One simulation, that several sets of sensors, slow leaks and faults can be laid over.
use serde::{Deserialize, Serialize};

use super::{Climate, Family, GasKind, Request, VesselKind, World, WorldError};

/// What decides the cylinder and its surroundings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct SimulationKey {
    /// Vessel.
    pub vessel: VesselKind,
    /// Climate.
    pub climate: Climate,
    /// How the gas is resolved.
    pub gas: GasKind,
    /// Seed.
    pub seed: u64,
}

impl SimulationKey {
    /// That of a request.
    pub const fn of(request: &Request) -> Self {
        let Family { vessel, climate, gas, .. } = request.family;
        Self { vessel, climate, gas, seed: request.seed }
    }
}

/// A simulated cylinder without sensors.
#[derive(Clone, Debug)]
pub struct Simulated;

impl Simulated {
    /// Simulate what a request needs: its cylinder, its surroundings, its fast flows.
    ///
    /// # Errors
    /// A request out of range, or a simulation that fails.
    pub fn run(_request: &Request) -> Result<Self, WorldError> {
        todo!("types first")
    }

    /// The world of a request over this simulation. The request may differ from that of [`Simulated::run`] in sensors, rows no
    /// closer, set, a shorter length, slow leaks and faults of data.
    ///
    /// # Errors
    /// A request that needs another simulation.
    pub fn world(&self, _request: &Request) -> Result<World, WorldError> {
        todo!("types first")
    }
}

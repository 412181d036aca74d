//! What really happened in a world, row by row, and as a list.
use serde::{Deserialize, Serialize};

use super::overlay::FaultRow;

/// What happened to the cylinder at every row of the log; every vector has one entry for each row.
///
/// Masses are stated twice. `mass_kg` is in the volume that the vessel file states: the true mass times stated over true volume, since
/// readings of pressure and temperature cannot show an error of the volume. `mass_absolute_kg` is the gas itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Truth {
    /// True time at which the row was measured, s from the start of the log.
    pub time_s: Vec<f64>,
    /// Mass-weighted mean temperature of the gas, K.
    pub gas_mean_k: Vec<f64>,
    /// Mass of the gas in the stated volume, kg.
    pub mass_kg: Vec<f64>,
    /// Mass of the gas itself, kg.
    pub(crate) mass_absolute_kg: Vec<f64>,
    /// Pressure of the gas, Pa.
    pub pressure_pa: Vec<f64>,
    /// Pressure that this mass has at 15 °C in the true vessel, Pa.
    pub settled_pa: Vec<f64>,
    /// Mass flow out, in the stated volume, kg/s; negative while gas is put in.
    pub outflow_kg_s: Vec<f64>,
    /// Air at half the height, K.
    pub air_k: Vec<f64>,
    /// Mean temperature of the wall, K.
    pub wall_mean_k: Vec<f64>,
    /// Outer surface of the shoulder, K.
    pub shoulder_k: Vec<f64>,
    /// Valve, K.
    pub valve_k: Vec<f64>,
    /// What the surroundings do.
    pub regime: Vec<Regime>,
}

/// What the surroundings do at a time, the first that applies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Regime {
    /// Up to a quarter of an hour after the air began to jump: mouth of a tunnel, door, profile of a chamber.
    Mouth,
    /// Sun of more than 50 W/m² on the surface.
    Sun,
    /// A heater is on, or was within the last 5 min.
    Heater,
    /// None of those, and air that moves by less than 1 K within 10 min and calm wind.
    Calm,
    /// Everything else.
    Other,
}

impl Regime {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Mouth, Self::Sun, Self::Heater, Self::Calm, Self::Other];
}

/// Something that was done to the cylinder, its sensors or its rows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WorldEvent {
    /// What.
    pub kind: WorldEventKind,
    /// True time at which it begins, s from the start of the log.
    pub start_s: f64,
    /// True time at which it ends, s; beyond the last row: it goes on.
    pub end_s: f64,
    /// Mass that is lost by it until the end of the log, in the stated volume, kg; negative: gained.
    pub lost_kg: f64,
    /// Whether the candidate is told of it beforehand.
    pub announced: bool,
}

impl WorldEvent {
    /// Something that happens to the rows alone.
    pub(super) const fn of_rows(kind: WorldEventKind, (start_s, end_s): (f64, f64)) -> Self {
        Self { kind, start_s, end_s, lost_kg: 0.0, announced: false }
    }
}

/// What was done.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum WorldEventKind {
    /// A leak.
    Leak,
    /// A fast loss of gas that nobody ordered.
    FastLoss,
    /// A discharge.
    Discharge,
    /// Gas is put in.
    Refill,
    /// A fault of the fault table.
    Fault(FaultRow),
    /// A stretch without rows.
    Gap,
    /// The clock that stamps the rows is set.
    ClockStep,
}

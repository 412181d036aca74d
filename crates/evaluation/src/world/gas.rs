//! How the gas and the wall of a truth are resolved.
//!
//! Well-mixed and stacked gas stand behind a coarse wall: three axial cells on the cylinder, one radial cell in each layer that heat
//! passes within seconds. The full mesh is that of the vessel's file. Stacked gas has four cells (eight move the gas temperature of a winter week by 4 mK rms, the shoulder's
//! by 20 mK, and cost two thirds more), an exchange length of 0.7 to 1.4 diameters and a
//! core mixing of 0.02 to 0.1; with the axial exchange off, both are multiplied by one factor of 1/3 to 3, even by its logarithm.
use cylwatch_thermal::vessel::{GasResolution, Stratification, Vessel};
use cylwatch_thermal::wall::geometry::Layer;
use serde::{Deserialize, Serialize};

use super::GasKind;
use crate::random::{Purpose, Random};

const EXCHANGE_LENGTH_DIAMETERS: (f64, f64) = (0.7, 1.4);
const CORE_MIXING: (f64, f64) = (0.02, 0.1);
const MISFIT_FACTOR: (f64, f64) = (1.0 / 3.0, 3.0);
const STACKED_CELLS: usize = 4;
const COARSE_CELLS: usize = 3;
/// Time in which heat passes a layer of one cell, s.
const LAYER_TIME_S: f64 = 20.0;

/// What is drawn for stacked gas; without effect on well-mixed gas.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct GasDraw {
    /// Exchange length of the boundary layer, inner diameters.
    pub exchange_length_diameters: f64,
    /// Mixing of the core.
    pub core_mixing: f64,
    /// Factor on both where the exchange along the axis is off.
    pub(crate) off_by: f64,
}

impl GasDraw {
    /// The draw of a seed.
    pub(super) fn draw(seed: u64) -> Self {
        let random = &mut Random::new(seed, Purpose::WorldGas);
        Self {
            exchange_length_diameters: random.uniform(EXCHANGE_LENGTH_DIAMETERS),
            core_mixing: random.uniform(CORE_MIXING),
            off_by: random.by_logarithm(MISFIT_FACTOR),
        }
    }
}

impl GasKind {
    /// The vessel resolved this way.
    pub(super) fn resolve(self, vessel: &mut Vessel, draw: &GasDraw) {
        if self == Self::FullMesh {
            vessel.gas = GasResolution::WellMixed;
            return;
        }
        vessel.geometry.cylinder_cells = vessel.geometry.cylinder_cells.min(COARSE_CELLS);
        for layer in vessel.geometry.layers.iter_mut().filter(|layer| passing_s(layer) < LAYER_TIME_S) {
            layer.cells = 1;
        }
        let off_by = if self == Self::AxialExchange { draw.off_by } else { 1.0 };
        vessel.gas = match self {
            Self::Mixed | Self::FullMesh => GasResolution::WellMixed,
            Self::Stratified | Self::AxialExchange => GasResolution::Stratified(Stratification {
                cells: STACKED_CELLS,
                exchange_length_diameters: draw.exchange_length_diameters * off_by,
                core_mixing: draw.core_mixing * off_by,
            }),
        };
    }

    /// Relative tolerance of the simulation: stacked cells exchange small differences.
    pub(super) const fn tolerance(self) -> f64 {
        match self {
            Self::Mixed | Self::FullMesh => 1e-4,
            Self::Stratified | Self::AxialExchange => 1e-5,
        }
    }
}

/// Time in which heat passes a layer, `s^2 rho c / k`, s.
fn passing_s(layer: &Layer) -> f64 {
    let material = &layer.material;
    layer.thickness_m.powi(2) * material.density_kg_m3 * material.heat_capacity_j_kg_k
        / material.conductivity_w_m_k
}

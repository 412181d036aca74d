//! What a cylinder is: fluid, contour, wall, valve, surface and films, independent of what happens to it.
//!
//! [`VesselSpec`] is the raw content of a vessel file; [`VesselSpec::build`] checks it and gives a [`Vessel`].
#[cfg(feature = "files")]
mod build;
#[cfg(feature = "files")]
mod calibration;
#[cfg(feature = "files")]
mod contour;
#[cfg(feature = "files")]
pub mod presets;
#[cfg(feature = "files")]
mod read;
#[cfg(feature = "files")]
pub mod spec;
mod valid;

use alloc::string::String;
use alloc::vec::Vec;
#[cfg(feature = "files")]
pub use read::{read_specification, read_vessel, schema};
#[cfg(feature = "files")]
pub use spec::VesselSpec;

use serde::{Deserialize, Serialize};

use crate::fluid::Fluid;
use crate::wall::geometry::Geometry;
use crate::wall::material::Material;

/// A validated vessel. All values SI.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Vessel {
    /// Name for people.
    pub name: String,
    /// The gas inside, with the equation of state that describes it.
    pub fluid: Fluid,
    /// Contour, layers, mesh counts.
    pub geometry: Geometry,
    /// How the inner volume answers to temperature and pressure.
    pub volume: InnerVolume,
    /// The valve body on the neck, if modelled.
    pub valve: Option<Valve>,
    /// Radiation and film of the outer surface.
    pub surface: Surface,
    /// Heat transfer between wall and gas.
    pub inside_film: InsideFilm,
    /// Factor on the film of gas that a refill's jet stirs, 1 unless calibrated.
    pub jet_film_factor: f64,
    /// How the gas is resolved.
    pub gas: GasResolution,
}

/// Difference of stated volume and contour that drawings and data sheets do not have.
const VOLUME_DOUBT: f64 = 0.05;

impl Vessel {
    /// What fits badly without being impossible, in words.
    pub fn doubts(&self) -> Vec<String> {
        let contour_m3 = self.geometry.contour_volume_m3();
        let ratio = self.volume.volume_m3 / contour_m3 - 1.0;
        let volume = (ratio.abs() > VOLUME_DOUBT).then(|| {
            format!(
                "{}: volume_l = {} is {:.0} % {} the contour's {:.2} l, and the mass of gas goes with it: look at volume, diameters \
                 and lengths",
                self.name,
                libm::round(1e7 * self.volume.volume_m3) / 1e4,
                100.0 * ratio.abs(),
                if ratio > 0.0 { "above" } else { "below" },
                1e3 * contour_m3
            )
        });
        volume.into_iter().collect()
    }
}

/// Inner volume `V = V_0 [1 + a (T_wall - T_0) + b (p - p_0)]` with the heat-capacity-weighted mean wall
/// temperature; `a = b = 0` is a rigid vessel.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct InnerVolume {
    /// Volume `V_0` at the reference state, m³; the contour's own volume is scaled to it for the gas, not for the wall.
    pub volume_m3: f64,
    /// Relative thermal expansion `a`, 1/K (steel: 3.5e-5).
    pub thermal_expansion_per_k: f64,
    /// Relative expansion by pressure `b`, 1/Pa (20 L steel: 1.5e-10).
    pub pressure_expansion_per_pa: f64,
    /// Reference temperature `T_0`, K.
    pub reference_temperature_k: f64,
    /// Reference pressure `p_0`, Pa.
    pub reference_pressure_pa: f64,
}

/// Valve body: one heat capacity on the neck (or on the topmost wall cell where there is no neck).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Valve {
    /// What it is made of.
    pub material: Material,
    /// Mass, kg.
    pub mass_kg: f64,
    /// Thermal contact to the topmost wall cell, W/K.
    pub contact_w_k: f64,
    /// Outer area, m².
    pub area_m2: f64,
    /// Diameter that its outside film is computed with, m.
    pub diameter_m: f64,
    /// Outside film relative to the cylinder's where the latter is given as a coefficient.
    pub film_factor: f64,
}

/// The outer surface (cylinder and valve).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Surface {
    /// Long-wave emissivity, 0 to 1.
    pub emissivity: f64,
    /// Absorptivity for sunlight, 0 to 1.
    pub solar_absorptivity: f64,
    /// Factor on the outside film that a scenario says, 1 unless calibrated.
    pub film_factor: f64,
}

/// Film law between the inner surface and the gas, `Nu_L = c Ra_L^n`, times a multiplier; or a fixed coefficient.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum InsideFilm {
    /// Power law with properties at film temperature.
    Rayleigh {
        /// Factor `c`, e.g. 0.13 (McAdams) or 0.104 (Daney).
        factor: f64,
        /// Exponent `n`, e.g. 1/3 (length-free) or 0.352.
        exponent: f64,
        /// Multiplier for calibration, 1 by default.
        multiplier: f64,
    },
    /// Constant coefficient, W/(m² K).
    Coefficient {
        /// Film coefficient, W/(m² K).
        film_w_m2_k: f64,
    },
}

/// How the gas is resolved.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum GasResolution {
    /// One well-mixed node: what mean temperature and pressure need.
    WellMixed,
    /// Stacked cells of common pressure; the constants are uncertain (see `model::stratified`).
    Stratified(Stratification),
}

/// Constants of the stratified gas.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stratification {
    /// Number of gas cells, at least 2.
    pub cells: usize,
    /// Length over which the boundary layer gives its excess heat back to the core, in inner diameters (uncertain, about 1).
    pub exchange_length_diameters: f64,
    /// Core mixing `c` in `D_t = c w* D` (uncertain, 0 to 0.2).
    pub core_mixing: f64,
}

impl Default for Stratification {
    /// Twenty cells, an exchange length of one diameter, hardly any mixing of the core.
    fn default() -> Self {
        Self { cells: 20, exchange_length_diameters: 1.0, core_mixing: 0.05 }
    }
}

impl InnerVolume {
    /// Volume at a mean wall temperature and a pressure, m³.
    pub fn volume_m3(&self, wall_k: f64, pressure_pa: f64) -> f64 {
        self.volume_m3
            * (1.0
                + self.thermal_expansion_per_k * (wall_k - self.reference_temperature_k)
                + self.pressure_expansion_per_pa * (pressure_pa - self.reference_pressure_pa))
    }
}

impl Valve {
    /// Heat capacity at the reference temperature, J/K.
    pub fn capacity_j_k(&self) -> f64 {
        self.mass_kg * self.material.heat_capacity_j_kg_k
    }
}

/// What fixes the gas mass.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Fill {
    /// Settled pressure at a settled temperature of gas and wall, as a filling station states it.
    Settled {
        /// Absolute pressure, Pa.
        pressure_pa: f64,
        /// Temperature of gas and wall, K.
        temperature_k: f64,
    },
    /// Pressure at time 0 with the initial gas and wall temperatures.
    Pressure {
        /// Absolute pressure, Pa.
        pressure_pa: f64,
    },
    /// Gas mass, kg.
    Mass {
        /// Mass, kg.
        mass_kg: f64,
    },
}

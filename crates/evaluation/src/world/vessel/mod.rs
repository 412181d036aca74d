//! Nominal vessels, of a kind or an own one, and cylinders drawn around them.
//!
//! A candidate is told the nominal vessel. The real one has heat capacities, films and the contact of its valve within 30 % of it, a
//! volume within 5 %, expansions within 10 %, an emissivity of 0.6 to 0.95 and an absorptivity of 0.4 to 0.8, all drawn evenly.
//! To add a vessel: a file beside this one, an entry in `VesselKind::nominal_entry`, and a kind in [`VesselKind`].
use cylwatch_thermal::ThermalError;
use cylwatch_thermal::units::BAR_PA;
use cylwatch_thermal::vessel::{InsideFilm, Vessel, presets, read_vessel};
use serde::{Deserialize, Serialize};

use super::VesselKind;
use crate::random::{Purpose, Random};

const CAPACITY: (f64, f64) = (0.7, 1.3);
const CONTACT: (f64, f64) = (0.7, 1.3);
const FILM: (f64, f64) = (0.7, 1.3);
const VOLUME: (f64, f64) = (0.95, 1.05);
const EXPANSION: (f64, f64) = (0.9, 1.1);
const EMISSIVITY: (f64, f64) = (0.6, 0.95);
const ABSORPTIVITY: (f64, f64) = (0.4, 0.8);
const FILM_SLOPE: (f64, f64) = (-0.3, 0.3);

/// An own vessel is filled from this part of its stated fill on: a cylinder in service has lost some, or was filled on a cold day.
const OWN_FILL_FROM: f64 = 0.9;
/// Range of the transmitter of an own vessel, of the stated fill.
const OWN_FULL_SCALE: f64 = 1.25;
/// Bore of the valve of an own vessel, m.
const OWN_INLET_M: f64 = 0.006;

/// A vessel that cylinders are drawn around, how it is filled and how its pressure is read.
#[derive(Clone, Debug)]
pub struct NominalVessel {
    /// The vessel as its file states it.
    pub vessel: Vessel,
    /// Range of the pressure of its fill at 15 °C, Pa absolute.
    pub fill_pa: (f64, f64),
    /// Upper end of the range of its transmitter, Pa.
    pub full_scale_pa: f64,
    /// Bore through which it is filled, m.
    pub inlet_m: f64,
}

impl NominalVessel {
    /// An own vessel of a stated fill at 15 °C, Pa absolute: fills from 0.9 of it on, a transmitter of 1.25 times as much, a bore of 6 mm.
    pub fn own(vessel: Vessel, fill_pa: f64) -> Self {
        Self {
            vessel,
            fill_pa: (OWN_FILL_FROM * fill_pa, fill_pa),
            full_scale_pa: OWN_FULL_SCALE * fill_pa,
            inlet_m: OWN_INLET_M,
        }
    }
}

/// What stands in the table of kinds.
struct Entry {
    text: &'static str,
    /// Range of the pressure of its fill at 15 °C, bar.
    fill_bar: (f64, f64),
    /// Upper end of the range of its transmitter, bar.
    full_scale_bar: f64,
    /// Bore through which it is filled, m.
    inlet_m: f64,
}

impl VesselKind {
    fn nominal_entry(self) -> Entry {
        let entry =
            |text, fill_bar, full_scale_bar, inlet_m| Entry { text, fill_bar, full_scale_bar, inlet_m };
        match self {
            Self::Nitrogen20 => {
                let text = presets::FILES.text("nitrogen-20l").unwrap_or_default();
                entry(text, (180.0, 200.0), 250.0, 0.006)
            }
            Self::Argon50 => entry(include_str!("argon-50l.toml"), (270.0, 300.0), 400.0, 0.006),
            Self::Nitrogen80 => entry(include_str!("nitrogen-80l.toml"), (270.0, 300.0), 400.0, 0.008),
            Self::AirComposite7 => entry(include_str!("air-composite-7l.toml"), (270.0, 300.0), 400.0, 0.005),
            Self::Helium10 => entry(include_str!("helium-10l.toml"), (180.0, 200.0), 250.0, 0.005),
            Self::Hydrogen50 => entry(include_str!("hydrogen-50l.toml"), (180.0, 200.0), 250.0, 0.006),
            Self::AirTank8 => entry(include_str!("air-tank-8l.toml"), (3.0, 8.0), 10.0, 0.006),
        }
    }

    /// The nominal vessel's file.
    pub fn text(self) -> &'static str {
        self.nominal_entry().text
    }

    /// The nominal vessel.
    ///
    /// # Errors
    /// None: the files are tested.
    pub fn nominal(self) -> Result<NominalVessel, ThermalError> {
        let Entry { text, fill_bar: (low, high), full_scale_bar, inlet_m } = self.nominal_entry();
        Ok(NominalVessel {
            vessel: read_vessel(text, &format!("{self}.toml"))?,
            fill_pa: (low * BAR_PA, high * BAR_PA),
            full_scale_pa: full_scale_bar * BAR_PA,
            inlet_m,
        })
    }
}

/// How a cylinder differs from the nominal one: factors on its properties, unless a unit says otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct VesselDraw {
    /// Inner volume.
    pub volume: f64,
    /// Heat capacity of the wall.
    pub(crate) wall_capacity: f64,
    /// Heat capacity of the valve.
    pub valve_capacity: f64,
    /// Conductance between valve and shoulder.
    pub(crate) valve_contact: f64,
    /// Film inside.
    pub inside_film: f64,
    /// Film outside, by convection.
    pub(crate) outside_film: f64,
    /// Relative change of the outside film from bottom to top.
    pub film_slope: f64,
    /// Long-wave emissivity itself.
    pub emissivity: f64,
    /// Absorptivity for sunlight itself.
    pub absorptivity: f64,
    /// Expansion of the volume by temperature.
    pub(crate) thermal_expansion: f64,
    /// Expansion of the volume by pressure.
    pub(crate) pressure_expansion: f64,
}

impl VesselDraw {
    /// The draw of a seed.
    pub(super) fn draw(seed: u64) -> Self {
        let random = &mut Random::new(seed, Purpose::WorldVessel);
        Self {
            volume: random.uniform(VOLUME),
            wall_capacity: random.uniform(CAPACITY),
            valve_capacity: random.uniform(CAPACITY),
            valve_contact: random.uniform(CONTACT),
            inside_film: random.uniform(FILM),
            outside_film: random.uniform(FILM),
            film_slope: random.uniform(FILM_SLOPE),
            emissivity: random.uniform(EMISSIVITY),
            absorptivity: random.uniform(ABSORPTIVITY),
            thermal_expansion: random.uniform(EXPANSION),
            pressure_expansion: random.uniform(EXPANSION),
        }
    }

    /// The nominal vessel with these properties.
    pub(super) fn apply(&self, nominal: &Vessel) -> Vessel {
        let mut vessel = nominal.clone();
        for layer in &mut vessel.geometry.layers {
            layer.material.heat_capacity_j_kg_k *= self.wall_capacity;
        }
        if let Some(valve) = &mut vessel.valve {
            valve.material.heat_capacity_j_kg_k *= self.valve_capacity;
            valve.contact_w_k *= self.valve_contact;
        }
        match &mut vessel.inside_film {
            InsideFilm::Rayleigh { multiplier, .. } => *multiplier *= self.inside_film,
            InsideFilm::Coefficient { film_w_m2_k } => *film_w_m2_k *= self.inside_film,
        }
        vessel.surface.emissivity = self.emissivity;
        vessel.surface.solar_absorptivity = self.absorptivity;
        vessel.volume.volume_m3 *= self.volume;
        vessel.volume.thermal_expansion_per_k *= self.thermal_expansion;
        vessel.volume.pressure_expansion_per_pa *= self.pressure_expansion;
        vessel
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cylwatch_detector::evidence::Tails;

    #[test]
    fn every_vessel_has_the_tails_that_were_fitted_to_its_like() {
        for &kind in VesselKind::ALL {
            let NominalVessel { vessel, fill_pa: (low, high), .. } = kind.nominal().unwrap();
            let fitted = if kind == VesselKind::AirTank8 { Tails::TANK } else { Tails::CYLINDER };
            for fill_pa in [low, high] {
                assert_eq!(Tails::usual(&vessel, fill_pa), fitted, "{kind} {fill_pa}");
            }
        }
    }
}

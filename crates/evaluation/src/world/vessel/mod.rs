//! Nominal vessels, and cylinders drawn around them.
//!
//! A candidate is told the nominal vessel. The real one has heat capacities, films and the contact of its valve within 30 % of it, a
//! volume within 5 %, expansions within 10 %, an emissivity of 0.6 to 0.95 and an absorptivity of 0.4 to 0.8, all drawn evenly.
//! To add a vessel: a file beside this one, an entry in [`NOMINAL`], and a kind in [`VesselKind`].
use cylwatch_thermal::ThermalError;
use cylwatch_thermal::vessel::{InsideFilm, Vessel, presets, read_vessel};
use serde::{Deserialize, Serialize};

use super::VesselKind;
use crate::random::{Purpose, Random};

const BAR_PA: f64 = 1e5;
const CAPACITY: (f64, f64) = (0.7, 1.3);
const CONTACT: (f64, f64) = (0.7, 1.3);
const FILM: (f64, f64) = (0.7, 1.3);
const VOLUME: (f64, f64) = (0.95, 1.05);
const EXPANSION: (f64, f64) = (0.9, 1.1);
const EMISSIVITY: (f64, f64) = (0.6, 0.95);
const ABSORPTIVITY: (f64, f64) = (0.4, 0.8);
const FILM_SLOPE: (f64, f64) = (-0.3, 0.3);

/// What is known of a nominal vessel.
struct Nominal {
    text: &'static str,
    /// Range of the pressure of its fill at 15 °C, bar.
    fill_bar: (f64, f64),
    /// Upper end of the range of its transmitter, bar.
    full_scale_bar: f64,
    /// Bore through which it is filled, m.
    inlet_m: f64,
}

impl VesselKind {
    fn nominal_entry(self) -> Nominal {
        let entry =
            |text, fill_bar, full_scale_bar, inlet_m| Nominal { text, fill_bar, full_scale_bar, inlet_m };
        match self {
            Self::Nitrogen20 => {
                let text = presets::text("nitrogen-20l").unwrap_or_default();
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
    pub fn nominal(self) -> Result<Vessel, ThermalError> {
        read_vessel(self.text(), &format!("{self}.toml"))
    }

    /// Range of the pressure of its fill at 15 °C, Pa absolute.
    pub fn fill_pa(self) -> (f64, f64) {
        let (low, high) = self.nominal_entry().fill_bar;
        (low * BAR_PA, high * BAR_PA)
    }

    /// Upper end of the range of its transmitter, Pa.
    pub fn full_scale_pa(self) -> f64 {
        self.nominal_entry().full_scale_bar * BAR_PA
    }

    /// Bore through which it is filled, m.
    pub fn inlet_m(self) -> f64 {
        self.nominal_entry().inlet_m
    }
}

/// How a cylinder differs from the nominal one: factors on its properties, unless a unit says otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct VesselDraw {
    /// Inner volume.
    pub volume: f64,
    /// Heat capacity of the wall.
    pub wall_capacity: f64,
    /// Heat capacity of the valve.
    pub valve_capacity: f64,
    /// Conductance between valve and shoulder.
    pub valve_contact: f64,
    /// Film inside.
    pub inside_film: f64,
    /// Film outside, by convection.
    pub outside_film: f64,
    /// Relative change of the outside film from bottom to top.
    pub film_slope: f64,
    /// Long-wave emissivity itself.
    pub emissivity: f64,
    /// Absorptivity for sunlight itself.
    pub absorptivity: f64,
    /// Expansion of the volume by temperature.
    pub thermal_expansion: f64,
    /// Expansion of the volume by pressure.
    pub pressure_expansion: f64,
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

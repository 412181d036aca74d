//! One cylinder of many: a nominal vessel whose properties and sensors are drawn from a seed.
use cylwatch_thermal::scenario::{OutsideFilm, Scenario};
use cylwatch_thermal::vessel::{GasResolution, InsideFilm, Stratification, Vessel};
use serde::{Deserialize, Serialize};

use super::TruthSettings;
use crate::EvaluationError;
use crate::random::{Purpose, Random};

const OUTSIDE_FILM: (f64, f64) = (0.75, 1.3);
const INSIDE_FILM: (f64, f64) = (0.75, 1.3);
const WALL_CAPACITY: (f64, f64) = (0.8, 1.25);
const VALVE_CAPACITY: (f64, f64) = (0.75, 1.3);
const VALVE_CONTACT: (f64, f64) = (0.7, 1.3);
const EMISSIVITY: (f64, f64) = (0.6, 0.95);
const EXPANSION: (f64, f64) = (0.9, 1.1);
const FILM_SLOPE: (f64, f64) = (-0.3, 0.3);
const EXCHANGE_LENGTH_DIAMETERS: (f64, f64) = (0.7, 1.4);
const CORE_MIXING: (f64, f64) = (0.02, 0.1);
const COUPLING: (f64, f64) = (0.05, 0.15);
/// Class B of IEC 60751 at 0 °C, K.
const OFFSET_K: (f64, f64) = (-0.3, 0.3);
const PRESSURE_OFFSET_PA: (f64, f64) = (0.25e5, 0.625e5);
const PRESSURE_COEFFICIENT_PA_K: (f64, f64) = (0.0125e5, 0.0375e5);

/// How a cylinder differs from the nominal one: factors on its properties, unless a unit says otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CylinderParameters {
    /// Film outside, by convection.
    pub outside_film: f64,
    /// Film inside.
    pub inside_film: f64,
    /// Heat capacity of the wall.
    pub wall_capacity: f64,
    /// Heat capacity of the valve.
    pub valve_capacity: f64,
    /// Conductance between valve and shoulder.
    pub valve_contact: f64,
    /// Long-wave emissivity itself.
    pub emissivity: f64,
    /// Expansion of the volume by temperature.
    pub thermal_expansion: f64,
    /// Expansion of the volume by pressure.
    pub pressure_expansion: f64,
    /// Relative change of the outside film from bottom to top.
    pub film_slope: f64,
    /// Exchange length of the gas's boundary layer, inner diameters.
    pub exchange_length_diameters: f64,
    /// Core mixing of the gas.
    pub core_mixing: f64,
}

/// A surface temperature sensor as it is: it reads
/// `T + kappa (h/h_0)^0.3 (T_air - T) + offset + noise`, with `h` the film by convection, `h_0` = 10 W/(m² K), and
/// noise of 0.05 K. A filter takes the coupling as constant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TemperatureSensor {
    /// Constant offset, K.
    pub offset_k: f64,
    /// Mounting coupling `kappa` to the air, 0 to 1.
    pub air_coupling: f64,
}

/// A pressure transmitter as it is: it reads `p + offset + coefficient (T_valve - 288.15 K) + noise`, noise of 10 mbar.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PressureSensor {
    /// Constant offset, Pa.
    pub offset_pa: f64,
    /// Temperature coefficient, Pa/K.
    pub coefficient_pa_k: f64,
}

/// The sensors of a cylinder.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SensorParameters {
    /// On the shoulder.
    pub shoulder: TemperatureSensor,
    /// On the valve.
    pub valve: TemperatureSensor,
    /// On the middle of the wall.
    pub middle: TemperatureSensor,
    /// On the bottom.
    pub bottom: TemperatureSensor,
    /// In the valve.
    pub pressure: PressureSensor,
}

/// A drawn cylinder.
#[derive(Clone, Debug)]
pub struct Cylinder {
    /// The vessel with its drawn properties, its gas stratified.
    pub vessel: Vessel,
    /// What was drawn for the vessel and its exposure.
    pub parameters: CylinderParameters,
    /// What was drawn for the sensors.
    pub sensors: SensorParameters,
}

/// Draw a cylinder around a nominal one.
///
/// # Errors
/// [`EvaluationError::TruthSetting`]: a mesh that cannot be.
pub fn draw_cylinder(
    nominal: &Vessel,
    settings: &TruthSettings,
    seed: u64,
) -> Result<Cylinder, EvaluationError> {
    settings.validate()?;
    let parameters = CylinderParameters::draw(&mut Random::new(seed, Purpose::Cylinder));
    let sensors = SensorParameters::draw(&mut Random::new(seed, Purpose::Sensors));
    let mut vessel = parameters.apply(nominal);
    vessel.geometry.cylinder_cells = settings.cylinder_cells;
    for layer in &mut vessel.geometry.layers {
        layer.cells = settings.radial_cells;
    }
    vessel.gas = if settings.gas_cells < 2 {
        GasResolution::WellMixed
    } else {
        GasResolution::Stratified(Stratification {
            cells: settings.gas_cells,
            exchange_length_diameters: parameters.exchange_length_diameters,
            core_mixing: parameters.core_mixing,
        })
    };
    Ok(Cylinder { vessel, parameters, sensors })
}

impl CylinderParameters {
    fn draw(random: &mut Random) -> Self {
        Self {
            outside_film: random.uniform(OUTSIDE_FILM),
            inside_film: random.uniform(INSIDE_FILM),
            wall_capacity: random.uniform(WALL_CAPACITY),
            valve_capacity: random.uniform(VALVE_CAPACITY),
            valve_contact: random.uniform(VALVE_CONTACT),
            emissivity: random.uniform(EMISSIVITY),
            thermal_expansion: random.uniform(EXPANSION),
            pressure_expansion: random.uniform(EXPANSION),
            film_slope: random.uniform(FILM_SLOPE),
            exchange_length_diameters: random.uniform(EXCHANGE_LENGTH_DIAMETERS),
            core_mixing: random.uniform(CORE_MIXING),
        }
    }

    /// The nominal vessel with these properties.
    pub fn apply(&self, nominal: &Vessel) -> Vessel {
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
        vessel.volume.thermal_expansion_per_k *= self.thermal_expansion;
        vessel.volume.pressure_expansion_per_pa *= self.pressure_expansion;
        vessel
    }

    /// Surroundings as this cylinder feels them: its film, and how it changes along the axis.
    ///
    /// # Errors
    /// None for a scenario that was valid before.
    pub fn expose(&self, mut scenario: Scenario) -> Result<Scenario, EvaluationError> {
        match &mut scenario.surroundings.film {
            OutsideFilm::Coefficient { film_w_m2_k } => {
                *film_w_m2_k = film_w_m2_k.scaled(self.outside_film)?;
            }
            OutsideFilm::Convection { multiplier, .. } => *multiplier *= self.outside_film,
        }
        scenario.surroundings.axial.film_slope = self.film_slope;
        Ok(scenario)
    }
}

impl SensorParameters {
    fn draw(random: &mut Random) -> Self {
        let mut surface = || TemperatureSensor {
            offset_k: random.uniform(OFFSET_K),
            air_coupling: random.uniform(COUPLING),
        };
        let (shoulder, valve, middle, bottom) = (surface(), surface(), surface(), surface());
        let pressure = PressureSensor {
            offset_pa: random.either_sign(PRESSURE_OFFSET_PA),
            coefficient_pa_k: random.either_sign(PRESSURE_COEFFICIENT_PA_K),
        };
        Self { shoulder, valve, middle, bottom, pressure }
    }
}

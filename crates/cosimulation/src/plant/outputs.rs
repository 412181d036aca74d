//! What a plant says: the columns of a simulation in SI.
use cylwatch_estimator::log::Quantity;
use cylwatch_estimator::sensor::Sensor;
use cylwatch_thermal::trajectory::Trajectory;

use crate::variable::{Type, Unit, Variable};

/// An output and where it is taken from.
#[derive(Debug)]
pub(super) struct OutputOf {
    pub(super) variable: Variable,
    pub(super) place: Place,
}

/// Samples of a quantity.
type Samples = fn(&Trajectory) -> &[f64];

/// Where an output is taken from.
#[derive(Debug)]
pub(super) enum Place {
    Sample(Samples),
    Surface(String),
    Reading(usize),
}

impl Place {
    /// Its value in a trajectory of one sample.
    pub(super) fn value(&self, now: &Trajectory, readings: &[f64]) -> f64 {
        let value = match self {
            Self::Sample(of) => of(now).first().copied(),
            Self::Surface(place) => now.surface_k(place).and_then(|values| values.first().copied()),
            Self::Reading(index) => readings.get(*index).copied(),
        };
        value.unwrap_or(f64::NAN)
    }
}

/// What every vessel has.
const OF_ALL: [(&str, &str, Unit, Samples); 7] = [
    ("gas_mean_k", "Mass-weighted mean gas temperature", Unit::Kelvin, |now| &now.gas_mean_k),
    (
        "wall_mean_k",
        "Mean wall temperature: that of a uniform wall of the same energy",
        Unit::Kelvin,
        |now| &now.wall_mean_k,
    ),
    ("wall_inner_mean_k", "Mean temperature of the inner surface, by area", Unit::Kelvin, |now| {
        &now.wall_inner_mean_k
    }),
    ("pressure_pa", "Absolute gas pressure", Unit::Pascal, |now| &now.pressure_pa),
    ("mass_kg", "Gas mass", Unit::Kilogram, |now| &now.mass_kg),
    ("outflow_kg_s", "Net mass flow out of the cylinder", Unit::KilogramPerSecond, |now| &now.outflow_kg_s),
    ("heat_to_gas_w", "Heat flow from the wall to the gas", Unit::Watt, |now| &now.heat_to_gas_w),
];

/// The outputs of a vessel, of which `now` is a sample, with its sensors.
pub(super) fn outputs(now: &Trajectory, sensors: &[Sensor]) -> Vec<OutputOf> {
    let output = |name: String, description: String, unit: Unit, place: Place| OutputOf {
        variable: Variable::output(name, description, Type::Real(unit)),
        place,
    };
    let mut outputs: Vec<OutputOf> = OF_ALL
        .iter()
        .map(|&(name, words, unit, of)| output(name.to_owned(), words.to_owned(), unit, Place::Sample(of)))
        .collect();
    let places = now.places.iter().map(|place| place.name).chain(now.valve_k.as_ref().map(|_| "valve"));
    outputs.extend(places.map(|place| {
        let name = match place {
            "shoulder" | "valve" => format!("{place}_k"),
            place => format!("wall_{place}_k"),
        };
        let words = match place {
            "valve" => "Temperature of the valve body".to_owned(),
            place => format!("Temperature of the outer surface, {place}"),
        };
        output(name, words, Unit::Kelvin, Place::Surface(place.to_owned()))
    }));
    outputs.extend(sensors.iter().enumerate().map(|(index, sensor)| {
        let (name, unit) = reading(sensor);
        let words = format!("Reading of the sensor {}, without noise", sensor.name);
        output(format!("measured_{name}"), words, unit, Place::Reading(index))
    }));
    outputs
}

/// Name and unit of a sensor's reading.
pub(crate) fn reading(sensor: &Sensor) -> (String, Unit) {
    match sensor.quantity() {
        Quantity::Temperature => (format!("{}_k", sensor.name), Unit::Kelvin),
        Quantity::Pressure => (format!("{}_pa", sensor.name), Unit::Pascal),
    }
}

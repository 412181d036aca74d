//! What each sensor is for.
use crate::estimator::log::Quantity;
use crate::estimator::sensor::{Sensor, Site};
use alloc::vec::Vec;

/// Indices of sensors by what they tell of the cylinder.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Roles {
    /// The pressure transmitter; the first one.
    pub pressure: Option<usize>,
    /// Thermometers on the wall, the valve or in the gas.
    pub thermometers: Vec<usize>,
    /// Two thermometers on the surface that can be compared.
    pub pair: Option<[usize; 2]>,
}

impl Roles {
    pub(super) fn of(sensors: &[Sensor]) -> Self {
        let all = || sensors.iter().enumerate();
        let surface = all().filter(|(_, sensor)| sensor.is_on_surface());
        let surface: Vec<usize> = surface.map(|(index, _)| index).collect();
        let on_the_cylinder =
            |sensor: &Sensor| sensor.quantity() == Quantity::Temperature && sensor.site() != Site::Air;
        Self {
            pressure: all()
                .find(|(_, sensor)| sensor.quantity() == Quantity::Pressure)
                .map(|(index, _)| index),
            thermometers: all().filter(|(_, s)| on_the_cylinder(s)).map(|(index, _)| index).collect(),
            pair: surface.first().zip(surface.get(1)).map(|(first, second)| [*first, *second]),
        }
    }
}

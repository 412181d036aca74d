//! What a reading is made of.
use super::parameter::MAX_PARAMETERS;
use super::place::{GasPlace, SurfacePlace};

/// What a sensor measures; the unit of its values is SI.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Temperature, K.
    Temperature,
    /// Absolute pressure, Pa.
    Pressure,
}

/// Where a sensor sits. It decides which body of the vessel the sensor is exposed to, what a model leaves out there, and
/// what a monitor takes the sensor for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Site {
    /// On the outer surface, or on the valve body.
    Surface(SurfacePlace),
    /// In the gas.
    Gas(GasPlace),
    /// In the air around the vessel.
    Air,
    /// At the port of the valve, outside of the gas.
    Port,
}

/// What a sensor is exposed to at an instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Exposure {
    /// Temperature of surface, valve or gas at its place, K.
    pub body_k: f64,
    /// Air temperature, K.
    pub air_k: f64,
    /// Gas pressure, Pa absolute.
    pub pressure_pa: f64,
    /// Temperature of the valve, which the electronics of a transmitter have, K.
    pub electronics_k: f64,
}

/// A reading with its derivatives, in K or Pa.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Prediction {
    /// Reading.
    pub value: f64,
    /// Derivative to the body's temperature.
    pub per_body: f64,
    /// Derivative to the air temperature.
    pub per_air: f64,
    /// Derivative to the pressure.
    pub per_pressure: f64,
    /// Derivative to the electronics' temperature, that of the valve.
    pub per_electronics: f64,
    /// Derivatives to the parameters, in their order; 0 beyond the last one.
    pub per_parameter: [f64; MAX_PARAMETERS],
}

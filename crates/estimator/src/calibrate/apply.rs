//! What a parameter changes in vessel, scenario and sensors.
use cylwatch_thermal::ThermalError;
use cylwatch_thermal::flow::FlowKind;
use cylwatch_thermal::model::Model;
use cylwatch_thermal::scenario::Scenario;
use cylwatch_thermal::vessel::Fill;
use cylwatch_thermal::vessel::{InsideFilm, Vessel};

use super::{CalibrateError, ParameterKind, ParameterSpec};
use crate::log::Quantity;
use crate::sensor::Sensor;

/// Everything that an experiment's readings depend on.
#[derive(Clone, Debug)]
pub(super) struct Setup {
    pub vessel: Vessel,
    pub scenario: Scenario,
    pub sensors: Vec<Sensor>,
}

impl Setup {
    /// The same with the parameters of an experiment at given values.
    pub(super) fn with(
        &self,
        specs: &[ParameterSpec],
        values: &[f64],
        experiment: usize,
    ) -> Result<Self, ThermalError> {
        let mut setup = self.clone();
        let mut fill_factor = None;
        for (spec, &value) in specs.iter().zip(values).filter(|(spec, _)| spec.scope.contains(experiment)) {
            match spec.kind {
                ParameterKind::FillMass => fill_factor = Some(value),
                _ => setup.apply(&spec.kind, value)?,
            }
        }
        // Last, since the mass of a stated pressure depends on volume and temperature.
        if let Some(factor) = fill_factor {
            setup.fill(factor)?;
        }
        Ok(setup)
    }

    /// The sensors with the parameters of an experiment at given values.
    pub(super) fn sensors_with(
        &self,
        specs: &[ParameterSpec],
        values: &[f64],
        experiment: usize,
    ) -> Vec<Sensor> {
        let mut sensors = self.sensors.clone();
        for (spec, &value) in specs.iter().zip(values).filter(|(spec, _)| spec.scope.contains(experiment)) {
            apply_to_sensor(&mut sensors, &spec.kind, value);
        }
        sensors
    }

    /// Whether a parameter is a number of a pressure sensor.
    pub(super) fn is_of_pressure(&self, kind: &ParameterKind) -> bool {
        let of_pressure = |sensor: &Sensor| {
            Some(sensor.name.as_str()) == kind.sensor() && sensor.quantity() == Quantity::Pressure
        };
        self.sensors.iter().any(of_pressure)
    }

    fn apply(&mut self, kind: &ParameterKind, value: f64) -> Result<(), ThermalError> {
        let Self { vessel, scenario, sensors } = self;
        match kind {
            ParameterKind::DischargeCoefficient { flow } => {
                for flow in scenario.flows.iter_mut().filter(|known| known.name == *flow) {
                    if let Some(coefficient) = flow.kind.discharge_coefficient_mut() {
                        *coefficient = value;
                    }
                }
            }
            ParameterKind::InitialTemperature => {
                scenario.initial.wall_temperature_k += value;
                scenario.initial.gas_temperature_k += value;
            }
            ParameterKind::AirOffset => {
                let surroundings = &mut scenario.surroundings;
                surroundings.air_k = surroundings.air_k.shifted(-value)?;
                if let Some(radiation_k) = &mut surroundings.radiation_k {
                    *radiation_k = radiation_k.shifted(-value)?;
                }
            }
            ParameterKind::OutsideFilm
            | ParameterKind::InsideFilm
            | ParameterKind::JetFilm
            | ParameterKind::WallCapacity
            | ParameterKind::ValveCapacity
            | ParameterKind::ValveContact
            | ParameterKind::Volume => apply_to_vessel(vessel, kind, value),
            // Needs everything else to be in place.
            ParameterKind::FillMass => {}
            ParameterKind::SensorLag { .. }
            | ParameterKind::SensorOffset { .. }
            | ParameterKind::SensorCoupling { .. }
            | ParameterKind::SensorSpan { .. }
            | ParameterKind::SensorTemperatureCoefficient { .. } => apply_to_sensor(sensors, kind, value),
        }
        Ok(())
    }

    fn fill(&mut self, factor: f64) -> Result<(), ThermalError> {
        let model = Model::new(&self.vessel, &self.scenario)?;
        let x0 = model.initial_state(&self.vessel, &self.scenario.initial)?;
        self.scenario.initial.fill = Fill::Mass { mass_kg: factor * model.mass_kg(&x0) };
        Ok(())
    }

    /// Whether a parameter has something to act on.
    pub(super) fn check(&self, kind: &ParameterKind, source: &str) -> Result<(), CalibrateError> {
        let fail = |missing: &'static str, remedy: &'static str| {
            let (parameter, experiment) = (kind.to_string(), source.to_owned());
            Err(CalibrateError::ParameterMisfit { parameter, experiment, missing, remedy })
        };
        match kind {
            ParameterKind::ValveCapacity | ParameterKind::ValveContact if self.vessel.valve.is_none() => {
                fail("a valve", "leave the parameter out, or give the vessel a valve")
            }
            ParameterKind::JetFilm if !self.scenario.flows.iter().any(|flow| flow.kind.has_jet()) => {
                fail("a refill with an inlet", "give the refill of the scenario its inlet_diameter_mm")
            }
            ParameterKind::DischargeCoefficient { flow } => {
                let has_coefficient = |kind: &FlowKind| kind.clone().discharge_coefficient_mut().is_some();
                if self.scenario.flows.iter().any(|known| known.name == *flow && has_coefficient(&known.kind))
                {
                    Ok(())
                } else {
                    fail("an orifice flow of this name", "name a flow of the scenario that has a bore")
                }
            }
            _ => self.check_sensor(kind, fail),
        }
    }

    fn check_sensor(
        &self,
        kind: &ParameterKind,
        fail: impl Fn(&'static str, &'static str) -> Result<(), CalibrateError>,
    ) -> Result<(), CalibrateError> {
        let Some(name) = kind.sensor() else { return Ok(()) };
        let Some(sensor) = self.sensors.iter().find(|sensor| sensor.name == name) else {
            return fail("a sensor of this name", "name one of the fitted channels");
        };
        match kind.sensor_parameter() {
            Some(of_sensor) if !sensor.parameters().iter().any(|known| known.kind == of_sensor) => fail(
                "a sensor with such a number",
                "couplings belong to surface sensors, spans and temperature coefficients to pressure sensors",
            ),
            _ => Ok(()),
        }
    }
}

pub(super) fn apply_to_vessel(vessel: &mut Vessel, kind: &ParameterKind, factor: f64) {
    match kind {
        ParameterKind::OutsideFilm => vessel.surface.film_factor *= factor,
        ParameterKind::InsideFilm => match &mut vessel.inside_film {
            InsideFilm::Rayleigh { multiplier, .. } => *multiplier *= factor,
            InsideFilm::Coefficient { film_w_m2_k } => *film_w_m2_k *= factor,
        },
        ParameterKind::JetFilm => vessel.jet_film_factor *= factor,
        ParameterKind::WallCapacity => {
            for layer in &mut vessel.geometry.layers {
                layer.material.heat_capacity_j_kg_k *= factor;
            }
        }
        ParameterKind::ValveCapacity => {
            if let Some(valve) = &mut vessel.valve {
                valve.material.heat_capacity_j_kg_k *= factor;
            }
        }
        ParameterKind::ValveContact => {
            if let Some(valve) = &mut vessel.valve {
                valve.contact_w_k *= factor;
            }
        }
        ParameterKind::Volume => vessel.volume.volume_m3 *= factor,
        _ => {}
    }
}

fn apply_to_sensor(sensors: &mut [Sensor], kind: &ParameterKind, value: f64) {
    let named = |sensor: &&mut Sensor| kind.sensor() == Some(sensor.name.as_str());
    for sensor in sensors.iter_mut().filter(named) {
        match kind.sensor_parameter() {
            Some(of_sensor) => {
                if let Some(parameter) = sensor.parameter_mut(of_sensor) {
                    parameter.mean = value;
                }
            }
            None => sensor.lag_s = value,
        }
    }
}

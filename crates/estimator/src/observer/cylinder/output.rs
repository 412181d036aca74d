//! What sensors read of the cylinder: readings before lags, their gradients, and the noise for what the model leaves out.
use super::Cylinder;
use crate::EstimatorError;
use crate::sensor::{Exposure, MAX_PARAMETERS, Sensor, Site};
use crate::thermal::reduced::{Pressure, ReducedModel, SurfaceState};
use crate::thermal::vessel::Vessel;

/// What a sensor looks at: its site in the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Target {
    /// A place on the surface.
    Surface(SurfaceState),
    /// The gas.
    Gas,
    Air,
    /// The valve.
    Port,
}

impl Target {
    /// That of a sensor.
    pub(super) fn of(sensor: &Sensor, model: &ReducedModel, vessel: &Vessel) -> Result<Self, EstimatorError> {
        Ok(match sensor.site() {
            Site::Surface(place) => Self::Surface(model.surface(&place).ok_or_else(|| {
                EstimatorError::SensorPlace { name: sensor.name.clone(), vessel: vessel.name.clone() }
            })?),
            Site::Gas(_) => Self::Gas,
            Site::Air => Self::Air,
            Site::Port => Self::Port,
        })
    }
}

/// A reading is linear in what the sensor is exposed to: what it depends on once it always does.
pub(super) fn reads_pressure(sensor: &Sensor) -> bool {
    sensor.predict(&Exposure::default(), &sensor.means()).per_pressure != 0.0
}

impl Cylinder {
    /// Variance of a sensor's noise, K² or Pa², for a member of such caution, Pa/K.
    pub(in crate::observer) fn noise_at_caution(&self, j: usize, x: &[f64], caution_pa_k: f64) -> f64 {
        let error = &self.settings.model_error;
        let states = &self.states;
        let square = |v: f64| v * v;
        let model = match self.targets[j] {
            _ if self.reads_pressure[j] => {
                let wall_k = self.model.mean_wall_k(x);
                let away_k = wall_k - x[states.gas];
                let per_k2 = square(error.pressure_per_wall_k) + square(caution_pa_k);
                square(error.pressure_pa) + per_k2 * square(away_k)
            }
            Target::Gas => square(error.gas_k),
            Target::Surface(place) => {
                let away_k = x[states.air] - self.surface_k(place, x);
                square(error.surface_k) + square(error.surface_per_air_k * away_k)
            }
            Target::Air => square(error.air_k),
            Target::Port => square(error.surface_k),
        };
        let again = (error.correlation_s / self.interval_s[j]).max(1.0);
        let sensor = &self.sensors[j];
        // A reading within the same step has the same rounding: a run of them tells hardly more than its first one.
        let rounding = square(sensor.resolution) / 12.0 * f64::from(self.repeats[j]);
        sensor.noise_variance() + rounding + model * again
    }

    /// Temperature of a place on the surface, K.
    fn surface_k(&self, place: SurfaceState, x: &[f64]) -> f64 {
        let departure = self.states.valve.map_or(0.0, |valve| x[valve] - x[self.states.wall - 1]);
        let sun_w = self.states.sun.map_or(0.0, |sun| x[sun]);
        x[place.state] + place.valve_share * departure + place.sun_rise_k_w * sun_w
    }

    /// Reading of a sensor before its lag, with its gradient.
    pub(in crate::observer) fn static_reading(
        &mut self,
        sensor: usize,
        x: &[f64],
        gradient: Option<&mut [f64]>,
    ) -> Result<f64, EstimatorError> {
        let target = self.targets[sensor];
        let pressure = match self.reads_pressure[sensor] {
            true if gradient.is_some() => Some(self.model.pressure(&x[..self.model.states()])?),
            true => Some(Pressure { pressure_pa: self.pressure_pa(x)?, ..Pressure::default() }),
            false => None,
        };
        let states = &self.states;
        let electronics = states.valve.unwrap_or(states.wall - 1);
        let exposure = Exposure {
            body_k: match target {
                Target::Surface(place) => self.surface_k(place, x),
                Target::Gas => x[states.gas],
                Target::Air | Target::Port => x[electronics],
            },
            air_k: x[states.air],
            pressure_pa: pressure.map_or(0.0, |p| p.pressure_pa),
            electronics_k: x[electronics],
        };
        let object = &self.sensors[sensor];
        let mut parameters: [f64; MAX_PARAMETERS] = object.means();
        for (value, state) in parameters.iter_mut().zip(&states.parameters[sensor]) {
            if let Some(state) = state {
                *value = x[*state];
            }
        }
        let prediction = object.predict(&exposure, &parameters);
        let Some(h) = gradient else { return Ok(prediction.value) };
        h.fill(0.0);
        match target {
            Target::Surface(place) => {
                h[place.state] += prediction.per_body;
                if let Some(valve) = states.valve {
                    h[valve] += prediction.per_body * place.valve_share;
                    h[states.wall - 1] -= prediction.per_body * place.valve_share;
                }
                if let Some(sun) = states.sun {
                    h[sun] += prediction.per_body * place.sun_rise_k_w;
                }
            }
            Target::Gas => h[states.gas] += prediction.per_body,
            Target::Air | Target::Port => h[electronics] += prediction.per_body,
        }
        h[states.air] += prediction.per_air;
        if let Some(p) = pressure {
            h[states.gas] += prediction.per_pressure * p.per_gas_k;
            h[states.mass] += prediction.per_pressure * p.per_mass_kg;
            for (node, by) in h[..states.wall].iter_mut().enumerate() {
                *by += prediction.per_pressure * p.per_wall_k * self.model.mean_wall_per_node(x, node);
            }
        }
        h[electronics] += prediction.per_electronics;
        for (by, state) in prediction.per_parameter.iter().zip(&states.parameters[sensor]) {
            if let Some(state) = state {
                h[*state] += by;
            }
        }
        Ok(prediction.value)
    }
}

//! A sensor: its numbers, its static reading and the derivatives of that.
use crate::EstimatorError;
use crate::log::Quantity;
use alloc::string::String;
use alloc::vec::Vec;
#[cfg(feature = "design")]
use cylwatch_thermal::sensor::SensorSpec;
use cylwatch_thermal::sensor::{
    CorrelatedNoise, Exposure, MAX_PARAMETERS, MountedSensor, Parameter, ParameterKind, Prediction,
    SensorKind, Site,
};
use serde::{Deserialize, Serialize};

/// Distance from an end of the range that counts as the end, relative to the range: what a logger rounds.
const END_OF_RANGE: f64 = 1e-6;

/// A sensor. Readings are in K or in Pa absolute, and so is everything here that has the unit of a reading.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sensor {
    /// Name, that of its channel in a log.
    pub name: String,
    /// What it reads, and where.
    pub kind: SensorKind,
    /// Time constant of its first-order lag, s; 0: none.
    pub lag_s: f64,
    /// Standard deviation of its white noise.
    pub noise_sd: f64,
    /// Correlated noise.
    pub correlated: Option<CorrelatedNoise>,
    /// Smallest step of a reading; 0: none.
    pub resolution: f64,
    /// Steady drift per second.
    pub drift_per_s: f64,
    /// Probability that a reading is missing.
    pub dropout: f64,
    plausible: (f64, f64),
    parameters: Vec<Parameter>,
}

impl From<&MountedSensor> for Sensor {
    fn from(mounted: &MountedSensor) -> Self {
        Self {
            name: mounted.name.clone(),
            kind: mounted.kind,
            lag_s: mounted.lag_s,
            noise_sd: mounted.noise,
            correlated: mounted.correlated,
            resolution: mounted.resolution,
            drift_per_s: mounted.drift_per_s,
            dropout: mounted.dropout,
            plausible: mounted.plausible,
            parameters: mounted.parameters.clone(),
        }
    }
}

impl From<&Sensor> for MountedSensor {
    fn from(sensor: &Sensor) -> Self {
        Self {
            name: sensor.name.clone(),
            kind: sensor.kind,
            lag_s: sensor.lag_s,
            parameters: sensor.parameters.clone(),
            drift_per_s: sensor.drift_per_s,
            noise: sensor.noise_sd,
            correlated: sensor.correlated,
            resolution: sensor.resolution,
            dropout: sensor.dropout,
            plausible: sensor.plausible,
        }
    }
}

#[cfg(feature = "design")]
impl TryFrom<&SensorSpec> for Sensor {
    type Error = EstimatorError;

    /// Checks a specification by itself.
    ///
    /// # Errors
    /// [`EstimatorError::Thermal`] with the first value that breaks a bound.
    fn try_from(spec: &SensorSpec) -> Result<Self, EstimatorError> {
        Ok(Self::from(&spec.build("sensor")?))
    }
}

impl Sensor {
    /// Checks every value; `path` says which one it is, e.g. `sensor[0]`.
    ///
    /// # Errors
    /// [`EstimatorError::Thermal`] with the path of the first value that breaks a bound.
    pub fn validate(&self, path: &str) -> Result<(), EstimatorError> {
        Ok(MountedSensor::from(self).validate(path)?)
    }

    /// Parameters: offset, then those of its kind.
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// Standard deviation of what it is off by all the time, in its unit; 0: nothing.
    pub fn offset_sd(&self) -> f64 {
        let offset = self.parameters.iter().find(|parameter| parameter.kind == ParameterKind::Offset);
        offset.map_or(0.0, |offset| offset.sd)
    }

    /// The parameter of a kind, to change its prior; `None` for a kind that this sensor does not have.
    pub fn parameter_mut(&mut self, kind: ParameterKind) -> Option<&mut Parameter> {
        self.parameters.iter_mut().find(|parameter| parameter.kind == kind)
    }

    /// Means of the parameters; 0 beyond the last one.
    pub(crate) fn means(&self) -> [f64; MAX_PARAMETERS] {
        let mut means = [0.0; MAX_PARAMETERS];
        for (mean, parameter) in means.iter_mut().zip(&self.parameters) {
            *mean = parameter.mean;
        }
        means
    }

    /// Static reading (before the lag, without drift and noise) with its derivatives. It is linear in the exposure for
    /// fixed parameters, and linear in the parameters for a fixed exposure.
    ///
    /// # Shapes
    /// `parameters`: one value for each of [`Sensor::parameters`], in that order; further ones are ignored.
    ///
    /// # Panics
    /// With fewer values than parameters.
    pub fn predict(&self, exposure: &Exposure, parameters: &[f64]) -> Prediction {
        self.kind.predict(exposure, parameters)
    }

    /// Variance of a reading's noise: white, correlated, and rounding to a step `d`, which is uniform in `±d/2`:
    /// `sd^2 + sd_c^2 + d^2 / 12`.
    pub fn noise_variance(&self) -> f64 {
        let correlated = self.correlated.map_or(0.0, |noise| noise.sd * noise.sd);
        self.noise_sd * self.noise_sd + correlated + self.resolution * self.resolution / 12.0
    }

    /// What it measures.
    pub fn quantity(&self) -> Quantity {
        self.kind.quantity()
    }

    /// Where it sits.
    pub fn site(&self) -> Site {
        self.kind.site()
    }

    /// Whether it is a thermometer on the wall or the valve.
    pub fn is_on_surface(&self) -> bool {
        self.quantity() == Quantity::Temperature && matches!(self.site(), Site::Surface(_))
    }

    /// Lowest and highest reading that can be one; a reading outside is a fault of the sensor.
    pub fn plausible(&self) -> (f64, f64) {
        self.plausible
    }

    /// Lowest and highest reading that say what the value is: one at an end of the bounds says only that the value is beyond. A transmitter's upper end
    /// is its full scale, though its signal goes somewhat farther: there its data sheet ends, and loggers clip.
    pub fn usable_range(&self) -> (f64, f64) {
        let (low, high) = self.plausible;
        let end = END_OF_RANGE * (high - low);
        let high = match self.kind {
            SensorKind::Pressure { reference, full_scale_pa: Some(scale_pa) } => {
                reference.zero_pa() + scale_pa
            }
            _ => high,
        };
        (low + end, high - end)
    }

    /// Time constant of its first-order lag, s; 0: none.
    pub fn lag_s(&self) -> f64 {
        self.lag_s
    }
}

#[cfg(test)]
mod tests;

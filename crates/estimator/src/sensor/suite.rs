//! Several sensors, and specimens of them.
use rand::{Rng, RngExt};
use rand_distr::{Distribution, StandardNormal};

use super::stream::{Purpose, stream};
use super::{GasPlace, Law, MAX_PARAMETERS, Parameter, Sensor, Site, SurfacePlace};
use crate::EstimatorError;
use cylwatch_thermal::scenario::Scenario;
use cylwatch_thermal::vessel::Vessel;
use cylwatch_thermal::wall::mesh::Mesh;

/// Sensors with different names.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SensorSuite {
    sensors: Vec<Sensor>,
}

/// The real parameters of one specimen of a sensor, in the order of [`Sensor::parameters`]; 0 beyond the last one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorTruth {
    /// Values.
    pub parameters: [f64; MAX_PARAMETERS],
}

/// A sensor and one specimen of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Specimen {
    /// The sensor.
    pub sensor: Sensor,
    /// What this one really is.
    pub truth: SensorTruth,
}

/// Specimens of all sensors of a suite.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SuiteTruth {
    /// One for each sensor, in the order of the suite.
    pub specimens: Vec<Specimen>,
}

impl Sensor {
    /// One specimen: every uncertain parameter from its prior, uniform where the prior is a tolerance, else normal, and
    /// never outside of the parameter's domain (a coupling is redrawn until it lies within 0 and 1).
    pub(crate) fn draw<R: Rng + ?Sized>(&self, rng: &mut R) -> SensorTruth {
        let mut truth = self.nominal();
        for (value, parameter) in truth.parameters.iter_mut().zip(self.parameters()) {
            *value = drawn(parameter, rng);
        }
        truth
    }

    /// The specimen whose parameters are the means of their priors.
    pub(crate) fn nominal(&self) -> SensorTruth {
        SensorTruth { parameters: self.means() }
    }

    /// The same sensor without noise, drift, steps and losses, its parameters known to be their means; the lag stays.
    pub fn ideal(&self) -> Self {
        let mut ideal = self.clone();
        (ideal.noise_sd, ideal.correlated, ideal.resolution) = (0.0, None, 0.0);
        (ideal.drift_per_s, ideal.dropout) = (0.0, 0.0);
        for parameter in self.parameters() {
            if let Some(known) = ideal.parameter_mut(parameter.kind) {
                (known.sd, known.walk_per_sqrt_s) = (0.0, 0.0);
            }
        }
        ideal
    }

    /// What the sensor needs and the vessel does not have; `None`: it can sit there.
    pub fn misfit(&self, vessel: &Vessel) -> Option<String> {
        self.misfit_on(vessel, &Mesh::new(&vessel.geometry))
    }

    /// The same with the vessel's mesh at hand.
    pub(super) fn misfit_on(&self, vessel: &Vessel, mesh: &Mesh) -> Option<String> {
        match self.site() {
            Site::Surface(SurfacePlace::Valve) => vessel.valve.is_none().then(|| "a valve".to_owned()),
            Site::Surface(place) => match (place.column(&vessel.geometry, mesh), place) {
                (Some(_), _) => None,
                (None, SurfacePlace::Height { height_m }) => Some(format!("a wall at {height_m} m")),
                (None, place) => Some(format!("a {}", place.as_str())),
            },
            Site::Gas(place) => match (place.cell(vessel, mesh), place) {
                (Some(_), _) => None,
                (None, GasPlace::Cell { number }) => Some(format!("{number} gas cells")),
                (None, GasPlace::Height { height_m }) => Some(format!("gas at {height_m} m")),
            },
            Site::Air | Site::Port => None,
        }
    }
}

fn drawn<R: Rng + ?Sized>(parameter: &Parameter, rng: &mut R) -> f64 {
    if parameter.sd <= 0.0 {
        return parameter.mean;
    }
    let (low, high) = parameter.domain();
    loop {
        let deviation: f64 = match parameter.law {
            Law::Normal => StandardNormal.sample(rng),
            Law::Uniform => 3.0_f64.sqrt() * rng.random_range(-1.0..=1.0),
        };
        let value = parameter.mean + parameter.sd * deviation;
        if (low..=high).contains(&value) {
            return value;
        }
    }
}

impl SensorSuite {
    /// A suite.
    ///
    /// # Errors
    /// [`EstimatorError::SensorTwice`] for two sensors of one name.
    pub fn try_new(sensors: Vec<Sensor>) -> Result<Self, EstimatorError> {
        for (i, sensor) in sensors.iter().enumerate() {
            if sensors[..i].iter().any(|other| other.name == sensor.name) {
                return Err(EstimatorError::SensorTwice { name: sensor.name.clone() });
            }
        }
        Ok(Self { sensors })
    }

    /// The sensors.
    pub fn sensors(&self) -> &[Sensor] {
        &self.sensors
    }

    /// The sensor of a name.
    pub fn find(&self, name: &str) -> Option<&Sensor> {
        self.sensors.iter().find(|sensor| sensor.name == name)
    }

    /// The sensors that fit on a vessel, and those that do not.
    pub fn split_by_fit(self, vessel: &Vessel) -> (Self, Vec<Sensor>) {
        let (fitting, others) = self.sensors.into_iter().partition(|sensor| sensor.misfit(vessel).is_none());
        (Self { sensors: fitting }, others)
    }

    /// The suite of [`Sensor::ideal`] sensors.
    pub fn ideal(&self) -> Self {
        Self { sensors: self.sensors.iter().map(Sensor::ideal).collect() }
    }

    /// One specimen of each sensor by `Sensor::draw`; a sensor's specimen depends on the seed and on its name alone.
    pub fn draw(&self, seed: u64) -> SuiteTruth {
        self.specimens(|sensor| sensor.draw(&mut stream(seed, &sensor.name, Purpose::Specimen)))
    }

    /// The specimens whose parameters are the means of their priors.
    pub fn nominal(&self) -> SuiteTruth {
        self.specimens(Sensor::nominal)
    }

    fn specimens(&self, truth: impl Fn(&Sensor) -> SensorTruth) -> SuiteTruth {
        let specimen = |sensor: &Sensor| Specimen { sensor: sensor.clone(), truth: truth(sensor) };
        SuiteTruth { specimens: self.sensors.iter().map(specimen).collect() }
    }
}

impl From<&Scenario> for SensorSuite {
    /// The sensors of a scenario, which has no name twice.
    fn from(scenario: &Scenario) -> Self {
        Self { sensors: scenario.sensors.iter().map(Sensor::from).collect() }
    }
}

impl SuiteTruth {
    /// The specimen of a name, e.g. to set its parameters.
    pub fn find_mut(&mut self, name: &str) -> Option<&mut Specimen> {
        self.specimens.iter_mut().find(|specimen| specimen.sensor.name == name)
    }
}

#[cfg(test)]
mod tests;

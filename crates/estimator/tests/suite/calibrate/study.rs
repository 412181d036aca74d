//! A simulated log of class B sensors on a cylinder that differs by 30 % in six numbers, and in its valve's contact, from what
//! its file says.
use cylwatch_estimator::calibrate::{
    Calibrated, Calibration, CalibrationSettings, Experiment, ParameterKind, ParameterSpec,
};
use cylwatch_estimator::log::Log;
use cylwatch_estimator::sensor::{ParameterKind as SensorNumber, Sensor, SensorSuite, sample};
use cylwatch_thermal::scenario::{self, OutsideFilm, Scenario};
use cylwatch_thermal::simulate::{SimulationSettings, simulate};
use cylwatch_thermal::trajectory::Trajectory;
use cylwatch_thermal::vessel::{self, InsideFilm, Vessel};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// How far each property is off, as a factor.
const OFF: f64 = 1.3;

pub(crate) const COUPLING: f64 = 0.1;

/// How far the contact of a valve may be off, as a standard deviation of its logarithm: a factor of two. Nothing outside
/// shows it well, and without any idea of it some logs leave all else uncertain.
const CONTACT_SD: f64 = 0.7;

/// What is sought: four factors and the couplings of shoulder and valve.
pub(crate) fn kinds() -> [ParameterKind; 6] {
    [
        ParameterKind::OutsideFilm,
        ParameterKind::InsideFilm,
        ParameterKind::WallCapacity,
        ParameterKind::ValveCapacity,
        ParameterKind::SensorCoupling { sensor: "shoulder".into() },
        ParameterKind::SensorCoupling { sensor: "valve".into() },
    ]
}

/// A cylinder of a seed: which of its properties are larger, which are smaller.
pub(crate) struct Case {
    pub seed: u64,
    /// True values of the [`kinds`].
    pub truth: [f64; 6],
    /// True factor on the valve's contact.
    pub contact: f64,
}

impl Case {
    pub(crate) fn new(seed: u64) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut off = || if rng.random::<bool>() { OFF } else { 1.0 / OFF };
        let mut truth = [(); 6].map(|()| off());
        truth[4..].iter_mut().for_each(|coupling| *coupling *= COUPLING);
        Self { seed, truth, contact: off() }
    }

    pub(crate) fn vessel(&self) -> Vessel {
        let mut vessel = vessel::presets::load("nitrogen-20l").unwrap();
        let [_, inside, wall, valve_capacity, ..] = self.truth;
        let InsideFilm::Rayleigh { multiplier, .. } = &mut vessel.inside_film else { panic!("a power law") };
        *multiplier *= inside;
        vessel.geometry.layers[0].material.heat_capacity_j_kg_k *= wall;
        let valve = vessel.valve.as_mut().unwrap();
        valve.material.heat_capacity_j_kg_k *= valve_capacity;
        valve.contact_w_k *= self.contact;
        vessel
    }

    /// A scenario as this cylinder feels it.
    pub(crate) fn exposed(&self, scenario: &Scenario) -> Scenario {
        let mut scenario = scenario.clone();
        if let OutsideFilm::Coefficient { film_w_m2_k } = &mut scenario.surroundings.film {
            *film_w_m2_k = film_w_m2_k.scaled(self.truth[0]).unwrap();
        }
        scenario
    }

    pub(crate) fn course(&self, scenario: &Scenario) -> Trajectory {
        run(&self.vessel(), &self.exposed(scenario))
    }

    /// What drawn specimens of the sensors read.
    pub(crate) fn log(&self, scenario: &Scenario) -> Log {
        self.readings(&self.course(scenario))
    }

    /// What they read along a course.
    pub(crate) fn readings(&self, course: &Trajectory) -> Log {
        let mut specimens = SensorSuite::try_new(sensors()).unwrap().draw(self.seed);
        specimens.find_mut("shoulder").unwrap().truth.parameters[1] = self.truth[4];
        specimens.find_mut("valve").unwrap().truth.parameters[1] = self.truth[5];
        sample(course, &specimens, self.seed).unwrap()
    }

    pub(crate) fn calibration(&self, scenario: &Scenario) -> Calibration {
        let starts = [1.0, 1.0, 1.0, 1.0, COUPLING, COUPLING];
        let sensors = sensors();
        let sought = kinds().into_iter().zip(starts).map(|(kind, start)| ParameterSpec::new(kind, start));
        let contact = ParameterSpec::new(ParameterKind::ValveContact, 1.0).with_prior(1.0, CONTACT_SD);
        // Offsets and the transmitter's temperature coefficient are unknown too, within what their data sheets say.
        let nuisance =
            sensors.iter().flat_map(ParameterSpec::of_sensor).filter(|spec| !kinds().contains(&spec.kind));
        Calibration {
            vessel: vessel::presets::load("nitrogen-20l").unwrap(),
            parameters: sought.chain([contact]).chain(nuisance).collect(),
            experiments: vec![Experiment {
                source: format!("seed {}", self.seed),
                vessel: None,
                log: self.log(scenario),
                scenario: scenario.clone(),
                channels: sensors,
            }],
            settings: CalibrationSettings::default(),
        }
    }

    /// Which of the six intervals hold the truth.
    pub(crate) fn covered(&self, calibrated: &Calibrated) -> [bool; 6] {
        std::array::from_fn(|i| calibrated.estimates[i].holds(self.truth[i]))
    }

    /// Root mean square errors of the mean gas temperature, K, in a scenario that was not recorded: as the vessel's file
    /// says, and as calibrated.
    pub(crate) fn prediction(&self, calibrated: &Calibrated, next: &Scenario) -> (f64, f64) {
        let truth = self.course(next).gas_mean_k;
        let file = vessel::presets::load("nitrogen-20l").unwrap();
        let before = run(&file, next);
        let after = run(&calibrated.applied(0, &file), &calibrated.applied_to_scenario(0, next).unwrap());
        (rms(&truth, &before.gas_mean_k), rms(&truth, &after.gas_mean_k))
    }
}

/// Pt100 of class B on shoulder and valve, a pressure transmitter of 0.25 % accuracy.
pub(crate) fn sensors() -> Vec<Sensor> {
    let sensors = ["shoulder", "valve", "pressure"].map(|name| Sensor::typical(name).unwrap());
    sensors.to_vec()
}

pub(crate) fn preset(name: &str) -> Scenario {
    scenario::presets::load(name).unwrap()
}

pub(crate) fn run(vessel: &Vessel, scenario: &Scenario) -> Trajectory {
    let settings = SimulationSettings { relative_tolerance: 1e-10, ..SimulationSettings::default() };
    simulate(vessel, scenario, &settings, &mut |_| {}).unwrap()
}

pub(crate) fn rms(a: &[f64], b: &[f64]) -> f64 {
    (a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / a.len() as f64).sqrt()
}

/// A sensor without offset and with known numbers.
#[allow(dead_code)]
pub(crate) fn known(name: &str, noise: f64) -> Sensor {
    let mut sensor = Sensor::typical(name).unwrap().ideal();
    for kind in [SensorNumber::Offset, SensorNumber::Coupling] {
        if let Some(number) = sensor.parameter_mut(kind) {
            number.mean = 0.0;
        }
    }
    sensor.noise_sd = noise;
    sensor
}

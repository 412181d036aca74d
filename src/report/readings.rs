//! What a run's sensors read, for tables and figures.
use crate::estimator::EstimatorError;
use crate::estimator::log::{Log, Quantity};
use crate::estimator::sensor::{PressureReference, Sensor, SensorKind, SensorSuite, SuiteTruth, sample};
use crate::thermal::trajectory::Trajectory;
use crate::thermal::units::{ATMOSPHERE_PA, BAR_PA, ZERO_CELSIUS_K};

/// Readings of a scenario's sensors at the samples of a run.
#[derive(Clone, Debug)]
pub struct Readings {
    /// What the sensors really are, in the order of the log's channels.
    pub truth: SuiteTruth,
    /// What they read.
    pub log: Log,
    /// Sensors that the vessel has no place for.
    pub left_out: Vec<Sensor>,
}

impl Readings {
    /// Readings of specimens and with noise drawn by a seed.
    ///
    /// # Errors
    /// The run has no samples.
    pub(crate) fn sampled(run: &Trajectory, seed: u64) -> Result<Self, EstimatorError> {
        let (suite, left_out) = SensorSuite::from(&run.scenario).split_by_fit(&run.vessel);
        Self::of(run, suite.draw(seed), left_out, seed)
    }

    /// Readings as expected: parameters at their stated values, no noise, no steps, nothing lost.
    ///
    /// # Errors
    /// The run has no samples.
    pub fn expected(run: &Trajectory) -> Result<Self, EstimatorError> {
        let (suite, left_out) = SensorSuite::from(&run.scenario).split_by_fit(&run.vessel);
        // Nothing is random, so any seed will do.
        Self::of(run, suite.ideal().nominal(), left_out, 0)
    }

    fn of(
        run: &Trajectory,
        truth: SuiteTruth,
        left_out: Vec<Sensor>,
        seed: u64,
    ) -> Result<Self, EstimatorError> {
        let log = sample(run, &truth, seed)?;
        Ok(Self { truth, log, left_out })
    }

    /// Every sensor with its readings, SI; NaN is a missing one.
    pub fn columns(&self) -> impl Iterator<Item = (&Sensor, Vec<f64>)> {
        let column = |index: usize| self.log.rows().map(|(_, row)| row[index]).collect();
        self.truth.specimens.iter().enumerate().map(move |(index, one)| (&one.sensor, column(index)))
    }
}

/// Name of a sensor's column and its readings in that column's unit: °C, bar, or bar above the atmosphere.
pub(super) fn column(sensor: &Sensor, values: &[f64]) -> (String, Vec<f64>) {
    let (unit, zero, factor) = match (sensor.quantity(), sensor.kind) {
        (Quantity::Temperature, _) => ("degc", ZERO_CELSIUS_K, 1.0),
        (_, SensorKind::Pressure { reference: PressureReference::Gauge { .. }, .. }) => {
            ("barg", ATMOSPHERE_PA, BAR_PA)
        }
        (Quantity::Pressure, _) => ("bar", 0.0, BAR_PA),
    };
    let values = values.iter().map(|value| (value - zero) / factor).collect();
    (format!("measured_{}_{unit}", sensor.name), values)
}

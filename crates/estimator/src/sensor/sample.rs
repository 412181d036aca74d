//! From a trajectory to a log: what the sensors' specimens read of it.
//!
//! Between the samples of a trajectory temperatures and pressure are taken as linear; the air is the scenario's own
//! signal with its jumps. A static reading is then linear between these times, and its lag is exact. Before the start
//! everything has been at rest at its first value. A reading is
//!
//! ```text
//! round( lag(y) + drift t + sum_j dy/dparameter_j walk_j + correlated + white )
//! ```
//!
//! and missing (NaN) where it is lost. A transmitter with a full scale reads no more than its range. At a jump of the
//! air a reading without lag is that after the jump.
use rand::RngExt;

use super::exposure::ExposedSensor;
use super::lag::FirstOrderLag;
use super::noise::{GaussMarkov, RandomWalk, WhiteNoise};
use super::stream::{Purpose, stream};
use super::{Sensor, SensorKind, Specimen, SuiteTruth};
use crate::EstimatorError;
use crate::log::{Channel, Log};
use cylwatch_thermal::trajectory::Trajectory;

/// Readings at every sample of a trajectory; a sensor's readings depend on the seed and on that sensor alone.
///
/// # Errors
/// [`EstimatorError::SensorMisfit`] for a sensor on a place that the vessel does not have.
pub fn sample(trajectory: &Trajectory, suite: &SuiteTruth, seed: u64) -> Result<Log, EstimatorError> {
    sample_at(trajectory, suite, &trajectory.time_s, seed)
}

/// Readings at given times, s, which may lie anywhere within the trajectory.
///
/// # Errors
/// [`EstimatorError::SampleTime`] for a time outside of the trajectory or not later than the one before, and as
/// [`sample`].
pub fn sample_at(
    trajectory: &Trajectory,
    suite: &SuiteTruth,
    times_s: &[f64],
    seed: u64,
) -> Result<Log, EstimatorError> {
    check_times(&trajectory.time_s, times_s)?;
    let columns: Vec<Vec<f64>> = suite
        .specimens
        .iter()
        .map(|specimen| readings(trajectory, specimen, times_s, seed))
        .collect::<Result<_, _>>()?;
    let channel = |specimen: &Specimen| Channel {
        name: specimen.sensor.name.clone(),
        quantity: specimen.sensor.quantity(),
    };
    Ok(Log {
        channels: suite.specimens.iter().map(channel).collect(),
        time_s: times_s.to_vec(),
        values: (0..times_s.len()).flat_map(|row| columns.iter().map(move |column| column[row])).collect(),
    })
}

fn check_times(known_s: &[f64], times_s: &[f64]) -> Result<(), EstimatorError> {
    let (Some(&from_s), Some(&to_s)) = (known_s.first(), known_s.last()) else {
        return Err(EstimatorError::EmptyTrajectory);
    };
    for (index, &time_s) in times_s.iter().enumerate() {
        let is_later = index == 0 || time_s > times_s[index - 1];
        if !is_later || !(from_s..=to_s).contains(&time_s) {
            return Err(EstimatorError::SampleTime { number: index + 1, time_s, from_s, to_s });
        }
    }
    Ok(())
}

/// Readings of one sensor.
fn readings(
    trajectory: &Trajectory,
    specimen: &Specimen,
    times_s: &[f64],
    seed: u64,
) -> Result<Vec<f64>, EstimatorError> {
    let Specimen { sensor, truth } = specimen;
    let exposed = ExposedSensor::new(trajectory, sensor, &truth.parameters)?;
    let lagged = lagged_readings(&exposed, sensor, times_s);
    let mut errors = Errors::new(sensor, seed, exposed.start_s());
    let reading = |(&t, lagged): (&f64, f64)| {
        let per_parameter = exposed.at(t).per_parameter;
        errors.reading(t, lagged, &per_parameter)
    };
    Ok(times_s.iter().zip(lagged).map(reading).collect())
}

/// Readings after the lag, before anything random.
fn lagged_readings(exposed: &ExposedSensor<'_>, sensor: &Sensor, times_s: &[f64]) -> Vec<f64> {
    if sensor.lag_s <= 0.0 {
        return times_s.iter().map(|&t| exposed.at(t).value).collect();
    }
    let lag = FirstOrderLag { tau_s: sensor.lag_s };
    let mut knots = exposed.knots_s();
    knots.extend_from_slice(times_s);
    knots.sort_by(f64::total_cmp);
    knots.dedup();
    let mut lagged = exposed.before_start();
    let mut wanted = times_s.iter().peekable();
    let mut readings = Vec::with_capacity(times_s.len());
    for (index, &t) in knots.iter().enumerate() {
        if index > 0 {
            let (start, end) = exposed.between(knots[index - 1], t);
            lagged = lag.advance(lagged, start, end, t - knots[index - 1]);
        }
        if wanted.next_if(|&&next| next == t).is_some() {
            readings.push(lagged);
        }
    }
    readings
}

/// What a sensor adds to its lagged reading.
struct Errors<'a> {
    sensor: &'a Sensor,
    start_s: f64,
    before_s: f64,
    walks: Vec<RandomWalk>,
    correlated: GaussMarkov,
    rng: Streams,
}

struct Streams {
    walks: Vec<rand_chacha::ChaCha8Rng>,
    correlated: rand_chacha::ChaCha8Rng,
    white: rand_chacha::ChaCha8Rng,
    dropout: rand_chacha::ChaCha8Rng,
}

impl<'a> Errors<'a> {
    fn new(sensor: &'a Sensor, seed: u64, start_s: f64) -> Self {
        let of = |purpose| stream(seed, &sensor.name, purpose);
        let parameters = sensor.parameters();
        Self {
            sensor,
            start_s,
            before_s: start_s,
            walks: parameters.iter().map(|p| RandomWalk::new(p.walk_per_sqrt_s)).collect(),
            correlated: sensor
                .correlated
                .map_or(GaussMarkov::new(0.0, 0.0), |c| GaussMarkov::new(c.sd, c.time_s)),
            rng: Streams {
                walks: (0..parameters.len()).map(|index| of(Purpose::Walk(index))).collect(),
                correlated: of(Purpose::Correlated),
                white: of(Purpose::White),
                dropout: of(Purpose::Dropout),
            },
        }
    }

    /// The reading at a time; NaN: it is lost.
    fn reading(&mut self, time_s: f64, lagged: f64, per_parameter: &[f64]) -> f64 {
        let elapsed_s = time_s - self.before_s;
        self.before_s = time_s;
        let sensor = self.sensor;
        let mut reading = lagged + sensor.drift_per_s * (time_s - self.start_s);
        for ((walk, rng), per) in self.walks.iter_mut().zip(&mut self.rng.walks).zip(per_parameter) {
            reading += per * walk.next(elapsed_s, rng);
        }
        reading += self.correlated.next(elapsed_s, &mut self.rng.correlated);
        reading += WhiteNoise { sd: sensor.noise_sd }.next(&mut self.rng.white);
        if sensor.resolution > 0.0 {
            reading = sensor.resolution * (reading / sensor.resolution).round();
        }
        if let SensorKind::Pressure { full_scale_pa: Some(_), .. } = sensor.kind {
            let (low, high) = sensor.plausible();
            reading = reading.clamp(low, high);
        }
        if self.rng.dropout.random::<f64>() < sensor.dropout { f64::NAN } else { reading }
    }
}

#[cfg(test)]
mod tests;

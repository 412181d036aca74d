//! How good an observer was: its estimates against a truth, beside the paper's transfer function on the same readings.
//!
//! Only samples from the judged part on count: after ten days of learning in railway weeks, from the change of the air in
//! the chamber's courses. Masses are compared with themselves in the hour before it (weeks: with their mean), since a
//! constant error of the transmitter shifts the mass for ever.
use super::{Course, Truth};
use crate::EvaluationError;
use crate::estimator::identify::published::TransferFunction;
use crate::estimator::observer::{Commissioning, Estimate, Observer, ObserverSettings};
use crate::estimator::sensor::Sensor;
use crate::thermal::units::ZERO_CELSIUS_K;
use crate::thermal::vessel::Vessel;

/// Learning before the judged part of railway weeks, s.
const LEARNING_S: f64 = 864_000.0;
/// Half width of a 95 % band in standard deviations.
const BAND: f64 = 1.959_963_984_540_054;

/// Errors of mean gas temperature and mass over the judged part.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Score {
    /// Number of samples.
    pub samples: usize,
    /// Root mean square of the temperature's error, K.
    pub gas_rms_k: f64,
    /// Mean of the temperature's error, K.
    pub gas_bias_k: f64,
    /// Largest error of the temperature, K.
    pub gas_max_k: f64,
    /// Standard deviation of the mass's error about its mean, kg.
    pub mass_sd_kg: f64,
    /// Root mean square of the mass's error relative to its mean error in the commissioning hour (weeks: its mean), kg.
    pub mass_rms_kg: f64,
    /// Mean error of the mass, kg.
    pub mass_bias_kg: f64,
    /// Root mean square of the temperature's stated standard deviation, K; NaN for the transfer function.
    pub gas_stated_k: f64,
    /// Root mean square of the mass's stated standard deviation, kg.
    pub mass_stated_kg: f64,
    /// Part of the samples whose 95 % band holds the true temperature.
    pub gas_coverage: f64,
    /// Part of the samples whose 95 % band holds the true mass.
    pub mass_coverage: f64,
    /// Standard deviation of the leak rate's error, kg/s.
    pub leak_sd_kg_s: f64,
    /// Mean of the normalised innovations squared.
    pub nis: f64,
}

/// One estimate beside the truth.
struct Pair {
    time_s: f64,
    gas_error_k: f64,
    gas_sd_k: f64,
    mass_error_kg: f64,
    mass_sd_kg: f64,
    leak_error_kg_s: f64,
}

/// Run an observer over a truth's readings of the named sensors and score it.
///
/// # Errors
/// A sensor is unknown, or the observer refuses its settings.
pub fn score(
    truth: &Truth,
    nominal: &Vessel,
    sensors: &[&str],
    settings: &ObserverSettings,
) -> Result<Score, EvaluationError> {
    let objects = sensors.iter().map(|name| Sensor::typical(name)).collect::<Result<Vec<_>, _>>()?;
    let commissioning = Commissioning::filled(2e7, ZERO_CELSIUS_K + 15.0);
    score_observer(truth, &mut Observer::new(nominal, &objects, &commissioning, settings)?, sensors)
}

/// Run an observer that has seen nothing yet over a truth's readings of the named sensors and score it.
///
/// # Errors
/// The observer's sensors are not as many as the names, or it refuses a row.
pub fn score_observer(
    truth: &Truth,
    observer: &mut Observer,
    sensors: &[&str],
) -> Result<Score, EvaluationError> {
    let columns = columns(truth, sensors);
    let (mut pairs, mut nis) = (Vec::new(), (0.0, 0.0));
    for (index, (time_s, row)) in truth.log.rows().enumerate() {
        let readings: Vec<f64> = columns.iter().map(|&column| row[column]).collect();
        let estimate = observer.step(time_s, &readings)?;
        if time_s < commissioning_s(truth) {
            continue;
        }
        pairs.push(pair(truth, index, &estimate));
        for innovation in observer.innovations().iter().filter(|i| i.s.is_finite()) {
            nis = (nis.0 + innovation.nu * innovation.nu / innovation.s, nis.1 + 1.0);
        }
    }
    Ok(Score { nis: nis.0 / nis.1, ..summarise(truth, &pairs) })
}

/// The paper's way: a [`TransferFunction`] that has seen nothing yet for the mean gas temperature, and the mass from the measured pressure at that temperature.
///
/// # Errors
/// The pressure is outside the fluid's domain.
pub fn score_transfer_function(
    truth: &Truth,
    nominal: &Vessel,
    mut filter: TransferFunction,
) -> Result<Score, EvaluationError> {
    let columns = columns(truth, &["shoulder", "pressure"]);
    let mut pairs = Vec::new();
    for (index, (time_s, row)) in truth.log.rows().enumerate() {
        let (input, pressure_pa) = (row[columns[0]] - ZERO_CELSIUS_K, row[columns[1]]);
        let gas_degc = filter.step(time_s, input);
        if time_s < commissioning_s(truth) {
            continue;
        }
        let gas_k = gas_degc + ZERO_CELSIUS_K;
        let rho = nominal.fluid.density_from_pressure_temperature(pressure_pa, gas_k)?;
        let estimate = Estimate {
            time_s,
            gas_mean_k: gas_k,
            gas_mean_sd_k: f64::NAN,
            mass_kg: rho * nominal.volume.volume_m3(gas_k, pressure_pa),
            mass_sd_kg: f64::NAN,
            leak_kg_s: f64::NAN,
            leak_sd_kg_s: f64::NAN,
            pressure_pa,
            pressure_expected_pa: f64::NAN,
            p15_pa: f64::NAN,
            quality: crate::estimator::observer::Quality::Good,
        };
        pairs.push(pair(truth, index, &estimate));
    }
    Ok(Score { nis: f64::NAN, ..summarise(truth, &pairs) })
}

fn columns(truth: &Truth, sensors: &[&str]) -> Vec<usize> {
    sensors
        .iter()
        .filter_map(|name| truth.log.channels.iter().position(|channel| channel.name == *name))
        .collect()
}

/// Start of the samples that matter: the commissioning hour, or the judged part of railway weeks.
fn commissioning_s(truth: &Truth) -> f64 {
    match &truth.course {
        Course::RailwayWeeks { days } | Course::RailwayYear { days } if *days > 10.0 => LEARNING_S,
        course => course.opening_s(),
    }
}

fn pair(truth: &Truth, index: usize, estimate: &Estimate) -> Pair {
    let leaking = truth.leak.filter(|leak| estimate.time_s >= leak.start_s);
    Pair {
        time_s: estimate.time_s,
        gas_error_k: estimate.gas_mean_k - truth.gas_mean_k[index],
        gas_sd_k: estimate.gas_mean_sd_k,
        mass_error_kg: estimate.mass_kg - truth.mass_kg[index],
        mass_sd_kg: estimate.mass_sd_kg,
        leak_error_kg_s: estimate.leak_kg_s - leaking.map_or(0.0, |leak| leak.rate_kg_s),
    }
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / count
}

fn summarise(truth: &Truth, pairs: &[Pair]) -> Score {
    let change_s = match truth.course {
        Course::RailwayWeeks { .. } | Course::RailwayYear { .. } => f64::NEG_INFINITY,
        _ => truth.course.change_s(),
    };
    let judged: Vec<&Pair> = pairs.iter().filter(|pair| pair.time_s >= change_s).collect();
    let rms = |value: &dyn Fn(&Pair) -> f64| mean(judged.iter().map(|pair| value(pair).powi(2))).sqrt();
    let average = |value: &dyn Fn(&Pair) -> f64| mean(judged.iter().map(|pair| value(pair)));
    let mass_bias = average(&|pair| pair.mass_error_kg);
    let before = mean(pairs.iter().filter(|pair| pair.time_s < change_s).map(|pair| pair.mass_error_kg));
    let reference = if before.is_finite() { before } else { mass_bias };
    let leak_bias = average(&|pair| pair.leak_error_kg_s);
    let inside = |ok: bool| f64::from(u8::from(ok));
    Score {
        samples: judged.len(),
        gas_rms_k: rms(&|pair| pair.gas_error_k),
        gas_bias_k: average(&|pair| pair.gas_error_k),
        gas_max_k: judged.iter().fold(0.0, |max, pair| f64::max(max, pair.gas_error_k.abs())),
        mass_sd_kg: rms(&|pair| pair.mass_error_kg - mass_bias),
        mass_rms_kg: rms(&|pair| pair.mass_error_kg - reference),
        mass_bias_kg: mass_bias,
        gas_stated_k: rms(&|pair| pair.gas_sd_k),
        mass_stated_kg: rms(&|pair| pair.mass_sd_kg),
        gas_coverage: average(&|pair| inside(pair.gas_error_k.abs() <= BAND * pair.gas_sd_k)),
        mass_coverage: average(&|pair| inside(pair.mass_error_kg.abs() <= BAND * pair.mass_sd_kg)),
        leak_sd_kg_s: rms(&|pair| pair.leak_error_kg_s - leak_bias),
        nis: f64::NAN,
    }
}

#[cfg(test)]
mod tests;

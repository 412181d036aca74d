//! A filter's step on the observer's own linearisation, to compare with filterpy and Stone Soup.
//!
//! The observer runs through the paper's second scenario (a tunnel in winter) until half an hour after the air has
//! changed; transition, noise, gradients and covariance of that moment are then taken for constant.
use super::linear::{Inputs, Process, rows};
use super::stopwatch::{Stopwatch, Timing};
use anyhow::Context;
use cylwatch::estimator::filter::{ExtendedKalman, Linearisation, StateSpace, UdFactors};
use cylwatch::estimator::observer::{Commissioning, Observer, ObserverSettings};
use cylwatch::estimator::sensor::Sensor;
use cylwatch::evaluation::world::chamber::{Chamber, ChamberRequest};
use cylwatch::thermal::units::ZERO_CELSIUS_K;
use cylwatch::thermal::vessel::presets;
use nalgebra::DMatrix;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;
use serde::Serialize;

const SENSORS: [&str; 3] = ["shoulder", "valve", "pressure"];
const INTERVAL_S: f64 = 10.0;
/// From the change of the air to the operating point, s.
const AFTER_S: f64 = 1800.0;
const SAMPLES: usize = 500;
const SEED: u64 = 1;
/// Member of the default bank whose equations are taken.
const LEAK_MEMBER: usize = 1;

/// The observer at the operating point, and readings of a process that is as it supposes.
pub(crate) fn inputs() -> anyhow::Result<Inputs> {
    let sensors = SENSORS.map(Sensor::typical).into_iter().collect::<Result<Vec<_>, _>>()?;
    let filled = Commissioning::filled(200e5, ZERO_CELSIUS_K + 15.0);
    let vessel = presets::load("nitrogen-20l")?;
    let settings = ObserverSettings::default();
    // The member whose leak rate walks: in the first one the leak is none, with no variance.
    let bank = settings.bank.get(LEAK_MEMBER).cloned().into_iter().collect();
    let settings = ObserverSettings { bank, ..settings };
    let mut observer = Observer::new(&vessel, &sensors, &filled, &settings)?;
    let chamber = Chamber::SCENARIOS[1];
    let run = ChamberRequest::new(chamber, SEED, INTERVAL_S).run()?;
    let end_s = chamber.change_s() + AFTER_S;
    for (time_s, readings) in run.log.rows().take_while(|(time_s, _)| *time_s <= end_s) {
        observer.step(time_s, readings)?;
    }
    let (mean, prior) = observer.state(0).context("no sample")?;
    let cylinder = observer.cylinder();
    let (n, leading) = (cylinder.states(), cylinder.leading());
    let mut linear = Linearisation::zeros(n, leading, cylinder.noises());
    let x = mean.as_slice();
    cylinder.propagate(&mut x.to_vec(), INTERVAL_S, Some(&mut linear))?;
    let mut h = vec![vec![0.0; n]; SENSORS.len()];
    for (sensor, h) in h.iter_mut().enumerate() {
        cylinder.output(sensor, x, Some(h))?;
    }
    let mut inputs = Inputs {
        names: cylinder.state_map().names.clone(),
        interval_s: INTERVAL_S,
        phi: rows(&linear.phi),
        g: rows(&linear.g),
        q: linear.q.iter().copied().collect(),
        r: (0..SENSORS.len()).map(|sensor| cylinder.noise_variance(sensor, x)).collect(),
        h,
        prior: rows(&prior),
        readings: Vec::new(),
    };
    inputs.readings = readings(&inputs, &prior, SAMPLES, SEED)?;
    Ok(inputs)
}

/// Readings of a process that starts from the prior.
pub(crate) fn readings(
    inputs: &Inputs,
    prior: &DMatrix<f64>,
    samples: usize,
    seed: u64,
) -> anyhow::Result<Vec<Vec<f64>>> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut normal = || rng.sample::<f64, _>(StandardNormal);
    let mut process = Process::new(inputs);
    let spread: Vec<f64> = prior.diagonal().iter().map(|variance| variance.sqrt()).collect();
    let mut x: Vec<f64> = spread.iter().map(|sd| sd * normal()).collect();
    let noise_sd = process.noise_sd();
    let mut sample = || {
        let w: Vec<f64> = noise_sd.iter().map(|sd| sd * normal()).collect();
        process.propagate(&mut x, inputs.interval_s, None)?;
        process.disturb(&mut x, &w);
        let z =
            inputs.r.iter().enumerate().map(|(j, r)| Ok(process.output(j, &x, None)? + r.sqrt() * normal()));
        z.collect()
    };
    (0..samples).map(|_| sample()).collect()
}

/// State and covariance after the last sample, and the time of a step.
#[derive(Debug, Serialize)]
pub(crate) struct Results {
    x: Vec<f64>,
    covariance: Vec<Vec<f64>>,
    time: Timing,
}

/// The filter over the record.
pub(crate) fn run(inputs: &Inputs, stopwatch: &Stopwatch) -> anyhow::Result<Results> {
    let process = Process::new(inputs);
    let start = vec![0.0; process.states()];
    let prior = UdFactors::from_covariance(&super::linear::matrix(&inputs.prior))?;
    let filter = ExtendedKalman::try_new(process, &start, prior)?;
    let over = |mut filter: ExtendedKalman<Process>| {
        for z in &inputs.readings {
            filter.step(inputs.interval_s, z)?;
        }
        anyhow::Ok(filter)
    };
    let end = over(filter.clone())?;
    let time = stopwatch.time(inputs.readings.len(), || over(filter.clone()));
    Ok(Results { x: end.state().to_vec(), covariance: rows(&end.factors().covariance()), time })
}

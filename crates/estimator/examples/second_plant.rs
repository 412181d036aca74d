//! The filters on another plant: a water tank, heated with 900 W, with a slow leak, whose water is hidden and expands as it warms.
//!
//! `cargo run --release -p cylwatch-estimator --example second_plant`
//!
//! A thermometer reads the shell, a gauge the level `m / (rho A)`, `rho = 992.2 kg/m3 (1 - 3.8e-4/K (T - 313.15 K))` (Wagner, Pruss 2002).
//! Lumped capacities with natural convection, `Q = k dT |dT|^(1/3)` (Incropera, DeWitt 2002, sections 5.1, 9.6). One member of the bank
//! supposes a tight tank, the other a leak. One reading of the gauge in twenty is spoilt.
#![allow(clippy::print_stdout, missing_docs)]
use std::convert::Infallible;

use cylwatch_estimator::EstimatorError;
use cylwatch_estimator::consistency::{EnsembleNees, Significance};
use cylwatch_estimator::filter::{
    self, Bank, BankEngine, Belief, Dimensions, Linearisation, Outcome, Plant, StateSpace,
};
use nalgebra::DMatrix;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

/// Temperatures of shell and water, K; mass, kg; leak, kg/h; offset of the gauge, m.
const MEAN: [f64; 5] = [312.0, 315.0, 190.0, 0.5, 0.0];
const SD: [f64; 5] = [0.5, 0.7, 1.0, 0.2, 0.003];
/// Variance that each moving state gains in an hour.
const NOISE: [f64; 4] = [0.5, 0.02, 1e-4, 1e-3];
/// Of thermometer, K, and gauge, m.
const READING_SD: [f64; 2] = [0.2, 0.002];
pub(crate) const SAMPLE_S: f64 = 60.0;
const TIMES: [usize; 4] = [60, 180, 330, 480];

type Linear<'a> = Option<&'a mut Linearisation>;
type Nees = [EnsembleNees; 2];
/// The tank with the part of the leak's noise that a member supposes: 0 of a tight one.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tank(f64);

impl StateSpace for Tank {
    type Error = Infallible;
    fn dimensions(&self) -> Dimensions {
        Dimensions { states: MEAN.len(), leading: NOISE.len(), noises: NOISE.len(), outputs: 2 }
    }
    fn propagate(&mut self, x: &mut [f64], dt: f64, to: Linear<'_>) -> Result<(), Infallible> {
        let film = 150.0 * (x[1] - x[0]).abs().cbrt();
        let (inside, outside) = (film * (x[1] - x[0]), 15.0 * (x[0] - 293.15));
        let rates = [(inside - outside) / 15e3, (900.0 - inside) / (4180.0 * x[2]), -x[3] / 3600.0];
        if let Some(Linearisation { phi, g, q }) = to {
            phi.fill_with_identity();
            let (shell, water) = (dt * film / 0.75 / 15e3, dt * film / 0.75 / (4180.0 * x[2]));
            (phi[(0, 0)], phi[(0, 1)]) = (1.0 - shell - dt * 15.0 / 15e3, shell);
            (phi[(1, 0)], phi[(1, 1)], phi[(1, 2)]) = (water, 1.0 - water, -dt * rates[1] / x[2]);
            phi[(2, 3)] = -dt / 3600.0;
            g.fill_with_identity();
            q.iter_mut().zip(NOISE).for_each(|(q, hourly)| *q = hourly * dt / 3600.0);
            q[3] *= self.0;
        }
        x.iter_mut().zip(rates).for_each(|(x, rate)| *x += dt * rate);
        Ok(())
    }
    fn output(&mut self, j: usize, x: &[f64], h: Option<&mut [f64]>) -> Result<f64, Infallible> {
        let z = outputs(x);
        let (level, shrinking) = (z[1] - x[4], 1.0 - 3.8e-4 * (x[1] - 313.15));
        let gauge = [0.0, level * 3.8e-4 / shrinking, level / x[2], 0.0, 1.0];
        h.into_iter().for_each(|h| h.copy_from_slice(&[[1.0, 0.0, 0.0, 0.0, 0.0], gauge][j]));
        Ok(z[j])
    }
    fn noise_variance(&self, j: usize, _x: &[f64]) -> f64 {
        READING_SD[j] * READING_SD[j]
    }
}

fn outputs(x: &[f64]) -> [f64; 2] {
    [x[0], x[2] / (992.2 * 0.2 * (1.0 - 3.8e-4 * (x[1] - 313.15))) + x[4]]
}

impl Plant for Tank {
    type Hypothesis = f64;
    fn suppose(&mut self, leak_noise: &f64) {
        self.0 = *leak_noise;
    }
    fn longest_step_s(&self) -> f64 {
        20.0
    }
}

/// A bank of a tight member and a leaking one.
pub(crate) fn bank(tank: &mut Tank, engine: &BankEngine) -> Bank<Tank> {
    let prior = DMatrix::from_fn(5, 5, |i, j| if i == j { SD[i] * SD[i] } else { 0.0 });
    let members = [(0.0, prior.clone()), (1.0, prior)];
    let mut bank = Bank::new(tank, engine, &MEAN, &members).expect("a covariance");
    bank.set(0, 3, 0.0, 0.0);
    bank
}

/// True states and readings of a drawn tank with a leak so many times as large.
pub(crate) fn truth(seed: u64, leak: f64) -> Vec<([f64; 5], [f64; 2])> {
    let (mut tank, mut x, mut rng) = (Tank::default(), MEAN, ChaCha8Rng::seed_from_u64(seed));
    let mut normal = move || rng.sample::<f64, _>(StandardNormal);
    x.iter_mut().zip(SD).for_each(|(x, sd)| *x += sd * normal());
    x[3] *= leak;
    let sample = |_| {
        for _ in 0..12 {
            let Ok(()) = tank.propagate(&mut x, SAMPLE_S / 12.0, None);
            let sd = |i: usize| [1.0, 1.0, 1.0, leak][i] * (NOISE[i] * SAMPLE_S / 43_200.0).sqrt();
            (0..4).for_each(|i| x[i] += sd(i) * normal());
        }
        let spoilt = [0.0, if normal().abs() > 1.96 { 0.1 } else { 0.0 }];
        (x, [0, 1].map(|j| outputs(&x)[j] + spoilt[j] + READING_SD[j] * normal()))
    };
    (0..TIMES[3]).map(sample).collect()
}

/// Errors of the leaking member, filtered and smoothed; readings refused; whether the tight member is excluded at the end.
pub(crate) fn watch(seed: u64, leak: f64, nees: &mut Nees) -> Result<(usize, bool), EstimatorError> {
    let (mut tank, truth, mut refused) = (Tank::default(), truth(seed, leak), 0);
    let (mut bank, mut work) = (bank(&mut tank, &BankEngine::Extended), filter::Workspace::new(&tank));
    let mut records = vec![bank.record(1, &tank)];
    for (_, z) in &truth {
        let Ok(()) = bank.predict(&mut tank, &mut work, SAMPLE_S);
        let Ok(()) = bank.update(&mut tank, &mut work, z);
        records.push(bank.record(1, &tank));
        refused += bank.innovations(1).iter().filter(|of| of.outcome == Outcome::Rejected).count();
    }
    let smoothed = filter::smooth(&records);
    for (index, k) in TIMES.into_iter().enumerate() {
        for (which, x, p) in [(0, &records[k].x, &records[k].p), (1, &smoothed[k].x, &smoothed[k].p)] {
            let error: Vec<f64> = x.iter().zip(truth[k - 1].0).map(|(x, truth)| x - truth).collect();
            nees[which].add(index, &error, p)?;
        }
    }
    Ok((refused, Belief::of(bank.moments(0, 2), bank.moments(1, 2)).is_excluded()))
}

pub(crate) fn ensembles() -> Nees {
    [0, 1].map(|_| EnsembleNees::new(&TIMES.map(|k| SAMPLE_S * k as f64), 5))
}

fn main() -> Result<(), EstimatorError> {
    let mut nees = ensembles();
    let all = (0..200).map(|seed| watch(seed, 1.0, &mut nees)).collect::<Result<Vec<_>, _>>()?;
    for at in nees.iter().flat_map(|nees| nees.judge(Significance::FIVE_PERCENT).times) {
        println!("{:.1} h: NEES {:.3}, band {:.3?}", at.time_s / 3600.0, at.mean, at.band);
    }
    println!("Filtered, then smoothed; {} leaks are certain.", all.iter().filter(|of| of.1).count());
    Ok(())
}

//! One member of the bank: an estimate with its own view of how gas may leave, and what it made of the readings.
use nalgebra::DVector;
use serde::{Deserialize, Serialize};

use super::cylinder::Cylinder;
use super::pass::Pass;
use super::settings::LeakHypothesis;
use crate::filter::kernel::axpy;
use crate::filter::{Gate, Innovation, Outcome};
use crate::numbers;

/// Mean and counters of a member; its covariance is in the bank's.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Member {
    pub hypothesis: LeakHypothesis,
    #[serde(with = "numbers")]
    pub x: Vec<f64>,
    /// Rejections in a row of each sensor.
    rejected: Vec<u32>,
    pub innovations: Vec<Innovation>,
    /// Change of each sensor's expected reading by its last reading.
    #[serde(with = "numbers")]
    pub pulled: Vec<f64>,
    /// Whether a constant or a film stood at its bound after the last step.
    pub at_bound: bool,
    /// The last step, for a smoother or the signature of a leak; it is not saved.
    #[serde(skip)]
    pub pass: Option<Box<Pass>>,
}

impl Member {
    pub fn new(hypothesis: LeakHypothesis, mean: &[f64], sensors: usize) -> Self {
        Self {
            hypothesis,
            x: mean.to_vec(),
            rejected: vec![0; sensors],
            innovations: vec![Innovation::MISSING; sensors],
            pulled: vec![0.0; sensors],
            at_bound: false,
            pass: None,
        }
    }

    /// Its last step, kept from now on; so many of its states move.
    pub fn recorded(&mut self, leading: usize) -> &mut Pass {
        let (n, sensors) = (self.x.len(), self.innovations.len());
        self.pass.get_or_insert_with(|| Box::new(Pass::new(n, leading, sensors)))
    }

    /// Become as another one is, without allocating.
    pub fn copy_from(&mut self, other: &Self) {
        self.hypothesis = other.hypothesis;
        self.x.clone_from(&other.x);
        self.rejected.clone_from(&other.rejected);
        self.innovations.clone_from(&other.innovations);
        self.pulled.clone_from(&other.pulled);
        self.at_bound = other.at_bound;
        match (&mut self.pass, &other.pass) {
            (Some(to), Some(from)) => to.copy_from(from),
            (to, from) => to.clone_from(from),
        }
    }

    /// Have another mean (n), and no reading refused.
    pub fn place_at(&mut self, mean: impl Iterator<Item = f64>) {
        self.x.iter_mut().zip(mean).for_each(|(x, mean)| *x = mean);
        self.rejected.fill(0);
    }

    /// Whether it has seen so many sensors.
    pub fn has_sensors(&self, sensors: usize) -> bool {
        [self.rejected.len(), self.innovations.len(), self.pulled.len()] == [sensors; 3]
    }

    /// What becomes of a reading with the innovation `nu` of variance `s` at a gate.
    pub fn judge(&mut self, sensor: usize, (nu, s): (f64, f64), gate: Gate) -> Outcome {
        let outcome = gate.judge((nu, s), &mut self.rejected[sensor]);
        self.innovations[sensor] = Innovation { nu, s, outcome };
        outcome
    }

    /// Keep constants and films within what can be, with a function that writes the covariance of a state with all others into memory for it: (n).
    ///
    /// What a state may not be the others take on as far as they are correlated with it, so that readings are explained as before: the state within the bound that is nearest
    /// in the metric of the covariance (D. Simon, IET Control Theory Appl. 4 (2010) 1303). Were it cut off alone, the pressure would be expected too high from then on, row
    /// by row, which is what a leak looks like. A state that has gone farther than its standard deviation in one row did not creep there, as in a filling: what its covariance
    /// says of the others is worth nothing then, and it is cut off alone.
    pub fn bound(&mut self, cylinder: &Cylinder, covariance: impl Fn(usize, &mut [f64]), memory: &mut [f64]) {
        self.at_bound = false;
        for &(state, low, high) in cylinder.bounds() {
            let lacks = self.x[state].clamp(low, high) - self.x[state];
            if lacks == 0.0 {
                continue;
            }
            self.at_bound = true;
            covariance(state, memory);
            let variance = memory[state];
            if variance > 0.0 && lacks * lacks <= variance {
                memory.iter_mut().for_each(|of| *of /= variance);
                if self.hypothesis.considers_offset {
                    cylinder
                        .transmitter_offsets()
                        .iter()
                        .filter(|&&of| of != state)
                        .for_each(|&of| memory[of] = 0.0);
                }
                axpy(lacks, memory, &mut self.x);
                if let Some(pass) = &mut self.pass {
                    pass.bound(state, lacks / variance, memory);
                }
            }
        }
        if self.at_bound {
            // Those that were cut off alone, and what another one has pushed beyond its own.
            for &(state, low, high) in cylinder.bounds() {
                self.x[state] = self.x[state].clamp(low, high);
            }
        }
    }

    /// Mean (n).
    pub fn mean(&self) -> DVector<f64> {
        DVector::from_column_slice(&self.x)
    }
}

/// States that an exchange of gas frees of everything known about them, with their variances; what has been learnt of the constants
/// stays.
pub(super) fn freed(cylinder: &Cylinder) -> [(usize, f64); 2] {
    let (states, mass_sd_kg) = (cylinder.state_map(), cylinder.settings().free_mass_sd_kg);
    [(states.mass, mass_sd_kg * mass_sd_kg), (states.gas, FREE_GAS_SD_K * FREE_GAS_SD_K)]
}

/// What the gas temperature may be while gas is exchanged.
const FREE_GAS_SD_K: f64 = 20.0;

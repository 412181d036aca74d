//! One member of the bank: a Kalman filter with its own view of how gas may leave.
use super::belief::Moments;
use super::cylinder::Cylinder;
use super::engine::{Mechanism, Predicted, Shared};
use super::pass::Pass;
use super::settings::LeakHypothesis;
use crate::EstimatorError;
use crate::filter::{StateSpace, UdFactors};
use nalgebra::{DMatrix, DVector, Dyn};

/// Interval at which slow walks are added to the constants, s.
const SLOW_WALK_S: f64 = 3600.0;

/// What became of a reading.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Outcome {
    /// It was used.
    Accepted,
    /// Its gate refused it.
    Rejected,
    /// It was taken after too many rejections in a row: the estimate was opened for it.
    Reacquired,
    /// There was none.
    #[default]
    Missing,
}

/// Innovation of one sensor, before its gate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Innovation {
    /// Reading minus prediction, K or Pa.
    pub nu: f64,
    /// Its predicted variance, K² or Pa².
    pub s: f64,
    /// What became of the reading.
    pub outcome: Outcome,
}

impl Innovation {
    /// No reading.
    pub const MISSING: Self = Self { nu: f64::NAN, s: f64::NAN, outcome: Outcome::Missing };
}

/// State, covariance and counters of a member.
#[derive(Clone, Debug)]
pub(super) struct Member {
    pub hypothesis: LeakHypothesis,
    pub x: Vec<f64>,
    pub p: UdFactors<Dyn>,
    /// Rejections in a row of each sensor.
    pub rejected: Vec<u32>,
    pub innovations: Vec<Innovation>,
    /// Change of each sensor's expected reading by its last reading.
    pub pulled: Vec<f64>,
    slow_s: f64,
    /// Whether a constant or a film stood at its bound after the last step.
    pub at_bound: bool,
    pub mechanism: Mechanism,
    /// The last step, for a smoother.
    pub pass: Option<Box<Pass>>,
}

impl Member {
    pub fn new(
        cylinder: &mut Cylinder,
        hypothesis: LeakHypothesis,
        mean: &[f64],
        covariance: &DMatrix<f64>,
    ) -> Result<Self, EstimatorError> {
        let leak = cylinder.state_map().leak;
        let mut covariance = covariance.clone();
        covariance.row_mut(leak).fill(0.0);
        covariance.column_mut(leak).fill(0.0);
        covariance[(leak, leak)] = hypothesis.rate.prior_sd.powi(2);
        let mut p = UdFactors::from_covariance(&covariance)?;
        cylinder.suppose(&hypothesis);
        let mechanism = Mechanism::new(cylinder.settings().engine, cylinder, &mut p)?;
        let sensors = cylinder.sensors().len();
        Ok(Self {
            hypothesis,
            x: mean.to_vec(),
            p,
            rejected: vec![0; sensors],
            innovations: vec![Innovation::MISSING; sensors],
            pulled: vec![0.0; sensors],
            slow_s: 0.0,
            at_bound: false,
            mechanism,
            pass: None,
        })
    }

    /// Time update over an interval, in steps no longer than the settings allow.
    pub fn predict(
        &mut self,
        cylinder: &mut Cylinder,
        shared: &mut Shared,
        dt_s: f64,
    ) -> Result<(), EstimatorError> {
        cylinder.suppose(&self.hypothesis);
        if let Some(pass) = &mut self.pass {
            pass.begin(dt_s);
        }
        let belief = (self.x.as_mut_slice(), &mut self.p);
        self.mechanism.predict(cylinder, shared, belief, self.pass.as_deref_mut(), dt_s)?;
        self.slow_s += dt_s;
        if self.slow_s >= SLOW_WALK_S {
            for state in cylinder.leading()..cylinder.states() {
                let process = cylinder.slow_process(state);
                let (factor, variance) = process.over(self.slow_s);
                if factor < 1.0 {
                    self.x[state] = process.rest + factor * (self.x[state] - process.rest);
                    self.mechanism.relax(&mut self.p, state, factor, process.rest);
                    if let Some(pass) = &mut self.pass {
                        pass.relax(state, factor);
                    }
                }
                if variance > 0.0 {
                    self.mechanism.inflate(&mut self.p, state, variance);
                }
            }
            self.slow_s = 0.0;
        }
        Ok(())
    }

    /// Measurement update with one reading per sensor (NaN: missing), sensor by sensor.
    pub fn update(
        &mut self,
        cylinder: &mut Cylinder,
        shared: &mut Shared,
        readings: &[f64],
        gate: f64,
    ) -> Result<(), EstimatorError> {
        self.pulled.fill(0.0);
        for (sensor, &reading) in readings.iter().enumerate() {
            self.innovations[sensor] = if reading.is_finite() {
                self.update_one(cylinder, shared, sensor, reading, gate)?
            } else {
                self.mechanism.interrupt(&mut self.p);
                Innovation::MISSING
            };
        }
        cylinder.suppose(&self.hypothesis);
        self.mechanism.finish(cylinder, &mut self.x, &mut self.p);
        self.at_bound = false;
        for &(state, low, high) in cylinder.bounds() {
            self.at_bound |= !(low..=high).contains(&self.x[state]);
            self.x[state] = self.x[state].clamp(low, high);
        }
        Ok(())
    }

    fn update_one(
        &mut self,
        cylinder: &mut Cylinder,
        shared: &mut Shared,
        sensor: usize,
        reading: f64,
        gate: f64,
    ) -> Result<Innovation, EstimatorError> {
        let Predicted { value, mut r } =
            self.mechanism.expect(cylinder, shared, (&self.x, &self.p), sensor)?;
        let nu = reading - value;
        let s = self.mechanism.innovation_variance(shared, &mut self.p, sensor, r);
        let mut outcome = Outcome::Accepted;
        if nu * nu > gate * s {
            self.rejected[sensor] += 1;
            self.mechanism.interrupt(&mut self.p);
            if self.rejected[sensor] <= cylinder.settings().rejections_in_a_row {
                return Ok(Innovation { nu, s, outcome: Outcome::Rejected });
            }
            outcome = Outcome::Reacquired;
            if cylinder.reads_pressure(sensor) {
                self.open(cylinder, Some(sensor));
                self.mechanism.innovation_variance(shared, &mut self.p, sensor, r);
            } else {
                // Whatever moved the reading, the state may follow it half of the way at most.
                r = r.max(nu * nu);
                self.mechanism.distrust();
            }
        }
        self.rejected[sensor] = 0;
        self.pulled[sensor] = (1.0 - r / s) * nu;
        let used_s = self.mechanism.update(shared, &mut self.p, (sensor, reading), r);
        if let Some(pass) = &mut self.pass {
            pass.take(sensor, &shared.h, &shared.gain, (nu, used_s));
        }
        for (x, k) in self.x.iter_mut().zip(&shared.gain) {
            *x += k * nu;
        }
        Ok(Innovation { nu, s, outcome })
    }

    /// Begin anew with all that another member knows. Where that is less mass than supposed, a leak rate that may walk may
    /// be anything then; more mass is no leak, but tells that one was supposed in vain.
    pub fn begin_anew_from(&mut self, other: &Self, (mass, leak): (usize, usize)) {
        let lost = other.x[mass] < self.x[mass];
        self.x.clone_from(&other.x);
        self.p.clone_from(&other.p);
        self.mechanism.clone_from(&other.mechanism);
        self.x[leak] = 0.0;
        let leak_sd_kg_s = if lost && !self.hypothesis.rate.is_known() { ANY_LEAK_SD_KG_S } else { 0.0 };
        self.mechanism.decorrelate_and_set(&mut self.p, leak, leak_sd_kg_s * leak_sd_kg_s);
        self.slow_s = other.slow_s;
        if let Some(pass) = &mut self.pass {
            pass.begin_anew();
        }
    }

    /// Mean and variance of a state.
    pub fn moments(&self, state: usize) -> Moments {
        (self.x[state], self.variance(state))
    }

    /// Free mass and gas temperature of everything known about them; what has been learnt of the constants stays.
    /// It happens before the readings of a sample, or before that of one sensor.
    pub fn open(&mut self, cylinder: &Cylinder, before: Option<usize>) {
        let states = cylinder.state_map();
        for (state, sd) in [(states.mass, FREE_MASS_SD_KG), (states.gas, FREE_GAS_SD_K)] {
            self.mechanism.decorrelate_and_set(&mut self.p, state, sd * sd);
        }
        if let Some(pass) = &mut self.pass {
            pass.open(before);
        }
    }

    /// Whether mean and covariance are numbers, and the mean a state of the cylinder.
    pub fn is_possible(&self, cylinder: &mut Cylinder) -> bool {
        let finite = self.x.iter().chain(self.p.diagonal().iter()).all(|value| value.is_finite());
        finite && cylinder.is_possible(&self.x)
    }

    /// Variance of a state.
    pub fn variance(&self, state: usize) -> f64 {
        self.mechanism.variance(&self.p, state)
    }

    pub fn covariance(&self) -> DMatrix<f64> {
        self.mechanism.covariance(&self.p)
    }

    /// Samples at which the engine could not do its own and fell back on the extended filter inside it.
    pub fn fallbacks(&self) -> u64 {
        self.mechanism.fallbacks()
    }

    pub fn mean(&self) -> DVector<f64> {
        DVector::from_column_slice(&self.x)
    }
}

/// What mass and gas temperature may be while gas is exchanged.
const FREE_MASS_SD_KG: f64 = 1.0;
const FREE_GAS_SD_K: f64 = 20.0;

/// What a leak rate may be once a slow member was wrong, kg/s: 20 g/h.
const ANY_LEAK_SD_KG_S: f64 = 20e-3 / 3600.0;

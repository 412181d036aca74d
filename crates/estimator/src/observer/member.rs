//! One member of the bank: a Kalman filter with its own view of how gas may leave.
use super::cylinder::Cylinder;
use super::engine::{self, Mechanism, Predicted, SigmaPoints};
use super::settings::LeakHypothesis;
use crate::EstimatorError;
use crate::filter::{Linearisation, StateSpace, UdFactors};
use nalgebra::{DMatrix, DVector, Dyn};

/// Interval at which slow walks are added to the constants, s.
const SLOW_WALK_S: f64 = 3600.0;
/// Bounds on the logarithms of the film multipliers: outside, inside.
const LN_OUTSIDE_BOUND: f64 = 2.5;
const LN_INSIDE_BOUND: f64 = 1.5;

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
    slow_s: f64,
    /// Whether a film multiplier stood at its bound after the last step.
    pub at_bound: bool,
    mechanism: Mechanism,
}

/// Memory shared by the members.
#[derive(Debug)]
pub(super) struct Shared {
    pub linear: Linearisation,
    pub h: Vec<f64>,
    pub gain: Vec<f64>,
    points: SigmaPoints,
}

impl Shared {
    pub fn new(cylinder: &Cylinder) -> Self {
        let n = cylinder.states();
        Self {
            linear: Linearisation::zeros(n, cylinder.leading(), cylinder.noises()),
            h: vec![0.0; n],
            gain: vec![0.0; n],
            points: SigmaPoints::new(cylinder),
        }
    }
}

impl Member {
    pub fn new(
        cylinder: &Cylinder,
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
        let engine = cylinder.settings().engine;
        p.reserve(cylinder.leading(), engine::noises(engine, cylinder));
        let sensors = cylinder.sensors().len();
        Ok(Self {
            hypothesis,
            x: mean.to_vec(),
            p,
            rejected: vec![0; sensors],
            innovations: vec![Innovation::MISSING; sensors],
            slow_s: 0.0,
            at_bound: false,
            mechanism: Mechanism::new(engine),
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
        let parts = (dt_s / cylinder.settings().longest_step_s).ceil().max(1.0);
        for _ in 0..parts as usize {
            self.move_on(cylinder, shared, dt_s / parts)?;
        }
        self.slow_s += dt_s;
        if self.slow_s >= SLOW_WALK_S {
            for state in cylinder.leading()..cylinder.states() {
                let process = cylinder.slow_process(state);
                let (factor, variance) = process.over(self.slow_s);
                if factor < 1.0 {
                    self.x[state] = process.rest + factor * (self.x[state] - process.rest);
                    self.p.scale(state, factor);
                }
                if variance > 0.0 {
                    self.p.inflate(state, variance);
                }
            }
            self.slow_s = 0.0;
        }
        Ok(())
    }

    fn move_on(
        &mut self,
        cylinder: &mut Cylinder,
        shared: &mut Shared,
        dt_s: f64,
    ) -> Result<(), EstimatorError> {
        match &mut self.mechanism {
            Mechanism::Extended => {
                cylinder.propagate(&mut self.x, dt_s, Some(&mut shared.linear))?;
                self.p.predict(&shared.linear);
            }
            Mechanism::Unscented => shared.points.predict(cylinder, &mut self.x, &mut self.p, dt_s)?,
        }
        Ok(())
    }

    /// Mean and noise of a sensor's next reading; its gradient goes to `shared.h`.
    fn expect(
        &mut self,
        cylinder: &mut Cylinder,
        shared: &mut Shared,
        sensor: usize,
    ) -> Result<Predicted, EstimatorError> {
        match &mut self.mechanism {
            Mechanism::Extended => Ok(Predicted {
                value: cylinder.output(sensor, &self.x, Some(&mut shared.h))?,
                r: cylinder.noise_variance(sensor, &self.x),
            }),
            Mechanism::Unscented => shared.points.output(cylinder, sensor, &self.x, &self.p, &mut shared.h),
        }
    }

    /// Measurement update with one reading per sensor (NaN: missing), sensor by sensor.
    pub fn update(
        &mut self,
        cylinder: &mut Cylinder,
        shared: &mut Shared,
        readings: &[f64],
        gate: f64,
    ) -> Result<(), EstimatorError> {
        for (sensor, &reading) in readings.iter().enumerate() {
            self.innovations[sensor] = if reading.is_finite() {
                self.update_one(cylinder, shared, sensor, reading, gate)?
            } else {
                Innovation::MISSING
            };
        }
        let states = cylinder.state_map();
        self.at_bound = false;
        for (state, bound) in [(states.outside, LN_OUTSIDE_BOUND), (states.inside, LN_INSIDE_BOUND)] {
            if let Some(state) = state {
                self.at_bound |= self.x[state].abs() >= bound;
                self.x[state] = self.x[state].clamp(-bound, bound);
            }
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
        let Predicted { value, mut r } = self.expect(cylinder, shared, sensor)?;
        let nu = reading - value;
        let s = self.p.quadratic(&shared.h) + r;
        let mut outcome = Outcome::Accepted;
        if nu * nu > gate * s {
            self.rejected[sensor] += 1;
            if self.rejected[sensor] <= cylinder.settings().rejections_in_a_row {
                return Ok(Innovation { nu, s, outcome: Outcome::Rejected });
            }
            outcome = Outcome::Reacquired;
            if cylinder.reads_pressure(sensor) {
                self.open(cylinder, FREE_MASS_SD_KG, FREE_GAS_SD_K);
            } else {
                // Whatever moved the reading, the state may follow it half of the way at most.
                r = r.max(nu * nu);
            }
        }
        self.rejected[sensor] = 0;
        self.p.update(&shared.h, r, &mut shared.gain);
        for (x, k) in self.x.iter_mut().zip(&shared.gain) {
            *x += k * nu;
        }
        Ok(Innovation { nu, s, outcome })
    }

    /// Free mass and gas temperature of everything known about them; what has been learnt of the constants stays.
    pub fn open(&mut self, cylinder: &Cylinder, mass_sd_kg: f64, gas_sd_k: f64) {
        let states = cylinder.state_map();
        self.p.decorrelate_and_set(states.mass, mass_sd_kg * mass_sd_kg);
        self.p.decorrelate_and_set(states.gas, gas_sd_k * gas_sd_k);
    }

    pub fn is_finite(&self) -> bool {
        self.x.iter().all(|x| x.is_finite()) && self.p.diagonal().iter().all(|d| d.is_finite())
    }

    /// Variance of a state.
    pub fn variance(&self, state: usize) -> f64 {
        self.p.variance(state)
    }

    pub fn covariance(&self) -> DMatrix<f64> {
        self.p.covariance()
    }

    pub fn mean(&self) -> DVector<f64> {
        DVector::from_column_slice(&self.x)
    }
}

/// What mass and gas temperature may be while gas is exchanged.
pub(super) const FREE_MASS_SD_KG: f64 = 1.0;
pub(super) const FREE_GAS_SD_K: f64 = 20.0;

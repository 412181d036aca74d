//! An engine at work: how mean `x` (n) and covariance `p` (n, n) of a member move in time and take a reading.
use nalgebra::{DMatrix, Dyn};

use super::super::bank::Memory;
use super::super::cylinder::Cylinder;
use super::super::pass::Pass;
use super::Engine;
use super::horizon::Horizon;
use super::stationary::Stationary;
use super::unscented::SigmaPoints;
use crate::EstimatorError;
use crate::filter::{Linearisation, StateSpace, UdFactors};

/// An engine with its memory of the past beside mean and covariance.
#[derive(Clone, Debug)]
pub(in crate::observer) enum Mechanism {
    Unscented,
    Stationary(Box<Stationary>),
    MovingHorizon(Box<Horizon>),
}

/// A reading as an engine predicts it; the gradient is written beside.
#[derive(Clone, Copy, Debug)]
pub(in crate::observer) struct Predicted {
    /// Mean.
    pub value: f64,
    /// Variance of what the gradient does not say: the sensor's noise, and curvature over the spread of the estimate.
    pub r: f64,
}

/// Memory shared by the members. Nothing in it outlives a step.
#[derive(Debug)]
pub(in crate::observer) struct Shared {
    pub linear: Linearisation,
    pub h: Vec<f64>,
    pub gain: Vec<f64>,
    points: SigmaPoints,
    pub memory: Memory,
}

impl Shared {
    pub fn new(cylinder: &Cylinder) -> Self {
        let n = cylinder.states();
        Self {
            linear: Linearisation::zeros(n, cylinder.leading(), cylinder.noises()),
            h: vec![0.0; n],
            gain: vec![0.0; n],
            points: SigmaPoints::new(cylinder),
            memory: Memory::new(cylinder),
        }
    }
}

impl Mechanism {
    /// An engine for a member with the covariance `p`, which becomes what the engine moves.
    ///
    /// # Errors
    /// The covariance is none.
    pub fn new(
        engine: Engine,
        cylinder: &mut Cylinder,
        p: &mut UdFactors<Dyn>,
    ) -> Result<Self, EstimatorError> {
        p.reserve(cylinder.leading(), cylinder.noises());
        Ok(match engine {
            Engine::Extended | Engine::Unscented => {
                p.reserve(cylinder.leading(), SigmaPoints::noises(cylinder));
                Self::Unscented
            }
            Engine::Stationary => Self::Stationary(Box::new(Stationary::new(cylinder, p)?)),
            Engine::MovingHorizon(settings) => {
                Self::MovingHorizon(Box::new(Horizon::new(cylinder, &settings)))
            }
        })
    }

    /// Time update over `dt_s`, s, in steps no longer than the settings allow, recorded in `pass`.
    ///
    /// # Errors
    /// The process refuses the state.
    pub fn predict(
        &mut self,
        cylinder: &mut Cylinder,
        shared: &mut Shared,
        (x, p): (&mut [f64], &mut UdFactors<Dyn>),
        mut pass: Option<&mut Pass>,
        dt_s: f64,
    ) -> Result<(), EstimatorError> {
        let (parts, part_s) = cylinder.parts(dt_s);
        if let Self::Stationary(stationary) = self {
            stationary.begin(p, dt_s);
        }
        for _ in 0..parts {
            if let Self::Unscented = self {
                shared.points.predict(cylinder, x, p, part_s)?;
                if let Some(pass) = &mut pass {
                    pass.move_on(&shared.points.linear.phi);
                }
                continue;
            }
            cylinder.propagate(x, part_s, Some(&mut shared.linear))?;
            match self {
                Self::Stationary(stationary) => stationary.predict(&shared.linear, p),
                _ => p.predict(&shared.linear),
            }
            if let Some(pass) = &mut pass {
                pass.move_on(&shared.linear.phi);
            }
        }
        if let Self::MovingHorizon(horizon) = self {
            horizon.begin(dt_s);
        }
        Ok(())
    }

    /// Mean and noise of a sensor's next reading; its gradient goes to `shared.h`.
    ///
    /// # Errors
    /// The state has no such reading.
    pub fn expect(
        &self,
        cylinder: &mut Cylinder,
        shared: &mut Shared,
        (x, p): (&[f64], &UdFactors<Dyn>),
        sensor: usize,
    ) -> Result<Predicted, EstimatorError> {
        if let Self::Unscented = self {
            return shared.points.output(cylinder, sensor, x, p, &mut shared.h);
        }
        let value = cylinder.output(sensor, x, Some(&mut shared.h))?;
        Ok(Predicted { value, r: cylinder.noise_variance(sensor, x) })
    }

    /// Variance of the innovation of a sensor with the gradient `shared.h` and noise of variance `r`.
    pub fn innovation_variance(
        &mut self,
        shared: &Shared,
        p: &mut UdFactors<Dyn>,
        sensor: usize,
        r: f64,
    ) -> f64 {
        match self {
            Self::Stationary(stationary) => stationary.innovation_variance(p, sensor, &shared.h, r),
            _ => p.project(&shared.h) + r,
        }
    }

    /// Update the covariance by a reading with the gradient `shared.h` and noise of variance `r`; the gain goes to
    /// `shared.gain`. Returns the innovation's variance; with a constant gain it is of no meaning.
    /// [`innovation_variance`](Self::innovation_variance) comes before, with the same gradient and covariance.
    pub fn update(
        &mut self,
        shared: &mut Shared,
        p: &mut UdFactors<Dyn>,
        (sensor, reading): (usize, f64),
        r: f64,
    ) -> f64 {
        match self {
            Self::Stationary(stationary) => {
                stationary.update(p, sensor, &shared.h, r, &mut shared.gain);
                return f64::NAN;
            }
            Self::MovingHorizon(horizon) => horizon.take(sensor, reading),
            Self::Unscented => {}
        }
        p.update_projected(r, &mut shared.gain)
    }

    /// The sample is not as usual: a reading is missing or was rejected.
    pub fn interrupt(&mut self, p: &mut UdFactors<Dyn>) {
        match self {
            Self::Stationary(stationary) => stationary.miss(p),
            Self::MovingHorizon(_) | Self::Unscented => {}
        }
    }

    /// A reading will be taken although the past speaks against it.
    pub fn distrust(&mut self) {
        if let Self::MovingHorizon(horizon) = self {
            horizon.clear();
        }
    }

    /// Make a moving state independent of all others, with the given variance.
    pub fn decorrelate_and_set(&mut self, p: &mut UdFactors<Dyn>, state: usize, variance: f64) {
        match self {
            Self::Stationary(stationary) => stationary.forget(p, state),
            Self::MovingHorizon(horizon) => horizon.clear(),
            Self::Unscented => {}
        }
        p.decorrelate_and_set(state, variance);
    }

    /// A constant has come nearer to where it rests, by a factor.
    pub fn relax(&mut self, p: &mut UdFactors<Dyn>, state: usize, factor: f64, rest: f64) {
        match self {
            Self::Stationary(stationary) => return stationary.relax(state, factor),
            Self::MovingHorizon(horizon) => horizon.relax(state, factor, rest),
            Self::Unscented => {}
        }
        p.scale(state, factor);
    }

    /// Add `variance` to a constant.
    pub fn inflate(&mut self, p: &mut UdFactors<Dyn>, state: usize, variance: f64) {
        match self {
            Self::Stationary(stationary) => stationary.inflate(state, variance),
            Self::MovingHorizon(horizon) => {
                horizon.inflate(state, variance);
                p.inflate(state, variance);
            }
            Self::Unscented => p.inflate(state, variance),
        }
    }

    /// The sample is complete.
    pub fn finish(&mut self, cylinder: &mut Cylinder, x: &mut [f64], p: &mut UdFactors<Dyn>) {
        match self {
            Self::Stationary(stationary) => stationary.settle(cylinder, x, p),
            Self::MovingHorizon(horizon) => horizon.refine(x, p),
            Self::Unscented => {}
        }
    }

    /// Samples at which the moving horizon could not improve on the extended filter inside it.
    pub fn fallbacks(&self) -> u64 {
        match self {
            Self::MovingHorizon(horizon) => horizon.fallbacks,
            _ => 0,
        }
    }

    /// Variance of a state, with all that is uncertain.
    pub fn variance(&self, p: &UdFactors<Dyn>, state: usize) -> f64 {
        match self {
            Self::Stationary(stationary) => stationary.variance(p, state),
            _ => p.variance(state),
        }
    }

    /// Covariance of a state with all states, with all that is uncertain: (n).
    pub fn write_column(&self, p: &UdFactors<Dyn>, state: usize, column: &mut [f64]) {
        match self {
            Self::Stationary(stationary) => stationary.write_column(p, state, column),
            _ => p.write_column(state, column),
        }
    }

    /// Covariance of all states, with all that is uncertain: (n, n).
    pub fn covariance(&self, p: &UdFactors<Dyn>) -> DMatrix<f64> {
        match self {
            Self::Stationary(stationary) => stationary.covariance(p),
            _ => p.covariance(),
        }
    }
}

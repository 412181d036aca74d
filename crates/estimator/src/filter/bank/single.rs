//! A member that moves by itself: engines that carry more than mean and covariance, or linearise in their own way.
use alloc::boxed::Box;
use nalgebra::DMatrix;

use super::engine::BankEngine;
use super::member::Member;
use super::windowed::Windowed;
use super::workspace::{SingleMemory, Workspace};
use crate::EstimatorError;
use crate::filter::gate::Outcome;
use crate::filter::plant::Plant;
use crate::filter::stationary::Stationary;
use crate::filter::step::parts;
use crate::filter::ud::UdFactors;
use crate::filter::unscented::SigmaPoints;

/// Covariance and engine of a member.
#[derive(Clone, Debug)]
pub(super) struct Single<P: Plant> {
    p: UdFactors,
    engine: Engine<P>,
}

/// An engine with its memory of the past in addition to mean and covariance.
#[derive(Clone, Debug)]
enum Engine<P: Plant> {
    Unscented,
    Stationary(Box<Stationary>),
    MovingHorizon(Box<Windowed<P>>),
}

impl<P: Plant> Single<P> {
    /// An engine at a covariance; the plant supposes what the member does.
    ///
    /// # Errors
    /// The covariance is none.
    pub(super) fn new(engine: &BankEngine, plant: &P, mut p: UdFactors) -> Result<Self, EstimatorError> {
        p.reserve(plant.leading(), plant.noises());
        let engine = match engine {
            BankEngine::Extended | BankEngine::Unscented => {
                p.reserve(plant.leading(), SigmaPoints::noises(plant));
                Engine::Unscented
            }
            BankEngine::Stationary => Engine::Stationary(Box::new(Stationary::new(plant, &mut p)?)),
            BankEngine::MovingHorizon(settings, constraints) => {
                Engine::MovingHorizon(Box::new(Windowed::new(plant, settings, constraints)))
            }
        };
        Ok(Self { p, engine })
    }

    /// Take over covariance and engine of another member; nothing is allocated for an engine without memory of its own.
    pub(super) fn copy_from(&mut self, other: &Self) {
        self.p.copy_from(&other.p);
        self.engine.clone_from(&other.engine);
    }

    /// Time update over `dt_s`, s, in steps no longer than the plant allows.
    ///
    /// # Errors
    /// The process refuses the state.
    pub(super) fn predict(
        &mut self,
        plant: &mut P,
        work: &mut Workspace,
        member: &mut Member<P::Hypothesis>,
        dt_s: f64,
    ) -> Result<(), P::Error> {
        plant.suppose(&member.hypothesis);
        let Self { p, engine } = self;
        let (parts, part_s) = parts(dt_s, plant.longest_step_s());
        if let Engine::Stationary(stationary) = engine {
            stationary.begin(p, dt_s);
        }
        let memory = work.single.get_or_insert_with(|| Box::new(SingleMemory::new(plant)));
        for _ in 0..parts {
            let linear = if let Engine::Unscented = engine {
                memory.points.predict(plant, &mut member.x, p, part_s)?;
                &memory.points.linear
            } else {
                plant.propagate(&mut member.x, part_s, Some(&mut memory.linear))?;
                match engine {
                    Engine::Stationary(stationary) => stationary.predict(&memory.linear, p),
                    _ => p.predict(&memory.linear),
                }
                &memory.linear
            };
            if let Some(record) = &mut member.record {
                record.append(&linear.phi);
            }
        }
        if let Engine::MovingHorizon(windowed) = engine {
            windowed.begin(dt_s);
        }
        Ok(())
    }

    /// Take a reading of an output.
    ///
    /// # Errors
    /// The state has no such reading.
    pub(super) fn update(
        &mut self,
        plant: &mut P,
        work: &mut Workspace,
        member: &mut Member<P::Hypothesis>,
        (output, reading): (usize, f64),
    ) -> Result<(), P::Error> {
        plant.suppose(&member.hypothesis);
        let (value, mut r) = self.expect(plant, work, &member.x, output)?;
        let nu = reading - value;
        let s = self.innovation_variance(&work.h, output, r);
        match member.judge(plant, output, (nu, s)) {
            Outcome::Rejected => {
                self.interrupt();
                return Ok(());
            }
            Outcome::Reacquired => {
                self.interrupt();
                let freed = plant.freed_by(output);
                for &(state, variance) in freed {
                    self.decorrelate_and_set(state, variance);
                    if let Some(record) = &mut member.record {
                        record.freed_by.push((output, state));
                    }
                }
                if freed.is_empty() {
                    // Whatever moved the reading, the state may follow it half of the way at most.
                    r = r.max(nu * nu);
                    if let Engine::MovingHorizon(windowed) = &mut self.engine {
                        windowed.clear();
                    }
                } else {
                    self.innovation_variance(&work.h, output, r);
                }
            }
            Outcome::Accepted | Outcome::Missing => {}
        }
        member.pulled[output] = (1.0 - r / s) * nu;
        let used_s = self.update_covariance(work, (output, reading), r);
        if let Some(record) = &mut member.record {
            record.update(output, &work.h, &work.gain, (nu, used_s));
        }
        for (x, k) in member.x.iter_mut().zip(&work.gain) {
            *x += k * nu;
        }
        Ok(())
    }

    /// Mean of an output's next reading, and variance of what the gradient does not say: noise, and curvature over the spread of the
    /// estimate. The gradient goes to the memory.
    fn expect(
        &self,
        plant: &mut P,
        work: &mut Workspace,
        x: &[f64],
        output: usize,
    ) -> Result<(f64, f64), P::Error> {
        if let Engine::Unscented = self.engine {
            let memory = work.single.get_or_insert_with(|| Box::new(SingleMemory::new(plant)));
            return memory.points.output(plant, output, x, &self.p, &mut work.h);
        }
        let value = plant.output(output, x, Some(&mut work.h))?;
        Ok((value, plant.noise_variance(output, x)))
    }

    /// Variance of the innovation of an output with the gradient `h` and noise of variance `r`.
    fn innovation_variance(&mut self, h: &[f64], output: usize, r: f64) -> f64 {
        match &mut self.engine {
            Engine::Stationary(stationary) => stationary.innovation_variance(&self.p, output, h, r),
            _ => self.p.project(h) + r,
        }
    }

    /// Update the covariance by a reading with noise of variance `r`, after its [innovation](Self::innovation_variance); the gain goes to
    /// the memory. Returns the innovation's variance; with a constant gain it is of no meaning.
    fn update_covariance(&mut self, work: &mut Workspace, (output, reading): (usize, f64), r: f64) -> f64 {
        match &mut self.engine {
            Engine::Stationary(stationary) => {
                stationary.update(&mut self.p, output, &work.h, r, &mut work.gain);
                return f64::NAN;
            }
            Engine::MovingHorizon(windowed) => windowed.take(output, reading),
            Engine::Unscented => {}
        }
        self.p.update_projected(r, &mut work.gain)
    }

    /// The sample is not as usual: a reading is missing or was rejected.
    pub(super) fn interrupt(&mut self) {
        if let Engine::Stationary(stationary) = &mut self.engine {
            stationary.miss(&mut self.p);
        }
    }

    /// The sample is complete.
    pub(super) fn finish(&mut self, plant: &mut P, member: &mut Member<P::Hypothesis>) {
        plant.suppose(&member.hypothesis);
        match &mut self.engine {
            Engine::Stationary(stationary) => stationary.settle(plant, &member.x, &self.p),
            Engine::MovingHorizon(windowed) => windowed.refine(&mut member.x, &mut self.p),
            Engine::Unscented => {}
        }
    }

    /// A constant has come closer to where it rests, by a factor.
    pub(super) fn relax(&mut self, state: usize, factor: f64, rest: f64) {
        match &mut self.engine {
            Engine::Stationary(stationary) => return stationary.relax(state, factor),
            Engine::MovingHorizon(windowed) => windowed.relax(state, factor, rest),
            Engine::Unscented => {}
        }
        self.p.scale(state, factor);
    }

    /// Add a variance to a constant.
    pub(super) fn inflate(&mut self, state: usize, variance: f64) {
        match &mut self.engine {
            Engine::Stationary(stationary) => return stationary.inflate(state, variance),
            Engine::MovingHorizon(windowed) => windowed.inflate(state, variance),
            Engine::Unscented => {}
        }
        self.p.inflate(state, variance);
    }

    /// Make a state independent of all others, with the given variance.
    pub(super) fn decorrelate_and_set(&mut self, state: usize, variance: f64) {
        match &mut self.engine {
            Engine::Stationary(stationary) => {
                return stationary.decorrelate_and_set(&mut self.p, state, variance);
            }
            Engine::MovingHorizon(windowed) => windowed.clear(),
            Engine::Unscented => {}
        }
        self.p.decorrelate_and_set(state, variance);
    }

    pub(super) fn is_finite(&self) -> bool {
        self.p.diagonal().iter().all(|d| d.is_finite())
    }

    /// Variance of a state, with all that is uncertain.
    pub(super) fn variance(&self, state: usize) -> f64 {
        match &self.engine {
            Engine::Stationary(stationary) => stationary.variance(&self.p, state),
            _ => self.p.variance(state),
        }
    }

    /// Covariance of a state with all states, with all that is uncertain: (n).
    pub(super) fn write_column(&self, state: usize, column: &mut [f64]) {
        match &self.engine {
            Engine::Stationary(stationary) => stationary.write_column(&self.p, state, column),
            _ => self.p.write_column(state, column),
        }
    }

    /// Covariance of all states, with all that is uncertain: (n, n).
    pub(super) fn covariance(&self) -> DMatrix<f64> {
        match &self.engine {
            Engine::Stationary(stationary) => stationary.covariance(&self.p),
            _ => self.p.covariance(),
        }
    }

    /// Whether the gain is that of the steady state.
    #[cfg(test)]
    pub(super) fn is_settled(&self) -> bool {
        matches!(&self.engine, Engine::Stationary(stationary) if stationary.is_settled())
    }

    /// Samples at which the moving horizon could not improve on the extended filter inside it.
    pub(super) fn fallbacks(&self) -> u64 {
        match &self.engine {
            Engine::MovingHorizon(windowed) => windowed.fallbacks,
            _ => 0,
        }
    }
}

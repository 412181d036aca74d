//! A member that moves by itself: engines that carry more than mean and covariance, or linearise in their own way.
use nalgebra::{DMatrix, Dyn};

use crate::EstimatorError;
use crate::filter::{Gate, Outcome, UdFactors};
use crate::observer::cylinder::Cylinder;
use crate::observer::engine::{Engine, Mechanism, Predicted, Shared};
use crate::observer::member::{Member, freed};

/// Covariance and engine of a member.
#[derive(Clone, Debug)]
pub(super) struct Separate {
    p: UdFactors<Dyn>,
    mechanism: Mechanism,
}

impl Separate {
    /// Take over covariance and engine of another member; nothing is allocated for an engine without memory of its own.
    pub fn copy_from(&mut self, other: &Self) {
        self.p.copy_from(&other.p);
        self.mechanism.clone_from(&other.mechanism);
    }

    /// An engine at a covariance; the cylinder supposes what the member does.
    pub fn new(
        engine: Engine,
        cylinder: &mut Cylinder,
        mut p: UdFactors<Dyn>,
    ) -> Result<Self, EstimatorError> {
        let mechanism = Mechanism::new(engine, cylinder, &mut p)?;
        Ok(Self { p, mechanism })
    }

    pub fn predict(
        &mut self,
        cylinder: &mut Cylinder,
        shared: &mut Shared,
        member: &mut Member,
        dt_s: f64,
    ) -> Result<(), EstimatorError> {
        cylinder.suppose(&member.hypothesis);
        let belief = (member.x.as_mut_slice(), &mut self.p);
        self.mechanism.predict(cylinder, shared, belief, member.pass.as_deref_mut(), dt_s)
    }

    /// Take a reading of a sensor.
    pub fn update(
        &mut self,
        cylinder: &mut Cylinder,
        shared: &mut Shared,
        member: &mut Member,
        (sensor, reading): (usize, f64),
        gate: f64,
    ) -> Result<(), EstimatorError> {
        cylinder.suppose(&member.hypothesis);
        let Self { p, mechanism } = self;
        let Predicted { value, mut r } = mechanism.expect(cylinder, shared, (&member.x, p), sensor)?;
        let nu = reading - value;
        let s = mechanism.innovation_variance(shared, p, sensor, r);
        let gate = Gate { limit: gate, rejections_in_a_row: cylinder.settings().rejections_in_a_row };
        match member.judge(sensor, (nu, s), gate) {
            Outcome::Rejected => {
                mechanism.interrupt(p);
                return Ok(());
            }
            Outcome::Reacquired => {
                mechanism.interrupt(p);
                if cylinder.reads_pressure(sensor) {
                    for (state, variance) in freed(cylinder) {
                        mechanism.decorrelate_and_set(p, state, variance);
                    }
                    if let Some(pass) = &mut member.pass {
                        pass.open(Some(sensor));
                    }
                    mechanism.innovation_variance(shared, p, sensor, r);
                } else {
                    // Whatever moved the reading, the state may follow it half of the way at most.
                    r = r.max(nu * nu);
                    mechanism.distrust();
                }
            }
            Outcome::Accepted | Outcome::Missing => {}
        }
        member.pulled[sensor] = (1.0 - r / s) * nu;
        let used_s = mechanism.update(shared, p, (sensor, reading), r);
        if let Some(pass) = &mut member.pass {
            pass.take(sensor, &shared.h, &shared.gain, (nu, used_s));
        }
        for (x, k) in member.x.iter_mut().zip(&shared.gain) {
            *x += k * nu;
        }
        Ok(())
    }

    /// The sample is not as usual: a reading is missing.
    pub fn interrupt(&mut self) {
        self.mechanism.interrupt(&mut self.p);
    }

    /// The sample is complete.
    pub fn finish(&mut self, cylinder: &mut Cylinder, member: &mut Member) {
        cylinder.suppose(&member.hypothesis);
        self.mechanism.finish(cylinder, &mut member.x, &mut self.p);
    }

    /// A constant has come nearer to where it rests, by a factor.
    pub fn relax(&mut self, state: usize, factor: f64, rest: f64) {
        self.mechanism.relax(&mut self.p, state, factor, rest);
    }

    /// Add a variance to a constant.
    pub fn inflate(&mut self, state: usize, variance: f64) {
        self.mechanism.inflate(&mut self.p, state, variance);
    }

    /// Make a moving state independent of all others, with the given variance.
    pub fn decorrelate_and_set(&mut self, state: usize, variance: f64) {
        self.mechanism.decorrelate_and_set(&mut self.p, state, variance);
    }

    pub fn is_finite(&self) -> bool {
        self.p.diagonal().iter().all(|d| d.is_finite())
    }

    pub fn variance(&self, state: usize) -> f64 {
        self.mechanism.variance(&self.p, state)
    }

    /// Covariance of a state with all states: (n).
    pub fn write_column(&self, state: usize, column: &mut [f64]) {
        self.mechanism.write_column(&self.p, state, column);
    }

    pub fn covariance(&self) -> DMatrix<f64> {
        self.mechanism.covariance(&self.p)
    }

    pub fn fallbacks(&self) -> u64 {
        self.mechanism.fallbacks()
    }

    #[cfg(test)]
    pub fn mechanism(&self) -> &Mechanism {
        &self.mechanism
    }
}

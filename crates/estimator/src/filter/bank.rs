//! A bank of filters on one [`Plant`], each with its own hypothesis, and what happens to all of them alike: gates, re-acquisition,
//! bounds, slow walks of the constants.
//!
//! Members with the extended filter move in a [`Pack`], in four lanes and mostly by one linearisation. Those with another
//! engine move one by one.
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use super::belief::Moments;
use super::gate::Innovation;
use super::lanes::Lanes;
use super::plant::Plant;
use super::record::StepRecord;
use super::ud::UdFactors;
use crate::EstimatorError;
use crate::numbers;
pub use engine::BankEngine;
use member::Members;
pub(crate) use outline::Outline;
use pack::Pack;
use single::Single;
pub use workspace::Workspace;

mod engine;
mod member;
mod outline;
mod pack;
#[cfg_attr(not(feature = "design"), path = "bank/single/none.rs")]
mod single;
#[cfg(feature = "design")]
mod windowed;
mod workspace;

/// Interval at which slow walks are added to the constants, s.
const SLOW_WALK_S: f64 = 3600.0;

/// The members of a bank with their covariances.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound(
    serialize = "P::Hypothesis: Serialize",
    deserialize = "P::Hypothesis: serde::de::DeserializeOwned"
))]
pub struct Bank<P: Plant> {
    pub(crate) members: Members<P::Hypothesis>,
    covariances: Covariances<P>,
    /// Time since slow walks were added, s.
    slow_s: f64,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound(serialize = "", deserialize = ""))]
enum Covariances<P: Plant> {
    Packs(Vec<Pack>),
    /// Engines that carry more than mean and covariance cannot be saved.
    #[serde(skip)]
    Singles(Vec<Single<P>>),
}

impl<P: Plant> Default for Bank<P> {
    fn default() -> Self {
        Self { members: Members::default(), covariances: Covariances::Packs(Vec::new()), slow_s: 0.0 }
    }
}

impl<P: Plant> Covariances<P> {
    /// Covariance of a state with all states: (n).
    fn write_column(&self, index: usize, state: usize, column: &mut [f64]) {
        match self {
            Self::Packs(packs) => {
                let (pack, lane) = place(index);
                let of = |other| packs[pack].bank.covariance_of(lane, state, other);
                column.iter_mut().zip(0..).for_each(|(with, other)| *with = of(other));
            }
            Self::Singles(all) => all[index].write_column(state, column),
        }
    }
}

impl<P: Plant> Bank<P> {
    /// Members that begin at one mean (n), each with its hypothesis and covariance (n, n).
    ///
    /// # Errors
    /// A covariance is none.
    pub fn new(
        plant: &mut P,
        engine: &BankEngine,
        mean: &[f64],
        members: &[(P::Hypothesis, DMatrix<f64>)],
    ) -> Result<Self, EstimatorError> {
        let mut bank =
            Self::with_room(plant, engine, members.iter().map(|(hypothesis, _)| hypothesis.clone()));
        let write = |index: usize, _: &P::Hypothesis, p: &mut DMatrix<f64>| p.copy_from(&members[index].1);
        bank.begin(plant, engine, mean, &mut UdFactors::zeros(mean.len()), write)?;
        Ok(bank)
    }

    /// Memory for members with these hypotheses, which have not begun.
    pub(crate) fn with_room(
        plant: &P,
        engine: &BankEngine,
        hypotheses: impl Iterator<Item = P::Hypothesis>,
    ) -> Self {
        let members = Members::new(hypotheses, plant.states(), plant.outputs());
        let covariances = if *engine == BankEngine::Extended {
            let left = |pack: usize| (members.room() - pack * Pack::SIZE).min(Pack::SIZE);
            let packs = 0..members.room().div_ceil(Pack::SIZE);
            Covariances::Packs(packs.map(|pack| Pack::new(plant, left(pack))).collect())
        } else {
            Covariances::Singles(Vec::new())
        };
        Self { members, covariances, slow_s: 0.0 }
    }

    /// Let all members begin, or begin again, at one mean (n), each with the covariance (n, n) that `write` makes for its hypothesis. Members in packs do so without allocating, with
    /// `factors` as memory.
    ///
    /// # Errors
    /// A covariance is none.
    pub(crate) fn begin(
        &mut self,
        plant: &mut P,
        engine: &BankEngine,
        mean: &[f64],
        factors: &mut UdFactors,
        write: impl Fn(usize, &P::Hypothesis, &mut DMatrix<f64>),
    ) -> Result<(), EstimatorError> {
        if let Covariances::Singles(all) = &mut self.covariances {
            all.clear();
        }
        for (index, member) in self.members.all_mut().iter_mut().enumerate() {
            factors.factorise(|p| write(index, &member.hypothesis, p))?;
            member.begin(mean);
            match &mut self.covariances {
                Covariances::Packs(packs) => {
                    let (pack, lane) = place(index);
                    packs[pack].begin(lane, factors);
                }
                Covariances::Singles(all) => {
                    plant.suppose(&member.hypothesis);
                    all.push(Single::new(engine, plant, factors.clone())?);
                }
            }
        }
        self.members.begin();
        self.slow_s = 0.0;
        Ok(())
    }

    /// There are no members until it begins again.
    pub(crate) fn forget(&mut self) {
        self.members.forget();
        self.slow_s = 0.0;
    }

    /// Become as another bank of the same plant is, without allocating where there is memory for its members; where that has memory for more, as its first ones are.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        // Before the first sample one that was saved has no members, and what it has of covariances says nothing.
        let alike = self.members.room() > 0 || other.members.is_empty();
        match (&mut self.covariances, &other.covariances) {
            (Covariances::Packs(packs), Covariances::Packs(others)) if alike => {
                self.members.copy_from(&other.members);
                packs.iter_mut().zip(others).for_each(|(to, from)| to.copy_from(from));
                self.slow_s = other.slow_s;
            }
            _ => self.clone_from(other),
        }
    }

    /// Round the covariances to single precision, of members in packs.
    pub(crate) fn round(&mut self) {
        if let Covariances::Packs(packs) = &mut self.covariances {
            packs.iter_mut().for_each(|pack| pack.bank.round(numbers::single));
        }
    }

    /// Time update over an interval, s, in steps no longer than the plant allows.
    ///
    /// # Errors
    /// The process refuses the state.
    pub fn predict(&mut self, plant: &mut P, work: &mut Workspace, dt_s: f64) -> Result<(), P::Error> {
        for record in self.members.iter_mut().filter_map(|member| member.record.as_mut()) {
            record.begin(dt_s);
        }
        match &mut self.covariances {
            Covariances::Packs(packs) => {
                for (pack, members) in packs.iter_mut().zip(self.members.chunks_mut(Pack::SIZE)) {
                    pack.predict(plant, &mut work.pack, members, dt_s)?;
                }
            }
            Covariances::Singles(all) => {
                for (single, member) in all.iter_mut().zip(self.members.iter_mut()) {
                    single.predict(plant, work, member, dt_s)?;
                }
            }
        }
        self.slow_s += dt_s;
        if self.slow_s >= SLOW_WALK_S {
            self.walk_slowly(plant);
            self.slow_s = 0.0;
        }
        Ok(())
    }

    /// Motion of the constants since the last time.
    fn walk_slowly(&mut self, plant: &P) {
        for state in plant.leading()..plant.states() {
            let process = plant.slow_process(state);
            let (factor, variance) = process.over(self.slow_s);
            if factor < 1.0 {
                for member in self.members.iter_mut() {
                    member.x[state] = process.rest + factor * (member.x[state] - process.rest);
                    if let Some(record) = &mut member.record {
                        record.relax(state, factor);
                    }
                }
                match &mut self.covariances {
                    Covariances::Packs(packs) => packs.iter_mut().for_each(|p| p.bank.scale(state, factor)),
                    Covariances::Singles(all) => {
                        all.iter_mut().for_each(|p| p.relax(state, factor, process.rest));
                    }
                }
            }
            if variance > 0.0 {
                self.inflate(state, variance);
            }
        }
    }

    /// Measurement update with one reading per output (NaN: missing), output by output.
    ///
    /// # Errors
    /// A state has no such reading.
    pub fn update(&mut self, plant: &mut P, work: &mut Workspace, readings: &[f64]) -> Result<(), P::Error> {
        self.members.iter_mut().for_each(|member| member.pulled.fill(0.0));
        for (output, &reading) in readings.iter().enumerate() {
            if reading.is_finite() {
                self.update_by(plant, work, (output, reading))?;
                continue;
            }
            self.members.iter_mut().for_each(|member| member.innovations[output] = Innovation::MISSING);
            if let Covariances::Singles(all) = &mut self.covariances {
                all.iter_mut().for_each(Single::interrupt);
            }
        }
        if let Covariances::Singles(all) = &mut self.covariances {
            all.iter_mut().zip(self.members.iter_mut()).for_each(|(one, member)| one.finish(plant, member));
        }
        for (index, member) in self.members.iter_mut().enumerate() {
            let write =
                |state: usize, column: &mut [f64]| self.covariances.write_column(index, state, column);
            member.bound(plant, write, &mut work.gain);
        }
        Ok(())
    }

    /// Innovation that a reading would be for the first member, and its variance; of members in packs.
    ///
    /// # Errors
    /// As [`update`](Self::update).
    pub(crate) fn innovation_of_first(
        &mut self,
        plant: &mut P,
        work: &mut Workspace,
        reading: (usize, f64),
    ) -> Result<(f64, f64), P::Error> {
        match (&mut self.covariances, self.members.first()) {
            (Covariances::Packs(packs), Some(first)) => {
                packs[0].innovation_of(plant, (&mut work.pack, &mut work.h), first, reading)
            }
            _ => Ok((0.0, 1.0)),
        }
    }

    fn update_by(
        &mut self,
        plant: &mut P,
        work: &mut Workspace,
        reading: (usize, f64),
    ) -> Result<(), P::Error> {
        match &mut self.covariances {
            Covariances::Packs(packs) => {
                packs.iter_mut().zip(self.members.chunks_mut(Pack::SIZE)).try_for_each(|(pack, members)| {
                    pack.update(plant, (&mut work.pack, &mut work.h), members, reading)
                })
            }
            Covariances::Singles(all) => all
                .iter_mut()
                .zip(self.members.iter_mut())
                .try_for_each(|(one, member)| one.update(plant, work, member, reading)),
        }
    }

    /// Let a member become as another one in mean and covariance; its hypothesis stays.
    pub(crate) fn replace(&mut self, index: usize, from: usize) {
        let Ok([member, other]) = self.members.get_disjoint_mut([index, from]) else { return };
        member.x.clone_from(&other.x);
        if let Some(record) = &mut member.record {
            record.replaced = true;
        }
        match &mut self.covariances {
            Covariances::Packs(packs) => {
                let ((from, from_lane), (to, to_lane)) = (place(from), place(index));
                if from == to {
                    packs[to].bank.copy_lane(from_lane, to_lane);
                } else if let Ok([from, to]) = packs.get_disjoint_mut([from, to]) {
                    to.bank.copy_lane_of(&from.bank, from_lane, to_lane);
                }
            }
            Covariances::Singles(all) => {
                if let Ok([from, to]) = all.get_disjoint_mut([from, index]) {
                    to.copy_from(from);
                }
            }
        }
    }

    /// Add a variance to a state of every member.
    pub(crate) fn inflate(&mut self, state: usize, variance: f64) {
        match &mut self.covariances {
            Covariances::Packs(packs) => {
                packs.iter_mut().for_each(|p| p.bank.inflate(state, Lanes::splat(variance)));
            }
            Covariances::Singles(all) => all.iter_mut().for_each(|p| p.inflate(state, variance)),
        }
    }

    /// Set a state of a member, independent of all others.
    pub fn set(&mut self, index: usize, state: usize, mean: f64, variance: f64) {
        self.members[index].x[state] = mean;
        self.set_variance(index, state, variance);
    }

    /// Make a state of a member independent of all others, with the given variance; its mean stays.
    pub(crate) fn set_variance(&mut self, index: usize, state: usize, variance: f64) {
        match &mut self.covariances {
            Covariances::Packs(packs) => {
                let (pack, lane) = place(index);
                packs[pack].bank.decorrelate_and_set(lane, state, variance);
            }
            Covariances::Singles(all) => all[index].decorrelate_and_set(state, variance),
        }
    }

    /// Free states of a member of everything known about them, before the readings of a sample: states with their variances.
    pub(crate) fn free(&mut self, index: usize, states: impl IntoIterator<Item = (usize, f64)>) {
        for (state, variance) in states {
            self.set_variance(index, state, variance);
            if let Some(record) = &mut self.members[index].record {
                record.freed.push(state);
            }
        }
    }

    /// Make room for the last step of a member, which is recorded from then on.
    pub(crate) fn record_steps(&mut self, index: usize, plant: &P) {
        if let Some(member) = self.members.all_mut().get_mut(index) {
            member.recorded(plant.leading());
        }
    }

    /// Shift a state of every member.
    pub(crate) fn shift(&mut self, state: usize, by: f64) {
        self.members.iter_mut().for_each(|member| member.x[state] += by);
    }

    /// Whether mean and covariance of a member are made of numbers, and its mean is a possible state of the plant.
    pub(crate) fn is_possible(&self, index: usize, plant: &P) -> bool {
        let finite = match &self.covariances {
            Covariances::Packs(packs) => packs[place(index).0].bank.is_finite(),
            Covariances::Singles(all) => all[index].is_finite(),
        };
        let x = &self.members[index].x;
        finite && x.iter().sum::<f64>().is_finite() && plant.is_possible(x)
    }

    /// Mean of a member: (n).
    pub fn mean(&self, index: usize) -> DVector<f64> {
        self.members[index].mean()
    }

    /// Innovation of each output at the last sample, by one member.
    pub fn innovations(&self, index: usize) -> &[Innovation] {
        &self.members[index].innovations
    }

    /// Variance of a state.
    pub(crate) fn variance(&self, index: usize, state: usize) -> f64 {
        match &self.covariances {
            Covariances::Packs(packs) => {
                let (pack, lane) = place(index);
                packs[pack].bank.variance(lane, state)
            }
            Covariances::Singles(all) => all[index].variance(state),
        }
    }

    /// Mean and variance of a state.
    pub fn moments(&self, index: usize, state: usize) -> Moments {
        (self.members[index].x[state], self.variance(index, state))
    }

    /// Covariance of two states.
    pub(crate) fn covariance_of(&self, index: usize, i: usize, j: usize) -> f64 {
        match &self.covariances {
            Covariances::Packs(packs) => {
                let (pack, lane) = place(index);
                packs[pack].bank.covariance_of(lane, i, j)
            }
            Covariances::Singles(all) => all[index].covariance()[(i, j)],
        }
    }

    /// Whether it is a bank of this plant, whose members have these hypotheses.
    pub(crate) fn is_like(&self, plant: &P, hypotheses: &[P::Hypothesis]) -> bool {
        // Before the first sample there are no members.
        let begun = !self.members.is_empty();
        let members = self.members.iter().zip(hypotheses).all(|(member, hypothesis)| {
            let sizes = member.x.len() == plant.states() && member.has_outputs(plant.outputs());
            member.hypothesis == *hypothesis && sizes
        });
        let packs = match &self.covariances {
            Covariances::Packs(packs) => {
                let of_packs = hypotheses.chunks(Pack::SIZE).map(<[_]>::len);
                (packs.len() == of_packs.len() || !begun)
                    && packs.iter().zip(of_packs).all(|(pack, members)| pack.is_like(plant, members))
            }
            Covariances::Singles(_) => !begun,
        };
        members && packs && (self.members.len() == hypotheses.len() || !begun)
    }

    /// Mean and variance of a state, member by member.
    pub(crate) fn write_moments(&self, state: usize, moments: &mut Vec<Moments>) {
        moments.clear();
        match &self.covariances {
            Covariances::Packs(packs) => {
                for (pack, members) in packs.iter().zip(self.members.chunks(Pack::SIZE)) {
                    let variances = pack.bank.variances(state);
                    moments.extend(
                        members.iter().zip(variances.0).map(|(of, variance)| (of.x[state], variance)),
                    );
                }
            }
            Covariances::Singles(all) => {
                moments
                    .extend(self.members.iter().zip(all).map(|(of, own)| (of.x[state], own.variance(state))));
            }
        }
    }

    /// Covariance of all states: (n, n).
    pub fn covariance(&self, index: usize) -> DMatrix<f64> {
        let n = self.members[index].x.len();
        let mut p = DMatrix::zeros(n, n);
        self.covariance_into(index, &mut p);
        p
    }

    /// The same, into a matrix of that size.
    fn covariance_into(&self, index: usize, p: &mut DMatrix<f64>) {
        match &self.covariances {
            Covariances::Packs(packs) => {
                let (pack, lane) = place(index);
                packs[pack].bank.covariance_into(lane, p);
            }
            Covariances::Singles(all) => p.copy_from(&all[index].covariance()),
        }
    }

    /// Record of a member's last step, for a [smoother](super::smooth); from the first call on its steps are recorded.
    ///
    /// Where the estimate began, or began again, no step leads there: forget the record before.
    pub fn record(&mut self, index: usize, plant: &P) -> StepRecord {
        let member = &mut self.members[index];
        let record = member.recorded(plant.leading());
        let mut copy = record.clone();
        // A sample at the same time has no interval of its own.
        record.begin(0.0);
        copy.x = member.mean();
        copy.p = self.covariance(index);
        copy
    }

    /// Whether the gain of a member is that of the steady state.
    #[cfg(test)]
    pub(crate) fn is_settled(&self, index: usize) -> bool {
        match &self.covariances {
            Covariances::Packs(_) => false,
            Covariances::Singles(all) => all[index].is_settled(),
        }
    }

    /// Samples at which a moving horizon found no solution inside its constraints, of all members.
    pub fn fallbacks(&self) -> u64 {
        match &self.covariances {
            Covariances::Packs(_) => 0,
            Covariances::Singles(all) => all.iter().map(Single::fallbacks).sum(),
        }
    }
}

/// Pack and lane of a member.
fn place(index: usize) -> (usize, usize) {
    (index / Pack::SIZE, index % Pack::SIZE)
}

#[cfg(test)]
mod tests;

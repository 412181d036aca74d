//! The members of the bank with their covariances, and what happens to all of them alike: gates, re-acquisition, events, bounds, slow
//! walks of the constants.
//!
//! Members with the extended filter move [`together`](Together), in four lanes and mostly by one linearisation. Those with another
//! engine move one by one.
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use super::belief::Moments;
use super::cylinder::Cylinder;
use super::engine::{Engine, Shared};
use super::member::{Member, freed};
use super::settings::LeakHypothesis;
use crate::EstimatorError;
use crate::filter::lanes::Lanes;
use crate::filter::{Innovation, StateSpace, UdFactors};
use crate::numbers;
use separate::Separate;
use together::Together;

mod outline;
mod separate;
mod together;

pub(super) use outline::Outline;
pub(super) use together::Memory;

/// Interval at which slow walks are added to the constants, s.
const SLOW_WALK_S: f64 = 3600.0;

/// The members in the order of the settings.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct Bank {
    pub members: Vec<Member>,
    covariances: Covariances,
    /// Time since slow walks were added, s.
    slow_s: f64,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
enum Covariances {
    Together(Vec<Together>),
    /// Engines that carry more than mean and covariance cannot be saved.
    #[serde(skip)]
    Separate(Vec<Separate>),
}

/// Innovations beyond which a reading is refused, in variances.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gates {
    /// Of every reading.
    pub all: f64,
    /// Of a pressure where gas may flow: beyond it gas has.
    pub flow: f64,
}

impl Default for Covariances {
    fn default() -> Self {
        Self::Together(Vec::new())
    }
}

impl Covariances {
    /// Covariance of a state with all states: (n).
    fn write_column(&self, index: usize, state: usize, column: &mut [f64]) {
        match self {
            Self::Together(packs) => {
                let (pack, lane) = place(index);
                let of = |other| packs[pack].bank.covariance_of(lane, state, other);
                column.iter_mut().zip(0..).for_each(|(with, other)| *with = of(other));
            }
            Self::Separate(all) => all[index].write_column(state, column),
        }
    }
}

impl Bank {
    /// Members that start at one mean and covariance, but for the leak rate, of which each has its own prior.
    ///
    /// # Errors
    /// The covariance is none.
    pub fn new(
        cylinder: &mut Cylinder,
        mean: &[f64],
        covariance: &DMatrix<f64>,
    ) -> Result<Self, EstimatorError> {
        let settings = cylinder.settings();
        let (bank, engine) = (settings.bank.clone(), settings.engine);
        let leak = cylinder.state_map().leak;
        let factors = |hypothesis: &LeakHypothesis| {
            let mut covariance = covariance.clone();
            covariance.row_mut(leak).fill(0.0);
            covariance.column_mut(leak).fill(0.0);
            covariance[(leak, leak)] = hypothesis.rate.prior_sd.powi(2);
            UdFactors::from_covariance(&covariance)
        };
        let factors = bank.iter().map(factors).collect::<Result<Vec<_>, _>>()?;
        let covariances = if engine == Engine::Extended {
            Covariances::Together(
                factors.chunks(Together::SIZE).map(|some| Together::new(cylinder, some)).collect(),
            )
        } else {
            let one = |(hypothesis, p): (&LeakHypothesis, UdFactors<_>)| {
                cylinder.suppose(hypothesis);
                Separate::new(engine, cylinder, p)
            };
            Covariances::Separate(bank.iter().zip(factors).map(one).collect::<Result<_, _>>()?)
        };
        let sensors = cylinder.outputs();
        let members = bank.into_iter().map(|hypothesis| Member::new(hypothesis, mean, sensors)).collect();
        Ok(Self { members, covariances, slow_s: 0.0 })
    }

    /// Become as another bank is, without allocating where that has the same members.
    pub fn copy_from(&mut self, other: &Self) {
        let alike = self.members.len() == other.members.len();
        match (&mut self.covariances, &other.covariances) {
            (Covariances::Together(packs), Covariances::Together(others)) if alike => {
                self.members.iter_mut().zip(&other.members).for_each(|(to, from)| to.copy_from(from));
                packs.iter_mut().zip(others).for_each(|(to, from)| to.copy_from(from));
                self.slow_s = other.slow_s;
            }
            _ => self.clone_from(other),
        }
    }

    /// Round the covariances to single precision, of members that move together.
    pub fn round(&mut self) {
        if let Covariances::Together(packs) = &mut self.covariances {
            packs.iter_mut().for_each(|pack| pack.bank.round(numbers::single));
        }
    }

    /// Time update over an interval, in steps no longer than the settings allow.
    ///
    /// # Errors
    /// The process refuses the state.
    pub fn predict(
        &mut self,
        cylinder: &mut Cylinder,
        shared: &mut Shared,
        dt_s: f64,
    ) -> Result<(), EstimatorError> {
        for pass in self.members.iter_mut().filter_map(|member| member.pass.as_mut()) {
            pass.begin(dt_s);
        }
        match &mut self.covariances {
            Covariances::Together(packs) => {
                for (pack, members) in packs.iter_mut().zip(self.members.chunks_mut(Together::SIZE)) {
                    pack.predict(cylinder, shared, members, dt_s)?;
                }
            }
            Covariances::Separate(all) => {
                for (separate, member) in all.iter_mut().zip(&mut self.members) {
                    separate.predict(cylinder, shared, member, dt_s)?;
                }
            }
        }
        self.slow_s += dt_s;
        if self.slow_s >= SLOW_WALK_S {
            self.walk_slowly(cylinder);
            self.slow_s = 0.0;
        }
        Ok(())
    }

    /// Motion of the constants since the last time.
    fn walk_slowly(&mut self, cylinder: &Cylinder) {
        for state in cylinder.leading()..cylinder.states() {
            let process = cylinder.slow_process(state);
            let (factor, variance) = process.over(self.slow_s);
            if factor < 1.0 {
                for member in &mut self.members {
                    member.x[state] = process.rest + factor * (member.x[state] - process.rest);
                    if let Some(pass) = &mut member.pass {
                        pass.relax(state, factor);
                    }
                }
                match &mut self.covariances {
                    Covariances::Together(packs) => {
                        packs.iter_mut().for_each(|p| p.bank.scale(state, factor))
                    }
                    Covariances::Separate(all) => {
                        all.iter_mut().for_each(|p| p.relax(state, factor, process.rest));
                    }
                }
            }
            if variance > 0.0 {
                self.inflate(state, variance);
            }
        }
    }

    /// Measurement update with one reading per sensor (NaN: missing), sensor by sensor.
    ///
    /// # Errors
    /// A state has no such reading.
    pub fn update(
        &mut self,
        cylinder: &mut Cylinder,
        shared: &mut Shared,
        readings: &[f64],
        gates: Gates,
    ) -> Result<(), EstimatorError> {
        self.members.iter_mut().for_each(|member| member.pulled.fill(0.0));
        for (sensor, &reading) in readings.iter().enumerate() {
            if reading.is_finite() {
                self.take(cylinder, shared, (sensor, reading), gates)?;
                continue;
            }
            self.members.iter_mut().for_each(|member| member.innovations[sensor] = Innovation::MISSING);
            if let Covariances::Separate(all) = &mut self.covariances {
                all.iter_mut().for_each(Separate::interrupt);
            }
        }
        if let Covariances::Separate(all) = &mut self.covariances {
            all.iter_mut().zip(&mut self.members).for_each(|(one, member)| one.finish(cylinder, member));
        }
        for index in 0..self.members.len() {
            let covariances = &self.covariances;
            let write = |state: usize, column: &mut [f64]| covariances.write_column(index, state, column);
            self.members[index].bound(cylinder, write, &mut shared.gain);
        }
        Ok(())
    }

    /// Innovation that a reading would be for the first member, and its variance; of members that move together.
    ///
    /// # Errors
    /// As [`update`](Self::update).
    pub fn foresee(
        &mut self,
        cylinder: &mut Cylinder,
        shared: &mut Shared,
        reading: (usize, f64),
    ) -> Result<(f64, f64), EstimatorError> {
        match (&mut self.covariances, self.members.first()) {
            (Covariances::Together(packs), Some(first)) => packs[0].foresee(cylinder, shared, first, reading),
            _ => Ok((0.0, 1.0)),
        }
    }

    fn take(
        &mut self,
        cylinder: &mut Cylinder,
        shared: &mut Shared,
        reading: (usize, f64),
        gates: Gates,
    ) -> Result<(), EstimatorError> {
        match &mut self.covariances {
            Covariances::Together(packs) => packs
                .iter_mut()
                .zip(self.members.chunks_mut(Together::SIZE))
                .try_for_each(|(pack, members)| pack.update(cylinder, shared, members, reading, gates)),
            Covariances::Separate(all) => all
                .iter_mut()
                .zip(&mut self.members)
                .try_for_each(|(one, member)| one.update(cylinder, shared, member, reading, gates.all)),
        }
    }

    /// Let a member begin anew with all that another one knows. Where that is less mass than supposed, a leak rate that may walk
    /// may be anything then; more mass is no leak, but tells that one was supposed in vain.
    pub fn begin_anew(&mut self, index: usize, from: usize, cylinder: &Cylinder) {
        let (mass, leak) = (cylinder.state_map().mass, cylinder.state_map().leak);
        let any_leak_sd_kg_s = cylinder.settings().any_leak_sd_kg_s;
        let Ok([member, other]) = self.members.get_disjoint_mut([index, from]) else { return };
        let lost = other.x[mass] < member.x[mass];
        member.x.clone_from(&other.x);
        member.x[leak] = 0.0;
        if let Some(pass) = &mut member.pass {
            pass.begin_anew();
        }
        let sd_kg_s = if lost && !member.hypothesis.rate.is_known() { any_leak_sd_kg_s } else { 0.0 };
        self.copy_covariance(from, index);
        self.decorrelate_and_set(index, leak, sd_kg_s * sd_kg_s);
    }

    fn copy_covariance(&mut self, from: usize, to: usize) {
        match &mut self.covariances {
            Covariances::Together(packs) => {
                let ((from, from_lane), (to, to_lane)) = (place(from), place(to));
                if from == to {
                    packs[to].bank.copy_lane(from_lane, to_lane);
                } else if let Ok([from, to]) = packs.get_disjoint_mut([from, to]) {
                    to.bank.copy_lane_of(&from.bank, from_lane, to_lane);
                }
            }
            Covariances::Separate(all) => {
                if let Ok([from, to]) = all.get_disjoint_mut([from, to]) {
                    to.copy_from(from);
                }
            }
        }
    }

    /// Add a variance to a constant of every member.
    pub fn inflate(&mut self, state: usize, variance: f64) {
        match &mut self.covariances {
            Covariances::Together(packs) => {
                packs.iter_mut().for_each(|p| p.bank.inflate(state, Lanes::splat(variance)));
            }
            Covariances::Separate(all) => all.iter_mut().for_each(|p| p.inflate(state, variance)),
        }
    }

    /// Let a constant of every member be as it was before the first sample.
    pub fn forget(&mut self, state: usize, mean: f64, variance: f64) {
        for index in 0..self.members.len() {
            self.members[index].x[state] = mean;
            self.decorrelate_and_set(index, state, variance);
        }
    }

    fn decorrelate_and_set(&mut self, index: usize, state: usize, variance: f64) {
        match &mut self.covariances {
            Covariances::Together(packs) => {
                let (pack, lane) = place(index);
                packs[pack].bank.decorrelate_and_set(lane, state, variance);
            }
            Covariances::Separate(all) => all[index].decorrelate_and_set(state, variance),
        }
    }

    /// Shift a state of every member.
    pub fn shift(&mut self, state: usize, by: f64) {
        self.members.iter_mut().for_each(|member| member.x[state] += by);
    }

    /// Free the rate of a member of everything known about it, to a standard deviation, kg/s.
    pub fn free_the_rate(&mut self, index: usize, cylinder: &Cylinder, sd_kg_s: f64) {
        self.decorrelate_and_set(index, cylinder.state_map().leak, sd_kg_s * sd_kg_s);
    }

    /// Free mass and gas temperature of everything known about them, and forget the leak rate. A member whose gas may flow knows better.
    pub fn open(&mut self, cylinder: &Cylinder) {
        let leak = cylinder.state_map().leak;
        for index in 0..self.members.len() {
            if self.members[index].hypothesis.is_flowing() {
                continue;
            }
            self.members[index].x[leak] = 0.0;
            let prior_sd_kg_s = self.members[index].hypothesis.rate.prior_sd;
            self.decorrelate_and_set(index, leak, prior_sd_kg_s * prior_sd_kg_s);
            for (state, variance) in freed(cylinder) {
                self.decorrelate_and_set(index, state, variance);
            }
            if let Some(pass) = &mut self.members[index].pass {
                pass.open(None);
            }
        }
    }

    /// Whether mean and covariance of a member are made of numbers, and the mean a state of the cylinder.
    pub fn is_possible(&self, index: usize, cylinder: &Cylinder) -> bool {
        let finite = match &self.covariances {
            Covariances::Together(packs) => packs[place(index).0].bank.is_finite(),
            Covariances::Separate(all) => all[index].is_finite(),
        };
        let x = &self.members[index].x;
        finite && x.iter().sum::<f64>().is_finite() && cylinder.is_possible(x)
    }

    /// Variance of a state.
    pub fn variance(&self, index: usize, state: usize) -> f64 {
        match &self.covariances {
            Covariances::Together(packs) => {
                let (pack, lane) = place(index);
                packs[pack].bank.variance(lane, state)
            }
            Covariances::Separate(all) => all[index].variance(state),
        }
    }

    /// Mean and variance of a state.
    pub fn moments(&self, index: usize, state: usize) -> Moments {
        (self.members[index].x[state], self.variance(index, state))
    }

    /// Covariance of two states.
    pub fn covariance_of(&self, index: usize, i: usize, j: usize) -> f64 {
        match &self.covariances {
            Covariances::Together(packs) => {
                let (pack, lane) = place(index);
                packs[pack].bank.covariance_of(lane, i, j)
            }
            Covariances::Separate(all) => all[index].covariance()[(i, j)],
        }
    }

    /// Whether it has members and sensors as another one, and covariances of so many states.
    pub fn is_like(&self, hypotheses: &[LeakHypothesis], states: usize, sensors: usize) -> bool {
        let members = self.members.iter().zip(hypotheses).all(|(member, hypothesis)| {
            member.hypothesis == *hypothesis && member.x.len() == states && member.has_sensors(sensors)
        });
        let packs = match &self.covariances {
            Covariances::Together(packs) => {
                packs.len() == hypotheses.len().div_ceil(Together::SIZE)
                    && packs.iter().all(|pack| pack.bank.states() == states)
            }
            Covariances::Separate(_) => false,
        };
        // Before the first sample there are none.
        self.members.is_empty() || (members && packs && self.members.len() == hypotheses.len())
    }

    /// Mean and variance of a state, member by member.
    pub fn write_moments(&self, state: usize, moments: &mut Vec<Moments>) {
        moments.clear();
        match &self.covariances {
            Covariances::Together(packs) => {
                for (pack, members) in packs.iter().zip(self.members.chunks(Together::SIZE)) {
                    let variances = pack.bank.variances(state);
                    moments.extend(
                        members.iter().zip(variances.0).map(|(of, variance)| (of.x[state], variance)),
                    );
                }
            }
            Covariances::Separate(all) => {
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
    pub fn covariance_into(&self, index: usize, p: &mut DMatrix<f64>) {
        match &self.covariances {
            Covariances::Together(packs) => {
                let (pack, lane) = place(index);
                packs[pack].bank.covariance_into(lane, p);
            }
            Covariances::Separate(all) => p.copy_from(&all[index].covariance()),
        }
    }

    /// The engine of a member that moves by itself.
    #[cfg(test)]
    pub fn mechanism(&self, index: usize) -> Option<&super::engine::Mechanism> {
        match &self.covariances {
            Covariances::Together(_) => None,
            Covariances::Separate(all) => all.get(index).map(Separate::mechanism),
        }
    }

    /// Samples at which an engine could not do its own and fell back on the extended filter inside it.
    pub fn fallbacks(&self) -> u64 {
        match &self.covariances {
            Covariances::Together(_) => 0,
            Covariances::Separate(all) => all.iter().map(Separate::fallbacks).sum(),
        }
    }
}

/// Pack and lane of a member.
fn place(index: usize) -> (usize, usize) {
    (index / Together::SIZE, index % Together::SIZE)
}

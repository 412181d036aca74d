//! Estimates given the samples before and after them.
//!
//! The observer's pass is recorded, sample by sample, and smoothed backwards (modified Bryson-Frazier recursion of
//! [`crate::filter::smooth`]): the first member gives the mass, the middle slow one leak rate and gas temperature, and the freest
//! one takes part with the weight that the filter gave it.
//!
//! A year of samples does not fit into memory, so the record has room for a number of rows, by default [`ROWS`]. A log of
//! no more rows is smoothed over its whole length. When the record is full, it is smoothed from the newest row back, the older
//! half is handed out, each row with at least half the record of later samples, and the newer half stays. Later samples count
//! less and less: what matters is whether half the record is longer than the filter's memory of the mass, some hours.
//!
//! Where gas was exchanged, later samples say nothing about the mass before, and earlier ones nothing about that after. A
//! restart of the estimate ends one record and begins another.
use alloc::collections::VecDeque;
use alloc::vec::Vec;

use super::engine::Engine;
use super::{Estimate, Observer, Quality};
use crate::EstimatorError;
use crate::filter::{Backward, Belief, Smoothed, StateSpace, StepRecord};

/// Rows of the record by default: at 18 states and three members some 120 MB; 23 hours at 10 s, 5.7 days at a minute.
pub(super) const ROWS: usize = 8192;

/// An observer whose estimates are smoothed.
///
/// Rows go in one after the other ([`push`](Self::push)) and come out in the same order, later, each exactly once; the rest
/// comes at the [end](Self::finish).
#[derive(Debug)]
pub struct Smoother {
    observer: Observer,
    rows: usize,
    record: VecDeque<Row>,
    /// Indices of the members that are recorded.
    members: Vec<usize>,
    backward: Vec<Backward>,
    smoothed: Vec<Smoothed>,
}

/// One sample as the filter saw it.
#[derive(Debug)]
struct Row {
    estimate: Estimate,
    reference_kg: Option<f64>,
    /// Weight of the first member in the mass, and of the thermometer in the gas temperature, against the freest.
    beliefs: (Belief, Belief),
    passes: Vec<StepRecord>,
}

impl Smoother {
    /// Smooth the estimates of an observer that has not begun, with room for 8192 rows: some 75 MB, 23 hours at 10 s or 5.7 days at
    /// a minute. A longer log is smoothed block by block, each row with at least half the room of later rows.
    ///
    /// # Errors
    /// Its engine has not the gains of its covariance (it is extended or unscented), or it has taken samples.
    pub fn new(observer: Observer) -> Result<Self, EstimatorError> {
        Self::with_rows(observer, ROWS)
    }

    /// The same with room for so many rows, at least 2.
    ///
    /// # Errors
    /// As [`new`](Self::new), or there is no room.
    pub fn with_rows(observer: Observer, rows: usize) -> Result<Self, EstimatorError> {
        let engine: Engine = observer.cylinder.settings().engine;
        if !engine.can_be_smoothed() {
            return Err(EstimatorError::EngineNotSmoothed);
        }
        if rows < 2 {
            return Err(EstimatorError::SmootherRows { rows });
        }
        if observer.clock.time_s.is_some() {
            return Err(EstimatorError::ObserverBegun);
        }
        // Later rows tell what a rate of minutes tells, and better.
        let observer = observer.without_flow();
        let n = observer.cylinder.states();
        let mut members = vec![0];
        for index in observer.roles.slow.into_iter().chain([observer.roles.freest]) {
            if !members.contains(&index) {
                members.push(index);
            }
        }
        let zeros = Smoothed { x: nalgebra::DVector::zeros(n), p: nalgebra::DMatrix::zeros(n, n) };
        Ok(Self {
            rows,
            record: VecDeque::new(),
            backward: vec![Backward::new(n); members.len()],
            smoothed: vec![zeros; members.len()],
            members,
            observer,
        })
    }

    /// The observer, as it is after the last row.
    pub fn observer(&self) -> &Observer {
        &self.observer
    }

    /// As [`Observer::begin_exchange`].
    pub fn begin_exchange(&mut self) {
        self.observer.begin_exchange();
    }

    /// As [`Observer::end_exchange`].
    pub fn end_exchange(&mut self) {
        self.observer.end_exchange();
    }

    /// Take in a row of readings; the smoothed estimates that are final now, mostly none.
    ///
    /// # Errors
    /// As [`Observer::step`].
    pub fn push(&mut self, time_s: f64, readings: &[f64]) -> Result<Vec<Estimate>, EstimatorError> {
        let estimate = self.observer.step(time_s, readings)?;
        let restarted = self.record.is_empty() || estimate.quality == Quality::Restarted;
        let out = if restarted { self.smooth(self.record.len()) } else { Vec::new() };
        let row = self.row(estimate, restarted);
        self.record.push_back(row);
        if self.record.len() < self.rows {
            return Ok(out);
        }
        let mut out = out;
        out.extend(self.smooth(self.record.len() / 2));
        Ok(out)
    }

    /// The estimates that are left.
    pub fn finish(mut self) -> Vec<Estimate> {
        self.smooth(self.record.len())
    }

    /// The observer after the last row, and the estimates that are left.
    pub fn into_parts(mut self) -> (Observer, Vec<Estimate>) {
        let rest = self.smooth(self.record.len());
        (self.observer, rest)
    }

    /// Record the last step of the observer; after a restart there is no step that leads there.
    fn row(&mut self, estimate: Estimate, restarted: bool) -> Row {
        let Observer { bank, cylinder, .. } = &mut self.observer;
        let record = |&index: &usize| {
            if restarted {
                bank.members[index].record = None;
            }
            bank.record(index, cylinder)
        };
        let passes = self.members.iter().map(record).collect();
        let Roles { first, thermometer, .. } = self.roles();
        let belief = |role: usize| self.observer.belief(self.members[role]);
        let beliefs = (belief(first), belief(thermometer));
        Row { estimate, reference_kg: self.observer.clock.reference_mass_kg, beliefs, passes }
    }

    /// Where the members stand among the recorded ones; the slow one is the first where there is none.
    fn roles(&self) -> Roles {
        let place = |index: usize| self.members.iter().position(|&member| member == index).unwrap_or(0);
        let observer = &self.observer;
        Roles {
            first: 0,
            thermometer: place(observer.roles.thermometer),
            slow: observer.roles.slow.map_or(0, place),
            freest: place(observer.roles.freest),
        }
    }

    /// Smooth the whole record and hand out the oldest `count` rows.
    fn smooth(&mut self, count: usize) -> Vec<Estimate> {
        self.backward.iter_mut().for_each(Backward::clear);
        let mut out = Vec::with_capacity(count);
        for index in (0..self.record.len()).rev() {
            if index < count {
                let estimate = self.smoothed_estimate(index);
                out.push(estimate);
            }
            for (pass, backward) in self.record[index].passes.iter().zip(&mut self.backward) {
                backward.pass_step(pass);
            }
        }
        out.reverse();
        self.record.drain(..count);
        out
    }

    /// Where the smoothed state is none of a cylinder, the estimate is that of the filter.
    fn smoothed_estimate(&mut self, index: usize) -> Estimate {
        let row = &self.record[index];
        for ((pass, backward), smoothed) in row.passes.iter().zip(&mut self.backward).zip(&mut self.smoothed)
        {
            backward.estimate(pass, smoothed);
        }
        let (filtered, reference_kg, beliefs) = (row.estimate, row.reference_kg, row.beliefs);
        let Roles { first, thermometer, slow, freest } = self.roles();
        let learnt = &row.passes[thermometer].p;
        let states = self.observer.cylinder.state_map();
        let (gas, mass, leak) = (states.gas, states.mass, states.leak);
        let [first, thermometer, slow, freest] =
            [first, thermometer, slow, freest].map(|role| &self.smoothed[role]);
        let of = |smoothed: &Smoothed, state: usize| (smoothed.x[state], smoothed.p[(state, state)].max(0.0));
        let (mass_kg, mass_variance_kg2) = beliefs.0.blend(of(first, mass), of(freest, mass));
        let (gas_mean_k, gas_variance_k2) = beliefs.1.blend(of(thermometer, gas), of(freest, gas));
        // What the filter had learnt at this row: with what later rows tell too, more of them could widen the band.
        let gas_variance_k2 = self.observer.band.stated_k2(gas_variance_k2, |state| learnt[(state, state)]);
        let mut estimate = Estimate {
            gas_mean_k,
            gas_mean_sd_k: libm::sqrt(gas_variance_k2),
            mass_kg,
            mass_sd_kg: libm::sqrt(mass_variance_kg2),
            ..filtered
        };
        if !filtered.leak_kg_s.is_nan() {
            let (leak_kg_s, variance) = of(slow, leak);
            (estimate.leak_kg_s, estimate.leak_sd_kg_s) = (leak_kg_s, libm::sqrt(variance));
        }
        self.observer.reference_x.copy_from_slice(first.x.as_slice());
        match self.observer.add_pressures(&mut estimate, reference_kg) {
            Ok(()) => estimate,
            Err(_) => filtered,
        }
    }
}

/// Places among the recorded members.
struct Roles {
    first: usize,
    thermometer: usize,
    slow: usize,
    freest: usize,
}

#[cfg(test)]
mod tests;

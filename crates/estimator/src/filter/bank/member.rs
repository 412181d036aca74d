//! One member of a bank: an estimate with its own hypothesis, and what it made of the readings.
use alloc::boxed::Box;
use alloc::vec::Vec;
use core::ops::{Deref, DerefMut};
use nalgebra::DVector;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::filter::gate::{Innovation, Outcome};
use crate::filter::kernel::axpy;
use crate::filter::plant::Plant;
use crate::filter::record::StepRecord;
use crate::numbers;

/// The members of a bank. Before it begins there are none, though the memory for them may be there.
#[derive(Clone, Debug)]
pub(crate) struct Members<H> {
    all: Vec<Member<H>>,
    begun: bool,
}

impl<H: Clone> Members<H> {
    /// Memory for members with these hypotheses.
    pub(crate) fn new(hypotheses: impl Iterator<Item = H>, states: usize, outputs: usize) -> Self {
        let all = hypotheses.map(|hypothesis| Member::new(hypothesis, states, outputs)).collect();
        Self { all, begun: false }
    }

    /// How many there will be.
    pub(crate) fn room(&self) -> usize {
        self.all.len()
    }

    /// The memory of all of them.
    pub(crate) fn all_mut(&mut self) -> &mut [Member<H>] {
        &mut self.all
    }

    /// There they are.
    pub(crate) fn begin(&mut self) {
        self.begun = true;
    }

    /// There are none any more.
    pub(crate) fn forget(&mut self) {
        self.begun = false;
    }

    /// Become as others are, in the memory for as many.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        self.begun = other.begun;
        if other.begun {
            self.all.iter_mut().zip(&other.all).for_each(|(to, from)| to.copy_from(from));
        }
    }
}

impl<H> Default for Members<H> {
    fn default() -> Self {
        Self { all: Vec::new(), begun: false }
    }
}

impl<H> Deref for Members<H> {
    type Target = [Member<H>];

    fn deref(&self) -> &[Member<H>] {
        if self.begun { &self.all } else { &[] }
    }
}

impl<H> DerefMut for Members<H> {
    fn deref_mut(&mut self) -> &mut [Member<H>] {
        if self.begun { &mut self.all } else { &mut [] }
    }
}

impl<H: Serialize> Serialize for Members<H> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        (**self).serialize(serializer)
    }
}

impl<'de, H: Deserialize<'de>> Deserialize<'de> for Members<H> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let all = Vec::deserialize(deserializer)?;
        Ok(Self { begun: !all.is_empty(), all })
    }
}

/// Mean and counters of a member; its covariance is in the bank's.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Member<H> {
    pub hypothesis: H,
    #[serde(with = "numbers")]
    pub x: Vec<f64>,
    /// Rejections in a row of each output.
    rejected: Vec<u32>,
    pub innovations: Vec<Innovation>,
    /// Change of each output's prediction by its last reading.
    #[serde(with = "numbers")]
    pub pulled: Vec<f64>,
    /// Whether a bounded state stood at its bound after the last step.
    pub at_bound: bool,
    /// The last step, where it is recorded; it is not saved.
    #[serde(skip)]
    pub record: Option<Box<StepRecord>>,
}

impl<H: Clone> Member<H> {
    fn new(hypothesis: H, states: usize, outputs: usize) -> Self {
        Self {
            hypothesis,
            x: vec![0.0; states],
            rejected: vec![0; outputs],
            innovations: vec![Innovation::MISSING; outputs],
            pulled: vec![0.0; outputs],
            at_bound: false,
            record: None,
        }
    }

    /// Its last step, recorded from now on; so many of its states move.
    pub(crate) fn recorded(&mut self, leading: usize) -> &mut StepRecord {
        let (n, outputs) = (self.x.len(), self.innovations.len());
        self.record.get_or_insert_with(|| Box::new(StepRecord::new(n, leading, outputs)))
    }

    /// Become as another one is, without allocating.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        self.hypothesis.clone_from(&other.hypothesis);
        self.x.clone_from(&other.x);
        self.rejected.clone_from(&other.rejected);
        self.innovations.clone_from(&other.innovations);
        self.pulled.clone_from(&other.pulled);
        self.at_bound = other.at_bound;
        // Where there is no memory for the last step nobody asks for it.
        if let (Some(to), Some(from)) = (&mut self.record, &other.record) {
            to.copy_from(from);
        }
    }

    /// Begin, or begin again, with a mean (n).
    pub(crate) fn begin(&mut self, mean: &[f64]) {
        self.place_at(mean.iter().copied());
        self.innovations.fill(Innovation::MISSING);
        self.pulled.fill(0.0);
        self.at_bound = false;
    }

    /// Have another mean (n), and no reading refused.
    pub(crate) fn place_at(&mut self, mean: impl Iterator<Item = f64>) {
        self.x.iter_mut().zip(mean).for_each(|(x, mean)| *x = mean);
        self.rejected.fill(0);
    }

    /// Whether it has so many outputs.
    pub(crate) fn has_outputs(&self, outputs: usize) -> bool {
        [self.rejected.len(), self.innovations.len(), self.pulled.len()] == [outputs; 3]
    }

    /// What becomes of a reading with the innovation `nu` of variance `s`.
    pub(crate) fn judge<P: Plant<Hypothesis = H>>(
        &mut self,
        plant: &P,
        output: usize,
        (nu, s): (f64, f64),
    ) -> Outcome {
        let gate = plant.gate(&self.hypothesis, output);
        let outcome = gate.judge((nu, s), &mut self.rejected[output]);
        self.innovations[output] = Innovation { nu, s, outcome };
        outcome
    }

    /// Keep bounded states within their bounds, with a function that writes the covariance of a state with all others into memory for it: (n).
    ///
    /// What a state may not be the others take on as far as they are correlated with it, so that readings are explained as before: the state within the bound that is nearest
    /// in the metric of the covariance (D. Simon, IET Control Theory Appl. 4 (2010) 1303). Were it cut off alone, outputs would be predicted wrong from then on, row
    /// by row, which is what a slow loss looks like. A state that has gone farther than its standard deviation in one row did not creep there: what its covariance
    /// says of the others is worth nothing then, and it is cut off alone.
    pub(crate) fn bound<P: Plant<Hypothesis = H>>(
        &mut self,
        plant: &P,
        covariance: impl Fn(usize, &mut [f64]),
        memory: &mut [f64],
    ) {
        self.at_bound = false;
        for &(state, low, high) in plant.bounds() {
            let lacks = self.x[state].clamp(low, high) - self.x[state];
            if lacks == 0.0 {
                continue;
            }
            self.at_bound = true;
            covariance(state, memory);
            let variance = memory[state];
            if variance > 0.0 && lacks * lacks <= variance {
                memory.iter_mut().for_each(|of| *of /= variance);
                if plant.considers(&self.hypothesis) {
                    plant.considered().iter().filter(|&&of| of != state).for_each(|&of| memory[of] = 0.0);
                }
                axpy(lacks, memory, &mut self.x);
                if let Some(record) = &mut self.record {
                    record.bound(state, lacks / variance, memory);
                }
            }
        }
        if self.at_bound {
            // Those that were cut off alone, and what another one has pushed beyond its own.
            for &(state, low, high) in plant.bounds() {
                self.x[state] = self.x[state].clamp(low, high);
            }
        }
    }

    /// Mean (n).
    pub(crate) fn mean(&self) -> DVector<f64> {
        DVector::from_column_slice(&self.x)
    }
}

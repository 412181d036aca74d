//! Leaks by their signature in the innovations of a member that knows of none.
//!
//! One member of the bank [holds](super::roles::held) the mass: no leak rate, and a mass that hardly walks. What a leak of unit rate since a time
//! `k` would have made of its error by now, `f_k`, follows from its own transition `Phi`, gradients `h` and gains `K`, with 1 in the leak rate for
//! ever:
//!
//! `f <- Phi f` over an interval, `g = h' f`, `f <- f - K g` at a reading, `f <- f - P e f_i/P_ii` where a state `i` is held at its bound.
//!
//! So an innovation `nu` of variance `S` has the mean `r g` in a leak of rate `r` since `k`, and generalised least squares from three sums tell its rate,
//! its standard deviation and how far it is from none:
//!
//! `d = sum w g nu/S`, `J = sum w g^2/S`, `I = sum g^2/S`;   `r = d/J`, `s = sqrt(I)/J`, `z = d/sqrt(I)`.
//!
//! The weight `w = min(1, 2 sqrt(S)/|nu|)` bounds what a single reading counts for (Huber). A possible onset comes with the first sample and every
//! ten minutes; older ones are thinned out to a geometric ladder of ages up to sixty days, some twenty-five. The likeliest of them and its neighbours
//! stay: between two that lie far apart neither has the rate of a leak that began in between.
//!
//! The recursion is linear, the filter is not. A member that knows of no leak explains one of a hundredth of the mass by its films, and the rate comes out a
//! third too large. So the member is compensated for the likeliest leak beyond three standard deviations, `r (1 - 9/z^2)`: its estimate is moved by that times `f`. What
//! has been compensated, `t`, follows the same recursion, and `nu + h' t` stands for `nu` in `d`: the innovation as it would have been without. The weight is by `nu` itself.
//!
//! Where the member begins anew from the freest one its error has nothing of the leak any more: `f = 0` but for the rate; what the sums have stays. An exchange of gas or a
//! restart ends all onsets.
//!
//! Assumptions: one leak of constant rate since its onset; innovations that are independent, which they are not: their colour makes `z` larger or smaller
//! than a standard normal number, and who decides must learn how much. Constant time and memory per sample.
//!
//! Source: generalised likelihood ratio, A. S. Willsky, H. L. Jones, IEEE Trans. Autom. Control 21 (1976) 108; bounded weight, P. J. Huber, Ann. Math. Stat.
//! 35 (1964) 73.
use alloc::vec::Vec;
use serde::{Deserialize, Serialize};

use super::Observer;
use crate::filter::kernel::{axpy, column, dot};
use crate::filter::simd::{Arch, Simd, WithSimd};
use crate::filter::{Plant, StateSpace, StepRecord};
use crate::numbers;

/// Interval between possible onsets, s.
const ONSET_INTERVAL_S: f64 = 600.0;
/// Age beyond which an onset is given up, s.
const LONGEST_S: f64 = 60.0 * 86_400.0;
/// Largest ratio of the ages of two onsets between which one is thinned out.
const ONSET_AGE_RATIO: f64 = 1.7;
/// Onsets for which there is room: two in each step of the ladder, a new one, and the likeliest with its neighbours.
pub const ONSETS_AT_MOST: usize = 40;
/// Standard deviations up to which an innovation counts in full.
const BOUND: f64 = 2.0;
/// Standard deviations from which the member is compensated for a leak.
const COMPENSATED: f64 = 3.0;

/// The leak that there would be if it had begun at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Onset {
    /// Time at which it would have begun, s.
    pub since_s: f64,
    /// Its rate, kg/s.
    pub rate_kg_s: f64,
    /// Standard deviation of the rate if innovations were independent, kg/s.
    pub sd_kg_s: f64,
}

/// Sums of one onset.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Sums {
    since_s: f64,
    /// `d`, `J`, `I`.
    score: f64,
    weighted: f64,
    information: f64,
}

/// All onsets that are possible, oldest first.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Onsets {
    sums: Vec<Sums>,
    /// What each has made of the member's error: (n), one after the other.
    #[serde(with = "numbers")]
    responses: Vec<f64>,
    /// What the member was compensated: (n).
    #[serde(with = "numbers")]
    compensated: Vec<f64>,
    /// When the next one comes, s.
    due_s: Option<f64>,
}

impl Sums {
    fn z(&self) -> f64 {
        if self.information > 0.0 { self.score / libm::sqrt(self.information) } else { 0.0 }
    }

    fn rate(&self) -> f64 {
        if self.weighted > 0.0 { self.score / self.weighted } else { 0.0 }
    }
}

impl Onsets {
    /// None, with memory for responses of `n` states.
    pub(super) fn with_room(n: usize) -> Self {
        Self {
            sums: Vec::with_capacity(ONSETS_AT_MOST),
            responses: Vec::with_capacity(n * ONSETS_AT_MOST),
            compensated: Vec::with_capacity(n),
            due_s: None,
        }
    }

    /// Become as others are, without allocating where there is room.
    pub(super) fn copy_from(&mut self, other: &Self) {
        self.sums.clone_from(&other.sums);
        self.responses.clone_from(&other.responses);
        self.compensated.clone_from(&other.compensated);
        self.due_s = other.due_s;
    }

    /// Whether it is of a member with so many states.
    pub(super) fn is_like(&self, states: usize) -> bool {
        self.sums.len() <= ONSETS_AT_MOST
            && self.responses.len() == self.sums.len() * states
            && (self.compensated.len() == states || self.sums.is_empty() && self.compensated.is_empty())
    }

    /// The onsets with information, oldest first.
    pub(super) fn all(&self) -> impl Iterator<Item = Onset> {
        self.sums.iter().filter(|sums| sums.weighted > 0.0).map(|sums| Onset {
            since_s: sums.since_s,
            rate_kg_s: sums.rate(),
            sd_kg_s: libm::sqrt(sums.information) / sums.weighted,
        })
    }

    /// Round the responses, and what has been compensated, to single precision.
    pub(super) fn round(&mut self) {
        self.responses
            .iter_mut()
            .chain(&mut self.compensated)
            .for_each(|value| *value = numbers::single(*value));
    }

    /// None any more.
    pub(super) fn clear(&mut self) {
        self.sums.clear();
        self.responses.clear();
        self.compensated.fill(0.0);
        self.due_s = None;
    }

    /// The member's error has nothing of a leak any more, but for the rate.
    pub(super) fn begin_anew(&mut self, leak: usize) {
        let n = self.compensated.len();
        self.compensated.fill(0.0);
        for response in self.responses.chunks_mut(n.max(1)) {
            response.fill(0.0);
            response[leak] = 1.0;
        }
    }

    /// The member's state is another one, whatever leak there was.
    pub(super) fn reset(&mut self, state: usize) {
        let n = self.compensated.len();
        let responses = self.responses.chunks_mut(n.max(1)).chain([self.compensated.as_mut_slice()]);
        responses.filter(|response| !response.is_empty()).for_each(|response| response[state] = 0.0);
    }

    /// Take a step of the member, with memory for a product.
    fn follow(&mut self, step: &StepRecord, leak: usize, moved: &mut Vec<f64>) {
        if !step.freed.is_empty() {
            self.clear();
        }
        moved.resize(step.phi.nrows(), 0.0);
        Arch::new().dispatch(Follow { onsets: self, step, moved });
        if step.replaced {
            self.begin_anew(leak);
        }
    }

    /// A new onset where one is due; without those that are too old or too close.
    fn renew(&mut self, time_s: f64, leak: usize) {
        let n = self.compensated.len();
        if self.due_s.is_some_and(|due_s| time_s < due_s) {
            return;
        }
        self.due_s = Some(time_s + ONSET_INTERVAL_S);
        while self.sums.first().is_some_and(|oldest| time_s - oldest.since_s > LONGEST_S) {
            self.remove(0, n);
        }
        self.sums.push(Sums { since_s: time_s, score: 0.0, weighted: 0.0, information: 0.0 });
        self.responses.resize(self.sums.len() * n, 0.0);
        let last = self.responses.len() - n;
        self.responses[last + leak] = 1.0;
        self.thin_out(time_s, n);
    }

    /// What lies between two onsets of nearly one age goes; the likeliest and its neighbours stay.
    fn thin_out(&mut self, time_s: f64, n: usize) {
        let mut index = 1;
        while index + 1 < self.sums.len() {
            let age_s = |index: usize| time_s - self.sums[index].since_s;
            let stays = self.likeliest().is_some_and(|likeliest| likeliest.abs_diff(index) <= 1);
            if !stays && age_s(index - 1) < ONSET_AGE_RATIO * age_s(index + 1) {
                self.remove(index, n);
            } else {
                index += 1;
            }
        }
    }

    fn remove(&mut self, index: usize, n: usize) {
        self.sums.remove(index);
        self.responses.drain(index * n..(index + 1) * n);
    }

    /// The onset since which a loss is likeliest.
    fn likeliest(&self) -> Option<usize> {
        let losing = (0..self.sums.len()).filter(|&index| self.sums[index].z() > 0.0);
        losing.max_by(|&a, &b| self.sums[a].z().total_cmp(&self.sums[b].z()))
    }

    /// What should have been compensated by now: (n).
    fn to_compensate(&self, to: &mut Vec<f64>) {
        let n = self.compensated.len();
        to.clear();
        to.resize(n, 0.0);
        let Some(index) = self.likeliest() else { return };
        let z = self.sums[index].z();
        if z > COMPENSATED {
            let rate = self.sums[index].rate() * (1.0 - COMPENSATED * COMPENSATED / (z * z));
            axpy(rate, column(&self.responses, n, index), to);
        }
    }
}

/// A step of the member through all responses, compiled for the vector registers of the machine.
struct Follow<'a> {
    onsets: &'a mut Onsets,
    step: &'a StepRecord,
    moved: &'a mut [f64],
}

impl WithSimd for Follow<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { onsets, step, moved } = self;
        let n = onsets.compensated.len();
        for response in onsets.responses.chunks_mut(n).chain([onsets.compensated.as_mut_slice()]) {
            carry(step, response, moved);
        }
        for sensor in (0..step.used.len()).filter(|&sensor| step.used[sensor]) {
            let (h, gain) = (column(step.h.as_slice(), n, sensor), column(step.gain.as_slice(), n, sensor));
            let (nu, s) = (step.innovation[sensor], step.variance[sensor]);
            let weight = (BOUND * libm::sqrt(s) / nu.abs()).min(1.0);
            let expected = dot(h, &onsets.compensated);
            axpy(-expected, gain, &mut onsets.compensated);
            for (sums, response) in onsets.sums.iter_mut().zip(onsets.responses.chunks_mut(n)) {
                let g = dot(h, response);
                sums.score += weight * g * (nu + expected) / s;
                sums.weighted += weight * g * g / s;
                sums.information += g * g / s;
                axpy(-g, gain, response);
            }
        }
        for (&(state, _), shares) in step.bounded.iter().zip(step.shares.chunks(n.max(1))) {
            for response in onsets.responses.chunks_mut(n).chain([onsets.compensated.as_mut_slice()]) {
                axpy(-response[state], shares, response);
            }
        }
    }
}

/// Take a response over an interval, with memory for its moving part.
#[inline(always)]
fn carry(step: &StepRecord, response: &mut [f64], moved: &mut [f64]) {
    let (phi, m) = (step.phi.as_slice(), moved.len());
    moved.fill(0.0);
    for (column, &by) in phi.chunks_exact(m).zip(&*response) {
        if by != 0.0 {
            axpy(by, column, moved);
        }
    }
    response[..m].copy_from_slice(moved);
    response.iter_mut().zip(&step.relaxed).skip(m).for_each(|(by, factor)| *by *= factor);
}

impl Observer {
    /// What a leak would be that had begun at one of some twenty-five times, oldest first; none without a member that holds the mass.
    pub fn onsets(&self) -> impl Iterator<Item = Onset> {
        self.onsets.all()
    }

    /// Nothing that has been seen so far speaks for or against a leak any more.
    pub fn forget_onsets(&mut self) {
        self.onsets.clear();
        if let Some(member) = self.roles.held.and_then(|held| self.bank.members.get_mut(held)) {
            member.x[self.cylinder.state_map().leak] = 0.0;
        }
    }

    /// The member that holds the mass keeps what it does at the next sample.
    pub(super) fn record_the_step(&mut self) {
        if let Some(member) = self.roles.held.and_then(|held| self.bank.members.get_mut(held)) {
            member.recorded(self.cylinder.leading()).begin(0.0);
        }
    }

    /// Take what the member did into the onsets, and compensate it for the leak that is nearly certain.
    pub(super) fn follow_onsets(&mut self, time_s: f64, restarted: bool) {
        if restarted {
            self.onsets.clear();
        }
        let leak = self.cylinder.state_map().leak;
        let Some(member) = self.roles.held.and_then(|held| self.bank.members.get_mut(held)) else { return };
        self.onsets.compensated.resize(member.x.len(), 0.0);
        if let Some(step) = &member.record {
            self.onsets.follow(step, leak, &mut self.to_compensate);
        }
        self.onsets.renew(time_s, leak);
        self.onsets.to_compensate(&mut self.to_compensate);
        self.reference_x.copy_from_slice(&member.x);
        for ((x, to), done) in
            self.reference_x.iter_mut().zip(&self.to_compensate).zip(&self.onsets.compensated)
        {
            *x += to - done;
        }
        if self.cylinder.is_possible(&self.reference_x) {
            member.x.copy_from_slice(&self.reference_x);
            self.onsets.compensated.copy_from_slice(&self.to_compensate);
        }
    }
}

#[cfg(test)]
mod tests;

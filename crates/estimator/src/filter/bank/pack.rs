//! Up to four members with the extended filter, side by side.
//!
//! They see one plant and differ in their hypotheses: their means are close to each other. Members close to a reference use its
//! derivatives, `x_k' = f(x) + Phi (x_k - x)` and likewise for a reading; where they are not so close that the curvature of the
//! equations would not show ([`LINEAR_DISTANCE`]), by their own rates and readings. A member that is far away, after something that its
//! hypothesis does not allow, is linearised by itself. Covariances move in lanes ([`UdBank`]).
use alloc::vec::Vec;
use core::marker::PhantomData;
use cylwatch_thermal::real::powi;

use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

use super::member::Member;
use crate::filter::gate::Outcome;
use crate::filter::kernel::dot_difference;
use crate::filter::lanes::{LANES, Lanes};
use crate::filter::plant::Plant;
use crate::filter::step::{StepMemory, StepTransition, Steps};
use crate::filter::ud::UdFactors;
use crate::filter::ud_bank::{BankTransition, Factors, UdBank, UdMemory, Unrolled};

/// Distance up to which two states differ linearly: curvature is left out.
const LINEAR_DISTANCE: f64 = 0.5;
/// The same where it is taken into account.
const BENT_DISTANCE: f64 = 1.0;
/// Part of the variance of a considered state that a reading explains at least that moves it.
const MIN_EXPLAINED_PART: f64 = 0.01;

/// Covariances of up to four members.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Pack {
    pub bank: UdBank,
    /// Which members share derivatives, found at each time update; readings hardly change it.
    groups: SmallVec<[Group; LANES]>,
}

/// Memory that all packs share. Nothing in it outlives a step.
#[derive(Debug)]
pub(super) struct PackMemory {
    step: StepTransition,
    doubling: StepMemory,
    transition: BankTransition,
    factors: UdMemory,
    /// Departure of each member from its reference, and where the transition takes it: (n), (leading).
    away: Vec<Lanes>,
    moved: Vec<[Lanes; 1]>,
    /// The reference before a step (n), and its moving states after it.
    before: Vec<f64>,
    after: Vec<f64>,
    /// The same with what curvature adds for one member.
    bent: Vec<f64>,
    /// Intensity of each noise source in every lane, and in one.
    intensities: Vec<Lanes>,
    one_intensity: Vec<f64>,
    /// Gradient and gain: (n).
    h: Vec<Lanes>,
    gain: Vec<Lanes>,
    /// One lane of them, for a record.
    one_h: Vec<f64>,
    one_gain: Vec<f64>,
}

impl PackMemory {
    pub(super) fn new<P: Plant>(plant: &P) -> Self {
        let (n, m) = (plant.states(), plant.leading());
        Self {
            step: StepTransition::zeros(n, m, P::SOURCES),
            doubling: StepMemory::new(n, m),
            transition: BankTransition::new(plant.pattern()),
            factors: UdMemory::new(n, m),
            away: vec![Lanes::ZERO; n],
            moved: vec![[Lanes::ZERO]; m],
            before: vec![0.0; n],
            after: vec![0.0; m],
            bent: vec![0.0; m],
            intensities: vec![Lanes::ZERO; P::SOURCES],
            one_intensity: vec![0.0; P::SOURCES],
            h: vec![Lanes::ZERO; n],
            gain: vec![Lanes::ZERO; n],
            one_h: vec![0.0; n],
            one_gain: vec![0.0; n],
        }
    }
}

/// Sizes for which a plant's loops over covariances are unrolled.
struct UsualSizes<P>(PhantomData<P>);

impl<P: Plant> Unrolled for UsualSizes<P> {
    const SIZES: (usize, usize) = P::USUAL_SIZES;
}

/// Some of the lanes.
type Some4 = [bool; LANES];

impl Pack {
    /// Members per pack.
    pub(super) const SIZE: usize = LANES;

    /// Memory for so many members.
    pub(super) fn new<P: Plant>(plant: &P, members: usize) -> Self {
        let bank = UdBank::new(plant.states(), plant.leading()).with_filters(members);
        Self { bank, groups: SmallVec::new() }
    }

    /// A member, the first of which comes first, begins with this covariance.
    pub(super) fn begin(&mut self, lane: usize, factors: &UdFactors) {
        self.bank.set(lane, factors);
        if lane == 0 {
            // A lane without a member does as the first one.
            (1..LANES).for_each(|lane| self.bank.copy_lane(0, lane));
            self.groups.clear();
        }
    }

    /// Whether it is of this plant and so many members.
    pub(super) fn is_like<P: Plant>(&self, plant: &P, members: usize) -> bool {
        self.bank.is_like(plant.states(), plant.leading(), members)
            && self.groups.iter().all(|group| group.reference < members)
    }

    /// Become as others of the same members are, without allocating.
    pub(super) fn copy_from(&mut self, other: &Self) {
        self.bank.copy_from(&other.bank);
        self.groups.clone_from(&other.groups);
    }

    /// Become as an outline is, each member with this variance of the state `own`.
    pub(super) fn return_to(&mut self, outline: &Factors, own: usize, variances: &[f64]) {
        self.bank.return_to(outline);
        self.groups.clear();
        for (lane, &variance) in variances.iter().enumerate().skip(1) {
            self.bank.decorrelate_and_set(lane, own, variance);
        }
    }

    /// Time update over an interval, in parts no longer than the plant allows, of which a long one takes [several at once](Steps).
    pub(super) fn predict<P: Plant>(
        &mut self,
        plant: &mut P,
        memory: &mut PackMemory,
        members: &mut [Member<P::Hypothesis>],
        dt_s: f64,
    ) -> Result<(), P::Error> {
        let mut steps = Steps::of(dt_s, plant.longest_step_s());
        let part_s = steps.part_s;
        steps.try_for_each(|doublings| self.step(plant, memory, members, (part_s, doublings)))
    }

    /// Group members that are no farther from their reference than this.
    fn group<P: Plant>(&mut self, plant: &P, members: &[Member<P::Hypothesis>], within: f64) {
        self.groups.clear();
        let mut left = [true; LANES];
        while let Some(group) = Group::next(plant, members, &mut left, within) {
            self.groups.push(group);
        }
    }

    fn step<P: Plant>(
        &mut self,
        plant: &mut P,
        memory: &mut PackMemory,
        members: &mut [Member<P::Hypothesis>],
        step: (f64, u32),
    ) -> Result<(), P::Error> {
        memory.away.fill(Lanes::ZERO);
        // What curvature adds is known over one part.
        self.group(plant, members, if step.1 == 0 { BENT_DISTANCE } else { LINEAR_DISTANCE });
        for group in &self.groups {
            memory.move_group(plant, members, group, step)?;
        }
        memory.transition.carry(&memory.away, &mut memory.moved);
        for (lane, member) in members.iter_mut().enumerate() {
            for (x, [by]) in member.x.iter_mut().zip(&memory.moved) {
                *x += by.0[lane];
            }
        }
        self.bank.predict::<UsualSizes<P>>(&mut memory.transition, &mut memory.factors);
        Ok(())
    }

    /// Innovation that a reading would be for a member, the first one, and its variance.
    pub(super) fn innovation_of<P: Plant>(
        &mut self,
        plant: &mut P,
        (memory, gradient): (&mut PackMemory, &mut [f64]),
        first: &Member<P::Hypothesis>,
        (output, reading): (usize, f64),
    ) -> Result<(f64, f64), P::Error> {
        let expected = plant.output(output, &first.x, Some(&mut *gradient))?;
        let h = &mut memory.h;
        h.iter_mut().zip(gradient).for_each(|(to, h)| *to = Lanes::splat(*h));
        let r = plant.noise_variance_supposing(&first.hypothesis, output, &first.x);
        Ok((reading - expected, self.bank.project::<UsualSizes<P>>(h).0[0] + r))
    }

    /// Take a reading of an output, with memory for its gradient: (n).
    pub(super) fn update<P: Plant>(
        &mut self,
        plant: &mut P,
        (memory, h): (&mut PackMemory, &mut [f64]),
        members: &mut [Member<P::Hypothesis>],
        (output, reading): (usize, f64),
    ) -> Result<(), P::Error> {
        let (mut nu, mut r) = (Lanes::ZERO, Lanes::splat(1.0));
        if self.groups.is_empty() {
            self.group(plant, members, BENT_DISTANCE);
        }
        for group in &self.groups {
            let x = &members[group.reference].x;
            let value = plant.output(output, x, Some(&mut *h))?;
            memory.h.iter_mut().zip(&*h).for_each(|(to, &h)| to.put(group.lanes, Lanes::splat(h)));
            for (lane, member) in members.iter().enumerate().filter(|(lane, _)| group.lanes[*lane]) {
                let expected = match group.distance[lane] {
                    far if far > LINEAR_DISTANCE => plant.output(output, &member.x, None)?,
                    _ if lane == group.reference => value,
                    _ => value + dot_difference(h, &member.x, x),
                };
                nu.0[lane] = reading - expected;
                r.0[lane] = plant.noise_variance_supposing(&member.hypothesis, output, x);
            }
        }
        let s = self.bank.project::<UsualSizes<P>>(&memory.h) + r;
        let used = self.judge(plant, memory, members, output, (nu, s, &mut r));
        let used_s = self.bank.update::<UsualSizes<P>>(r, used, &mut memory.gain, &mut memory.factors);
        if members.iter().any(|member| plant.considers(&member.hypothesis)) {
            self.consider(plant, members, used_s, &mut memory.gain);
        }
        for (lane, member) in lanes_of(used, members) {
            if let Some(record) = &mut member.record {
                one_lane(lane, &memory.h, &mut memory.one_h);
                one_lane(lane, &memory.gain, &mut memory.one_gain);
                record.update(output, &memory.one_h, &memory.one_gain, (nu.0[lane], used_s.0[lane]));
            }
            member.pulled[output] = (1.0 - r.0[lane] / s.0[lane]) * nu.0[lane];
            for (x, gain) in member.x.iter_mut().zip(&memory.gain) {
                *x += gain.0[lane] * nu.0[lane];
            }
        }
        Ok(())
    }

    /// No gain on what a member considers, but where the reading, of the variance `s`, says much of it.
    fn consider<P: Plant>(&self, plant: &P, members: &[Member<P::Hypothesis>], s: Lanes, gain: &mut [Lanes]) {
        for &state in plant.considered() {
            let (gain, variance) = (&mut gain[state], self.bank.variances(state));
            for (lane, _) in members.iter().enumerate().filter(|(_, of)| plant.considers(&of.hypothesis)) {
                if powi(gain.0[lane], 2) * s.0[lane] < MIN_EXPLAINED_PART * variance.0[lane] {
                    gain.0[lane] = 0.0;
                }
            }
        }
    }

    /// Which members use a reading; its noise grows, or the covariance opens, for those that had refused it too often.
    fn judge<P: Plant>(
        &mut self,
        plant: &P,
        memory: &PackMemory,
        members: &mut [Member<P::Hypothesis>],
        output: usize,
        (nu, s, r): (Lanes, Lanes, &mut Lanes),
    ) -> Some4 {
        let mut used = [false; LANES];
        let mut opened = false;
        for (lane, member) in members.iter_mut().enumerate() {
            let (nu, s) = (nu.0[lane], s.0[lane]);
            let outcome = member.judge(plant, output, (nu, s));
            used[lane] = outcome != Outcome::Rejected;
            if outcome != Outcome::Reacquired {
                continue;
            }
            let freed = plant.freed_by(output);
            for &(state, variance) in freed {
                self.bank.decorrelate_and_set(lane, state, variance);
                if let Some(record) = &mut member.record {
                    record.freed_by.push((output, state));
                }
            }
            if freed.is_empty() {
                // Whatever moved the reading, the state may follow it half of the way at most.
                r.0[lane] = r.0[lane].max(nu * nu);
            } else {
                opened = true;
            }
        }
        if opened {
            self.bank.project::<UsualSizes<P>>(&memory.h);
        }
        used
    }
}

impl PackMemory {
    /// Move the reference of a group; the others of the group to where it is then, with how far they were from it in `away`.
    fn move_group<P: Plant>(
        &mut self,
        plant: &mut P,
        members: &mut [Member<P::Hypothesis>],
        group: &Group,
        (part_s, doublings): (f64, u32),
    ) -> Result<(), P::Error> {
        let (m, reference) = (self.moved.len(), group.reference);
        self.before.copy_from_slice(&members[reference].x);
        plant.suppose(&members[reference].hypothesis);
        let x = &mut members[reference].x;
        plant.transition(x, part_s, &mut self.step)?;
        (0..doublings).for_each(|_| self.step.double(&self.before, x, &mut self.doubling));
        self.transition.set(group.lanes, self.step.phi.as_slice());
        self.set_noise(plant, group.lanes, members);
        self.after.copy_from_slice(&members[reference].x[..m]);
        for (lane, member) in lanes_of(group.lanes, members) {
            if let Some(record) = &mut member.record {
                record.append(&self.step.phi);
            }
            if lane == reference {
                continue;
            }
            for ((away, x), before) in self.away.iter_mut().zip(&member.x).zip(&self.before) {
                away.0[lane] = x - before;
            }
            self.bent.copy_from_slice(&self.after);
            if group.distance[lane] > LINEAR_DISTANCE {
                plant.add_curvature(&self.before, &member.x, part_s, &self.step, &mut self.bent)?;
            }
            member.x[..m].copy_from_slice(&self.bent);
        }
        Ok(())
    }

    /// Noise that all share, and that of the sources with the intensity that each member supposes.
    fn set_noise<P: Plant>(&mut self, plant: &P, group: Some4, members: &[Member<P::Hypothesis>]) {
        for lane in 0..LANES {
            let member = members.get(lane).unwrap_or(&members[0]);
            plant.intensities(&member.hypothesis, &mut self.one_intensity);
            let all = self.intensities.iter_mut().zip(&self.one_intensity);
            all.for_each(|(intensities, intensity)| intensities.0[lane] = *intensity);
        }
        // Of known number: the sum over them is unrolled.
        let StepTransition { noise, by_source, .. } = &self.step;
        let (by_source, intensities) = (&by_source[..P::SOURCES], &self.intensities[..P::SOURCES]);
        self.transition.set_noise(group, |place| {
            let by_source = intensities.iter().zip(by_source);
            by_source.fold(Lanes::splat(noise[place]), |sum, (&intensity, by)| sum + intensity * by[place])
        });
    }
}

/// Members that share the derivatives of one.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Group {
    reference: usize,
    lanes: Some4,
    /// Distance of each from the reference.
    distance: [f64; LANES],
}

impl Group {
    /// The next reference with all that are close to it, among the lanes that are left; lanes without a member join the first group.
    fn next<P: Plant>(
        plant: &P,
        members: &[Member<P::Hypothesis>],
        left: &mut Some4,
        within: f64,
    ) -> Option<Self> {
        let candidates = || (0..members.len()).filter(|&lane| left[lane]);
        let first = candidates().find(|&lane| plant.is_reference(&members[lane].hypothesis));
        let reference = first.or_else(|| candidates().next())?;
        let mut group = Self { reference, lanes: *left, distance: [0.0; LANES] };
        let of = &members[reference];
        for lane in candidates().filter(|&lane| lane != reference) {
            let member = &members[lane];
            group.distance[lane] = plant.distance((&of.hypothesis, &of.x), (&member.hypothesis, &member.x));
            group.lanes[lane] = group.distance[lane] <= within;
        }
        left.iter_mut().zip(group.lanes).for_each(|(left, taken)| *left &= !taken);
        Some(group)
    }
}

/// The members of some lanes.
fn lanes_of<H>(group: Some4, members: &mut [Member<H>]) -> impl Iterator<Item = (usize, &mut Member<H>)> {
    members.iter_mut().enumerate().filter(move |(lane, _)| group[*lane])
}

fn one_lane(lane: usize, from: &[Lanes], to: &mut [f64]) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to = from.0[lane]);
}

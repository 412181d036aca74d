//! Up to four members with the extended filter, side by side.
//!
//! They see one cylinder and differ in what they suppose of its leak: their means are near each other. Members near a reference use its
//! derivatives, `x_k' = f(x) + Phi (x_k - x)` and likewise for a reading; where they are not so near that the curvature of the
//! equations would not show ([`HARDLY`]), by their own rates and readings. A member that is far away, after a leak that it does not
//! allow, is linearised by itself. Covariances move in lanes ([`UdBank`]).
use super::Gates;
use nalgebra::Dyn;
use serde::{Deserialize, Serialize};

use crate::EstimatorError;
use crate::filter::bank::{BankTransition, UdBank};
use crate::filter::kernel::dot_difference;
use crate::filter::lanes::{LANES, Lanes};
use crate::filter::{Gate, Outcome, StateSpace, UdFactors};
use crate::numbers;
use crate::observer::cylinder::{Crossing, Cylinder, HARDLY};
use crate::observer::engine::Shared;
use crate::observer::member::{Member, freed};

/// Part of the variance of an offset that a reading explains at least that moves it where it is considered.
const TELLING: f64 = 0.01;

/// Covariances of up to four members.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Together {
    pub bank: UdBank,
    /// Who shares derivatives, found at each time update; readings hardly change it.
    groups: Vec<Group>,
}

/// Memory that all share. Nothing in it outlives a step.
#[derive(Debug)]
pub(in crate::observer) struct Memory {
    crossing: Crossing,
    transition: BankTransition,
    /// Departure of each member from its reference, and where the transition takes it: (n), (leading).
    away: Vec<Lanes>,
    moved: Vec<[Lanes; 1]>,
    /// The reference before a step (n), and its moving states after it.
    before: Vec<f64>,
    after: Vec<f64>,
    /// The same with what curvature adds for one member.
    bent: Vec<f64>,
    /// Gradient and gain: (n).
    h: Vec<Lanes>,
    gain: Vec<Lanes>,
    /// One lane of them, for a smoother.
    one_h: Vec<f64>,
    one_gain: Vec<f64>,
}

impl Memory {
    pub fn new(cylinder: &Cylinder) -> Self {
        let (n, m) = (cylinder.states(), cylinder.leading());
        Self {
            crossing: Crossing::new(n, m),
            transition: BankTransition::new(cylinder.pattern()),
            away: vec![Lanes::ZERO; n],
            moved: vec![[Lanes::ZERO]; m],
            before: vec![0.0; n],
            after: vec![0.0; m],
            bent: vec![0.0; m],
            h: vec![Lanes::ZERO; n],
            gain: vec![Lanes::ZERO; n],
            one_h: vec![0.0; n],
            one_gain: vec![0.0; n],
        }
    }
}

/// Some of the lanes.
type Some4 = [bool; LANES];

impl Together {
    /// Members per pack.
    pub const SIZE: usize = LANES;

    /// Members with these covariances.
    pub fn new(cylinder: &Cylinder, factors: &[UdFactors<Dyn>]) -> Self {
        let mut bank = UdBank::new(cylinder.states(), cylinder.leading()).with_filters(factors.len());
        // A lane without a member does as the first one.
        for lane in 0..LANES {
            bank.set(lane, factors.get(lane).unwrap_or(&factors[0]));
        }
        Self { bank, groups: Vec::with_capacity(LANES) }
    }

    /// Become as others of the same members are, without allocating.
    pub fn copy_from(&mut self, other: &Self) {
        self.bank.copy_from(&other.bank);
        self.groups.clone_from(&other.groups);
    }

    /// The covariance of the first member, with factors that are [coarse](numbers::coarse).
    pub fn outline(&self) -> Self {
        let mut bank = self.bank.clone().with_filters(1);
        (1..LANES).for_each(|lane| bank.copy_lane(0, lane));
        bank.round(numbers::coarse);
        Self { bank, groups: Vec::new() }
    }

    /// Become as the outline is, each member with this variance of the state `leak`.
    pub fn return_to(&mut self, outline: &Self, leak: usize, variances: &[f64]) {
        self.copy_from(outline);
        for (lane, &variance) in variances.iter().enumerate().skip(1) {
            self.bank.decorrelate_and_set(lane, leak, variance);
        }
    }

    /// Time update over an interval, in steps no longer than the settings allow.
    pub fn predict(
        &mut self,
        cylinder: &mut Cylinder,
        shared: &mut Shared,
        members: &mut [Member],
        dt_s: f64,
    ) -> Result<(), EstimatorError> {
        let (parts, part_s) = cylinder.parts(dt_s);
        for _ in 0..parts {
            self.move_on(cylinder, &mut shared.memory, members, part_s)?;
        }
        Ok(())
    }

    fn group(&mut self, cylinder: &Cylinder, members: &[Member]) {
        self.groups.clear();
        let mut left = [true; LANES];
        while let Some(group) = Group::next(cylinder, members, &mut left) {
            self.groups.push(group);
        }
    }

    fn move_on(
        &mut self,
        cylinder: &mut Cylinder,
        memory: &mut Memory,
        members: &mut [Member],
        dt_s: f64,
    ) -> Result<(), EstimatorError> {
        memory.away.fill(Lanes::ZERO);
        self.group(cylinder, members);
        for group in &self.groups {
            memory.cross(cylinder, members, group, dt_s)?;
        }
        memory.transition.carry(&memory.away, &mut memory.moved);
        for (lane, member) in members.iter_mut().enumerate() {
            for (x, [by]) in member.x.iter_mut().zip(&memory.moved) {
                *x += by.0[lane];
            }
        }
        self.bank.predict(&mut memory.transition);
        Ok(())
    }

    /// Innovation that a reading would be for the first member, and its variance.
    pub fn foresee(
        &mut self,
        cylinder: &mut Cylinder,
        shared: &mut Shared,
        first: &Member,
        (sensor, reading): (usize, f64),
    ) -> Result<(f64, f64), EstimatorError> {
        let expected = cylinder.output(sensor, &first.x, Some(&mut shared.h))?;
        let h = &mut shared.memory.h;
        h.iter_mut().zip(&shared.h).for_each(|(to, &h)| *to = Lanes::splat(h));
        let r = cylinder.noise_at_caution(sensor, &first.x, first.hypothesis.caution_pa_k);
        Ok((reading - expected, self.bank.project(h).0[0] + r))
    }

    /// Take a reading of a sensor.
    pub fn update(
        &mut self,
        cylinder: &mut Cylinder,
        shared: &mut Shared,
        members: &mut [Member],
        (sensor, reading): (usize, f64),
        gates: Gates,
    ) -> Result<(), EstimatorError> {
        let h = &mut shared.h;
        let memory = &mut shared.memory;
        let (mut nu, mut r) = (Lanes::ZERO, Lanes::splat(1.0));
        if self.groups.is_empty() {
            self.group(cylinder, members);
        }
        for group in &self.groups {
            let x = &members[group.reference].x;
            let value = cylinder.output(sensor, x, Some(h))?;
            memory.h.iter_mut().zip(&*h).for_each(|(to, &h)| to.put(group.lanes, Lanes::splat(h)));
            for (lane, member) in members.iter().enumerate().filter(|(lane, _)| group.lanes[*lane]) {
                let expected = match group.distance[lane] {
                    far if far > HARDLY => cylinder.output(sensor, &member.x, None)?,
                    _ if lane == group.reference => value,
                    _ => value + dot_difference(h, &member.x, x),
                };
                nu.0[lane] = reading - expected;
                r.0[lane] = cylinder.noise_at_caution(sensor, x, member.hypothesis.caution_pa_k);
            }
        }
        let s = self.bank.project(&memory.h) + r;
        let used = self.judge(cylinder, memory, members, sensor, (nu, s, &mut r), gates);
        let used_s = self.bank.update(r, used, &mut memory.gain);
        if members.iter().any(|member| member.hypothesis.considers_offset) {
            self.consider(cylinder.transmitter_offsets(), members, used_s, &mut memory.gain);
        }
        for (lane, member) in lanes_of(used, members) {
            if let Some(pass) = &mut member.pass {
                one_lane(lane, &memory.h, &mut memory.one_h);
                one_lane(lane, &memory.gain, &mut memory.one_gain);
                pass.take(sensor, &memory.one_h, &memory.one_gain, (nu.0[lane], used_s.0[lane]));
            }
            member.pulled[sensor] = (1.0 - r.0[lane] / s.0[lane]) * nu.0[lane];
            for (x, gain) in member.x.iter_mut().zip(&memory.gain) {
                *x += gain.0[lane] * nu.0[lane];
            }
        }
        Ok(())
    }

    /// No gain on what a member considers, but where the reading, of the variance `s`, says much of it.
    fn consider(&self, offsets: &[usize], members: &[Member], s: Lanes, gain: &mut [Lanes]) {
        for &state in offsets {
            let (gain, variance) = (&mut gain[state], self.bank.variances(state));
            for (lane, _) in members.iter().enumerate().filter(|(_, of)| of.hypothesis.considers_offset) {
                if gain.0[lane].powi(2) * s.0[lane] < TELLING * variance.0[lane] {
                    gain.0[lane] = 0.0;
                }
            }
        }
    }

    /// Which members use a reading; its noise grows, or the covariance opens, for those that had refused it too often.
    fn judge(
        &mut self,
        cylinder: &Cylinder,
        memory: &Memory,
        members: &mut [Member],
        sensor: usize,
        (nu, s, r): (Lanes, Lanes, &mut Lanes),
        gates: Gates,
    ) -> Some4 {
        let mut used = [false; LANES];
        let mut opened = false;
        let most_in_a_row = cylinder.settings().rejections_in_a_row;
        for (lane, member) in members.iter_mut().enumerate() {
            let (nu, s) = (nu.0[lane], s.0[lane]);
            let flows = member.hypothesis.is_flowing() && cylinder.reads_pressure(sensor);
            let (limit, rejections_in_a_row) =
                if flows { (gates.flow, 0) } else { (gates.all, most_in_a_row) };
            let outcome = member.judge(sensor, (nu, s), Gate { limit, rejections_in_a_row });
            used[lane] = outcome != Outcome::Rejected;
            if outcome != Outcome::Reacquired {
                continue;
            }
            if cylinder.reads_pressure(sensor) {
                for (state, variance) in freed(cylinder) {
                    self.bank.decorrelate_and_set(lane, state, variance);
                }
                if let Some(pass) = &mut member.pass {
                    pass.open(Some(sensor));
                }
                opened = true;
            } else {
                // Whatever moved the reading, the state may follow it half of the way at most.
                r.0[lane] = r.0[lane].max(nu * nu);
            }
        }
        if opened {
            self.bank.project(&memory.h);
        }
        used
    }
}

impl Memory {
    /// Move the reference of a group; the others of the group to where it is then, with how far they were from it in `away`.
    fn cross(
        &mut self,
        cylinder: &mut Cylinder,
        members: &mut [Member],
        group: &Group,
        dt_s: f64,
    ) -> Result<(), EstimatorError> {
        let (m, reference) = (self.moved.len(), group.reference);
        self.before.copy_from_slice(&members[reference].x);
        cylinder.suppose(&members[reference].hypothesis);
        cylinder.cross(&mut members[reference].x, dt_s, &mut self.crossing)?;
        self.transition.set(group.lanes, self.crossing.phi.as_slice());
        self.set_noise(group.lanes, members);
        self.after.copy_from_slice(&members[reference].x[..m]);
        for (lane, member) in lanes_of(group.lanes, members) {
            if let Some(pass) = &mut member.pass {
                pass.move_on(&self.crossing.phi);
            }
            if lane == reference {
                continue;
            }
            for ((away, x), before) in self.away.iter_mut().zip(&member.x).zip(&self.before) {
                away.0[lane] = x - before;
            }
            self.bent.copy_from_slice(&self.after);
            if group.distance[lane] > HARDLY {
                cylinder.bend(&self.before, &member.x, dt_s, &self.crossing, &mut self.bent)?;
            }
            member.x[..m].copy_from_slice(&self.bent);
        }
        Ok(())
    }

    /// Noise that all share, and that of mass and leak rate as each member supposes.
    fn set_noise(&mut self, group: Some4, members: &[Member]) {
        let supposed = |of: fn(&Member) -> f64| {
            Lanes(std::array::from_fn(|lane| of(members.get(lane).unwrap_or(&members[0]))))
        };
        let mass = supposed(|member| member.hypothesis.mass_walk_kg_per_sqrt_s.powi(2));
        let leak = supposed(|member| member.hypothesis.rate.per_sqrt_s.powi(2));
        let Crossing { noise, by_mass, by_leak, .. } = &self.crossing;
        self.transition.set_noise(group, |place| {
            Lanes::splat(noise[place]) + mass * by_mass[place] + leak * by_leak[place]
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
    /// The next reference with all that are near it, among the lanes that are left; lanes without a member join the first group.
    fn next(cylinder: &Cylinder, members: &[Member], left: &mut Some4) -> Option<Self> {
        let candidates = || (0..members.len()).filter(|&lane| left[lane]);
        let leaks = |lane: &usize| !members[*lane].hypothesis.rate.is_known();
        let reference = candidates().find(leaks).or_else(|| candidates().next())?;
        let mut group = Self { reference, lanes: *left, distance: [0.0; LANES] };
        let of = &members[reference];
        for lane in candidates().filter(|&lane| lane != reference) {
            let member = &members[lane];
            group.distance[lane] =
                cylinder.distance((&of.hypothesis, &of.x), (&member.hypothesis, &member.x));
            group.lanes[lane] = group.distance[lane] <= 1.0;
        }
        left.iter_mut().zip(group.lanes).for_each(|(left, taken)| *left &= !taken);
        Some(group)
    }
}

/// The members of some lanes.
fn lanes_of(group: Some4, members: &mut [Member]) -> impl Iterator<Item = (usize, &mut Member)> {
    members.iter_mut().enumerate().filter(move |(lane, _)| group[*lane])
}

fn one_lane(lane: usize, from: &[Lanes], to: &mut [f64]) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to = from.0[lane]);
}

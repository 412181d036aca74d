//! Another estimate of the same cylinder that uses the observer's model and memory: one that goes on without the pressure, or that has thermometers in
//! each other's place. It takes the observer's place for a step, so that three estimates need one model.
use alloc::vec::Vec;
use core::mem::swap;

use super::clock::Clock;
use super::commissioning::BegunFrom;
use super::roles::Roles;
use super::signature::Onsets;
use super::{Observer, Snapshot};
use crate::filter::StateSpace;
use crate::thermal::reduced::WarmStart;

/// An estimate beside that of an [`Observer`], which alone can go on with it.
#[derive(Debug)]
pub struct Companion {
    now: Snapshot,
    roles: Roles,
    replaced: Vec<bool>,
    begun_from: BegunFrom,
    memory: WarmStart,
}

impl Companion {
    /// Where it is.
    pub fn snapshot(&self) -> &Snapshot {
        &self.now
    }
}

impl Observer {
    /// A companion that has seen nothing yet, of the first so many members of the bank.
    pub fn companion(&self, members: usize) -> Companion {
        let bank = &self.cylinder.settings().bank;
        let roles = Roles::of(&bank[..members.min(bank.len())]);
        Companion {
            now: Snapshot {
                bank: self.room_for(&roles),
                onsets: roles
                    .held
                    .map_or_else(Onsets::default, |_| Onsets::with_room(self.cylinder.states())),
                clock: Clock::new(self.cylinder.sensors()),
                warm_start: self.fresh_start.clone(),
            },
            replaced: vec![false; roles.members],
            begun_from: BegunFrom::new(&self.commissioning, self.cylinder.outputs()),
            memory: self.fresh_start.clone(),
            roles,
        }
    }

    /// A companion of all members becomes as the observer is now.
    pub fn let_follow(&self, companion: &mut Companion) {
        self.snapshot_into(&mut companion.now);
    }

    /// Do something as a companion.
    pub fn with<R>(&mut self, companion: &mut Companion, act: impl FnOnce(&mut Self) -> R) -> R {
        self.change_places(companion);
        let done = act(self);
        self.change_places(companion);
        done
    }

    fn change_places(&mut self, companion: &mut Companion) {
        let Companion { now, roles, replaced, begun_from, memory } = companion;
        swap(&mut self.bank, &mut now.bank);
        swap(&mut self.onsets, &mut now.onsets);
        swap(&mut self.clock, &mut now.clock);
        swap(&mut self.roles, roles);
        swap(&mut self.replaced, replaced);
        swap(&mut self.begun_from, begun_from);
        self.cylinder.set_loosened(&self.clock.loosened);
        self.cylinder.write_warm_start(memory);
        self.cylinder.model().set_warm_start(&now.warm_start);
        swap(memory, &mut now.warm_start);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observer::{Commissioning, Estimate, ObserverSettings};
    use crate::sensor::Sensor;
    use crate::thermal::vessel::presets;

    fn new(members: usize) -> Observer {
        let vessel = presets::load("nitrogen-20l").unwrap();
        let sensors = ["shoulder", "valve", "pressure"].map(|name| Sensor::typical(name).unwrap());
        let mut settings = ObserverSettings::default();
        settings.bank.truncate(members);
        Observer::new(&vessel, &sensors, &Commissioning::filled(200e5, 288.15), &settings).unwrap()
    }

    fn row(minute: u32, pressure: bool) -> (f64, [f64; 3]) {
        let warm_k = 4.0 * (f64::from(minute) / 30.0).sin();
        let pressure_pa = if pressure { 200e5 + 0.7e5 * warm_k } else { f64::NAN };
        (60.0 * f64::from(minute), [288.0 + warm_k, 288.1 + 1.2 * warm_k, pressure_pa])
    }

    /// What an observer says that takes rows alone.
    fn alone(members: usize, pressure: bool) -> Vec<Estimate> {
        let mut observer = new(members);
        let step = |minute| {
            let (time_s, readings) = row(minute, pressure);
            observer.step(time_s, &readings).unwrap()
        };
        (0..300).map(step).collect()
    }

    #[test]
    fn a_companion_says_what_an_observer_of_its_own_says_and_does_not_disturb_the_first() {
        let mut observer = new(usize::MAX);
        let all = observer.roles.members;
        let mut companions = [observer.companion(all), observer.companion(1)];
        let mut said = [Vec::new(), Vec::new(), Vec::new()];
        for minute in 0..300 {
            let (time_s, readings) = row(minute, true);
            said[0].push(observer.step(time_s, &readings).unwrap());
            let (_, without) = row(minute, false);
            for (companion, (said, readings)) in
                companions.iter_mut().zip(said[1..].iter_mut().zip([without, readings]))
            {
                said.push(observer.with(companion, |observer| observer.step(time_s, &readings)).unwrap());
            }
        }
        let expected = [alone(all, true), alone(all, false), alone(1, true)];
        for (said, expected) in said.iter().zip(&expected) {
            for (said, expected) in said.iter().zip(expected) {
                // Bit by bit: what is no number is none in both.
                assert_eq!(format!("{said:?}"), format!("{expected:?}"));
            }
        }
    }
}

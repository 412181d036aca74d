//! Jumps of the pressure: noticed, examined, and what follows from them.
//!
//! The observer goes back before the jump and takes it with the mass free; a shadow of it goes on without the pressure, and what it
//! expects shows what the jump was. Until that is told, what is said of the gas is between both, and no more certain than they are apart.
//!
//! Beside the jumps, bounds of the mass tell gas that flows steadily ([`crate::monitor::gas::bounds`]), by the walls and by that member.
use alloc::vec::Vec;
use serde::{Deserialize, Serialize};

use super::{Monitor, SETTLED_S};
use crate::DetectorError;
use crate::estimator::observer::{Estimate, Flow, Innovation, Quality};
use crate::estimator::sensor::{ParameterKind, Site};
use crate::monitor::examination::{Before, Cause, Compared, Examination, NO_OFFSET, Subject};
use crate::monitor::gas::bounds::{Certain, Contact, FLOW_DEVIATIONS, Seen};
use crate::monitor::gas::jump::{Innovated, LONGEST_INTERVAL_S, USUAL_LARGEST};
use crate::monitor::gas::leak::{Change, LostUnheard};
use crate::monitor::step::judgement::MATTERS;
use crate::monitor::{Event, EventKind, Reason, restored};

/// Time for which a jump that remained unclear leaves doubt, s.
const DOUBT_S: f64 = 86_400.0;
/// Time by which an announced exchange may begin earlier or later than was said, s.
const ANNOUNCED_WITHIN_S: f64 = 600.0;

/// A jump under examination.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Examined {
    pub examination: Examination,
    before_kg: f64,
    pub samples: usize,
    pub flowing: bool,
    /// Since when nothing had been heard before it, s, if that was for long.
    silent_since_s: Option<f64>,
}

impl Examined {
    /// Checks one that was saved.
    pub(super) fn validate(&self) -> Result<(), DetectorError> {
        restored::count("examined.samples", self.samples as u64)?;
        self.examination.validate()
    }
}

/// Gas that was exchanged.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct Exchanged {
    pub at_s: f64,
    pub out: bool,
    pub announced: bool,
    /// How much, as a part of the fill.
    pub part: f64,
}

/// What is considered of the gas, as a part of it; an empty cylinder has none.
fn considered_part(flow: &Flow) -> f64 {
    if flow.mass_kg > 0.0 { flow.considered_sd_kg / flow.mass_kg } else { 0.0 }
}

impl Monitor {
    /// The observer's step, with what a jump of the pressure makes of it.
    pub(super) fn observe(
        &mut self,
        time_s: f64,
        silent_s: f64,
        events: &mut Vec<Event>,
    ) -> Result<Estimate, DetectorError> {
        if self.state.examined.is_some() {
            let estimate = self.observer.step(time_s, &self.usable)?;
            return self.examine(estimate, events);
        }
        self.keep_for_the_way_back();
        let before_kg = self.masses_kg();
        let estimate = self.observer.step(time_s, &self.usable)?;
        let Some(pressure) = self.roles.pressure else { return Ok(estimate) };
        let silent_since_s = (silent_s > LONGEST_INTERVAL_S).then_some(self.state.last_s);
        let any_temperature = self.roles.thermometers.iter().any(|&sensor| self.usable[sensor].is_finite());
        if self.blindness(time_s).is_some() && !(silent_since_s.is_some() && any_temperature) {
            // Without a temperature every change of the air is a change of the pressure.
            self.state.jumps.forget();
            return Ok(estimate);
        }
        if estimate.quality == Quality::Restarted
            && let Some(before_kg) = before_kg
        {
            // A row that cannot be with the gas as it was: perhaps it can with other gas.
            return self.begin_examination((time_s, silent_since_s), Before::default(), before_kg, events);
        }
        let of_full = self.full_pa.recip();
        let Innovation { nu, s, .. } = self.observer.innovations()[pressure];
        let innovation = of_full * nu;
        let fresh = of_full * self.observer.fresh_doubt_pa(pressure)?;
        let now = Innovated {
            time_s,
            reading: of_full * self.usable[pressure],
            innovation,
            doubt: FLOW_DEVIATIONS * fresh,
        };
        let step = of_full * self.state.watches[pressure].step();
        let doubted = FLOW_DEVIATIONS * self.settings.observer.flow_doubt.part;
        let jump = self.state.jumps.notice(now, step, doubted);
        // What the surroundings did in a silence no reading shows: they may have made all of it.
        let unexpected = innovation.abs() > MATTERS + FLOW_DEVIATIONS * of_full * libm::sqrt(s);
        let silent = silent_since_s.filter(|_| unexpected);
        let silent = silent.map(|_| Before { unseen: innovation.abs(), ..Before::default() });
        let fresh = self.state.jumps.excess() * fresh;
        let begun = jump.map(|before| Before { missing: -before, fresh, unseen: 0.0 }).or(silent);
        match (begun, before_kg) {
            (Some(before), Some(before_kg)) => {
                self.begin_examination((time_s, silent_since_s), before, before_kg, events)
            }
            _ => Ok(estimate),
        }
    }

    /// Loss and gain of gas that no temperature explains, whatever the observer says.
    pub(super) fn watch_bounds(
        &mut self,
        estimate: Estimate,
        events: &mut Vec<Event>,
    ) -> Result<Estimate, DetectorError> {
        let time_s = estimate.time_s;
        if estimate.quality == Quality::Restarted {
            self.state.bounds.forget_flow();
        }
        let Some(seen) = self.seen(time_s) else { return Ok(estimate) };
        let contents = &self.contents;
        let mass_kg =
            |pressure_pa, temperature_k| contents.mass_kg(pressure_pa, temperature_k).unwrap_or(f64::NAN);
        let before_kg = self.masses_kg();
        let Some(certain) = self.state.bounds.push(&seen, mass_kg) else {
            self.watch_flow(time_s, events);
            return Ok(estimate);
        };
        // A jump that may be the transmitter's is being examined; so much is none, if it is no spike.
        let examined = self.state.examined.as_ref();
        let large = self.state.bounds.beyond() >= NO_OFFSET;
        let may_be_gas = |of: &Examined| of.flowing || large && !of.examination.is_likely_nothing();
        if examined.is_some_and(|of| !may_be_gas(of)) {
            return Ok(estimate);
        }
        let out = certain == Certain::Out;
        if out && self.state.leak.found().is_some() {
            // It is told already, and goes on: where the mass has not followed it does, the leak stays.
            self.state.bounds.gone(certain);
            let followed = before_kg.is_some_and(|mass_kg| self.state.bounds.allow(mass_kg));
            let done = followed || self.state.examined.is_some();
            return if done { Ok(estimate) } else { self.step_anew(time_s) };
        }
        let onset_s = examined.map_or(time_s, |examined| examined.examination.onset_s());
        let (announced, part) = (self.is_announced(onset_s), self.state.bounds.beyond());
        self.state.bounds.gone(certain);
        self.state.exchanged = Some(Exchanged { at_s: time_s, out, announced, part: part.max(MATTERS) });
        if self.state.examined.is_some() {
            return Ok(estimate);
        }
        let estimate = self.step_anew(time_s)?;
        let change_kg = self.masses_kg().zip(before_kg).map_or(f64::NAN, |(now, before)| now - before);
        let change_kg = if out { change_kg.min(0.0) } else { change_kg.max(0.0) };
        self.exchanged(time_s, onset_s, change_kg, out, events);
        Ok(estimate)
    }

    /// Loss and gain of gas by the observer's flowing member.
    fn watch_flow(&mut self, time_s: f64, events: &mut Vec<Event>) {
        if self.state.examined.is_some() || self.blindness(time_s).is_some() || !self.is_pressure_used() {
            return;
        }
        let Some(flow) = self.observer.flow() else { return };
        let shaken = self.settings.observer.flow_doubt.part * self.state.pair.moved_k() / flow.gas_mean_k;
        let certain = self.state.bounds.push_flow(time_s, &flow, self.filled_kg.0, shaken);
        let Some(certain) = certain else { return };
        let out = certain == Certain::Out;
        let known = out && self.state.leak.found().is_some();
        let beside_kg = self.masses_kg().map_or(f64::INFINITY, |mass_kg| (mass_kg - flow.mass_kg).abs());
        if known && beside_kg < self.state.bounds.comes_and_goes_kg(&flow, self.filled_kg.0) {
            // The leak that was found has done it.
            self.state.bounds.gone(certain);
            return;
        }
        let held_kg = self.observer.leaks().map(|member| member.mass_kg);
        let least_kg = MATTERS * self.filled_kg.0;
        let change_kg = if out {
            (flow.mass_kg - held_kg.fold(flow.mass_kg, f64::max)).min(-least_kg)
        } else {
            (flow.mass_kg - held_kg.fold(flow.mass_kg, f64::min)).max(least_kg)
        };
        self.observer.follow_the_flow();
        self.state.jumps.forget();
        self.state.bounds.gone(certain);
        self.state.flowed_s = time_s;
        if known {
            return;
        }
        let lasting = |of: &&mut Exchanged| time_s - of.at_s < SETTLED_S && of.out == out;
        if let Some(exchanged) = self.state.exchanged.as_mut().filter(lasting) {
            // It goes on: one exchange, and masses that tell a leak from it.
            exchanged.at_s = time_s;
            exchanged.part += change_kg.abs() / self.filled_kg.0;
            return;
        }
        self.exchanged(time_s, time_s, change_kg, out, events);
    }

    /// The present row once more, with nothing known of the gas.
    fn step_anew(&mut self, time_s: f64) -> Result<Estimate, DetectorError> {
        self.go_back();
        self.free_the_mass();
        let estimate = self.observer.step(time_s, &self.usable)?;
        self.observer.end_exchange();
        Ok(estimate)
    }

    /// What thermometers and pressure of the present row bound the mass by; `None` where one of them is missing.
    fn seen(&self, time_s: f64) -> Option<Seen> {
        let pressure = self.roles.pressure?;
        let pressure_pa = Some(self.usable[pressure]).filter(|pressure_pa| pressure_pa.is_finite())?;
        let usable = || {
            let readings = self.roles.thermometers.iter().map(|&sensor| (sensor, self.usable[sensor]));
            readings.filter(|(_, reading)| reading.is_finite())
        };
        let in_gas = |sensor: usize| matches!(self.sensors[sensor].site(), Site::Gas(_));
        let any_in_gas = usable().any(|(sensor, _)| in_gas(sensor));
        let counted = usable().filter(|&(sensor, _)| !any_in_gas || in_gas(sensor));
        let ends = (f64::INFINITY, f64::NEG_INFINITY);
        let extremes_k = counted.fold(ends, |(low, high), (_, k)| (low.min(k), high.max(k)));
        let transmitter = &self.sensors[pressure];
        let mut coefficients =
            transmitter.parameters().iter().filter(|of| of.kind == ParameterKind::TemperatureCoefficient);
        extremes_k.0.is_finite().then(|| Seen {
            time_s,
            extremes_k,
            contact: if any_in_gas { Contact::Gas } else { Contact::Wall },
            pressure_pa,
            coefficient_pa_k: coefficients.next().map_or(0.0, |of| of.sd),
            noise_pa: libm::sqrt(transmitter.noise_variance()),
        })
    }

    /// An exchange of gas is announced for a time, s, as rows are stamped: what goes out then is no loss.
    pub fn announce(&mut self, from_s: f64, until_s: f64) {
        if !self.state.announced.contains(&(from_s, until_s)) {
            self.state.announced.push((from_s, until_s));
        }
    }

    /// Whether an exchange that began then was announced.
    pub(super) fn is_announced(&self, onset_s: f64) -> bool {
        let stamp_s = onset_s + self.state.intake.offset_s();
        let near = |&(from_s, until_s): &(f64, f64)| {
            (from_s - ANNOUNCED_WITHIN_S..=until_s + ANNOUNCED_WITHIN_S).contains(&stamp_s)
        };
        self.state.announced.iter().any(near)
    }

    /// Mass by the freest member, kg.
    fn masses_kg(&self) -> Option<f64> {
        self.observer.freest_mass_kg().map(|(mass_kg, _)| mass_kg)
    }

    /// Go back before the present row, and take it with the mass free and, in the shadow, without the pressure.
    fn begin_examination(
        &mut self,
        (time_s, silent_since_s): (f64, Option<f64>),
        before: Before,
        before_kg: f64,
        events: &mut Vec<Event>,
    ) -> Result<Estimate, DetectorError> {
        self.go_back();
        self.free_the_mass();
        let estimate = self.observer.step(time_s, &self.usable)?;
        let memory_s = self.settings.observer.flow_doubt.memory_s;
        let examination =
            Examination::new(Subject::Pressure, time_s, before, memory_s, self.state.jumps.far_off());
        self.state.examined =
            Some(Examined { examination, before_kg, samples: 0, flowing: false, silent_since_s });
        self.examine(estimate, events)
    }

    /// Let the observer take the mass from the present readings: nothing of what it knew of the gas holds.
    fn free_the_mass(&mut self) {
        self.observer.begin_exchange();
        if let Some(pressure) = self.roles.pressure {
            self.observer.forget_offset(self.place_of(pressure));
        }
    }

    /// The observer as it is now is the one to go back to: before each row, and after an examination.
    fn keep_for_the_way_back(&mut self) {
        self.observer.let_follow(&mut self.shadow);
    }

    /// The observer as it was before the present row.
    fn go_back(&mut self) {
        self.observer.restore(self.shadow.snapshot());
    }

    /// A sample of a jump: what it shows, and what follows.
    fn examine(&mut self, estimate: Estimate, events: &mut Vec<Event>) -> Result<Estimate, DetectorError> {
        let time_s = estimate.time_s;
        let Some(pressure) = self.roles.pressure else { return Ok(estimate) };
        let reading_pa = core::mem::replace(&mut self.usable[pressure], f64::NAN);
        let usable = &self.usable;
        let (blind, expected_pa) = self.observer.with(&mut self.shadow, |shadow| {
            let blind = shadow.step(time_s, usable)?;
            shadow.expected_reading(pressure).map(|expected_pa| (blind, expected_pa))
        })?;
        self.usable[pressure] = reading_pa;
        let now = self.observer.flow();
        let of_full = self.full_pa.recip();
        // A step is not known before there were some.
        let step = (of_full * self.state.watches[pressure].step()).min(USUAL_LARGEST);
        let compared = Compared {
            time_s,
            missing: of_full * (expected_pa - reading_pa),
            considered: now.map_or(0.0, |flow| of_full * expected_pa * considered_part(&flow)),
            noise: libm::hypot(
                step / libm::sqrt(12_f64),
                of_full * libm::sqrt(self.sensors[pressure].noise_variance()),
            ),
        };
        let Some(examined) = &mut self.state.examined else { return Ok(estimate) };
        examined.samples += 1;
        let cause = examined.examination.push(compared);
        examined.flowing = cause == Cause::Flowing;
        match cause {
            Cause::Open => return Ok(blind.or(estimate)),
            Cause::Flowing => return Ok(estimate),
            Cause::Spike | Cause::Passed | Cause::Offset(_) => {
                self.observer.restore(self.shadow.snapshot());
                self.state.jumps.were_far_off(examined.examination.seen_far_off());
                let shift = if let Cause::Offset(by) = cause { by } else { 0.0 };
                if shift != 0.0 {
                    self.shift_transmitter(pressure, shift * self.full_pa);
                } else {
                    self.state.jumps.was_none();
                }
                if cause == Cause::Spike {
                    self.state.watches[pressure].refused(time_s);
                }
                let (reading, innovation) = (of_full * reading_pa - shift, -compared.missing - shift);
                self.state.jumps.go_on(Innovated { time_s, reading, innovation, doubt: 0.0 });
            }
            Cause::Gas | Cause::Unclear => {
                self.exchange(time_s, cause == Cause::Unclear, events);
                self.state.jumps.forget();
            }
        }
        self.state.examined = None;
        self.keep_for_the_way_back();
        Ok(if matches!(cause, Cause::Gas | Cause::Unclear) { estimate } else { blind })
    }

    /// The transmitter's offset has changed by so much, Pa. That it did is no more certain than what was not seen without the pressure: as much is in doubt of it from
    /// then on, and what was held against its readings begins anew.
    fn shift_transmitter(&mut self, pressure: usize, by_pa: f64) {
        self.state.watches[pressure].shift(by_pa);
        self.observer.loosen(self.place_of(pressure), by_pa.abs());
        self.state.bounds.forget_flow();
    }

    /// Gas was exchanged, and the flow is over.
    fn exchange(&mut self, time_s: f64, unclear: bool, events: &mut Vec<Event>) {
        let Some(examined) = &self.state.examined else { return };
        let onset_s = examined.examination.onset_s();
        // Which way it went the pressure says; in a tunnel the mass may not have come to it yet.
        let error_pa = self.full_pa * examined.examination.error();
        let by_pressure_kg = -error_pa / self.state.p15.slope_pa_kg();
        let by_mass_kg = self.masses_kg().map_or(f64::NAN, |mass_kg| mass_kg - examined.before_kg);
        let change_kg = if by_mass_kg * by_pressure_kg < 0.0 { by_pressure_kg } else { by_mass_kg };
        self.observer.end_exchange();
        if unclear {
            self.state.look = (time_s + DOUBT_S, Reason::Jump);
        }
        if !self.state.bounds.allow(examined.before_kg + change_kg) {
            // What the shadow expects cannot be: it has been led astray, and the jump says nothing.
            self.state.look = (time_s + DOUBT_S, Reason::Jump);
            return;
        }
        let out = change_kg < 0.0;
        match examined.silent_since_s {
            Some(since_s) if out => {
                self.state.bounds.gone(Certain::Out);
                self.state.lost_across =
                    Some(LostUnheard { from_s: since_s, until_s: onset_s, mass_kg: -change_kg });
            }
            Some(since_s) => {
                // It may be another bottle, with sensors of its own.
                (0..self.usable.len()).for_each(|sensor| self.observer.renew(sensor));
                self.exchanged(time_s, since_s, change_kg, out, events);
            }
            None => self.exchanged(time_s, onset_s, change_kg, out, events),
        }
    }

    fn exchanged(&mut self, time_s: f64, onset_s: f64, change_kg: f64, out: bool, events: &mut Vec<Event>) {
        self.state.bounds.gone(if out { Certain::Out } else { Certain::In });
        self.state.flowed_s = time_s;
        let kind = if out { EventKind::Discharge(-change_kg) } else { EventKind::Refill(change_kg) };
        events.push(Event::new(time_s, onset_s, kind));
        let announced = self.is_announced(onset_s);
        let part = change_kg.abs() / self.filled_kg.0;
        let certain = self.state.exchanged.filter(|of| of.at_s == time_s).map_or(0.0, |of| of.part);
        self.state.exchanged = Some(Exchanged { at_s: time_s, out, announced, part: part.max(certain) });
        if part >= NO_OFFSET {
            self.state.filling.settle();
        }
        self.state.undisturbed.forget();
        if self.state.leak.begin_anew() == Change::Ended {
            events.push(Event::new(time_s, onset_s, EventKind::LeakEnded));
        }
        self.forget_masses();
    }

    /// A filling so slow that nothing jumped is over.
    pub(super) fn notice_gain(&mut self, time_s: f64, events: &mut Vec<Event>) {
        // A mass that does not fit the readings wanders.
        let learning = self.state.start_s.is_none_or(|start_s| time_s - start_s < self.settings.learning_s);
        let wanders = learning || self.state.filling.is_wrong();
        if wanders || self.state.is_exchanging(time_s) || self.blindness(time_s).is_some() {
            self.state.gains.forget();
            return;
        }
        let Some(mass_kg) = self.masses_kg().filter(|_| self.is_pressure_used()) else { return };
        if let Some((onset_s, gain_kg)) = self.state.gains.push(time_s, mass_kg, self.filled_kg.0) {
            self.observer.begin_exchange();
            self.observer.end_exchange();
            self.exchanged(time_s, onset_s, gain_kg, false, events);
        }
    }

    pub(super) fn forget_masses(&mut self) {
        self.state.evidence.forget();
        self.observer.forget_onsets();
        if self.state.leak.found().is_none() {
            self.state.leak.begin_anew();
        }
    }
}

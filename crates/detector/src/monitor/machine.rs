//! The monitor of one cylinder.
use serde::{Deserialize, Serialize};

use super::alarm::{AlarmEvent, AlarmInputs, AlarmPanel};
use super::contents::Tangent;
use super::health::SensorWatch;
use super::intake::{Intake, Row, Taken};
use super::jump::{Cause, Examination, JumpWatch};
use super::leak::{Change, LeakState, Look};
use super::outlook::{self, LimitMasses};
use super::rewind::Rewind;
use super::roles::Roles;
use super::settings::MonitorSettings;
use super::state::{self, Fingerprint, StateError};
use super::thermometers::{Lonely, Pair};
use super::{Event, EventKind, Health, Outlook, Output, Reason, Verdict};
use crate::DetectorError;
use crate::estimator::observer::{
    Commissioning, Estimate, Leak, Learned, Observer, Outcome, Quality, Snapshot,
};
use crate::estimator::sensor::Sensor;
use crate::estimator::thermal::vessel::Vessel;
use crate::evidence::{Evidence, Statistics, Thresholds};
use crate::prognosis::{Contents, QUOTED_K, ReactionSettings};

/// Change of the pressure across a gap that is no error of the observer, Pa, and the gap, s.
const ACROSS_PA: f64 = 2e5;
const ACROSS_S: f64 = 900.0;
/// Time after a gap, a blindness or a restart until something can be told again, s.
const LOOK_S: f64 = 3600.0;
/// Time after an exchange of gas for which it is the verdict, and until it has settled, s.
const EXCHANGED_S: f64 = 1800.0;
const SETTLED_S: f64 = 3.0 * 3600.0;
/// Time for which a jump that remained unclear leaves doubt, s.
const DOUBT_S: f64 = 86_400.0;
/// Distance from the limit at which a warning of the cold may come again, Pa.
const COLD_DEADBAND_PA: f64 = 1e5;
/// Samples of an examination after which the jump is no spike.
const NO_SPIKE: usize = 3;

/// Monitor of one cylinder: a pure function of its state and the row, so that batch, stream and a stream that was killed and
/// restored at any row give the same, bit for bit.
#[derive(Debug)]
pub struct Monitor {
    settings: MonitorSettings,
    contents: Contents,
    limits: LimitMasses,
    thresholds: Thresholds,
    full_pa: f64,
    roles: Roles,
    fingerprint: Fingerprint,
    commissioning: Commissioning,
    observer: Observer,
    /// Goes on without the pressure while a jump is examined.
    shadow: Observer,
    state: State,
    /// Of the present row.
    usable: Vec<f64>,
    leaks: Vec<Leak>,
}

/// All that a row changes, but for the observers.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct State {
    intake: Intake,
    watches: Vec<SensorWatch>,
    health: Vec<Health>,
    pair: Pair,
    jumps: JumpWatch,
    examined: Option<Examined>,
    rewind: Rewind,
    leak: LeakState,
    evidence: Evidence,
    /// Pressure was lost across a gap.
    lost_across: bool,
    /// Events that wait for a row.
    waiting: Vec<Event>,
    panel: AlarmPanel,
    verdict: Verdict,
    start_s: Option<f64>,
    last_s: f64,
    /// Until then nothing can be told, and why.
    look: (f64, Reason),
    exchanged: Option<Exchanged>,
    outlook: Option<Outlook>,
    outlook_due_s: f64,
    p15: Tangent,
    cold: Tangent,
    warned: bool,
}

impl State {
    /// Whether gas may be being exchanged, or has been and has not settled.
    fn is_exchanging(&self, time_s: f64) -> bool {
        self.examined.is_some() || self.exchanged.is_some_and(|of| time_s - of.at_s < SETTLED_S)
    }
}

/// A jump under examination.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Examined {
    examination: Examination,
    before_kg: f64,
    samples: usize,
    flowing: bool,
}

/// Gas that was exchanged.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Exchanged {
    at_s: f64,
    out: bool,
}

/// What is saved.
#[derive(Serialize, Deserialize)]
struct Saved {
    commissioning: Commissioning,
    reaction: ReactionSettings,
    state: State,
    observer: Snapshot,
    shadow: Option<Snapshot>,
}

/// What a state belongs to. When a reaction is due does not belong to it: the next service comes nearer every day.
fn fingerprint(vessel: &Vessel, sensors: &[Sensor], settings: &MonitorSettings) -> Fingerprint {
    let settings = MonitorSettings { reaction: ReactionSettings::default(), ..settings.clone() };
    state::fingerprint(&(vessel, sensors, settings))
}

impl Monitor {
    /// A monitor that begins with the first row.
    ///
    /// # Errors
    /// A setting is out of its bounds, a sensor has no place on the vessel, or the filling is no state of the fluid.
    pub fn new(
        vessel: &Vessel,
        sensors: &[Sensor],
        commissioning: &Commissioning,
        settings: &MonitorSettings,
    ) -> Result<Self, DetectorError> {
        settings.validate()?;
        let observer = || Observer::new(vessel, sensors, commissioning, &settings.observer);
        let contents = Contents::of(vessel);
        let full_kg = commissioning.mass_kg(vessel, QUOTED_K)?;
        let watches: Vec<SensorWatch> = sensors.iter().map(SensorWatch::new).collect();
        let state = State {
            intake: Intake::new(settings.intake, sensors.len())?,
            health: watches.iter().map(SensorWatch::health).collect(),
            watches,
            pair: Pair::default(),
            jumps: JumpWatch::default(),
            examined: None,
            rewind: Rewind::default(),
            leak: LeakState::default(),
            evidence: Evidence::try_new(&settings.observer)?,
            lost_across: false,
            waiting: Vec::new(),
            panel: AlarmPanel::default(),
            verdict: Verdict::Unknown(Reason::Learning),
            start_s: None,
            last_s: f64::NEG_INFINITY,
            look: (f64::NEG_INFINITY, Reason::Gap),
            exchanged: None,
            outlook: None,
            outlook_due_s: f64::NEG_INFINITY,
            p15: Tangent::at(QUOTED_K),
            cold: Tangent::at(settings.limits.coldest_k),
            warned: false,
        };
        Ok(Self {
            limits: LimitMasses::new(&contents, settings, full_kg)?,
            thresholds: Thresholds::for_mean_time_s(settings.false_alarm_interval_s)?,
            full_pa: contents.pressure_pa(full_kg, QUOTED_K)?,
            roles: Roles::of(sensors),
            fingerprint: fingerprint(vessel, sensors, settings),
            observer: observer()?,
            shadow: observer()?,
            commissioning: *commissioning,
            usable: vec![f64::NAN; sensors.len()],
            leaks: Vec::with_capacity(settings.observer.bank.len()),
            settings: settings.clone(),
            contents,
            state,
        })
    }

    /// Start with what an observer of the same cylinder has learnt; before the first row.
    pub fn with_learned(mut self, learned: Learned) -> Self {
        self.observer = self.observer.with_learned(learned);
        self
    }

    /// A monitor that goes on from saved bytes, with the commissioning of then. Other settings of the reaction are taken over.
    ///
    /// # Errors
    /// The bytes are no state of this vessel, these sensors and settings, of this version, whole and unchanged; or as
    /// [`Monitor::new`].
    pub fn restore(
        vessel: &Vessel,
        sensors: &[Sensor],
        settings: &MonitorSettings,
        bytes: &[u8],
    ) -> Result<Self, DetectorError> {
        let saved: Saved = state::decode(bytes, &fingerprint(vessel, sensors, settings))?;
        let mut monitor = Self::new(vessel, sensors, &saved.commissioning, settings)?;
        monitor.observer.try_restore(&saved.observer)?;
        if let Some(shadow) = &saved.shadow {
            monitor.shadow.try_restore(shadow)?;
        }
        monitor.state = saved.state;
        if saved.reaction != settings.reaction {
            monitor.state.outlook_due_s = f64::NEG_INFINITY;
        }
        Ok(monitor)
    }

    /// Everything that a restart needs.
    ///
    /// # Errors
    /// [`StateError::Engine`].
    pub fn save(&self) -> Result<Vec<u8>, StateError> {
        let examined = self.state.examined.is_some();
        let saved = Saved {
            commissioning: self.commissioning,
            reaction: self.settings.reaction,
            state: self.state.clone(),
            observer: self.observer.snapshot(),
            shadow: examined.then(|| self.shadow.snapshot()),
        };
        state::encode(&saved, &self.fingerprint)
    }

    /// Take in a row with its stamp, s, and one reading per sensor, SI, NaN where missing: an output for each row that is ready now.
    ///
    /// # Errors
    /// The row has another length; all is then as it was. Or the filling fits no state of the fluid.
    pub fn step(&mut self, stamp_s: f64, readings: &[f64]) -> Result<Vec<Output>, DetectorError> {
        let taken = self.state.intake.take(stamp_s, readings)?;
        self.process_all(taken)
    }

    /// The same of a row that says that it is replayed from a store: it never moves the clock.
    ///
    /// # Errors
    /// As [`Monitor::step`].
    pub fn step_historical(&mut self, stamp_s: f64, readings: &[f64]) -> Result<Vec<Output>, DetectorError> {
        let taken = self.state.intake.take_historical(stamp_s, readings)?;
        self.process_all(taken)
    }

    /// The rows have come to their end: what was held back.
    ///
    /// # Errors
    /// As [`Monitor::step`].
    pub fn finish(&mut self) -> Result<Vec<Output>, DetectorError> {
        let taken = self.state.intake.flush();
        self.process_all(taken)
    }

    /// Somebody has seen the alarms and looked after the sensors.
    pub fn acknowledge(&mut self, comment: &str) -> Vec<AlarmEvent> {
        self.state.watches.iter_mut().for_each(SensorWatch::repaired);
        let panel = std::mem::take(&mut self.state.panel);
        let (panel, events) = panel.acknowledge_all(&self.settings.alarms, self.state.last_s, comment);
        self.state.panel = panel;
        events
    }

    /// The alarms.
    pub fn alarms(&self) -> &AlarmPanel {
        &self.state.panel
    }

    /// The observer inside.
    pub fn observer(&self) -> &Observer {
        &self.observer
    }

    /// The statistics of the evidence for a leak after the last row.
    pub fn evidence(&self) -> Statistics {
        self.state.evidence.statistics()
    }

    /// What has become of the rows so far.
    pub fn intake(&self) -> &Intake {
        &self.state.intake
    }

    fn process_all(&mut self, taken: Taken) -> Result<Vec<Output>, DetectorError> {
        let mut outputs = Vec::with_capacity(taken.rows.len());
        let mut events = std::mem::take(&mut self.state.waiting);
        events.extend(taken.events);
        for row in &taken.rows {
            outputs.push(self.process(row, std::mem::take(&mut events))?);
        }
        // What happened without a row that could tell it comes with the next one.
        self.state.waiting = events;
        Ok(outputs)
    }

    fn process(&mut self, row: &Row, mut events: Vec<Event>) -> Result<Output, DetectorError> {
        let time_s = row.time_s;
        let silent_s = time_s - self.state.last_s;
        self.screen(row);
        self.watch_thermometers(time_s);
        if silent_s.is_finite() && silent_s > self.settings.gap_s {
            self.state.look = (time_s + LOOK_S, Reason::Gap);
        }
        let estimate = self.observe(time_s, silent_s, &mut events)?;
        self.mark_refused(time_s);
        if estimate.quality == Quality::Restarted {
            events.push(Event::new(time_s, time_s, EventKind::Restarted));
            self.state.look = (time_s + LOOK_S, Reason::Restarted);
            self.forget_masses();
        }
        self.state.start_s.get_or_insert(time_s);
        self.state.last_s = time_s;
        self.judge_leak(&estimate, &mut events)?;
        self.tell_health(time_s, &mut events);
        let verdict = self.verdict(time_s);
        let was = std::mem::replace(&mut self.state.verdict, verdict);
        if was != verdict {
            events.push(Event::new(time_s, time_s, EventKind::Verdict { from: was, to: verdict }));
        }
        self.output(row, estimate, was != verdict, events)
    }

    /// Readings that can be used.
    fn screen(&mut self, row: &Row) {
        let judged = self.state.watches.iter_mut().zip(&row.readings);
        for ((watch, &reading), usable) in judged.zip(&mut self.usable) {
            *usable = watch.judge(row.time_s, reading);
        }
    }

    fn watch_thermometers(&mut self, time_s: f64) {
        let Some(pair) = self.roles.pair else { return };
        if self.state.is_exchanging(time_s) {
            // Gas that comes in or goes out warms or cools the shoulder before the valve.
            self.state.pair.forget();
            return;
        }
        let watches = &mut self.state.watches;
        let as_read = pair.map(|sensor| self.usable[sensor] + watches[sensor].correction());
        match self.state.pair.update(time_s, as_read) {
            None => {}
            Some(Lonely::Shifted(which, by_k)) => {
                watches[pair[which]].shift(by_k);
                self.usable[pair[which]] -= by_k;
            }
            Some(Lonely::Detached(which)) => {
                watches[pair[which]].detach();
                self.usable[pair[which]] = f64::NAN;
            }
        }
    }

    /// The observer's step, with what a jump of the pressure makes of it.
    fn observe(
        &mut self,
        time_s: f64,
        silent_s: f64,
        events: &mut Vec<Event>,
    ) -> Result<Estimate, DetectorError> {
        if self.state.examined.is_some() {
            let estimate = self.observer.step(time_s, &self.usable)?;
            return self.examine(estimate, events);
        }
        let before_kg = self.masses_kg();
        let estimate = self.observer.step(time_s, &self.usable)?;
        let Some(pressure) = self.roles.pressure else { return Ok(estimate) };
        let innovation = self.observer.innovations()[pressure];
        let (innovation_pa, sd_pa) = (innovation.nu, innovation.s.sqrt());
        let jump = self.state.jumps.notice(
            time_s,
            self.usable[pressure],
            (innovation_pa, sd_pa),
            self.state.pair.moved_k(),
        );
        if let (Some(before_pa), Some(before_kg)) = (jump, before_kg)
            && estimate.quality != Quality::Restarted
        {
            return self.begin_examination(time_s, before_pa, before_kg, events);
        }
        if silent_s > ACROSS_S
            && innovation_pa.abs() > ACROSS_PA
            && let Some(before_kg) = before_kg
        {
            return self.take_across(time_s, innovation_pa, before_kg, events);
        }
        self.state.rewind.taken(&self.observer, time_s, &self.usable);
        Ok(estimate)
    }

    /// Mass by the freest member, kg.
    fn masses_kg(&self) -> Option<f64> {
        self.observer.leaks().last().map(|free| free.mass_kg)
    }

    /// Go back before the present row, and take it with the mass free and, in the shadow, without the pressure.
    fn begin_examination(
        &mut self,
        time_s: f64,
        before_pa: f64,
        before_kg: f64,
        events: &mut Vec<Event>,
    ) -> Result<Estimate, DetectorError> {
        self.go_back()?;
        self.observer.begin_exchange();
        let estimate = self.observer.step(time_s, &self.usable)?;
        let examination = Examination::new(time_s, before_pa);
        self.state.examined = Some(Examined { examination, before_kg, samples: 0, flowing: false });
        self.examine(estimate, events)
    }

    /// Both observers as they were before the present row.
    fn go_back(&mut self) -> Result<(), DetectorError> {
        if self.state.rewind.restore(&mut self.shadow, self.usable.len())? {
            self.observer.restore(&self.shadow.snapshot());
        }
        Ok(())
    }

    /// A sample of a jump: what it shows, and what follows.
    fn examine(&mut self, estimate: Estimate, events: &mut Vec<Event>) -> Result<Estimate, DetectorError> {
        let time_s = estimate.time_s;
        let Some(pressure) = self.roles.pressure else { return Ok(estimate) };
        let reading_pa = std::mem::replace(&mut self.usable[pressure], f64::NAN);
        let blind = self.shadow.step(time_s, &self.usable)?;
        self.usable[pressure] = reading_pa;
        let expected_pa = self.shadow.expected_reading(pressure)?;
        let Some(examined) = &mut self.state.examined else { return Ok(estimate) };
        examined.samples += 1;
        let cause = examined.examination.push(time_s, expected_pa, reading_pa, blind.gas_mean_k);
        examined.flowing = cause == Cause::Flowing;
        match cause {
            Cause::Open | Cause::Flowing => return Ok(estimate),
            Cause::Spike | Cause::Passed | Cause::Offset(_) => {
                self.observer.restore(&self.shadow.snapshot());
                match cause {
                    Cause::Spike => self.state.watches[pressure].refused(time_s),
                    Cause::Offset(by_pa) => self.state.watches[pressure].shift(by_pa),
                    _ => {}
                }
            }
            Cause::Gas | Cause::Unclear => self.exchange(time_s, cause == Cause::Unclear, events),
        }
        self.state.examined = None;
        self.state.jumps.forget();
        self.state.rewind.begin(&self.observer);
        Ok(if matches!(cause, Cause::Gas | Cause::Unclear) { estimate } else { blind })
    }

    /// Gas was exchanged, and the flow is over.
    fn exchange(&mut self, time_s: f64, unclear: bool, events: &mut Vec<Event>) {
        let Some(examined) = &self.state.examined else { return };
        let onset_s = examined.examination.onset_s();
        let change_kg = self.masses_kg().map_or(f64::NAN, |mass_kg| mass_kg - examined.before_kg);
        self.observer.end_exchange();
        if unclear {
            self.state.look = (time_s + DOUBT_S, Reason::Jump);
        }
        self.exchanged(time_s, onset_s, change_kg, events);
    }

    fn exchanged(&mut self, time_s: f64, onset_s: f64, change_kg: f64, events: &mut Vec<Event>) {
        let out = change_kg < 0.0;
        let kind = if out { EventKind::Discharge(-change_kg) } else { EventKind::Refill(change_kg) };
        events.push(Event::new(time_s, onset_s, kind));
        self.state.exchanged = Some(Exchanged { at_s: time_s, out });
        if self.state.leak.begin_anew() == Change::Ended {
            events.push(Event::new(time_s, onset_s, EventKind::LeakEnded));
        }
        self.forget_masses();
    }

    fn forget_masses(&mut self) {
        self.state.evidence.forget();
        if self.state.leak.found().is_none() {
            self.state.leak.begin_anew();
        }
    }

    /// The pressure is another one after a time without rows: a refill, or a loss that the trace of the masses will tell.
    fn take_across(
        &mut self,
        time_s: f64,
        innovation_pa: f64,
        before_kg: f64,
        events: &mut Vec<Event>,
    ) -> Result<Estimate, DetectorError> {
        let silent_since_s = self.state.last_s;
        self.go_back()?;
        self.observer.begin_exchange();
        let estimate = self.observer.step(time_s, &self.usable)?;
        self.observer.end_exchange();
        self.state.rewind.begin(&self.observer);
        if innovation_pa > 0.0 {
            let change_kg = self.masses_kg().map_or(f64::NAN, |mass_kg| mass_kg - before_kg);
            self.exchanged(time_s, silent_since_s, change_kg.max(0.0), events);
        } else {
            self.state.lost_across = true;
        }
        Ok(estimate)
    }

    fn mark_refused(&mut self, time_s: f64) {
        for (watch, innovation) in self.state.watches.iter_mut().zip(self.observer.innovations()) {
            if innovation.outcome == Outcome::Rejected {
                watch.refused(time_s);
            }
        }
    }

    /// Whether neither pressure nor temperature can be told, and why.
    fn blindness(&self, time_s: f64) -> Option<Reason> {
        let watches = &self.state.watches;
        let begun_s = self.state.start_s.unwrap_or(time_s);
        let since = |sensor: usize| time_s - watches[sensor].last_usable_s().max(begun_s);
        let late = |sensor: usize| since(sensor) > self.settings.blind_after_s;
        let stuck = |sensor: usize| watches[sensor].health() == Health::Stuck;
        match self.roles.pressure {
            None => return Some(Reason::NoPressure),
            Some(pressure) if stuck(pressure) => return Some(Reason::Stuck),
            Some(pressure) if late(pressure) => return Some(Reason::NoPressure),
            Some(_) => {}
        }
        let thermometers = &self.roles.thermometers;
        let blind = thermometers.iter().all(|sensor| stuck(*sensor) || late(*sensor));
        blind.then_some(Reason::NoTemperature)
    }

    fn judge_leak(&mut self, estimate: &Estimate, events: &mut Vec<Event>) -> Result<(), DetectorError> {
        let time_s = estimate.time_s;
        let pressure_used =
            self.roles.pressure.is_some_and(|p| self.observer.innovations()[p].outcome == Outcome::Accepted);
        if !pressure_used || self.state.examined.is_some() || self.blindness(time_s).is_some() {
            return Ok(());
        }
        self.leaks.clear();
        self.leaks.extend(self.observer.leaks());
        self.state.p15.pressure_pa(&self.contents, estimate.mass_kg)?;
        let statistics = self.state.evidence.update(estimate, &self.leaks);
        let alarm = self.thresholds.alarm(&statistics).is_some();
        let calm = self.thresholds.is_calm(&statistics);
        let lost_across = std::mem::take(&mut self.state.lost_across);
        let (Some(free), Some(slow)) = (self.leaks.last(), self.leaks.get(1)) else { return Ok(()) };
        let look = Look {
            estimate,
            free,
            slow,
            pa_per_kg: self.state.p15.slope_pa_kg(),
            error: &self.settings.mass_error,
            alarm: alarm || lost_across,
            calm: calm && !lost_across,
            over_after_s: self.settings.leak_over_after_s,
        };
        match self.state.leak.step(&look) {
            Change::None => {}
            Change::Found(finding) => {
                events.push(Event::new(time_s, finding.onset_s.value, EventKind::LeakFound(finding)));
            }
            Change::Ended => events.push(Event::new(time_s, time_s, EventKind::LeakEnded)),
        }
        Ok(())
    }

    fn tell_health(&mut self, time_s: f64, events: &mut Vec<Event>) {
        for (sensor, watch) in self.state.watches.iter().enumerate() {
            let health = watch.health();
            if std::mem::discriminant(&health) != std::mem::discriminant(&self.state.health[sensor]) {
                events.push(Event::new(time_s, time_s, EventKind::Sensor { sensor, health }));
            }
            self.state.health[sensor] = health;
        }
    }

    fn verdict(&self, time_s: f64) -> Verdict {
        let state = &self.state;
        let direction = |out: bool| if out { Verdict::Discharge } else { Verdict::Refill };
        if let Some(examined) = state.examined.as_ref().filter(|examined| examined.flowing) {
            return direction(examined.examination.error_pa() > 0.0);
        }
        if let Some(Exchanged { out, .. }) = state.exchanged.filter(|of| time_s - of.at_s < EXCHANGED_S) {
            return direction(out);
        }
        if state.leak.found().is_some() {
            return Verdict::Leak;
        }
        if let Some(reason) = self.doubt(time_s) {
            return Verdict::Unknown(reason);
        }
        let at_fault = |health: &Health| {
            matches!(health, Health::Stuck | Health::Shifted(_) | Health::Detached | Health::Implausible)
        };
        if state.health.iter().any(at_fault) { Verdict::SensorFault } else { Verdict::Tight }
    }

    /// Why it cannot be told, if so.
    fn doubt(&self, time_s: f64) -> Option<Reason> {
        let state = &self.state;
        if state.examined.as_ref().is_some_and(|examined| examined.samples >= NO_SPIKE) {
            return Some(Reason::Jump);
        }
        if state.intake.is_astray() {
            return Some(Reason::Clock);
        }
        if let Some(reason) = self.blindness(time_s) {
            return Some(reason);
        }
        if time_s < state.look.0 {
            return Some(state.look.1);
        }
        if state.exchanged.is_some_and(|of| time_s - of.at_s < SETTLED_S) {
            return Some(Reason::Settling);
        }
        let learning = state.start_s.is_some_and(|start_s| time_s - start_s < self.settings.learning_s);
        learning.then_some(Reason::Learning)
    }

    fn output(
        &mut self,
        row: &Row,
        mut estimate: Estimate,
        changed: bool,
        mut events: Vec<Event>,
    ) -> Result<Output, DetectorError> {
        let time_s = row.time_s;
        let leak = self.state.leak.found().copied();
        estimate.p15_pa = self.state.p15.pressure_pa(&self.contents, estimate.mass_kg)?;
        let cold_pressure_pa = self.state.cold.pressure_pa(&self.contents, estimate.mass_kg)?;
        self.warn_of_the_cold(time_s, cold_pressure_pa, &mut events);
        if changed || time_s >= self.state.outlook_due_s {
            self.state.outlook_due_s = time_s + outlook::interval_s(leak.is_some());
            self.leaks.clear();
            self.leaks.extend(self.observer.leaks());
            let slow = self.leaks.get(1).copied().unwrap_or(self.leaks[0]);
            let probability = self.state.leak.probability();
            let outlook =
                self.limits.outlook(&self.settings, &estimate, leak.as_ref(), &slow, probability)?;
            self.state.outlook = Some(outlook);
        }
        let mut output = Output {
            stamp_s: row.stamp_s,
            estimate,
            verdict: self.state.verdict,
            leak,
            leak_probability: self.state.leak.probability(),
            cold_pressure_pa,
            health: self.state.health.clone(),
            outlook: self.state.outlook,
            events,
            alarms: Vec::new(),
        };
        let inputs = AlarmInputs::of(&output, self.full_pa);
        let panel = std::mem::take(&mut self.state.panel);
        let (panel, alarms) = panel.step(&self.settings.alarms, time_s, &inputs);
        (self.state.panel, output.alarms) = (panel, alarms);
        Ok(output)
    }

    /// Once, when the pressure of a tight cylinder will be below the limit on the coldest night.
    fn warn_of_the_cold(&mut self, time_s: f64, cold_pressure_pa: f64, events: &mut Vec<Event>) {
        let limit_pa = self.settings.limits.operational_pa;
        let below = cold_pressure_pa < limit_pa;
        if below && !self.state.warned {
            events.push(Event::new(time_s, time_s, EventKind::ColdNight(cold_pressure_pa)));
        }
        // A bar of hysteresis: the estimate wanders.
        self.state.warned = below || (self.state.warned && cold_pressure_pa < limit_pa + COLD_DEADBAND_PA);
    }
}

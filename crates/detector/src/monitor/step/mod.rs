//! The monitor of one cylinder: what each row does.
mod disturbance;
mod exchange;
mod judgement;
mod output;
mod rows;
mod saved;
mod sensors;
mod state;
mod wiring;

use crate::units::QUOTED_K;
use alloc::boxed::Box;
use alloc::vec::Vec;

use self::rows::Said;
use self::state::State;
use super::alarm::{AlarmEvent, AlarmPanel};
use super::gas::leak::{Change, Look};
use super::gas::onset;
use super::gas::outlook::LimitMasses;
use super::intake::{Intake, Row};
use super::roles::Roles;
use super::settings::MonitorSettings;
use super::{Event, EventKind, Reason};
use crate::DetectorError;
use crate::estimator::observer::{Commissioning, Companion, Estimate, Learned, Observer, Quality};
use crate::estimator::sensor::Sensor;
use crate::estimator::thermal::vessel::Vessel;
use crate::evidence::{Statistics, Tails, Thresholds};
use crate::prognosis::Contents;
use crate::sealed::Fingerprint;

/// Time after a gap, a blindness or a restart until something can be told again, s.
const LOOK_S: f64 = 3600.0;
/// Time after an exchange of gas for which it is the verdict, s.
const EXCHANGED_S: f64 = 1800.0;
/// Time after an exchange of gas until it has settled, s.
const SETTLED_S: f64 = 3.0 * 3600.0;
/// What the evidence is divided by while a thermometer is missing: the thresholds are those of all of them.
const DEGRADED: f64 = 1.3;

/// Monitor of one cylinder: a pure function of its state and the row, so that batch, stream and a stream that was killed and
/// restored at any row give the same, bit for bit.
#[derive(Debug)]
pub struct Monitor {
    settings: MonitorSettings,
    vessel: Vessel,
    contents: Contents,
    limits: LimitMasses,
    tails: Tails,
    thresholds: Thresholds,
    full_pa: f64,
    /// Mass that was stated and its standard deviation, kg.
    filled_kg: (f64, f64),
    roles: Roles,
    /// Two thermometers and the pressure, whose wiring is checked.
    compared: Option<[usize; 3]>,
    sensors: Vec<Sensor>,
    fingerprint: Fingerprint,
    commissioning: Commissioning,
    // In boxes, so that a monitor that is handed on leaves no copies on the stack.
    observer: Box<Observer>,
    /// Has the thermometers in each other's place, until that is judged.
    twin: Option<Box<Companion>>,
    /// The observer before the present row; while a jump is examined, one that goes on without the pressure.
    shadow: Box<Companion>,
    state: Box<State>,
    /// Of the present row.
    usable: Vec<f64>,
    /// What the last row said, and memory for what the next one says.
    said: Box<Said>,
}

/// In a box of its own making: on a controller's stack there is room for one.
#[inline(never)]
fn observer_of(
    vessel: &Vessel,
    sensors: &[Sensor],
    commissioning: &Commissioning,
    settings: &MonitorSettings,
) -> Result<Box<Observer>, DetectorError> {
    Ok(Box::new(Observer::new(vessel, sensors, commissioning, &settings.observer)?))
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
        let observer = observer_of(vessel, sensors, commissioning, settings)?;
        let contents = Contents::of(vessel);
        let roles = Roles::of(sensors);
        let full_kg = commissioning.mass_kg(vessel, QUOTED_K)?;
        let full_pa = contents.pressure_pa(full_kg, QUOTED_K)?;
        let tails = settings.tails.unwrap_or_else(|| Tails::of(vessel, full_pa));
        let pair = wiring::pair(sensors, &roles, settings);
        let mut state = State::new(sensors, commissioning, settings, pair)?;
        let compared = wiring::compared(&roles, sensors);
        state.make_room(&observer);
        Ok(Self {
            limits: LimitMasses::new(&contents, settings, full_kg)?,
            thresholds: tails.thresholds(settings.false_alarm_interval_s)?,
            tails,
            full_pa,
            filled_kg: (full_kg, commissioning.mass_sd * full_kg),
            roles,
            compared,
            sensors: sensors.to_vec(),
            twin: compared.map(|_| Box::new(wiring::twin(&observer))),
            fingerprint: saved::fingerprint(vessel, sensors, settings),
            shadow: Box::new(observer.companion(usize::MAX)),
            observer,
            commissioning: *commissioning,
            usable: vec![f64::NAN; sensors.len()],
            said: Box::new(Said::with_room(sensors.len())),
            settings: settings.clone(),
            vessel: vessel.clone(),
            contents,
            state,
        })
    }

    /// Start with what an observer of the same cylinder has learnt; before the first row.
    ///
    /// # Errors
    /// As [`Learned::validate`].
    pub fn with_learned(mut self, learned: Learned) -> Result<Self, DetectorError> {
        self.observer = Box::new(self.observer.with_learned(learned)?);
        Ok(self)
    }

    /// Somebody has seen the alarms, looked after the sensors and knows the filling.
    pub fn acknowledge(&mut self, comment: &str) -> Vec<AlarmEvent> {
        self.state.filling.settle();
        self.state.watches.iter_mut().for_each(|watch| watch.repaired());
        self.state.panel.acknowledge_all(&self.settings.alarms, self.state.last_s, comment)
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

    /// The estimate of a row with the leak rate of the member that holds the mass, kg/s.
    fn process(&mut self, row: &Row, events: &mut Vec<Event>) -> Result<(Estimate, f64), DetectorError> {
        let time_s = row.time_s;
        let silent_s = time_s - self.state.last_s;
        self.judge_wiring(time_s, events)?;
        self.screen(row);
        self.read_wiring(row);
        self.watch_thermometers(time_s, events);
        self.place();
        self.observer.doubt_surroundings(self.state.jumps.excess());
        if silent_s.is_finite() && silent_s > self.settings.gap_s {
            self.state.look = (time_s + LOOK_S, Reason::Gap);
        }
        self.check_filling(time_s, events)?;
        let estimate = self.observe(time_s, silent_s, events)?;
        let estimate = self.watch_bounds(estimate, events)?;
        self.observer.round();
        if self.state.examined.is_some() {
            self.observer.with(&mut self.shadow, Observer::round);
        }
        self.mark_outcomes(time_s);
        self.keep_undisturbed(time_s);
        self.notice_gain(time_s, events);
        self.step_twin(time_s)?;
        if estimate.quality == Quality::Restarted {
            events.push(Event::new(time_s, time_s, EventKind::Restarted));
            self.state.look = (time_s + LOOK_S, Reason::Restarted);
            self.state.gains.forget();
            self.forget_masses();
        }
        self.state.start_s.get_or_insert(time_s);
        self.state.last_s = time_s;
        // The member that holds the mass; the first one where there is no other.
        let held_kg_s = self.observer.leaks().take(2).last().map_or(0.0, |leak| leak.rate_kg_s);
        self.judge_leak(&estimate, events)?;
        self.tell_health(time_s, events);
        Ok((estimate, held_kg_s))
    }

    fn judge_leak(&mut self, estimate: &Estimate, events: &mut Vec<Event>) -> Result<(), DetectorError> {
        let time_s = estimate.time_s;
        let blind =
            !self.is_pressure_used() || self.state.examined.is_some() || self.blindness(time_s).is_some();
        // With a wrong unit every change of the temperature is a change of the mass.
        if blind || self.state.filling.is_wrong() {
            return Ok(());
        }
        if self.state.pair.is_on_probation() {
            // The mass takes a step with the thermometers that it rests on: no evidence of a leak.
            self.forget_masses();
            return Ok(());
        }
        self.state.p15.pressure_pa(&self.contents, estimate.mass_kg)?;
        let degraded = self.is_degraded(time_s);
        let divisor = if degraded { DEGRADED } else { 1.0 };
        let off_kg = self.off_by_one_end(estimate.gas_mean_k) * self.filled_kg.0;
        let statistics = self.state.evidence.update(&self.observer, time_s, (divisor, off_kg));
        let look = Look {
            time_s,
            pa_per_kg: self.state.p15.slope_pa_kg(),
            filled_kg: self.filled_kg.0,
            false_alarm_s: self.tails.mean_time_s(&statistics),
            alarm: self.thresholds.alarm(&statistics).is_some() && !self.may_pressure_stand_still(),
            calm: self.thresholds.is_calm(&statistics),
            lost_across: self.state.lost_across.take(),
            over_after_s: self.settings.leak_over_after_s,
        };
        let (observer, evidence) = (&self.observer, &self.state.evidence);
        match self.state.leak.step(&look, || onset::fit(observer, evidence, time_s, look.filled_kg)) {
            Change::None => {}
            Change::Found(finding) => match self.state.filling.explains_leak(self.filled_kg) {
                Some(mass_kg) => {
                    self.doubt_filling(time_s, mass_kg, events);
                    self.state.leak.begin_anew();
                    self.forget_masses();
                }
                None => events.push(Event::new(time_s, finding.onset_s.value, EventKind::LeakFound(finding))),
            },
            Change::Ended => events.push(Event::new(time_s, time_s, EventKind::LeakEnded)),
        }
        Ok(())
    }
}

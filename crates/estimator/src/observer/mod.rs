//! The cylinder's observer: mean gas temperature, gas mass and leak rate from sensors outside.
//!
//! A bank of Kalman filters ([`Engine`]; [`UdFactors`]) on one [`cylinder::Cylinder`]: a few wall
//! nodes, valve, gas and mass, augmented by what is unknown in a vehicle ([`states`]). The members differ in how they let gas
//! leave ([`settings::LeakHypothesis`]): in the first the mass itself walks a little; it gives the mass. Slow ones hold the mass
//! but for a leak rate that walks, each with its own bandwidth; the middle one gives leak rate and gas temperature. The freest,
//! whose mass walks far, judges the others and takes the place of those that cannot be right (`belief`). The last one follows gas that
//! flows within minutes, either way ([`Flow`]). One that holds the mass and has no leak rate, if there is one beside the first, tells leaks of any onset by
//! their signature ([`Onset`]).
//!
//! Where all thermometers are surprised to one side, air and wind may have changed since the row before: steps of both are tried, and the
//! likeliest explanation of the row stays ([`AirStep`]).
//!
//! Missing readings are NaN; any reading may be missing, and samples may come at any interval. Readings are used one after the
//! other, each behind a gate on its own innovation. The estimate never ends in NaN: where it cannot go on, it starts again
//! from the prior with what it has learnt, and says so ([`Quality::Restarted`]).
//!
//! # What cannot be observed
//! Pressure, temperature and mass hang together by one equation, so constant errors of the sensors shift the mass for ever: 0.4 bar are
//! 8 g, 0.3 K are 6 g. The standard deviation of the mass says so. Changes since commissioning are known far better:
//! see [`Observer::observability`] and [`Observer::mass_change_sd_kg`].
mod band;
mod band_settings;
mod checkpoint;
mod clock;
mod commissioning;
mod companion;
pub mod cylinder;
mod engine;
mod estimate;
mod events;
mod flow;
mod learned;
mod observability;
mod roles;
mod scale;
mod screen;
mod settings;
mod signature;
mod smoother;
mod snapshot;
pub mod states;
mod surroundings;

use alloc::vec::Vec;
use cylwatch_thermal::real::powi;
use nalgebra::DMatrix;

use crate::EstimatorError;
use crate::filter::{Bank, Belief, Moments, StateSpace, UdFactors, Workspace};
pub use crate::filter::{Innovation, Outcome};
use crate::sensor::Sensor;
use crate::thermal::reduced::WarmStart;
use crate::thermal::vessel::Vessel;
use band::Band;
pub use band_settings::BandSettings;
pub use checkpoint::Checkpoint;
use clock::{Clock, Exchange};
use commissioning::BegunFrom;
pub use commissioning::Commissioning;
pub use companion::Companion;
use cylinder::Cylinder;
pub use engine::Engine;
#[cfg(feature = "design")]
pub use engine::MovingHorizonSettings;
pub use estimate::{Estimate, Leak, Quality};
pub use flow::Flow;
pub use learned::Learned;
pub use observability::{Combination, Observability};
use roles::Roles;
#[cfg(feature = "design")]
pub(crate) use roles::middle_slow;
pub(crate) use scale::Scale;
pub use screen::FaultCount;
pub use settings::{AirStep, FlowDoubt, LeakHypothesis, ModelError, ObserverSettings, Walk};
use signature::Onsets;
pub use signature::{ONSETS_AT_MOST, Onset};
pub use smoother::Smoother;
pub use snapshot::{Snapshot, SnapshotRef};

/// Time after commissioning or an exchange of gas after which the mass counts as the reference, s.
const REFERENCE_AFTER_S: f64 = 86_400.0;
/// Time after an exchange of gas during which mass and gas stay free, s.
const SETTLE_S: f64 = 1200.0;
/// Part of the gas that may flow between two rows while gas is exchanged: for more the linearised equations do not hold.
const MAX_EXCHANGE_PART: f64 = 0.15;
/// Innovation of a pressure beyond which gas has flowed by more than the linearised equations bear, in variances: as a part of the usual
/// gate, and while gas is exchanged.
const FLOW_GATE: f64 = 0.25;
const FLOW_GATE_OPEN: f64 = 9.0;
/// Interval as which that between two rows of one time counts, s.
const SHORTEST_S: f64 = 1e-3;

/// The observer of one cylinder.
#[derive(Debug)]
pub struct Observer {
    vessel: Vessel,
    commissioning: Commissioning,
    cylinder: Cylinder,
    band: Band,
    bank: Bank<Cylinder>,
    work: Workspace,
    learned: Option<Learned>,
    /// What the estimate began with: mean (n), covariance (n, n), and with what has been learnt.
    mean: Vec<f64>,
    prior: DMatrix<f64>,
    learned_prior: Option<DMatrix<f64>>,
    factors: UdFactors,
    begun_from: BegunFrom,
    /// Leaks by their signature in the innovations of the member that holds the mass, and what is to be compensated.
    onsets: Onsets,
    to_compensate: Vec<f64>,
    clock: Clock,
    gate: f64,
    roles: Roles,
    /// The bank before the present sample.
    before: Bank<Cylinder>,
    start_before: WarmStart,
    /// Where the model's iterations start first.
    fresh_start: WarmStart,
    reference_x: Vec<f64>,
    /// Mass of each member at the present sample.
    masses: Vec<Moments>,
    /// Which members were replaced at the present sample.
    replaced: Vec<bool>,
    /// The readings of the present sample without the faulty ones.
    usable: Vec<f64>,
}

impl Observer {
    /// An observer that starts with the first sample.
    ///
    /// # Errors
    /// A setting is out of its bounds, a sensor has no place on the vessel, or the fill is no state of the fluid.
    pub fn new(
        vessel: &Vessel,
        sensors: &[Sensor],
        commissioning: &Commissioning,
        settings: &ObserverSettings,
    ) -> Result<Self, EstimatorError> {
        if sensors.is_empty() {
            return Err(EstimatorError::NoSensors);
        }
        let mut settings = Scale::of(vessel, commissioning)?.applied(settings);
        if settings.engine != Engine::Extended {
            settings.suppose_no_flow();
        }
        let settings = &settings;
        let cylinder = Cylinder::new(vessel, sensors, settings)?;
        let gate = settings.gate_sd * settings.gate_sd;
        let n = cylinder.states();
        let mut observer = Self {
            vessel: vessel.clone(),
            commissioning: *commissioning,
            work: Workspace::new(&cylinder),
            band: Band::new(cylinder.state_map(), cylinder.sensors(), settings),
            bank: Bank::default(),
            learned: None,
            mean: vec![0.0; n],
            prior: DMatrix::zeros(n, n),
            learned_prior: None,
            factors: UdFactors::zeros(n),
            begun_from: BegunFrom::new(commissioning, sensors.len()),
            onsets: Onsets::with_room(n),
            to_compensate: Vec::with_capacity(cylinder.states()),
            clock: Clock::new(sensors),
            usable: vec![f64::NAN; sensors.len()],
            gate,
            roles: Roles::of(&settings.bank),
            before: Bank::default(),
            start_before: cylinder.warm_start(),
            fresh_start: cylinder.warm_start(),
            reference_x: vec![0.0; n],
            masses: Vec::with_capacity(settings.bank.len()),
            replaced: vec![false; settings.bank.len()],
            cylinder,
        };
        observer.make_room();
        Ok(observer)
    }

    /// Memory for the members of the bank.
    fn make_room(&mut self) {
        self.bank = self.room_for(&self.roles);
        self.before = self.room_between_steps(&self.roles);
    }

    /// Memory for a bank that takes no step.
    fn room_between_steps(&self, roles: &Roles) -> Bank<Cylinder> {
        let hypotheses = self.cylinder.settings().bank.iter().take(roles.members).copied();
        Bank::with_room(&self.cylinder, &self.cylinder.bank_engine(), hypotheses)
    }

    fn room_for(&self, roles: &Roles) -> Bank<Cylinder> {
        let mut bank = self.room_between_steps(roles);
        if let Some(held) = roles.held {
            bank.record_steps(held, &self.cylinder);
        }
        bank
    }

    /// Without the member whose gas may flow, and without onsets of leaks; before the first sample.
    fn without_flow(mut self) -> Self {
        self.cylinder.suppose_no_flow();
        self.roles = Roles { flowing: None, held: None, ..Roles::of(&self.cylinder.settings().bank) };
        self.make_room();
        self
    }

    /// Where the estimate begins, or has to begin again, this is known of the filling; what is stated as a part of the fill stays a part
    /// of that which it was made with.
    pub fn begin_with(&mut self, commissioning: &Commissioning) {
        self.commissioning = *commissioning;
    }

    /// Start with what an observer of the same cylinder has learnt; before the first sample.
    ///
    /// # Errors
    /// As [`Learned::validate`].
    pub fn with_learned(mut self, learned: Learned) -> Result<Self, EstimatorError> {
        learned.validate(&self.vessel)?;
        self.learned = Some(learned);
        self.learned_prior = Some(self.prior.clone());
        Ok(self)
    }

    /// Begin anew with the next sample, with nothing learnt.
    pub fn forget(&mut self) {
        self.learned = None;
        self.bank.forget();
        self.onsets.clear();
        self.clock.forget(self.cylinder.sensors());
        self.replaced.fill(false);
        self.cylinder.set_loosened(&self.clock.loosened);
        self.cylinder.model().set_warm_start(&self.fresh_start);
    }

    /// The observer's state space, e.g. for another filter.
    pub fn cylinder(&mut self) -> &mut Cylinder {
        &mut self.cylinder
    }

    /// Take in a row of readings, one per sensor, SI, NaN where missing.
    ///
    /// # Errors
    /// The row has another length, its time is not a number or before the last one; the observer stays as it was.
    /// Or the commissioning fits no state of the fluid.
    pub fn step(&mut self, time_s: f64, readings: &[f64]) -> Result<Estimate, EstimatorError> {
        let expected = self.cylinder.outputs();
        if readings.len() != expected {
            return Err(EstimatorError::RowLength { expected, found: readings.len() });
        }
        let last_s = self.clock.time_s;
        if !time_s.is_finite() || last_s.is_some_and(|last| time_s < last) {
            return Err(EstimatorError::TimeBackwards { time_s, last_s: last_s.unwrap_or(f64::NAN) });
        }
        let mut usable = core::mem::take(&mut self.usable);
        usable.copy_from_slice(readings);
        for (sensor, (reading, screen)) in usable.iter_mut().zip(&mut self.clock.screens).enumerate() {
            if screen.judge(*reading).is_some() {
                *reading = f64::NAN;
            }
            self.cylinder.set_repeats(sensor, screen.repeats());
        }
        self.record_the_step();
        let restarted = self.take(time_s, &usable);
        self.remember(time_s, &usable);
        self.mark_faulty(time_s, readings, &usable);
        self.usable = usable;
        let restarted = restarted?;
        self.replace_excluded();
        self.follow_onsets(time_s, restarted);
        self.clock.time_s = Some(time_s);
        self.estimate(time_s, readings, restarted)
    }

    /// Move on to a sample and take its readings; whether the estimate had to begin again.
    fn take(&mut self, time_s: f64, readings: &[f64]) -> Result<bool, EstimatorError> {
        let Some(last_s) = self.clock.time_s else {
            self.start(time_s, readings)?;
            return Ok(false);
        };
        // The equations hold for a state that is possible alone.
        if self.is_possible() && self.advance(time_s - last_s, time_s, readings).is_ok() && self.is_possible()
        {
            return Ok(false);
        }
        self.clock.restarts = self.clock.restarts.saturating_add(1);
        self.start(time_s, readings)?;
        Ok(true)
    }

    /// What the screens have sorted out counts as rejected.
    fn mark_faulty(&mut self, time_s: f64, readings: &[f64], usable: &[f64]) {
        for member in self.bank.members.iter_mut() {
            for (sensor, innovation) in member.innovations.iter_mut().enumerate() {
                if readings[sensor].is_finite() && !usable[sensor].is_finite() {
                    innovation.outcome = Outcome::Rejected;
                }
            }
        }
        if let Some(first) = self.bank.members.first()
            && time_s > self.clock.pulled_until_s
        {
            let pulls = first.pulled.iter().zip(&first.innovations);
            self.clock.screens.iter_mut().zip(pulls).for_each(|(screen, (&by, of))| screen.pull(by, of.nu));
        }
    }

    /// Members that are excluded begin anew from the freest one.
    fn replace_excluded(&mut self) {
        let mass = self.cylinder.state_map().mass;
        let (freest, flowing) = (self.roles.freest, self.roles.flowing);
        self.bank.write_moments(mass, &mut self.masses);
        self.replaced.fill(false);
        for index in (0..self.masses.len()).filter(|&index| index != freest && Some(index) != flowing) {
            if Belief::of(self.masses[index], self.masses[freest]).is_excluded() {
                self.replaced[index] = true;
                self.begin_anew(index, freest);
                self.masses[index] = self.masses[freest];
            }
        }
    }

    /// Move on and take readings; where the surroundings may have made a step, as the likeliest [explanation](surroundings) has it.
    fn advance(&mut self, dt_s: f64, time_s: f64, readings: &[f64]) -> Result<(), EstimatorError> {
        for (sensor, last_s) in self.clock.last_reading_s.iter().enumerate() {
            self.cylinder.set_interval_s(sensor, (time_s - last_s).max(SHORTEST_S));
        }
        let ObserverSettings { engine, air_step, .. } = *self.cylinder.settings();
        // Where more than one is expected they explain nothing.
        let may_step = |step: &AirStep| engine == Engine::Extended && dt_s > 0.0 && step.per_s * dt_s < 1.0;
        match air_step.filter(may_step) {
            Some(step) => self.explain(step, dt_s, time_s, readings),
            None => {
                self.move_on(dt_s)?;
                self.take_in(time_s, readings)
            }
        }
    }

    fn move_on(&mut self, dt_s: f64) -> Result<(), EstimatorError> {
        if dt_s <= 0.0 {
            return Ok(());
        }
        if let Some(flowing) = self.roles.flowing.filter(|_| self.clock.exchange == Exchange::Open) {
            // Much of the gas may go out within the interval, or as much come in, and cools or warms what is there.
            let much_kg = MAX_EXCHANGE_PART * self.cylinder.settings().free_mass_sd_kg;
            let rate_sd_kg_s = much_kg / dt_s;
            self.bank.set_variance(flowing, self.cylinder.state_map().leak, rate_sd_kg_s * rate_sd_kg_s);
        }
        self.bank.predict(&mut self.cylinder, &mut self.work, dt_s)
    }

    fn take_in(&mut self, time_s: f64, readings: &[f64]) -> Result<(), EstimatorError> {
        if self.clock.exchanging(time_s) {
            self.clock.pulled_until_s = time_s + SETTLE_S;
            self.open();
        }
        self.update(readings)
    }

    fn update(&mut self, readings: &[f64]) -> Result<(), EstimatorError> {
        // While gas is exchanged, less is gas that flows.
        let flow = if self.clock.exchange == Exchange::Open { FLOW_GATE_OPEN } else { FLOW_GATE * self.gate };
        self.cylinder.set_flow_gate(flow);
        self.bank.update(&mut self.cylinder, &mut self.work, readings)
    }

    /// Whether every member but the flowing one is possible; that begins anew from the freest one where it is not.
    fn is_possible(&mut self) -> bool {
        let mut held = (0..self.bank.members.len()).filter(|&index| Some(index) != self.roles.flowing);
        if !held.all(|index| self.bank.is_possible(index, &self.cylinder)) {
            return false;
        }
        if let Some(flowing) =
            self.roles.flowing.filter(|&index| !self.bank.is_possible(index, &self.cylinder))
        {
            self.begin_anew(flowing, self.roles.freest);
            let prior_sd_kg_s = self.bank.members[flowing].hypothesis.rate.prior_sd;
            self.bank.set_variance(flowing, self.cylinder.state_map().leak, prior_sd_kg_s * prior_sd_kg_s);
        }
        true
    }

    /// Let a member begin anew with all that another one knows. Where that is less mass than supposed, a leak rate that may walk
    /// may be anything then; more mass is no leak, but tells that one was supposed in vain.
    fn begin_anew(&mut self, index: usize, from: usize) {
        let (mass, leak) = (self.cylinder.state_map().mass, self.cylinder.state_map().leak);
        let lost = self.bank.members[from].x[mass] < self.bank.members[index].x[mass];
        let free = lost && !self.bank.members[index].hypothesis.rate.is_known();
        let sd_kg_s = if free { self.cylinder.settings().any_leak_sd_kg_s } else { 0.0 };
        self.bank.replace(index, from);
        self.bank.set(index, leak, 0.0, sd_kg_s * sd_kg_s);
    }

    /// Free mass and gas temperature of everything known about them, and forget the leak rate. A member whose gas may flow knows better.
    fn open(&mut self) {
        let leak = self.cylinder.state_map().leak;
        for index in 0..self.bank.members.len() {
            let member = &mut self.bank.members[index];
            if !member.hypothesis.is_flowing() {
                member.x[leak] = 0.0;
                let rate = (leak, powi(member.hypothesis.rate.prior_sd, 2));
                self.bank.free(index, [rate].into_iter().chain(self.cylinder.freed_gas().iter().copied()));
            }
        }
    }

    /// What the freest member says of another one.
    fn belief(&self, index: usize) -> Belief {
        let mass = self.cylinder.state_map().mass;
        Belief::of(self.bank.moments(index, mass), self.bank.moments(self.roles.freest, mass))
    }

    /// Innovation of each sensor at the last sample, by the first member.
    pub fn innovations(&self) -> &[Innovation] {
        self.bank.members.first().map_or(&[], |member| &member.innovations)
    }

    /// What a sensor would read now by the first member, K or Pa.
    ///
    /// # Errors
    /// There has been no sample, or the state has no such reading.
    pub fn expected_reading(&mut self, sensor: usize) -> Result<f64, EstimatorError> {
        let first = self.bank.members.first().ok_or(EstimatorError::NoEstimate)?;
        self.cylinder.output(sensor, &first.x, None)
    }

    /// Leak rate and mass of every member but the [flowing](Observer::flow) one, in the order of the bank; none before the first sample.
    pub fn leaks(&self) -> impl ExactSizeIterator<Item = Leak> {
        let states = self.cylinder.state_map();
        let of = |index: usize| {
            let (rate_kg_s, rate_variance) = self.bank.moments(index, states.leak);
            let (mass_kg, mass_variance) = self.bank.moments(index, states.mass);
            Leak {
                rate_kg_s,
                sd_kg_s: libm::sqrt(rate_variance),
                mass_kg,
                mass_sd_kg: libm::sqrt(mass_variance),
                covariance_kg2_s: self.bank.covariance_of(index, states.mass, states.leak),
                begun_anew: self.replaced[index],
            }
        };
        (0..self.roles.flowing.unwrap_or(self.bank.members.len()).min(self.bank.members.len())).map(of)
    }

    /// Mass and its standard deviation, kg, by the freest member or, where gas flows faster than that allows, by the
    /// [flowing](Observer::flow) one; `None` before the first sample.
    pub fn freest_mass_kg(&self) -> Option<(f64, f64)> {
        self.bank.members.first()?;
        let free = self.bank.moments(self.roles.freest, self.cylinder.state_map().mass);
        let (mass_kg, variance_kg2) = match self.flow() {
            Some(flow) => Belief::blended(free, flow.mass()),
            None => free,
        };
        Some((mass_kg, libm::sqrt(variance_kg2)))
    }

    /// Mean and covariance of a member's state, in the order of [`states::States`]; `None` before the first sample or
    /// beyond the bank.
    pub fn state(&self, member: usize) -> Option<(nalgebra::DVector<f64>, DMatrix<f64>)> {
        self.bank.members.get(member).map(|of| (of.mean(), self.bank.covariance(member)))
    }

    /// Faulty readings of each sensor so far.
    pub fn faults(&self) -> impl Iterator<Item = FaultCount> {
        self.clock.screens.iter().map(|screen| screen.count)
    }

    /// Number of times the estimate had to begin again.
    pub fn restarts(&self) -> u64 {
        self.clock.restarts
    }

    /// What has been learnt of the constants: films, capacity, sensors. `None` before the first sample.
    pub fn learned(&self) -> Option<Learned> {
        let first = self.bank.members.first()?;
        let covariance = self.bank.covariance(0);
        Some(Learned::of(&self.vessel.name, self.cylinder.state_map(), &first.x, &covariance))
    }

    /// Which combinations of states the data have not separated. `None` before the first sample.
    pub fn observability(&self) -> Option<Observability> {
        self.bank.members.first()?;
        let prior = self.prior_of_the_beginning().ok()?;
        Some(Observability::of(self.cylinder.state_map(), &prior, &self.bank.covariance(0)))
    }

    /// Standard deviation of the mass relative to commissioning, kg: of the mass where every constant error of a sensor is
    /// taken as it is, since it was the same at commissioning. `None` before the first sample.
    pub fn mass_change_sd_kg(&self) -> Option<f64> {
        self.bank.members.first()?;
        let states = self.cylinder.state_map();
        let covariance = self.bank.covariance(0);
        Some(libm::sqrt(observability::given_constants(&covariance, states.mass, states.leading)))
    }
}

#[cfg(test)]
mod tests;

//! The verdict: what is said of the cylinder, and why it cannot be told.
use super::{EXCHANGED_S, Monitor, SETTLED_S};
use crate::monitor::gas::bounds::ROWS;
use crate::monitor::{Health, Known, KnownExchange, Reason};
use crate::units::{ATMOSPHERE_PA, QUOTED_K};

/// Part of the fill from which an exchange or a flow is the verdict: what is smaller is an event, and leaves the verdict open until gas and wall have settled.
pub(super) const MATTERS: f64 = 0.01;
/// Pressure at 15 °C, Pa, below which gas leaves a hole slower than sound, and at the atmosphere not at all.
const EMPTY_PA: f64 = 2.0 * ATMOSPHERE_PA;

impl Monitor {
    /// Whether neither pressure nor temperature can be told, and why.
    pub(super) fn blindness(&self, time_s: f64) -> Option<Reason> {
        let watches = &self.state.watches;
        let late = |sensor: usize| self.unused_s(sensor, time_s) > self.settings.blind_after_s;
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

    /// What is known of the present row, for the decision.
    pub(super) fn known(&self, time_s: f64, p15_pa: f64) -> Known {
        let state = &self.state;
        let doubt = self.doubt(time_s).or((p15_pa < EMPTY_PA).then_some(Reason::Empty));
        let at_fault = |health: &Health| {
            matches!(health, Health::Stuck | Health::Shifted(_) | Health::Detached | Health::Implausible)
        };
        Known {
            exchange: self.known_exchange(time_s),
            leak_found: state.leak.found().is_some(),
            doubt,
            sensor_fault: state.health.iter().any(at_fault),
            leak_probability: self.evident_probability(doubt),
            reaction: None,
        }
    }

    /// Probability of a leak by masses that can be relied on; `None` while they cannot.
    fn evident_probability(&self, doubt: Option<Reason>) -> Option<f64> {
        let found = self.state.leak.found().is_some();
        self.state.leak.probability().filter(|_| found || doubt.is_none())
    }

    /// What the mass may be off by while one end of the cylinder is warmed or cooled by itself, as a part of it, at a gas temperature, K.
    pub(super) fn off_by_one_end(&self, gas_k: f64) -> f64 {
        self.state.parity.doubt_k() / gas_k
    }

    /// Gas that flows fast, or did a while ago.
    fn known_exchange(&self, time_s: f64) -> Option<KnownExchange> {
        let state = &self.state;
        let flowing = state.examined.as_ref().filter(|examined| examined.flowing);
        let recent = state.exchanged.filter(|of| time_s - of.at_s < EXCHANGED_S && of.part >= MATTERS);
        // What has become certain since the flow began tells its direction better than all of it together.
        let since_s = flowing.map_or(f64::NEG_INFINITY, |examined| examined.examination.onset_s());
        if let Some(of) = recent.filter(|of| of.at_s >= since_s) {
            return Some(KnownExchange { out: of.out, announced: of.announced });
        }
        let examination = &flowing.filter(|of| of.examination.error().abs() > MATTERS)?.examination;
        let announced = self.is_announced(examination.onset_s());
        Some(KnownExchange { out: examination.error() > 0.0, announced })
    }

    /// Why it cannot be told, if so.
    fn doubt(&self, time_s: f64) -> Option<Reason> {
        let state = &self.state;
        if state.examined.as_ref().is_some_and(|examined| examined.samples >= ROWS) {
            return Some(Reason::Jump);
        }
        if state.intake.is_astray() {
            return Some(Reason::Clock);
        }
        if let Some(reason) = self.blindness(time_s) {
            return Some(reason);
        }
        if state.filling.is_wrong() {
            return Some(Reason::Filling);
        }
        if time_s < state.look.0 {
            return Some(state.look.1);
        }
        if state.exchanged.is_some_and(|of| time_s - of.at_s < SETTLED_S) {
            return Some(Reason::Settling);
        }
        if self.off_by_one_end(QUOTED_K) > MATTERS {
            return Some(Reason::Disturbed);
        }
        let learning = state.start_s.is_some_and(|start_s| time_s - start_s < self.settings.learning_s);
        learning.then_some(Reason::Learning)
    }
}

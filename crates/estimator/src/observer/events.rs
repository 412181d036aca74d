//! Events from outside: gas that is exchanged, sensors that are not what they were.
use super::clock::Exchange;
use super::{Observer, REFERENCE_AFTER_S, SETTLE_S};
use crate::sensor::{ParameterKind, Sensor};

impl Observer {
    /// Gas begins to flow in or out on purpose: mass and gas temperature are free until the exchange ends, and what was known of a
    /// leak is forgotten, since the cylinder may be another one.
    pub fn begin_exchange(&mut self) {
        self.clock.exchange = Exchange::Open;
        self.clock.await_reference(f64::INFINITY);
    }

    /// The exchange is over; mass and gas stay free for twenty minutes more, in which the gas comes to rest.
    pub fn end_exchange(&mut self) {
        if let Some(time_s) = self.clock.time_s {
            self.clock.exchange = Exchange::Settling { until_s: time_s + SETTLE_S };
            self.clock.await_reference(time_s + SETTLE_S + REFERENCE_AFTER_S);
        }
    }

    /// Gas has flowed for certain: every member begins anew with what the [flowing](Self::flow) one says.
    pub fn follow_the_flow(&mut self) {
        let Some(flowing) = self.roles.flowing.filter(|&index| index < self.bank.members.len()) else {
            return;
        };
        for index in (0..flowing).rev() {
            self.begin_anew(index, flowing);
            self.replaced[index] = true;
        }
        self.onsets.begin_anew(self.cylinder.state_map().leak);
        let mass = self.cylinder.state_map().mass;
        self.bank.write_moments(mass, &mut self.masses);
        if let Some(time_s) = self.clock.time_s {
            self.clock.await_reference(time_s + REFERENCE_AFTER_S);
        }
    }

    /// The surroundings do so many times more to this cylinder than is considered by its settings, as between rows that are far apart; at least once.
    pub fn doubt_surroundings(&mut self, times: f64) {
        self.clock.doubt = times.max(1.0);
    }

    /// A sensor's offset may have changed by so much, standard deviation, K or Pa: it is learnt anew from there, and held no nearer to its
    /// prior than that allows. Of a sensor without an uncertain offset nothing is said.
    pub fn loosen(&mut self, sensor: usize, sd: f64) {
        if let Some(state) = self.cylinder.state_map().offset_of(sensor, self.cylinder.sensors()) {
            self.bank.inflate(state, sd * sd);
            let loosened = &mut self.clock.loosened;
            loosened[sensor] = libm::hypot(loosened[sensor], sd);
            self.cylinder.set_loosened(loosened);
        }
    }

    /// What was learnt of a sensor's offset is forgotten: gas that went out or came in before it was noticed may have been taken for it.
    pub fn forget_offset(&mut self, sensor: usize) {
        let sensors = self.cylinder.sensors();
        let offset = sensors[sensor].parameters().iter().find(|of| of.kind == ParameterKind::Offset);
        let state = self.cylinder.state_map().offset_of(sensor, sensors);
        if let (Some(state), Some(offset)) = (state, offset) {
            let (mean, variance) = (offset.mean, offset.sd * offset.sd);
            (0..self.bank.members.len()).for_each(|index| self.bank.set(index, state, mean, variance));
            self.onsets.reset(state);
        }
    }

    /// Another sensor of the same kind has taken the place: whatever is uncertain of it is so anew.
    pub fn renew(&mut self, sensor: usize) {
        let Some(parameters) = self.cylinder.sensors().get(sensor).map(Sensor::parameters) else { return };
        let states = &self.cylinder.state_map().parameters[sensor];
        let uncertain =
            states.iter().zip(parameters).filter_map(|(state, of)| Some(((*state)?, of.sd * of.sd)));
        uncertain.for_each(|(state, variance)| self.bank.inflate(state, variance));
        self.clock.loosened[sensor] = 0.0;
        self.cylinder.set_loosened(&self.clock.loosened);
    }
}

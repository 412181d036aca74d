//! The readings of a row: which can be used, what the sensors show of themselves, and whether they fit the filling.
use super::Monitor;
use crate::DetectorError;
use crate::estimator::observer::{Commissioning, Outcome};
use crate::estimator::thermal::vessel::Fill;
use crate::monitor::gas::bounds::FLOW_DEVIATIONS;
use crate::monitor::intake::Row;
use crate::monitor::readings::parity::Disturbance;
use crate::monitor::readings::thermometers::{Lonely, Surroundings};
use crate::monitor::{Event, EventKind, Health};
use alloc::vec::Vec;

/// Standard deviation of a thermometer's offset after it jumped, beside the jump, in errors of a surface temperature.
const JUMPED: f64 = 4.0;
/// Time without use after which a thermometer counts as missing, s.
const DEGRADED_AFTER_S: f64 = 3600.0;

impl Monitor {
    /// Readings that can be used, all of one time.
    pub(super) fn screen(&mut self, row: &Row) {
        self.usable.copy_from_slice(&row.readings);
        self.state.delays.align(row.time_s, &mut self.usable);
        let stood_still = self.is_pressure_stuck();
        for (watch, reading) in self.state.watches.iter_mut().zip(&mut self.usable) {
            *reading = watch.judge(row.time_s, *reading);
        }
        if !stood_still && self.is_pressure_stuck() {
            // What it read since it stood still is in what is known of every onset.
            self.forget_masses();
        }
    }

    fn is_pressure_stuck(&self) -> bool {
        self.roles.pressure.is_some_and(|pressure| self.state.watches[pressure].health() == Health::Stuck)
    }

    /// Whether the pressure may be standing still: what it shows is told when that is known.
    pub(super) fn may_pressure_stand_still(&self) -> bool {
        self.roles.pressure.is_some_and(|pressure| self.state.watches[pressure].may_stand_still())
    }

    pub(super) fn watch_thermometers(&mut self, time_s: f64, events: &mut Vec<Event>) {
        let one = self.roles.thermometers.first().map(|only| [*only, *only]);
        let Some(pair) = self.roles.pair.or(one) else { return };
        // Gas that comes in or goes out warms or cools the shoulder before the valve.
        let judged = self.roles.pair.is_some() && !self.state.is_exchanging(time_s);
        let as_read = pair.map(|sensor| self.usable[sensor]);
        if self.roles.pair.is_some() {
            self.compare_thermometers(time_s, pair, events);
        }
        let doubt = self.settings.observer.flow_doubt;
        let surroundings = Surroundings {
            part: FLOW_DEVIATIONS * doubt.part,
            away_k: self.beside_the_gas_k(as_read),
            memory_s: doubt.memory_s,
        };
        let watches = &mut self.state.watches;
        match self.state.pair.update(time_s, as_read, surroundings, judged) {
            None => {}
            Some(Lonely::Suspected(which)) => self.usable[pair[which]] = f64::NAN,
            Some(Lonely::Shifted(which, by_k)) => {
                self.let_shift(pair[which], by_k);
                self.state.undisturbed.forget();
            }
            Some(Lonely::Detached(which)) => {
                watches[pair[which]].detach();
                self.usable[pair[which]] = f64::NAN;
            }
        }
    }

    /// How far the nearer one is from the gas, K.
    fn beside_the_gas_k(&self, readings: [f64; 2]) -> f64 {
        let Some(flow) = self.observer.flow() else { return 0.0 };
        // Not a number counts for nothing.
        let nearest_k = readings.iter().map(|of| (of - flow.gas_mean_k).abs()).fold(f64::INFINITY, f64::min);
        if nearest_k.is_finite() { nearest_k } else { 0.0 }
    }

    fn compare_thermometers(&mut self, time_s: f64, pair: [usize; 2], events: &mut Vec<Event>) {
        let pressure_pa = self.roles.pressure.map_or(f64::NAN, |pressure| self.usable[pressure]);
        let gas_k = |pressure_pa: f64, near_k: f64| {
            let mass_kg = |at_k: f64| self.contents.mass_kg(pressure_pa, at_k).unwrap_or(f64::NAN);
            let near_kg = mass_kg(near_k);
            near_k + (self.filled_kg.0 - near_kg) / (mass_kg(near_k + 1.0) - near_kg)
        };
        match self.state.parity.push(time_s, pair.map(|sensor| self.usable[sensor]), pressure_pa, gas_k) {
            None => {}
            Some(Disturbance::Begun(off_k)) => {
                events.push(Event::new(time_s, time_s, EventKind::Disturbed { sensors: pair, off_k }));
            }
            Some(Disturbance::Over(by_k)) => {
                self.go_back_before_disturbance(time_s);
                if by_k.abs() > self.jumped_k() {
                    // One of them has shifted, and which is unknown.
                    for sensor in pair {
                        self.observer.loosen(self.place_of(sensor), by_k.abs());
                    }
                }
            }
            Some(Disturbance::Shifted(which, by_k)) => {
                self.go_back_before_disturbance(time_s);
                self.let_shift(pair[which], by_k);
            }
        }
        let deviating = self.state.parity.deviating();
        for (which, sensor) in pair.into_iter().enumerate() {
            let by_k = deviating.filter(|(named, _)| *named == which).map(|(_, by_k)| by_k);
            self.state.watches[sensor].deviates(by_k);
        }
    }

    fn jumped_k(&self) -> f64 {
        JUMPED * self.state.pair.error_k()
    }

    /// A thermometer's offset may have changed by so much, K: that is in doubt of it, and the pressure tells how far it did. To take it off would be as wrong as it may be none.
    fn let_shift(&mut self, sensor: usize, by_k: f64) {
        self.state.watches[sensor].may_have_shifted(by_k);
        self.state.parity.forget();
        self.usable[sensor] = f64::NAN;
        self.observer.loosen(self.place_of(sensor), libm::hypot(by_k, self.jumped_k()));
    }

    /// Whether the first rows fit the filling that was stated.
    pub(super) fn check_filling(
        &mut self,
        time_s: f64,
        events: &mut Vec<Event>,
    ) -> Result<(), DetectorError> {
        let stated = !matches!(self.commissioning.fill, Fill::Pressure { .. });
        let Some(pressure) = self.roles.pressure.filter(|_| stated && self.state.filling.is_open()) else {
            return Ok(());
        };
        let usable = self.roles.thermometers.iter().map(|sensor| self.usable[*sensor]);
        let usable = usable.filter(|reading| reading.is_finite());
        let mean_k = usable.clone().sum::<f64>() / usable.count() as f64;
        // No number where a reading is none or stands for no state of the gas.
        let stands_for = Commissioning::filled(self.usable[pressure], mean_k);
        let mass_kg = stands_for.mass_kg(&self.vessel, mean_k).unwrap_or(f64::NAN);
        if let Some(mass_kg) = self.state.filling.take(time_s, mass_kg, self.filled_kg) {
            self.doubt_filling(time_s, mass_kg, events);
        }
        Ok(())
    }

    pub(super) fn doubt_filling(&self, time_s: f64, mass_kg: f64, events: &mut Vec<Event>) {
        let filled_kg = self.filled_kg.0;
        events.push(Event::new(time_s, time_s, EventKind::FillingDoubted { mass_kg, filled_kg }));
    }

    /// Which readings the observer took, and which it refused.
    pub(super) fn mark_outcomes(&mut self, time_s: f64) {
        for sensor in 0..self.usable.len() {
            let outcome = self.observer.innovations()[self.place_of(sensor)].outcome;
            let watch = &mut self.state.watches[sensor];
            match outcome {
                Outcome::Accepted | Outcome::Reacquired => watch.used(time_s),
                Outcome::Rejected => watch.refused(time_s),
                Outcome::Missing => {}
            }
        }
    }

    pub(super) fn tell_health(&mut self, time_s: f64, events: &mut Vec<Event>) {
        for (sensor, watch) in self.state.watches.iter().enumerate() {
            let health = watch.health();
            if core::mem::discriminant(&health) != core::mem::discriminant(&self.state.health[sensor]) {
                events.push(Event::new(time_s, time_s, EventKind::Sensor { sensor, health }));
            }
            self.state.health[sensor] = health;
        }
    }

    /// Whether the observer took the present pressure.
    pub(super) fn is_pressure_used(&self) -> bool {
        self.roles.pressure.is_some_and(|p| self.observer.innovations()[p].outcome == Outcome::Accepted)
    }

    /// How long a sensor has not been used, s.
    pub(super) fn unused_s(&self, sensor: usize, time_s: f64) -> f64 {
        let begun_s = self.state.start_s.unwrap_or(time_s);
        time_s - self.state.watches[sensor].last_used_s().max(begun_s)
    }

    /// Whether a thermometer has not been used for an hour.
    pub(super) fn is_degraded(&self, time_s: f64) -> bool {
        self.roles.thermometers.iter().any(|sensor| self.unused_s(*sensor, time_s) > DEGRADED_AFTER_S)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimator::sensor::Sensor;
    use crate::estimator::thermal::vessel::presets;
    use crate::monitor::MonitorSettings;
    use crate::units::MINUTE_S;

    const FILL_K: f64 = 288.15;

    /// Gas temperature and health of the shoulder after ten hours at rest. From the fifth on it reads one kelvin more, until a time, h, from which that fades within an hour: it was the sun.
    fn after_a_jump(until_h: f64) -> (f64, Health) {
        let vessel = presets::load("nitrogen-20l").unwrap();
        let sensors = ["shoulder", "valve", "pressure"].map(|name| Sensor::typical(name).unwrap());
        let filled = Commissioning::filled(200e5, FILL_K);
        let mut monitor = Monitor::new(&vessel, &sensors, &filled, &MonitorSettings::default()).unwrap();
        let (mut gas_k, mut health) = (f64::NAN, Health::Good);
        for minute in 0..600 {
            let hour = f64::from(minute) / 60.0;
            // What never changes counts as stuck.
            let noise = if minute % 2 == 0 { 0.02 } else { -0.02 };
            let fades = (until_h + 1.0 - hour).clamp(0.0, 1.0);
            let shoulder_k = FILL_K + noise + if hour >= 5.0 { fades } else { 0.0 };
            let row = [shoulder_k, FILL_K - noise, 200e5 + 1e4 * noise];
            for output in monitor.step(MINUTE_S * f64::from(minute), &row).unwrap() {
                (gas_k, health) = (output.estimate.gas_mean_k, output.health[0]);
            }
        }
        (gas_k, health)
    }

    #[test]
    fn a_thermometer_that_may_have_shifted_misleads_neither_where_it_did_nor_where_it_did_not() {
        for until_h in [10.0, 6.5] {
            let (gas_k, health) = after_a_jump(until_h);
            assert!(matches!(health, Health::Shifted(_)), "until {until_h} h: {health:?}");
            // Taken off, a jump that was none leaves half of it on the gas, which has two thermometers: 0.5 K.
            assert!((gas_k - FILL_K).abs() < 0.3, "until {until_h} h: {:.3} K off", gas_k - FILL_K);
        }
    }
}

//! Channels that are late or in each other's place: found, put right, and begun again with.
use super::Monitor;
use crate::DetectorError;
use crate::estimator::EstimatorError;
use crate::estimator::observer::{Commissioning, Companion, Innovation, Observer};
use crate::estimator::sensor::Sensor;
use crate::estimator::thermal::vessel::Fill;
use crate::evidence::Evidence;
use crate::monitor::MonitorSettings;
use crate::monitor::gas::jump::JumpWatch;
use crate::monitor::gas::leak::Change;
use crate::monitor::intake::Row;
use crate::monitor::readings::health::SensorWatch;
use crate::monitor::readings::lateness::DelayLine;
use crate::monitor::readings::thermometers::Pair;
use crate::monitor::readings::wiring::Finding;
use crate::monitor::roles::Roles;
use crate::monitor::{Event, EventKind, Health};
use alloc::vec::Vec;

/// The channels that are compared: two thermometers on the surface, without a lag of their own, and the pressure.
pub(super) fn compared(roles: &Roles, sensors: &[Sensor]) -> Option<[usize; 3]> {
    let ([first, second], pressure) = roles.pair.zip(roles.pressure)?;
    let of_all = [first, second, pressure];
    of_all.iter().all(|sensor| sensors[*sensor].lag_s() == 0.0).then_some(of_all)
}

/// The observer's twin: its first member alone.
pub(super) fn twin(observer: &Observer) -> Companion {
    observer.companion(1)
}

impl Monitor {
    /// What a row as it came shows of the wiring: before a late thermometer's jumps at the mouth of a tunnel are taken for a fault of it.
    pub(super) fn read_wiring(&mut self, row: &Row) {
        let Some(compared) = self.compared.filter(|_| self.twin.is_some()) else { return };
        let watches = &self.state.watches;
        let read = |sensor: usize| match watches[sensor].health() {
            Health::Missing | Health::Implausible | Health::Stuck => f64::NAN,
            Health::Good | Health::Spikes | Health::Deviates(_) | Health::Shifted(_) | Health::Detached => {
                row.readings[sensor]
            }
        };
        let [first, second, pressure_pa] = compared.map(read);
        let error_k = self.state.pair.error_k();
        self.state.wiring.read(row.time_s, [first / error_k, second / error_k, pressure_pa]);
    }

    /// Usable readings in the order of the places.
    pub(super) fn place(&mut self) {
        if let Some([first, second, _]) = self.compared.filter(|_| self.state.swapped) {
            self.usable.swap(first, second);
        }
    }

    /// The place that a channel stands for.
    pub(super) fn place_of(&self, channel: usize) -> usize {
        match self.compared {
            Some([first, second, _]) if self.state.swapped && channel == first => second,
            Some([first, second, _]) if self.state.swapped && channel == second => first,
            _ => channel,
        }
    }

    /// Let the twin take the row that the observer took.
    pub(super) fn step_twin(&mut self, time_s: f64) -> Result<(), DetectorError> {
        let just_exchanged = self.state.exchanged.is_some_and(|of| of.at_s == time_s);
        if just_exchanged && self.compared.is_some() && self.twin.is_some() {
            self.know_the_filling(self.now());
        }
        let (Some(compared @ [first, second, _]), Some(own)) = (self.compared, &mut self.twin) else {
            return Ok(());
        };
        if just_exchanged {
            self.observer.with(own, Observer::forget);
            self.state.wiring.forget_twin();
            return Ok(());
        }
        self.usable.swap(first, second);
        let of = |observer: &Observer| compared.map(|sensor| innovation(observer, sensor));
        let usable = &self.usable;
        let stepped = self.observer.with(own, |observer| {
            observer.step(time_s, usable)?;
            observer.round();
            Ok::<_, EstimatorError>(of(observer))
        });
        self.usable.swap(first, second);
        let of_twin = stepped?;
        if !self.state.is_exchanging(time_s) {
            let noise = compared.map(|sensor| self.sensors[sensor].noise_variance());
            self.state.wiring.compare(of(&self.observer), of_twin, noise);
        }
        Ok(())
    }

    /// What the rows so far say, before the next one is taken.
    pub(super) fn judge_wiring(&mut self, time_s: f64, events: &mut Vec<Event>) -> Result<(), DetectorError> {
        let Some(compared) = self.compared.filter(|_| self.twin.is_some()) else { return Ok(()) };
        if self.state.examined.is_some() {
            return Ok(());
        }
        let kind = |sensor: usize, by_s: f64| EventKind::Late { sensor, by_s };
        match self.state.wiring.judge(time_s) {
            Finding::Open => return Ok(()),
            Finding::Sound => {
                self.twin = None;
                return Ok(());
            }
            Finding::Late(late_s) => {
                let latest_s = late_s.iter().copied().fold(0.0, f64::max);
                let mut delays_s = vec![0.0; self.usable.len()];
                for (sensor, late_s) in compared.into_iter().zip(late_s) {
                    delays_s[sensor] = latest_s - late_s;
                    if late_s > 0.0 {
                        events.push(Event::new(time_s, time_s, kind(sensor, late_s)));
                    }
                }
                self.state.delays = DelayLine::of(delays_s);
            }
            Finding::Swapped => {
                let [first, second, _] = compared;
                self.state.swapped = true;
                self.twin = None;
                events.push(Event::new(time_s, time_s, EventKind::Swapped([first, second])));
            }
        }
        self.begin_again(time_s, events);
        Ok(())
    }

    /// What was learnt was learnt of wrong rows: learn again.
    fn begin_again(&mut self, time_s: f64, events: &mut Vec<Event>) {
        let now = self.now();
        self.observer.forget();
        self.know_the_filling(now);
        if let Some(twin) = &mut self.twin {
            self.observer.with(twin, Observer::forget);
        }
        let state = &mut self.state;
        for (watch, sensor) in state.watches.iter_mut().zip(&self.sensors) {
            *watch = SensorWatch::new(sensor);
        }
        state.pair = pair(&self.sensors, &self.roles, &self.settings);
        state.parity.begin_anew();
        state.jumps = JumpWatch::default();
        state.undisturbed.forget();
        state.evidence = Evidence::new(&self.settings.observer);
        state.start_s = Some(time_s);
        state.bounds.forget_flow();
        if state.leak.begin_anew() == Change::Ended {
            events.push(Event::new(time_s, time_s, EventKind::LeakEnded));
        }
    }

    /// Wherever an estimate begins again, it begins with this.
    pub(super) fn know_the_filling(&mut self, begun_with: Commissioning) {
        self.state.begun_with = begun_with;
        self.observer.begin_with(&begun_with);
    }

    /// What is known of the filling now: after an exchange of gas, the mass that the observer sees.
    fn now(&self) -> Commissioning {
        match self.state.exchanged.and_then(|_| self.observer.freest_mass_kg()) {
            Some((mass_kg, _)) => Commissioning { fill: Fill::Mass { mass_kg }, ..self.state.begun_with },
            None => self.state.begun_with,
        }
    }
}

/// What compares two thermometers, with the coarser one's steps and the noise of the one that has more.
pub(super) fn pair(sensors: &[Sensor], roles: &Roles, settings: &MonitorSettings) -> Pair {
    let largest = |of: fn(&Sensor) -> f64, least: f64| {
        roles.pair.into_iter().flatten().map(|sensor| of(&sensors[sensor])).fold(least, f64::max)
    };
    let error_k = largest(|sensor| sensor.noise_sd, settings.observer.model_error.surface_k);
    Pair::new(largest(|sensor| sensor.resolution, 0.0), error_k)
}

fn innovation(observer: &Observer, sensor: usize) -> Innovation {
    observer.innovations().get(sensor).copied().unwrap_or(Innovation::MISSING)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimator::thermal::vessel::presets;
    use crate::monitor::MonitorSettings;

    #[test]
    fn what_is_known_of_the_filling_outlives_the_program() {
        let vessel = presets::load("nitrogen-20l").unwrap();
        let sensors = ["shoulder", "valve", "pressure"].map(|name| Sensor::typical(name).unwrap());
        let (filled, settings) = (Commissioning::filled(200e5, 288.15), MonitorSettings::default());
        let mut monitor = Monitor::new(&vessel, &sensors, &filled, &settings).unwrap();
        monitor.know_the_filling(Commissioning { fill: Fill::Mass { mass_kg: 2.0 }, ..filled });
        let saved = monitor.save().unwrap();
        let mut restored = Monitor::restore(&vessel, &sensors, &settings, &saved).unwrap();
        let mut outputs = restored.step(0.0, &[288.15, 288.15, f64::NAN]).unwrap();
        outputs.extend(restored.finish().unwrap());
        let mass_kg = outputs[0].estimate.mass_kg;
        assert!((mass_kg - 2.0).abs() < 1e-6, "{mass_kg} kg");
    }
}

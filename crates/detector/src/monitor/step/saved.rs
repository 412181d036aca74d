//! A monitor saved, and one that goes on from there.
use super::exchange::Examined;
use super::{Monitor, State};
use crate::DetectorError;
use crate::estimator::observer::{Commissioning, Companion, Snapshot, SnapshotRef};
use crate::estimator::sensor::Sensor;
use crate::estimator::thermal::vessel::Vessel;
use crate::monitor::MonitorSettings;
use crate::monitor::restored::{self, Restored};
use crate::sealed::{self, Fingerprint, Kind, SealError};
use crate::units::QUOTED_K;
use alloc::boxed::Box;
use alloc::vec::Vec;
use serde::{Deserialize, Serialize};

/// What is saved.
#[derive(Deserialize)]
struct Saved {
    commissioning: Commissioning,
    held_against: Fingerprint,
    state: Box<State>,
    observer: Snapshot,
    twin: Option<Snapshot>,
    shadow: Option<Snapshot>,
}

impl Saved {
    /// Checks what a monitor, which has just been made, is to go on from.
    fn validate(&self, monitor: &mut Monitor) -> Result<(), DetectorError> {
        let state = &self.state;
        let of = Restored::new(monitor.sensors.len(), state.intake.latest_s(), &monitor.settings.intake);
        state.validate(monitor, &of)?;
        let snapshots = [Some(&self.observer), self.twin.as_ref(), self.shadow.as_ref()];
        for snapshot in snapshots.into_iter().flatten() {
            of.any_time("observer.time_s", snapshot.time_s())?;
        }
        let examined = self.shadow.is_some() == state.examined.is_some();
        let shadows = f64::from(u8::from(self.shadow.is_some()));
        restored::require(examined, "shadow", shadows, "there while a jump is examined, and not else")
    }
}

impl State {
    fn validate(&self, monitor: &mut Monitor, of: &Restored) -> Result<(), DetectorError> {
        self.intake.validate(&monitor.settings.intake, of)?;
        of.each("watches", self.watches.len())?;
        of.each("health", self.health.len())?;
        for (watch, sensor) in self.watches.iter().zip(&monitor.sensors) {
            watch.validate(sensor)?;
        }
        self.pair.validate()?;
        self.parity.validate()?;
        self.undisturbed.validate(&mut monitor.observer)?;
        self.wiring.validate()?;
        self.delays.validate(of)?;
        self.begun_with.mass_kg(&monitor.vessel, QUOTED_K)?;
        self.filling.validate()?;
        self.bounds.validate()?;
        self.gains.validate()?;
        self.examined.as_ref().map_or(Ok(()), Examined::validate)?;
        self.leak.validate()?;
        self.ready.rows.iter().try_for_each(|row| row.validate("ready", of))?;
        self.ready.events.iter().try_for_each(|event| event.validate(of))?;
        of.any_time("last_s", Some(self.last_s).filter(|last_s| *last_s != f64::NEG_INFINITY))
    }
}

/// The same, to be written: without copies.
#[derive(Serialize)]
struct Saving<'a> {
    commissioning: Commissioning,
    held_against: Fingerprint,
    state: &'a State,
    observer: SnapshotRef<'a>,
    twin: Option<&'a Snapshot>,
    shadow: Option<&'a Snapshot>,
}

/// What a state belongs to: vessel, sensors, and settings that decide what is kept of the rows. What the gas is held against does not belong
/// to it: limits, alarms, how rare a false one is to be and the tails that say so, when a reaction is due.
pub(super) fn fingerprint(vessel: &Vessel, sensors: &[Sensor], settings: &MonitorSettings) -> Fingerprint {
    let any = MonitorSettings::default();
    let settings = MonitorSettings {
        false_alarm_interval_s: any.false_alarm_interval_s,
        tails: any.tails,
        limits: any.limits,
        loss: any.loss,
        reaction: any.reaction,
        alarms: any.alarms,
        ..settings.clone()
    };
    sealed::fingerprint(&(vessel, sensors, settings))
}

/// What an outlook rests on beside the state.
fn held_against(settings: &MonitorSettings) -> Fingerprint {
    sealed::fingerprint(&(settings.limits, settings.loss, settings.reaction))
}

impl Monitor {
    /// A monitor that goes on from saved bytes, with the commissioning of then. Other limits, alarms, reactions, tails and another
    /// rarity of false alarms are taken over from this row on.
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
        let saved: Saved = sealed::decode(Kind::State, bytes, &fingerprint(vessel, sensors, settings))?;
        let mut monitor = Self::new(vessel, sensors, &saved.commissioning, settings)?;
        saved.validate(&mut monitor)?;
        monitor.observer.try_restore(&saved.observer)?;
        match (&mut monitor.twin, &saved.twin) {
            (Some(twin), Some(saved)) => {
                monitor.observer.with(twin, |observer| observer.try_restore(saved))?
            }
            _ => monitor.twin = None,
        }
        if let Some(saved) = &saved.shadow {
            monitor.observer.with(&mut monitor.shadow, |observer| observer.try_restore(saved))?;
        }
        monitor.know_the_filling(saved.state.begun_with);
        monitor.state = saved.state;
        monitor.state.make_room(&monitor.observer);
        monitor.state.p15.move_to(QUOTED_K);
        monitor.state.cold.move_to(settings.limits.coldest_k);
        if saved.held_against != held_against(settings) {
            monitor.state.outlook_due_s = f64::NEG_INFINITY;
        }
        Ok(monitor)
    }

    /// Everything that a restart needs.
    ///
    /// # Errors
    /// [`SealError::Engine`].
    pub fn save(&self) -> Result<Vec<u8>, SealError> {
        let examined = self.state.examined.is_some();
        let saved = Saving {
            commissioning: self.commissioning,
            held_against: held_against(&self.settings),
            state: &self.state,
            observer: self.observer.snapshot_ref(),
            twin: self.twin.as_deref().map(Companion::snapshot),
            shadow: examined.then(|| self.shadow.snapshot()),
        };
        sealed::encode(Kind::State, &saved, &self.fingerprint)
    }
}

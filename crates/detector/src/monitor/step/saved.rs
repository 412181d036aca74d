//! A monitor saved, and one that goes on from there.
use super::Monitor;
use super::state::State;
use crate::DetectorError;
use crate::estimator::observer::{Commissioning, Companion, Snapshot, SnapshotRef};
use crate::estimator::sensor::Sensor;
use crate::estimator::thermal::vessel::Vessel;
use crate::monitor::MonitorSettings;
use crate::monitor::restored::{self, Restored};
use crate::sealed::{self, Fingerprint, Kind, Payload, SealError};
use crate::units::QUOTED_K;
use alloc::vec::Vec;
use serde::Serialize;

/// What is saved: without copies.
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
        let mut saved = sealed::open(Kind::State, bytes, &fingerprint(vessel, sensors, settings))?;
        let commissioning: Commissioning = saved.part()?;
        let was_held_against: Fingerprint = saved.part()?;
        let mut monitor = Self::new(vessel, sensors, &commissioning, settings)?;
        monitor.state.read(&mut saved)?;
        let of = Restored::new(sensors.len(), monitor.state.intake.latest_s(), &settings.intake);
        monitor.state.validate((vessel, sensors, settings), &mut monitor.observer, &of)?;
        monitor.read_observers(&mut saved, &of)?;
        monitor.know_the_filling(monitor.state.begun_with);
        monitor.state.make_room(&monitor.observer);
        monitor.state.p15.move_to(QUOTED_K);
        monitor.state.cold.move_to(settings.limits.coldest_k);
        if was_held_against != held_against(settings) {
            monitor.state.outlook_due_s = f64::NEG_INFINITY;
        }
        Ok(monitor)
    }

    /// One after the other: each takes as much memory as a bank.
    #[inline(never)]
    fn read_observers(&mut self, saved: &mut Payload<'_>, of: &Restored) -> Result<(), DetectorError> {
        let checked = |snapshot: &Snapshot| of.any_time("observer.time_s", snapshot.time_s());
        let own: Snapshot = saved.part()?;
        checked(&own)?;
        self.observer.try_restore(&own)?;
        drop(own);
        let twin: Option<Snapshot> = saved.part()?;
        twin.as_ref().map_or(Ok(()), checked)?;
        match (&mut self.twin, &twin) {
            (Some(twin), Some(saved)) => self.observer.with(twin, |observer| observer.try_restore(saved))?,
            _ => self.twin = None,
        }
        drop(twin);
        let shadow: Option<Snapshot> = saved.part()?;
        let examined = shadow.is_some() == self.state.examined.is_some();
        let shadows = f64::from(u8::from(shadow.is_some()));
        restored::require(examined, "shadow", shadows, "there while a jump is examined, and not else")?;
        if let Some(saved) = &shadow {
            checked(saved)?;
            self.observer.with(&mut self.shadow, |observer| observer.try_restore(saved))?;
        }
        Ok(())
    }

    /// Everything that a restart needs.
    ///
    /// # Errors
    /// [`SealError::Engine`].
    pub fn save(&self) -> Result<Vec<u8>, SealError> {
        sealed::encode(Kind::State, &self.saving(), &self.fingerprint)
    }

    /// The same into `room`, and how many bytes it is: if more than there is room for, what is in it means nothing. Allocates nothing.
    ///
    /// # Errors
    /// As [`save`](Self::save).
    pub fn save_into(&self, room: &mut [u8]) -> Result<usize, SealError> {
        sealed::encode_into(Kind::State, &self.saving(), &self.fingerprint, room)
    }

    fn saving(&self) -> Saving<'_> {
        let examined = self.state.examined.is_some();
        Saving {
            commissioning: self.commissioning,
            held_against: held_against(&self.settings),
            state: &self.state,
            observer: self.observer.snapshot_ref(),
            twin: self.twin.as_deref().map(Companion::snapshot),
            shadow: examined.then(|| self.shadow.snapshot()),
        }
    }
}

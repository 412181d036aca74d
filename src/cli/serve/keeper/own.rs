//! The alarms of the gateway itself.
use super::*;
use jiff::Timestamp;

impl Keeper<'_> {
    /// Raises the alarm of those that have fallen silent.
    pub(in crate::cli::serve) fn look_for_silence(&mut self, now: Instant) {
        for name in self.silence.fallen(now) {
            self.set_alarm(&name, Kind::Silent, true, self.last_row_s(&name));
        }
    }

    /// Time of the last row since 1970, s; of a cylinder without one, of now.
    pub(super) fn last_row_s(&self, name: &str) -> f64 {
        let last_s = self.cylinders.get(name).and_then(|cylinder| cylinder.steps.last_row_s());
        last_s.unwrap_or_else(|| Timestamp::now().as_millisecond() as f64 * 1e-3)
    }

    pub(super) fn set_alarm(&mut self, name: &str, kind: Kind, active: bool, time_s: f64) {
        let told = self.alarms.set(name, kind, active, time_s);
        self.own.extend(told.into_iter().map(|told| (name.to_owned(), told)));
    }

    /// Puts the gateway's alarms on disk and publishes what has changed, even if they cannot be written.
    pub(in crate::cli::serve) fn publish_alarms(&mut self) -> anyhow::Result<()> {
        let own = std::mem::take(&mut self.own);
        let new: BTreeSet<&str> = own.iter().map(|(name, _)| name.as_str()).collect();
        let is_unsaved =
            |name: &str| self.cylinders.get(name).is_some_and(|cylinder| cylinder.unsaved_since.is_some());
        let written =
            self.alarms.write(|name| new.contains(name) || is_unsaved(name) || self.outbox.has_events(name));
        own.iter().for_each(|(name, told)| self.tell(name, std::slice::from_ref(told)));
        written
    }
}

//! Monitors that begin anew: their state was damaged, or they have failed.
use super::*;

impl Keeper<'_> {
    /// Begins the monitors anew that have failed; rows that come before are refused, now and when the journal is read again.
    pub(in crate::cli::serve) fn begin_failed_anew(&mut self) -> anyhow::Result<()> {
        while let Some(name) = self.failed.first().cloned() {
            let reason = self.cylinders.get(&name).and_then(|cylinder| cylinder.failed.clone());
            self.begin_anew(&name, &reason.unwrap_or_default())?;
            self.failed.remove(&name);
        }
        Ok(())
    }

    /// Begins a monitor anew: said, an event, and what it had is set aside.
    pub(super) fn begin_anew(&mut self, name: &str, reason: &str) -> anyhow::Result<()> {
        self.messages
            .caution(&format!("{name}: {reason}; its state is set aside and its monitor begins anew"));
        let (cylinder, reason, time_s) = (name.to_owned(), reason.to_owned(), self.last_row_s(name));
        self.journal.append(&[Entry::Anew { cylinder, reason: reason.clone(), time_s }])?;
        self.settle()?;
        self.set_aside(name)?;
        let number = self.journal.number();
        if let Some(cylinder) = self.cylinders.get_mut(name) {
            cylinder.steps = cylinder.assigned.monitor()?;
            cylinder.failed = None;
            cylinder.unsaved_since.get_or_insert(number);
        }
        self.tell_anew(name, &reason, time_s);
        Ok(())
    }

    /// An event and an alarm.
    pub(super) fn tell_anew(&mut self, name: &str, reason: &str, time_s: f64) {
        self.outbox.push(publication::anew(&self.settings.prefix, name, reason, time_s));
        if !self.alarms.is_known(name, Kind::StateLost, time_s) {
            self.set_alarm(name, Kind::StateLost, true, time_s);
        }
    }

    /// Gives the files of a cylinder names that nothing reads.
    pub(super) fn set_aside(&self, name: &str) -> anyhow::Result<()> {
        self.files(name).iter().try_for_each(|file| set_aside(file))
    }
}

//! Rows and acknowledgements: onto the disk, and to their monitors.
use super::*;

impl Keeper<'_> {
    /// Puts rows and acknowledgements on disk; only then they are accepted.
    pub(in crate::cli::serve) fn record(&mut self, inputs: &[(String, Delivered)]) -> anyhow::Result<()> {
        for (name, input) in inputs {
            // A later alarm must not be acknowledged when the journal is read again: those of the gateway are before it.
            if let Delivered::Acknowledge(comment) = input {
                let told = self.alarms.acknowledge(name, comment);
                self.own.extend(told.into_iter().map(|told| (name.clone(), told)));
            }
        }
        self.publish_alarms()?;
        let entry = |(name, input): &(String, Delivered)| match input {
            Delivered::Row(Accepted { time_ns, cells }) => {
                Entry::Row { cylinder: name.clone(), time_ns: *time_ns, cells: cells.clone() }
            }
            Delivered::Acknowledge(comment) => {
                Entry::Acknowledged { cylinder: name.clone(), comment: comment.clone() }
            }
        };
        self.journal.append(&inputs.iter().map(entry).collect::<Vec<_>>())
    }

    /// Gives what was recorded to its monitor.
    pub(in crate::cli::serve) fn take(
        &mut self,
        name: &str,
        input: Delivered,
    ) -> Result<(), (Refusal, String)> {
        let number = self.journal.number();
        if let Some(cylinder) = self.cylinders.get_mut(name) {
            cylinder.unsaved_since.get_or_insert(number);
        }
        match input {
            Delivered::Row(Accepted { time_ns, cells }) => {
                self.rows += 1;
                self.recent.note(name, time_ns, &cells);
                self.silence.heard(name, Instant::now());
                if self.alarms.must_clear(name) {
                    self.set_alarm(name, Kind::Silent, false, time_ns as f64 * 1e-9);
                }
                let names = self.names.clone();
                self.step(name, &names, time_ns, &cells)
            }
            Delivered::Acknowledge(comment) => {
                self.acknowledge(name, &comment);
                Ok(())
            }
        }
    }

    pub(super) fn step(
        &mut self,
        name: &str,
        names: &[String],
        time_ns: i64,
        cells: &[f64],
    ) -> Result<(), (Refusal, String)> {
        let Some(cylinder) = self.cylinders.get_mut(name) else { return Ok(()) };
        if cylinder.failed.is_some() {
            return Err((Refusal::Monitor, "its monitor begins anew after this row".to_owned()));
        }
        let readings: Vec<(&str, f64)> =
            names.iter().map(String::as_str).zip(cells.iter().copied()).collect();
        let had_begun = cylinder.steps.has_begun();
        match cylinder.steps.step(StepTime::Instant(time_ns, ZONE.to_owned()), &readings) {
            Ok((table, told)) => {
                self.tell(name, &told);
                publication::last_row(&self.settings.prefix, name, &table)
                    .into_iter()
                    .for_each(|message| self.outbox.push(message));
                Ok(())
            }
            Err(error) => {
                let reason = format!("{error:#}");
                // It may have taken in a part of the row.
                if had_begun {
                    cylinder.failed = Some(reason.clone());
                    self.failed.insert(name.to_owned());
                }
                Err((Refusal::Monitor, reason))
            }
        }
    }

    pub(super) fn acknowledge(&mut self, name: &str, comment: &str) {
        let told = self.cylinders.get_mut(name).map(|cylinder| cylinder.steps.acknowledge(comment));
        self.tell(name, &told.unwrap_or_default());
    }

    pub(super) fn tell(&mut self, name: &str, told: &[Told]) {
        for one in told {
            self.messages.say(&format!("{name}: {}", one.words));
            self.outbox.push(publication::told(&self.settings.prefix, name, one));
        }
    }
}

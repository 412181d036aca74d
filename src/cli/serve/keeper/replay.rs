//! The start: what the journal has and the states do not know is taken in again.
use super::*;

impl Keeper<'_> {
    /// Takes in what the journal has and the states do not.
    pub(super) fn replay(&mut self, segments: Vec<Segment>) -> anyhow::Result<()> {
        let mut by_cylinder: BTreeMap<String, Vec<(u64, Vec<String>, Entry)>> = BTreeMap::new();
        for Segment { number, entries, surplus } in segments {
            if surplus > 0 {
                self.messages.caution(&format!(
                    "journal {number}: {surplus} bytes at its end are no whole row, as after a power cut; they are left out"
                ));
            }
            let mut names = self.names.clone();
            for entry in entries {
                match &entry {
                    Entry::Readings(readings) => names = readings.clone(),
                    Entry::Row { cylinder, time_ns, cells } => self.recent.note(cylinder, *time_ns, cells),
                    _ => {}
                }
                if let Some(cylinder) = entry.cylinder().map(str::to_owned) {
                    by_cylinder.entry(cylinder).or_default().push((number, names.clone(), entry));
                }
            }
        }
        let settings = Arc::clone(&self.settings);
        for (name, entries) in by_cylinder {
            match settings.named.get(&name).or(settings.by_pattern.as_ref()) {
                Some(assigned) => self.replay_of(&name, assigned, entries)?,
                None => self.messages.caution(&format!(
                    "{name} is in the journal and not in the configuration: its last rows wait in vain"
                )),
            }
        }
        Ok(())
    }

    fn replay_of(
        &mut self,
        name: &str,
        assigned: &Assigned,
        entries: Vec<(u64, Vec<String>, Entry)>,
    ) -> anyhow::Result<()> {
        let [state, waiting] = self.files(name);
        let on_disk = read(&state)?.or(read(&waiting)?).map(|bytes| Input::of("", &bytes).sha256);
        let known = entries.iter().rposition(
            |(_, _, entry)| matches!(entry, Entry::Saving { sha256, .. } if Some(sha256) == on_disk.as_ref()),
        );
        let anew = entries.iter().rposition(|(_, _, entry)| matches!(entry, Entry::Anew { .. }));
        let first = match (known, anew) {
            (Some(known), anew) if anew.is_none_or(|anew| anew < known) => known + 1,
            (_, Some(anew)) => {
                // The gateway was killed between the two.
                self.set_aside(name)?;
                anew
            }
            (_, None) => 0,
        };
        self.know(name, assigned)?;
        for (number, names, entry) in entries.into_iter().skip(first) {
            if let Some(cylinder) = self.cylinders.get_mut(name)
                && !matches!(entry, Entry::Saving { .. })
            {
                cylinder.unsaved_since = Some(cylinder.unsaved_since.unwrap_or(number).min(number));
            }
            match entry {
                Entry::Row { time_ns, cells, .. } => {
                    // What was refused is refused again, and was said.
                    _ = self.step(name, &names, time_ns, &cells);
                }
                Entry::Acknowledged { comment, .. } => self.acknowledge(name, &comment),
                Entry::Anew { reason, time_s, .. } => self.tell_anew(name, &reason, time_s),
                Entry::Saving { .. } | Entry::Readings(_) => {}
            }
        }
        Ok(())
    }
}

//! States on their way to the disk.
use super::*;
use crate::cli::serve::saver::Job;

impl Keeper<'_> {
    /// Names of the cylinders whose states do not know all.
    pub(in crate::cli::serve) fn unsaved(&self) -> Vec<String> {
        let unsaved = self.cylinders.iter().filter(|(_, cylinder)| cylinder.unsaved_since.is_some());
        unsaved.map(|(name, _)| name.clone()).collect()
    }

    /// Begins to save the states of some cylinders, but for those whose events have not arrived or whose state is being written.
    pub(in crate::cli::serve) fn save(&mut self, names: &[String]) -> anyhow::Result<()> {
        let (mut entries, mut jobs) = (Vec::new(), Vec::new());
        for name in names {
            let Some(cylinder) = self.cylinders.get(name) else { continue };
            if cylinder.unsaved_since.is_none()
                || cylinder.saving_since.is_some()
                || self.outbox.has_events(name)
            {
                continue;
            }
            let [state, waiting] = self.files(name);
            let job = match cylinder.steps.state_file()? {
                Some(bytes) => Job { name: name.clone(), file: state, bytes, replaces: Some(waiting) },
                None => {
                    Job { name: name.clone(), file: waiting, bytes: cylinder.steps.save()?, replaces: None }
                }
            };
            let sha256 = Input::of("", &job.bytes).sha256;
            entries.push(Entry::Saving { cylinder: name.clone(), sha256 });
            jobs.push(job);
        }
        if jobs.is_empty() {
            return Ok(());
        }
        self.journal.append(&entries)?;
        for job in &jobs {
            if let Some(cylinder) = self.cylinders.get_mut(&job.name) {
                cylinder.saving_since = cylinder.unsaved_since.take();
            }
        }
        self.saver.begin(jobs);
        Ok(())
    }

    /// Takes note of what has been written, and says how many; of a state that could not be, the rows stay in the journal.
    pub(in crate::cli::serve) fn note_saved(&mut self) -> anyhow::Result<usize> {
        let mut noted = Ok(0);
        while let Some((name, written)) = self.saver.done() {
            if let Some(cylinder) = self.cylinders.get_mut(&name) {
                let since = cylinder.saving_since.take();
                if written.is_err() {
                    cylinder.unsaved_since = since.or(cylinder.unsaved_since);
                }
            }
            noted = noted.and_then(|count: usize| written.map(|()| count + 1));
        }
        noted
    }

    /// Waits until nothing is being written.
    pub(in crate::cli::serve) fn settle(&mut self) -> anyhow::Result<()> {
        self.saver.wait();
        self.note_saved().map(|_| ())
    }

    /// Begins a segment, and removes those that no state needs, but for the last of them: what is delivered again is known by it.
    pub(in crate::cli::serve) fn turn_over(&mut self) -> anyhow::Result<()> {
        let since = |cylinder: &Cylinder| cylinder.saving_since.or(cylinder.unsaved_since);
        let oldest = self.cylinders.values().filter_map(since).min();
        let needed = oldest.unwrap_or(self.journal.number());
        self.journal.remove_before(needed.saturating_sub(1))?;
        self.journal.rotate()
    }
}

//! Another configuration: taken over whole, or refused whole.
use super::*;
use anyhow::anyhow;

/// What becomes of a cylinder.
enum Fate {
    Stays,
    /// Other options or readings: its monitor goes on with them.
    Changes(Box<Cylinder>),
    /// It is not there any more.
    Leaves,
}

impl Keeper<'_> {
    /// Whether all events have arrived of cylinders that change or leave.
    pub(in crate::cli::serve) fn is_settled(&self, settings: &Settings) -> bool {
        self.cylinders.iter().all(|(name, cylinder)| {
            self.assigned_in(settings, name) == Some(&cylinder.assigned) || !self.outbox.has_events(name)
        })
    }

    /// Takes a configuration over; says what has changed.
    ///
    /// # Errors
    /// It cannot be taken over; all stays as it was.
    pub(in crate::cli::serve) fn take_over(&mut self, settings: Arc<Settings>) -> anyhow::Result<String> {
        self.check(&settings)?;
        let names: Vec<String> =
            settings.mapping.readings.iter().map(|reading| reading.name.clone()).collect();
        // As it was: the state on disk is that of the options before.
        let is_other = |(name, cylinder): &(&String, &Cylinder)| {
            self.assigned_in(&settings, name) != Some(&cylinder.assigned)
        };
        let others: Vec<String> =
            self.cylinders.iter().filter(is_other).map(|(name, _)| name.clone()).collect();
        self.settle()?;
        self.save(&others)?;
        self.settle()?;
        let mut fates = Vec::new();
        for (name, cylinder) in &self.cylinders {
            fates.push((name.clone(), self.fate(&settings, &names, name, cylinder)?));
        }
        let new: Vec<(String, Assigned)> = settings
            .named
            .iter()
            .filter(|(name, _)| !self.cylinders.contains_key(*name))
            .map(|(name, assigned)| (name.clone(), assigned.clone()))
            .collect();
        for (name, assigned) in &new {
            assigned.monitor().with_context(|| name.clone())?;
        }
        if names != self.names {
            self.journal.go_on_with(&names)?;
        }
        self.names = names;
        self.settings = settings;
        let changed = self.commit(fates);
        for (name, assigned) in &new {
            self.know(name, assigned)?;
        }
        self.by_pattern =
            self.cylinders.keys().filter(|name| !self.settings.named.contains_key(*name)).count();
        let (changed, left) = changed;
        Ok(format!("{} cylinders new, {changed} with other options or readings, {left} left", new.len()))
    }

    /// What cannot change while the gateway runs.
    fn check(&self, settings: &Settings) -> anyhow::Result<()> {
        if settings.folder != self.settings.folder {
            bail!("the folder of [store] is another one: start the gateway again");
        }
        if settings.prefix != self.settings.prefix {
            bail!("the prefix of [publish] is another one: start the gateway again");
        }
        Ok(())
    }

    fn assigned_in<'a>(&self, settings: &'a Settings, name: &str) -> Option<&'a Assigned> {
        let is_by_pattern = !self.settings.named.contains_key(name);
        settings.named.get(name).or(settings.by_pattern.as_ref().filter(|_| is_by_pattern))
    }

    fn fate(
        &self,
        settings: &Settings,
        names: &[String],
        name: &str,
        cylinder: &Cylinder,
    ) -> anyhow::Result<Fate> {
        let Some(assigned) = self.assigned_in(settings, name) else { return Ok(Fate::Leaves) };
        if assigned == &cylinder.assigned && names == self.names {
            return Ok(Fate::Stays);
        }
        let mut steps = assigned.monitor().with_context(|| name.to_owned())?;
        match cylinder.steps.state_file()? {
            Some(state) => steps.resume(names, &state).map_err(|reason| match reason {
                NotResumed::Other(error) => {
                    error.context(format!("{name} cannot go on with its new options"))
                }
                NotResumed::Damaged(reason) => anyhow!("{name}: {reason}"),
            })?,
            None if names == self.names => steps.restore(&cylinder.steps.save()?)?,
            None => bail!("{name} waits for its first pressure: change the readings after that"),
        }
        Ok(Fate::Changes(Box::new(Cylinder {
            assigned: assigned.clone(),
            steps,
            unsaved_since: Some(cylinder.unsaved_since.unwrap_or(self.journal.number())),
            saving_since: None,
            failed: cylinder.failed.clone(),
        })))
    }

    /// How many have changed and left.
    fn commit(&mut self, fates: Vec<(String, Fate)>) -> (usize, usize) {
        let (mut changed, mut left) = (0, 0);
        for (name, fate) in fates {
            match fate {
                Fate::Stays => {}
                Fate::Changes(cylinder) => {
                    changed += 1;
                    self.silence.watch(&name, cylinder.assigned.silent_after, Instant::now());
                    self.cylinders.insert(name, *cylinder);
                }
                Fate::Leaves => {
                    left += 1;
                    self.silence.forget(&name);
                    self.alarms.forget(&name);
                    self.cylinders.remove(&name);
                    self.outbox.clear(&format!("{}/{name}/", self.settings.prefix));
                }
            }
        }
        (changed, left)
    }
}

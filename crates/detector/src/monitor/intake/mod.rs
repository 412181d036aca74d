//! From rows as they arrive to rows as an observer needs them: in order, each once, on a time that never runs backwards.
//!
//! A row passes three stations. The clock guard (`clock`) finds its place on an internal axis of time
//! `t = stamp - offset`: a stamp far ahead or behind is believed when the next rows agree with it, and moves the axis if it
//! was the clock that jumped. The order holds rows back for the allowed lateness, sorts them and unites rows of one
//! time. The bins make one row of many that lie closer together than a step.
//!
//! # What it assumes
//! * Rows of one time belong together, and what has been handed out stands.
//! * A jump forward within the longest gap is a gap; one hour of summer time is then an hour without rows.
//! * A jump backward within the lateness cannot be told from late rows, and is taken as such. Nor can rows of a time in which
//!   there were none: they come from a store. Rows that are replayed as they were are known for the last 1800 at least.
//!
//! As long as the clock does not jump and no row is later than the lateness, the rows that come out depend on the set of rows
//! that came in alone, not on their order nor on how often each came: bit for bit. State and time per row are bounded.
mod bins;
mod clock;
mod interval;
mod memory;
mod order;
mod row;
pub(super) mod settings;

use serde::{Deserialize, Serialize};

use self::bins::Bins;
use self::clock::{Guard, Place, Stray};
use self::interval::UsualInterval;
use self::memory::Memory;
use self::order::{Inserted, Order};
use self::row::United;
pub use self::row::{Counts, Readings, Row, Taken};
pub use self::settings::IntakeSettings;
use super::restored::{self, Restored};
use super::{Event, EventKind};
use crate::DetectorError;

/// Usual intervals without a row from which a row comes after a gap, however short a gap is reported.
const MISSED: f64 = 4.0;
/// Rows of distinct times that confirm a jump of the clock,
const CONFIRM_JUMP: usize = 3;
/// and a gap.
const CONFIRM_GAP: usize = 2;
/// Stamps beyond this, s, are none: there a second is no longer resolved well.
const STAMP_LARGEST_S: f64 = 1e12;

/// Takes in the rows of one cylinder.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Intake {
    settings: IntakeSettings,
    sensors: usize,
    guard: Guard,
    order: Order,
    usual: UsualInterval,
    memory: Memory,
    bins: Bins,
    counts: Counts,
    astray: u32,
}

impl Intake {
    /// An intake for rows of so many readings.
    ///
    /// # Errors
    /// A setting is out of its bounds.
    pub fn new(settings: IntakeSettings, sensors: usize) -> Result<Self, DetectorError> {
        settings.validate()?;
        Ok(Self {
            settings,
            sensors,
            guard: Guard::default(),
            order: Order::default(),
            usual: UsualInterval::default(),
            memory: Memory::default(),
            bins: Bins::new(settings.step_s, sensors),
            counts: Counts::default(),
            astray: 0,
        })
    }

    /// Time of the latest row that was accepted, s; minus infinity: of none.
    pub(super) fn latest_s(&self) -> f64 {
        self.guard.latest_s
    }

    /// Checks one that was saved, of a monitor with these settings.
    pub(super) fn validate(&self, settings: &IntakeSettings, of: &Restored) -> Result<(), DetectorError> {
        let Counts { rows, duplicates, merged, contradictions, too_late, wild, jumps, gaps } = self.counts;
        for counted in [rows, duplicates, merged, contradictions, too_late, wild, jumps, gaps] {
            restored::count("intake.counts", counted)?;
        }
        let own = &self.settings;
        for (what, own, stated) in [
            ("intake.lateness_s", own.lateness_s, settings.lateness_s),
            ("intake.step_s", own.step_s, settings.step_s),
            ("intake.gap_s", own.gap_s, settings.gap_s),
            ("intake.longest_gap_s", own.longest_gap_s, settings.longest_gap_s),
        ] {
            restored::require(own == stated, what, own, "that of the settings")?;
        }
        of.each("intake.sensors", self.sensors)?;
        self.guard.validate(of)?;
        self.order.validate(of)?;
        self.usual.validate()?;
        self.memory.validate()?;
        self.bins.validate(settings.step_s, of)
    }

    /// Memory for rows as they usually come.
    pub(super) fn make_room(&mut self) {
        self.order.make_room();
        self.bins.make_room();
    }

    /// Take in a row with its stamp, s, and its readings, SI, NaN where missing.
    ///
    /// # Errors
    /// The row has another number of readings; all is then as it was.
    pub fn take(&mut self, stamp_s: f64, readings: &[f64]) -> Result<Taken, DetectorError> {
        let mut taken = Taken::default();
        self.take_into(stamp_s, readings, false, &mut taken)?;
        Ok(taken)
    }

    /// The same of a row that is known to be replayed from a store: it never moves the clock, and is used within the lateness.
    ///
    /// # Errors
    /// As [`Intake::take`].
    pub fn take_historical(&mut self, stamp_s: f64, readings: &[f64]) -> Result<Taken, DetectorError> {
        let mut taken = Taken::default();
        self.take_into(stamp_s, readings, true, &mut taken)?;
        Ok(taken)
    }

    /// The same of a row that may be replayed, added to what was taken before.
    pub(super) fn take_into(
        &mut self,
        stamp_s: f64,
        readings: &[f64],
        historical: bool,
        taken: &mut Taken,
    ) -> Result<(), DetectorError> {
        if readings.len() != self.sensors {
            return Err(DetectorError::RowLength { expected: self.sensors, found: readings.len() });
        }
        self.counts.rows += 1;
        if stamp_s.is_nan() || stamp_s.abs() > STAMP_LARGEST_S {
            self.counts.wild += 1;
            self.astray = self.astray.saturating_add(1);
            return Ok(());
        }
        let stray = Stray { stamp_s, readings: Readings::from_slice(readings) };
        let place = self.guard.place(stamp_s, self.settings.lateness_s, self.reach_s());
        match place {
            Place::On => {
                self.accept(stray, taken);
                self.look_again(taken);
            }
            // Bit for bit what was handed out already.
            Place::Behind if self.memory.knows(memory::hash(&stray)) => self.counts.duplicates += 1,
            // It says that it comes from a store, or it belongs where rows were missing.
            Place::Behind if historical || self.memory.is_in_gap(stamp_s - self.guard.offset_s) => {
                self.astray = self.astray.saturating_add(1);
                self.too_late(stamp_s, taken);
            }
            Place::Behind | Place::Ahead => self.stray(stray, place, taken),
        }
        Ok(())
    }

    /// Hand out what is held back: the rows have come to their end.
    pub fn flush(&mut self) -> Taken {
        let mut taken = Taken::default();
        self.flush_into(&mut taken);
        taken
    }

    /// The same, added to what was taken before.
    pub(super) fn flush_into(&mut self, taken: &mut Taken) {
        let run = self.guard.take_run();
        let gap = run.first().is_some_and(|first| self.is_gap(first.stamp_s));
        for stray in run {
            if gap {
                self.accept(stray, taken);
            } else {
                self.give_up(&stray, taken);
            }
        }
        self.release(f64::INFINITY, taken);
        taken.rows.extend(self.bins.close());
    }

    /// What has become of the rows so far.
    pub fn counts(&self) -> &Counts {
        &self.counts
    }

    /// Whether the last rows, three or more, found no place in time: the clock stands still, or shows anything.
    pub fn is_astray(&self) -> bool {
        self.astray as usize >= CONFIRM_JUMP
    }

    /// Stamps minus internal time, s: the sum of all jumps of the clock.
    pub fn offset_s(&self) -> f64 {
        self.guard.offset_s
    }

    /// Usual interval between rows, s; `None` before the second row.
    pub fn usual_interval_s(&self) -> Option<f64> {
        self.usual.median_s()
    }

    /// Number of rows that are held back.
    pub fn held(&self) -> usize {
        self.guard.held() + self.order.held() + self.bins.held()
    }

    /// Time without rows that needs no confirmation, s.
    fn reach_s(&self) -> f64 {
        self.gap_s().max(self.settings.lateness_s)
    }

    /// Time without rows that is reported, s.
    fn gap_s(&self) -> f64 {
        self.settings.gap_s.max(MISSED * self.usual.median_s().unwrap_or(0.0))
    }

    /// Whether a stamp lies ahead, but no further than the longest gap.
    fn is_gap(&self, stamp_s: f64) -> bool {
        let ahead_s = self.guard.ahead_s(stamp_s);
        (0.0..=self.settings.longest_gap_s.max(self.reach_s())).contains(&ahead_s)
    }

    /// A row off the axis: into the run of those that may confirm each other.
    fn stray(&mut self, stray: Stray, place: Place, taken: &mut Taken) {
        self.astray = self.astray.saturating_add(1);
        let IntakeSettings { lateness_s, longest_gap_s, .. } = self.settings;
        let first_s = self.guard.run_first_s();
        let same_side = first_s.is_none_or(|s| self.guard.place(s, lateness_s, self.reach_s()) == place);
        if !same_side || !self.guard.fits_run(stray.stamp_s, lateness_s, longest_gap_s) {
            self.discard_run(taken);
        }
        match self.guard.join_run(stray) {
            None => {}
            Some(United::Same) => self.counts.duplicates += 1,
            Some(United::Filled) => self.counts.merged += 1,
            Some(United::Replaced) => self.counts.contradictions += 1,
        }
        let first_s = self.guard.run_first_s();
        let gap = first_s.is_some_and(|stamp_s| self.is_gap(stamp_s));
        let needed = if gap { CONFIRM_GAP } else { CONFIRM_JUMP };
        if self.guard.held() < needed {
            return;
        }
        let run = self.guard.take_run();
        if !gap {
            self.jump(&run, taken);
        }
        run.into_iter().for_each(|stray| self.accept(stray, taken));
    }

    /// The clock has jumped: rows go on a usual interval after the latest one.
    fn jump(&mut self, run: &[Stray], taken: &mut Taken) {
        self.release(f64::INFINITY, taken);
        let among = run.get(1).map_or(0.0, |second| second.stamp_s - run[0].stamp_s);
        let usual_s = self.usual.median_s().unwrap_or(among);
        let Some((time_s, jump_s)) = self.guard.jump(run[0].stamp_s, usual_s) else { return };
        self.counts.jumps += 1;
        taken.events.push(Event::new(time_s, time_s, EventKind::ClockJump(jump_s)));
    }

    /// A row whose time is believed.
    fn accept(&mut self, stray: Stray, taken: &mut Taken) {
        let stamp_s = stray.stamp_s;
        let hash = memory::hash(&stray);
        let time_s = self.guard.accept(stamp_s);
        let inserted = self.order.insert(Row { time_s, stamp_s, readings: stray.readings });
        match inserted {
            Inserted::New => {}
            Inserted::Merged => self.counts.merged += 1,
            Inserted::Duplicate => self.counts.duplicates += 1,
            Inserted::Contradicts => self.counts.contradictions += 1,
            Inserted::TooLate => self.too_late(stamp_s, taken),
        }
        match inserted {
            Inserted::New | Inserted::Merged => {
                self.astray = 0;
                self.memory.keep(hash);
            }
            Inserted::Contradicts | Inserted::TooLate => self.astray = self.astray.saturating_add(1),
            Inserted::Duplicate => {}
        }
        // At once without a lateness; else what no row inside the lateness can come before any more.
        let latest_s = self.guard.latest_s;
        let lateness_s = self.settings.lateness_s;
        self.release(if lateness_s > 0.0 { latest_s - lateness_s } else { f64::INFINITY }, taken);
    }

    /// Hand out rows before a time, and those for which there is no room.
    fn release(&mut self, before_s: f64, taken: &mut Taken) {
        while let Some(row) = self.order.pop(before_s) {
            if let Some(last_s) = self.order.handed_out_s() {
                let gap_s = row.time_s - last_s;
                if gap_s > self.gap_s() {
                    self.counts.gaps += 1;
                    taken.events.push(Event::new(row.time_s, last_s, EventKind::Gap(gap_s)));
                }
                if self.usual.median_s().is_some_and(|usual_s| gap_s > MISSED * usual_s) {
                    self.memory.keep_gap(last_s, row.time_s);
                }
                self.usual.push(gap_s);
            }
            self.order.note(&row);
            self.bins.take(row, &mut taken.rows);
        }
    }

    /// A row has been believed: what strayed lies on the axis now, or is given up.
    fn look_again(&mut self, taken: &mut Taken) {
        for stray in self.guard.take_run() {
            match self.guard.place(stray.stamp_s, self.settings.lateness_s, self.reach_s()) {
                Place::On => self.accept(stray, taken),
                Place::Behind | Place::Ahead => self.give_up(&stray, taken),
            }
        }
    }

    fn discard_run(&mut self, taken: &mut Taken) {
        for stray in self.guard.take_run() {
            self.give_up(&stray, taken);
        }
    }

    /// A stamp that nothing confirmed: too late, or wild.
    fn give_up(&mut self, stray: &Stray, taken: &mut Taken) {
        if self.guard.ahead_s(stray.stamp_s) > 0.0 {
            self.counts.wild += 1;
        } else {
            self.too_late(stray.stamp_s, taken);
        }
    }

    fn too_late(&mut self, stamp_s: f64, taken: &mut Taken) {
        self.counts.too_late += 1;
        let onset_s = stamp_s - self.guard.offset_s;
        taken.events.push(Event::new(self.guard.latest_s, onset_s, EventKind::TooLate));
    }
}

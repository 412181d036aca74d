//! A run: rows in, outputs out, the state saved now and then.
use super::context::RunContext;
use super::events::{Console, EventSink};
use super::reading::Reading;
use super::resume::refused;
use super::rows::Rows;
use super::state::{Refusal, State};
use super::*;
use crate::detector::monitor::intake::Counts;
use crate::detector::monitor::{Monitor, Outcome, Output};
use crate::log::Truth;
use crate::report::monitor::{self as report, FigureData, Naming, RowCounts, Summary};
use crate::report::{Clock, Report, Shown, Table};
use std::collections::VecDeque;
use std::path::PathBuf;
use std::time::Instant;

/// Most logs whose beginning is remembered.
const MOST_LOGS: usize = 64;

/// A run that has ended.
pub(in crate::cli) struct Finished {
    /// What is left of it; `None`: no row has come out yet.
    pub summary: Option<Summary>,
    /// What could not be written at the end.
    pub written: anyhow::Result<()>,
    /// Rows that a caller takes.
    pub rows: Option<Table>,
    /// Events and alarms that a caller takes.
    pub events: Vec<String>,
    /// Report that a caller takes.
    pub report: Option<Report>,
    /// Zone in which the dates of the log are told.
    pub zone: Option<String>,
    /// What was read.
    pub reading: Reading,
}

/// A run that is under way.
pub(super) struct Session<'a> {
    context: RunContext<'a>,
    monitor: Monitor,
    full_pa: f64,
    settled: bool,
    stated: bool,
    naming: Naming,
    sink: EventSink,
    /// `None`: no rows are wanted.
    rows: Option<Rows>,
    /// Takes what happens, beside the sink.
    course: Option<&'a mut Course>,
    figure: Option<FigureData>,
    readings: Vec<f64>,
    /// Truths of the rows that may be held back, with their stamps, s; only for a figure.
    truths: VecDeque<(f64, Truth)>,
    last: Option<Output>,
    last_stamp_s: f64,
    /// Times of the first rows of the last logs, s.
    log_starts_s: Vec<f64>,
    /// Rows up to this time are known to the state; NaN: none is. `None`: no row has been looked at.
    known_until_s: Option<f64>,
    known_rows: u64,
    /// What had become of rows before this run.
    counts_before: Counts,
    loss_found: bool,
    continued: bool,
    /// The table of the state.
    table: Option<(PathBuf, u64)>,
    /// Why the state could not be saved the last time.
    unsaved: Option<String>,
    /// Whether something failed that leaves the monitor or the rows with part of a row.
    broken: bool,
    saved: Instant,
}

impl<'a> Session<'a> {
    /// Goes on from a state, or begins cold.
    pub(super) fn begin(
        context: RunContext<'a>,
        start: &RunStart,
        engine: Engine,
        log: &LogInput,
        course: Option<&'a mut Course>,
    ) -> anyhow::Result<Self> {
        let state = start.state.as_ref();
        let options = context.options;
        let limits = options.limits;
        let sensors = context.selection.sensors.iter();
        let naming = Naming {
            clock: Clock::new(log.reader.origin_instant(), log.reader.zone().cloned())
                .after(state.map_or_else(Shown::default, |state| state.clock.clone())),
            sensors: sensors.map(|sensor| (sensor.name.clone(), sensor.quantity())).collect(),
        };
        let last_stamp_s = state.map_or(f64::NAN, |state| state.last_stamp_s);
        let mut sink = EventSink::open(options.events.as_ref(), state.is_some(), context.messages)?;
        if let Some(reason) = &start.cold_start {
            sink.cold_start(reason)?;
        }
        let counts_before = *engine.monitor.intake().counts();
        let mut monitor = engine.monitor;
        for announced in &options.announced {
            let (from_s, until_s) = announced.seconds(log.reader.origin_instant())?;
            monitor.announce(from_s, until_s);
        }
        Ok(Self {
            monitor,
            full_pa: engine.full_pa,
            settled: engine.settled,
            stated: engine.stated,
            naming,
            sink,
            rows: Rows::begin(&context, log, &start.vessel, state)?,
            course,
            table: state.and_then(|state| state.table.clone()),
            figure: options
                .views
                .is_any_requested()
                .then(|| FigureData::new(limits.limit_pa, engine.full_pa)),
            readings: Vec::new(),
            truths: VecDeque::new(),
            last: state.and_then(|state| state.last.clone()),
            last_stamp_s,
            log_starts_s: state.map_or(Vec::new(), |state| state.log_starts_s.clone()),
            known_until_s: None,
            known_rows: 0,
            counts_before,
            loss_found: false,
            continued: state.is_some(),
            unsaved: None,
            broken: false,
            saved: Instant::now(),
            context,
        })
    }

    /// Acknowledges the alarms of the state, if that is wanted.
    pub(super) fn acknowledge(&mut self, progress: &Progress) -> anyhow::Result<()> {
        let Some(comment) = &self.context.options.acknowledge else { return Ok(()) };
        let console = Console { messages: self.context.messages, progress };
        for alarm in self.monitor.acknowledge(comment) {
            self.sink.alarm(&alarm, &self.naming, &console)?;
        }
        Ok(())
    }

    /// Takes in a row.
    pub(super) fn push(&mut self, row: &Row, log: &LogInput, progress: &Progress) -> anyhow::Result<()> {
        if self.is_known(row)? {
            self.known_rows += 1;
            return Ok(());
        }
        self.naming.clock.set(log.reader.origin_instant(), log.reader.zone());
        self.readings.clear();
        self.readings.extend(self.context.selection.readings(row));
        self.broken = true;
        let outputs = self.monitor.step(row.time_s, &self.readings).with_context(|| log.reader.place(row))?;
        self.last_stamp_s = row.time_s;
        if self.figure.is_some() {
            self.truths.push_back((row.time_s, row.truth));
            let surplus = self.truths.len().saturating_sub(self.monitor.intake().held() + outputs.len() + 1);
            self.truths.drain(..surplus);
        }
        for output in outputs {
            self.take(output, progress)?;
        }
        if self.context.options.is_live {
            self.flush()?;
        }
        self.broken = false;
        if self.saved.elapsed() >= self.context.options.save_every {
            self.try_to_save(log)?;
        }
        Ok(())
    }

    /// Saves the state during the run. What hinders it costs one caution: it is tried again.
    fn try_to_save(&mut self, log: &LogInput) -> anyhow::Result<()> {
        self.flush()?;
        let messages = self.context.messages;
        match (self.save(log), self.unsaved.take()) {
            (Ok(()), Some(_)) => messages.caution("the state is saved again"),
            (Ok(()), None) => {}
            (Err(error), before) => {
                if before.is_none() {
                    messages.caution(&format!("{error:#}; the run goes on"));
                }
                self.unsaved = Some(format!("{error:#}"));
            }
        }
        Ok(())
    }

    /// Whether a row at the beginning of the log is one that the state has seen. A file may overlap with what came before. Through
    /// a pipe rows are new unless it is a known log once more: a clock that was set back must not be taken for old rows.
    fn is_known(&mut self, row: &Row) -> anyhow::Result<bool> {
        let until_s = match self.known_until_s {
            Some(until_s) => until_s,
            None => self.looked_back(row.time_s)?,
        };
        let known = match self.context.options.known_rows {
            Some(rows) => self.known_rows < rows,
            None => row.time_s <= until_s,
        };
        self.known_until_s = Some(if known { until_s } else { f64::NAN });
        Ok(known)
    }

    /// Until when the log that begins at a time is known, s; NaN: it is not. What the table has beyond the state comes once more from a log that is read
    /// again, and never from a pipe that goes on.
    fn looked_back(&mut self, start_s: f64) -> anyhow::Result<f64> {
        let again = self.log_starts_s.contains(&start_s);
        if !again {
            self.log_starts_s.push(start_s);
            let surplus = self.log_starts_s.len().saturating_sub(MOST_LOGS);
            self.log_starts_s.drain(..surplus);
        }
        let RunContext { options, .. } = self.context;
        if !again && options.is_live {
            return Ok(f64::NAN);
        }
        if let (Some((path, length)), Some(Target::File(now)), Some(rows)) =
            (&self.table, &options.data, &mut self.rows)
            && now.canonicalize().is_ok_and(|now| *path == now)
        {
            rows.take_back(*length)?;
        }
        Ok(self.last_stamp_s - options.lateness_s)
    }

    /// Truth of a row that may have been held back.
    fn truth_of(&self, stamp_s: f64) -> Truth {
        let of_row = self.truths.iter().find(|(at_s, _)| *at_s == stamp_s);
        of_row.map_or(Truth::UNKNOWN, |(_, truth)| *truth)
    }

    fn take(&mut self, output: Output, progress: &Progress) -> anyhow::Result<()> {
        self.naming.clock.note(output.estimate.time_s, output.stamp_s);
        let console = Console { messages: self.context.messages, progress };
        for event in &output.events {
            self.sink.event(event, &self.naming, &console)?;
        }
        self.loss_found |= output.decision.outcome == Outcome::Loss;
        for alarm in &output.alarms {
            self.sink.alarm(alarm, &self.naming, &console)?;
        }
        if let Some(rows) = &mut self.rows {
            rows.push(&output, &self.naming.clock)?;
        }
        if let Some(course) = &mut self.course {
            course.push(&output, &self.naming);
        }
        let truth = self.truth_of(output.stamp_s);
        if let Some(figure) = &mut self.figure {
            figure.push(&output, &truth);
        }
        self.last = Some(output);
        Ok(())
    }

    /// Hands on the rows that wait.
    fn flush(&mut self) -> anyhow::Result<()> {
        self.rows.as_mut().map_or(Ok(()), Rows::flush)
    }

    /// Saves the state, if one is wanted.
    fn save(&mut self, log: &LogInput) -> anyhow::Result<()> {
        self.saved = Instant::now();
        let options = self.context.options;
        let Some(path) = &options.state else { return Ok(()) };
        // A state that knows rows which the table lacks would lose them.
        let Some(length) = self.rows.as_ref().map_or(Some(0), Rows::complete_length) else {
            bail!("{} is not saved: rows wait for room in their file", path.display());
        };
        let table = match &options.data {
            Some(Target::File(rows)) if options.has_table() => Some((rows.canonicalize()?, length)),
            _ => None,
        };
        let state = State {
            table,
            identity: self.context.identity.clone(),
            origin: log.reader.origin(),
            clock: self.naming.clock.shown().clone(),
            last_stamp_s: self.last_stamp_s,
            log_starts_s: self.log_starts_s.clone(),
            full_pa: self.full_pa,
            settled: self.settled,
            stated: self.stated,
            last: self.last.clone(),
            monitor: self.monitor.save()?,
        };
        state.write(path)
    }

    /// Ends a run whose log failed: with a state, what was done up to there stays.
    pub(super) fn abandon(
        mut self,
        inputs: &Inputs,
        log: &LogInput,
        error: &anyhow::Error,
    ) -> anyhow::Result<()> {
        if self.broken || self.context.options.state.is_none() {
            return Ok(());
        }
        self.flush()?;
        self.save(log)?;
        if let Some(rows) = self.rows {
            rows.finish(inputs, log, None, Some(&format!("{error:#}")))?;
        }
        self.sink.finish().map(|_| ())
    }

    /// Ends the run; files appear here.
    pub(super) fn finish(
        mut self,
        title: String,
        log: &LogInput,
        progress: &Progress,
    ) -> anyhow::Result<Finished> {
        let RunContext { options, inputs, messages, .. } = self.context;
        if self.known_rows > 0 && self.known_rows == log.reader.sampling().rows() {
            let until = self.naming.clock.text_of_log(self.last_stamp_s);
            messages.caution(&format!("nothing new: the state has seen all rows up to {until}"));
        }
        if options.state.is_none() {
            // With a state, rows that are held back wait in it for those that come later.
            for output in self.monitor.finish()? {
                self.take(output, progress)?;
            }
        }
        let summary = self.last.take().map(|last| Summary {
            title,
            sampling: log.reader.sampling().clone(),
            cautions: log.reader.cautions().to_vec(),
            naming: self.naming.clone(),
            last,
            alarms: self.monitor.alarms().clone(),
            limits: options.limits,
            known_rows: self.known_rows,
            held_rows: self.monitor.intake().held() as u64,
            row_counts: row_counts(self.monitor.intake().counts(), &self.counts_before),
            loss_found: self.loss_found,
            continued: self.continued,
        });
        self.last = summary.as_ref().map(|summary| summary.last.clone());
        let provenance = inputs.provenance();
        // Everything is made before any file appears.
        let views = match self.figure.take().zip(summary.as_ref()) {
            Some((data, summary)) => {
                let picture = || report::figure(&summary.title, &data, &summary.naming.clock);
                let with = |picture| {
                    let cautions = summary.cautions.iter().map(ToString::to_string);
                    report::summary(summary).cautions(cautions).picture(picture, report::CAPTION)
                };
                options.views.make(picture, with, inputs.sources(), &provenance)?
            }
            None => RenderedViews::default(),
        };
        views.write()?;
        let report = views.kept;
        self.flush()?;
        let saved = self.save(log);
        let (mut rows, mut events) = (None, Vec::new());
        let written = match self.rows {
            Some(of_run) => of_run.finish(inputs, log, summary.as_ref(), None).map(|table| rows = table),
            None => Ok(()),
        };
        let written = written.and(self.sink.finish().map(|lines| events = lines)).and(saved);
        let zone = log.reader.zone().map(ToString::to_string);
        let reading = Reading::of(log, self.known_rows);
        Ok(Finished { summary, written, rows, events, report, zone, reading })
    }
}

/// What became of rows that were not simply used, of this run alone.
pub(super) fn row_counts(now: &Counts, before: &Counts) -> RowCounts {
    RowCounts {
        duplicates: now.duplicates - before.duplicates,
        contradictions: now.contradictions - before.contradictions,
        too_late: now.too_late - before.too_late,
        wild: now.wild - before.wild,
        jumps: now.jumps - before.jumps,
    }
}

/// Refuses a state that counts time in another way than the log.
pub(super) fn check_clock(options: &Options, state: &State, log: &LogInput) -> anyhow::Result<()> {
    const DATES: &str = "has dates";
    const SECONDS: &str = "has times without dates";
    let (then, now) = (state.origin.is_some(), log.reader.has_dates());
    if then == now {
        return Ok(());
    }
    let word = |dates: bool| if dates { DATES } else { SECONDS };
    let path = options.state.as_deref().unwrap_or(Path::new("the state"));
    Err(refused(path, &Refusal::Clock { then: word(then), now: word(now) }))
}

//! The monitor step by step: rows from a program that goes on, and bytes of a state at any of them.
#[cfg(feature = "serve")]
mod file;
mod out;
mod running;
mod seen;

use super::course::{self, Told};
use super::resume::RunStart;
use super::rows::Slope;
use super::state::{Identity, State};
use super::*;
use crate::cli::steps::{self, Frame, LONGEST_WAIT, StepTime, TableRows};
use crate::detector::monitor::{Monitor, Output};
use crate::estimator::log::Quantity;
use crate::estimator::sensor::Sensor;
use crate::log::{MemoryLog, RowScreen};
use crate::report::monitor::{MonitorRow, Naming};
use crate::report::{Clock, Table};
#[cfg(feature = "serve")]
pub(in crate::cli) use file::NotResumed;
use jiff::Timestamp;
use out::Out;
pub use out::RowsWanted;
use seen::Seen;
use serde::{Deserialize, Serialize};

/// A monitor that is fed row by row.
pub(crate) struct Steps {
    options: Options,
    documents: Vec<(String, String)>,
    beginning: RunStart,
    sensors: Option<Vec<Sensor>>,
    frame: Frame,
    /// The monitor, when the fill is known.
    running: Option<Running>,
}

/// A monitor that has begun.
struct Running {
    monitor: Monitor,
    identity: Identity,
    selection: Selection,
    screen: RowScreen,
    naming: Naming,
    slope: Slope,
    origin: Option<Timestamp>,
    last_stamp_s: f64,
    /// Time of the first row, s, as the state of the command has it.
    log_starts_s: Vec<f64>,
    full_pa: f64,
    settled: bool,
    stated: bool,
    last: Option<Output>,
    seen: Seen,
}

/// What is saved.
#[derive(Serialize, Deserialize)]
struct Saved {
    frame: Frame,
    /// The state file of the command.
    state: Option<Vec<u8>>,
}

/// Rows that came out, and what happened in them.
pub(crate) type Handed = (Table, Vec<Told>);

impl Steps {
    /// A monitor of a vessel with the options of the command.
    pub(in crate::cli) fn new(
        arguments: MonitorArguments,
        documents: Vec<(String, String)>,
    ) -> anyhow::Result<Self> {
        let options = Options::checked(arguments)?.kept()?;
        let (inputs, messages) = (steps::inputs(&documents, None), Messages::kept());
        let beginning = RunStart::find(&options, &inputs, &messages)?;
        let sensors = options.sensors.as_deref().map(|path| selection::read(&inputs, path)).transpose()?;
        Ok(Self { options, documents, beginning, sensors, frame: Frame::default(), running: None })
    }

    /// Takes in a row; hands out the rows that are final.
    pub(crate) fn step(&mut self, time: StepTime, readings: &[(&str, f64)]) -> anyhow::Result<Handed> {
        let mut out = Out::new(matches!(time, StepTime::Instant(..)), RowsWanted::Every);
        self.take(time, readings, &mut out)?;
        Ok((out.table, out.told))
    }

    /// Takes in the rows of a table in their order. After an error the rows before it have been taken in.
    pub(crate) fn steps(&mut self, log: &MemoryLog, wanted: RowsWanted) -> anyhow::Result<Handed> {
        let mut rows = TableRows::of(log)?;
        let mut out = Out::new(rows.have_dates(), wanted);
        while let Some((time, readings)) = rows.next()? {
            // Before the monitor begins an error has the place of its row among all that wait.
            let has_begun = self.running.is_some();
            let taken = self.take(time, readings, &mut out);
            if has_begun { taken.with_context(|| rows.place())? } else { taken? }
        }
        if let (RowsWanted::Last, Some(running)) = (wanted, &mut self.running)
            && let Some(last) = running.last.clone()
        {
            running.keep(&last, &mut out)?;
        }
        Ok((out.table, out.told))
    }

    fn take(&mut self, time: StepTime, readings: &[(&str, f64)], out: &mut Out) -> anyhow::Result<()> {
        let cells = self.frame.cells(readings)?;
        let Some(running) = &mut self.running else {
            self.frame.push(time, &cells)?;
            let begun = self.begin(out);
            if begun.is_err() {
                self.frame.pop();
            }
            return begun;
        };
        let (row, zone) = steps::row(&time, running.origin, &running.screen, &cells)?;
        running.naming.clock.set(running.origin, zone.as_ref());
        let outputs = running.push(&row)?;
        running.tell(outputs, out)
    }

    /// Hands out the rows that are held back.
    pub(crate) fn finish(&mut self) -> anyhow::Result<Handed> {
        let mut out = Out::new(self.frame.has_dates() == Some(true), RowsWanted::Every);
        if let Some(running) = &mut self.running {
            let outputs = running.monitor.finish()?;
            running.tell(outputs, &mut out)?;
        }
        Ok((out.table, out.told))
    }

    /// Exit code of the command if the log ended here.
    pub(crate) fn verdict(&self) -> &'static str {
        let last = self.running.as_ref().and_then(|running| running.last.as_ref());
        last.map_or("unknown", |last| last.decision.verdict.as_str())
    }

    /// All of it as bytes.
    pub(crate) fn save(&self) -> anyhow::Result<Vec<u8>> {
        let state = self.state_file()?;
        let frame = match &self.running {
            // Names, and whether there are dates; the rows have been used.
            Some(_) => self.frame.head(),
            None => self.frame.clone(),
        };
        steps::encoded(&Saved { frame, state })
    }

    /// The bytes of the file that `cylwatch monitor --state` and `fleet` write; `None`: the fill is not known yet.
    pub(crate) fn state_file(&self) -> anyhow::Result<Option<Vec<u8>>> {
        self.running.as_ref().map(|running| running.state()?.to_bytes()).transpose()
    }

    /// Goes on from bytes; if they are refused, all stays as it is.
    pub(crate) fn restore(&mut self, bytes: &[u8]) -> anyhow::Result<()> {
        let Saved { frame, state } = steps::decoded(bytes)?;
        let running = match state {
            None => None,
            Some(bytes) => Some(self.resumed(&frame, &State::from_bytes(&bytes)?)?),
        };
        (self.frame, self.running) = (frame, running);
        Ok(())
    }

    fn resumed(&self, frame: &Frame, state: &State) -> anyhow::Result<Running> {
        let messages = Messages::kept();
        let (_, mut log) = frame.opened(&self.documents, true, &self.log_options())?;
        let sensors = self.sensors.clone();
        let mut selection = Selection::new(&mut log.reader, sensors, &self.beginning.vessel, &[], &messages)?;
        selection.know_the_fill(state.full_pa, state.stated, &mut log.reader)?;
        let identity = self.beginning.identity(&self.options, &selection.sensors);
        state.check(&identity)?;
        let engine = Engine::restored(&self.options, &self.beginning, &selection, state)?;
        let origin = state.origin.as_deref().map(str::parse).transpose()?;
        let clock = Clock::new(origin, None).after(state.clock.clone());
        let running = self.running(engine, identity.after(&state.identity), selection, &log, clock);
        Ok(Running {
            origin,
            last_stamp_s: state.last_stamp_s,
            log_starts_s: state.log_starts_s.clone(),
            last: state.last.clone(),
            ..running
        })
    }

    /// Begins with the rows there are, if they tell the fill.
    fn begin(&mut self, out: &mut Out) -> anyhow::Result<()> {
        let messages = Messages::kept();
        let (inputs, mut log) = self.frame.opened(&self.documents, false, &self.log_options())?;
        let mut selection =
            Selection::new(&mut log.reader, self.sensors.clone(), &self.beginning.vessel, &[], &messages)?;
        if self.waits(&selection, &log.reader.row_screen()) {
            return Ok(());
        }
        let mut engine =
            Engine::cold(&self.options, &inputs, &self.beginning, &mut selection, &mut log, &messages)?;
        let first = std::mem::take(&mut engine.first);
        let identity = self.beginning.identity(&self.options, &selection.sensors);
        let clock = Clock::new(log.reader.origin_instant(), log.reader.zone().cloned());
        let mut running = self.running(engine, identity, selection, &log, clock);
        for announced in &self.options.announced {
            let (from_s, until_s) = announced.seconds(running.origin)?;
            running.monitor.announce(from_s, until_s);
        }
        running.log_starts_s.extend(first.first().map(|row| row.time_s));
        let mut outputs = Vec::new();
        for row in &first {
            outputs.extend(running.push(row)?);
        }
        running.tell(outputs, out)?;
        self.running = Some(running);
        Ok(())
    }

    /// Whether the fill is that of the first pressure, and none has come.
    fn waits(&self, selection: &Selection, screen: &RowScreen) -> bool {
        if self.options.source != FillSource::FirstPressure || self.frame.len() >= LONGEST_WAIT {
            return false;
        }
        let Some(channel) = selection.first_of(Quantity::Pressure) else { return false };
        let is_missing = |cells: &[f64]| steps::screened(screen, cells)[channel].is_nan();
        self.frame.rows().all(is_missing)
    }

    fn log_options(&self) -> LogOptions {
        let names = self.sensors.iter().flatten().map(|sensor| sensor.name.clone()).collect();
        LogOptions { any_order: true, ..self.options.reading.options(names) }
    }

    fn running(
        &self,
        engine: Engine,
        identity: Identity,
        selection: Selection,
        log: &LogInput,
        clock: Clock,
    ) -> Running {
        let sensors = selection.sensors.iter().map(|sensor| (sensor.name.clone(), sensor.quantity()));
        Running {
            monitor: engine.monitor,
            identity,
            screen: log.reader.row_screen(),
            naming: Naming { clock, sensors: sensors.collect() },
            slope: Slope::of(&self.beginning.vessel),
            origin: log.reader.origin_instant(),
            last_stamp_s: f64::NAN,
            log_starts_s: Vec::new(),
            full_pa: engine.full_pa,
            settled: engine.settled,
            stated: engine.stated,
            last: None,
            seen: Seen::default(),
            selection,
        }
    }
}

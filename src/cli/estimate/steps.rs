//! The observer step by step: rows from a program that goes on, and bytes of a state at any of them.
use super::*;
use crate::cli::steps::{self, Frame, LONGEST_WAIT, StepTime};
use crate::estimator::observer::{Estimate, Snapshot};
use crate::log::{LogOptions, RowScreen};
use crate::report::{Clock, RowFormat, Rows as Fields, Table};
use crate::thermal::vessel::VesselSpec;
use jiff::Timestamp;
use serde::{Deserialize, Serialize};

/// An observer that is fed row by row.
pub(crate) struct Steps {
    options: Options,
    documents: Vec<(String, String)>,
    vessel: Vessel,
    /// What a state belongs to.
    identity: String,
    sensors: Option<Vec<Sensor>>,
    learned: Option<Learned>,
    /// Rows up to the one that tells the fill.
    frame: Frame,
    /// The observer, when the fill is known.
    running: Option<Running>,
}

/// An observer that has begun.
struct Running {
    observer: Observer,
    selection: Selection,
    screen: RowScreen,
    slope: Slope,
    clock: Clock,
    origin: Option<Timestamp>,
    /// Time of the last row, s.
    last_s: f64,
}

/// What is saved: the first rows, from which an observer of the same kind is made, and what it has become.
#[derive(Serialize, Deserialize)]
struct Saved {
    identity: String,
    frame: Frame,
    state: Option<(Snapshot, (f64, f64), f64)>,
}

impl Steps {
    /// An observer of a vessel with the options of the command.
    pub(in crate::cli) fn new(
        arguments: EstimateArguments,
        documents: Vec<(String, String)>,
    ) -> anyhow::Result<Self> {
        let options = Options::checked(arguments)?;
        if options.smooth {
            bail!("--smooth needs later rows: call estimate on the whole log");
        }
        let (inputs, messages) = (steps::inputs(&documents, None), Messages::kept());
        let (specification, vessel, _) = inputs.vessel_specification(&options.vessel, &messages)?;
        let sensors = options.sensors.as_deref().map(|path| selection::read(&inputs, path)).transpose()?;
        let learned = options.learned_in.as_deref();
        let learned = learned.map(|path| start::learned(&inputs, path, &vessel)).transpose()?;
        let identity = identity(&specification, sensors.as_deref(), &options);
        let frame = Frame::default();
        Ok(Self { options, documents, vessel, identity, sensors, learned, frame, running: None })
    }

    /// Takes in a row; hands out one row of estimates, or as many as have waited for the fill.
    pub(crate) fn step(&mut self, time: StepTime, readings: &[(&str, f64)]) -> anyhow::Result<Table> {
        let cells = self.frame.cells(readings)?;
        let Some(running) = &mut self.running else {
            self.frame.push(time, &cells)?;
            let begun = self.begin();
            if begun.is_err() {
                self.frame.pop();
            }
            return begun;
        };
        let (row, zone) = steps::row(&time, running.origin, &running.screen, &cells)?;
        running.clock.set(running.origin, zone.as_ref());
        let estimate = running.push(&row)?;
        running.told(vec![estimate])
    }

    /// All of it as bytes.
    pub(crate) fn save(&self) -> anyhow::Result<Vec<u8>> {
        let state = self
            .running
            .as_ref()
            .map(|running| (running.observer.snapshot(), running.slope.known, running.last_s));
        steps::encoded(&Saved { identity: self.identity.clone(), frame: self.frame.clone(), state })
            .context("only an observer with the filter ekf can be saved")
    }

    /// Goes on from bytes; if they are refused, all stays as it is.
    pub(crate) fn restore(&mut self, bytes: &[u8]) -> anyhow::Result<()> {
        let Saved { identity, frame, state } = steps::decoded(bytes)?;
        if identity != self.identity {
            bail!(
                "the state is that of another vessel, other sensors or other options: make the object as it was"
            );
        }
        let running = match state {
            None => None,
            Some((snapshot, slope, last_s)) => {
                let (mut running, _) = self.begun(&frame)?;
                running.observer.try_restore(&snapshot)?;
                running.slope.known = slope;
                running.last_s = last_s;
                Some(running)
            }
        };
        (self.frame, self.running) = (frame, running);
        Ok(())
    }

    fn begin(&mut self) -> anyhow::Result<Table> {
        let waits = {
            let (_, mut log) = self.frame.opened(&self.documents, false, &self.log_options())?;
            let messages = Messages::kept();
            let selection =
                Selection::new(&mut log.reader, self.sensors.clone(), &self.vessel, &[], &messages)?;
            let screen = log.reader.row_screen();
            let is_missing = |channel: usize| {
                self.frame.rows().all(|cells| steps::screened(&screen, cells)[channel].is_nan())
            };
            self.options.source == FillSource::FirstPressure
                && self.frame.len() < LONGEST_WAIT
                && selection.first_of(Quantity::Pressure).is_some_and(is_missing)
        };
        if waits {
            return Ok(Table::new());
        }
        let (mut running, first) = self.begun(&self.frame)?;
        let estimates: anyhow::Result<Vec<Estimate>> = first.iter().map(|row| running.push(row)).collect();
        let told = running.told(estimates?)?;
        self.running = Some(running);
        Ok(told)
    }

    /// The observer that the first rows make, before any of them.
    fn begun(&self, frame: &Frame) -> anyhow::Result<(Running, Vec<Row>)> {
        let messages = Messages::kept();
        let (_, mut log) = frame.opened(&self.documents, false, &self.log_options())?;
        let (sensors, learned) = (self.sensors.clone(), self.learned.clone());
        let begun = begun(&self.options, &self.vessel, sensors, learned, &mut log, &messages)?;
        let (selection, first, mut observer) = begun;
        let running = Running {
            slope: Slope::of(observer.cylinder().clone()),
            observer,
            selection,
            screen: log.reader.row_screen(),
            clock: Clock::new(log.reader.origin_instant(), log.reader.zone().cloned()),
            origin: log.reader.origin_instant(),
            last_s: f64::NAN,
        };
        Ok((running, first))
    }

    fn log_options(&self) -> LogOptions {
        self.options
            .reading
            .options(self.sensors.iter().flatten().map(|sensor| sensor.name.clone()).collect())
    }
}

impl Running {
    fn push(&mut self, row: &Row) -> anyhow::Result<Estimate> {
        check_gap(self.last_s, row.time_s)?;
        let readings: Vec<f64> = self.selection.readings(row).collect();
        let estimate = self.observer.step(row.time_s, &readings)?;
        self.last_s = row.time_s;
        Ok(estimate)
    }

    fn told(&mut self, estimates: Vec<Estimate>) -> anyhow::Result<Table> {
        let rows = Fields::new(report::fields(self.origin.is_some()), RowFormat::Csv);
        let mut table = rows.empty_table();
        for estimate in estimates {
            rows.keep(&self.slope.row(estimate, &self.clock)?, &mut table);
        }
        Ok(table)
    }
}

/// Hash of vessel, sensors and options.
fn identity(specification: &VesselSpec, sensors: Option<&[Sensor]>, options: &Options) -> String {
    let options = (options.fill.text(), options.source, &options.engine, &options.reading);
    crate::report::digest(&format!("{specification:?}{sensors:?}{options:?}"))
}

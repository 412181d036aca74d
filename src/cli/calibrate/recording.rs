//! A log in memory: the readings of its sensors, and the air.
use crate::cli::input::{Inputs, shown};
use crate::cli::message::Messages;
use crate::cli::options::LogArguments;
use crate::cli::progress::Progress;
use crate::cli::selection::Selection;
use crate::estimator::log::{Channel, Log, Quantity};
use crate::estimator::sensor::{Sensor, Site};
use crate::thermal::units::ZERO_CELSIUS_K;
use crate::thermal::vessel::Vessel;

/// Column of the air.
pub(super) const AMBIENT: &str = "ambient";

/// How logs are read.
pub(super) struct Reading<'a> {
    pub inputs: &'a Inputs,
    pub reading: &'a LogArguments,
    /// Sensors of a file; none: typical ones.
    pub sensors: Option<&'a [Sensor]>,
    pub messages: &'a Messages,
}

/// A log.
pub(super) struct Recording {
    /// What messages call it.
    pub name: String,
    /// Readings of the sensors.
    pub log: Log,
    /// One for each channel of the log.
    pub sensors: Vec<Sensor>,
    /// Readings of the air, s and K; empty without a column for it.
    pub air: Vec<(f64, f64)>,
    /// Thermometer of the air.
    pub air_sensor: Sensor,
    /// Usual interval between rows, s.
    pub interval_s: f64,
}

impl Reading<'_> {
    /// Reads a log.
    pub(super) fn read(&self, name: &str, vessel: &Vessel) -> anyhow::Result<Recording> {
        let of_air = |sensor: &&Sensor| sensor.site() == Site::Air;
        let air_sensor = match self.sensors.and_then(|sensors| sensors.iter().find(of_air)) {
            Some(sensor) => sensor.clone(),
            None => Sensor::typical(AMBIENT)?,
        };
        let sensors = self.sensors.map(|sensors| {
            let on_vessel = |sensor: &&Sensor| sensor.site() != Site::Air;
            sensors.iter().filter(on_vessel).cloned().collect::<Vec<_>>()
        });
        let names = sensors.iter().flatten().map(|sensor| sensor.name.clone()).collect();
        let options = self.reading.options(names);
        let mut input = self.inputs.log(name, &options)?;
        let mut selection = Selection::new(&mut input.reader, sensors, vessel, &[AMBIENT], self.messages)?;
        let mut unknown = selection.first_of(Quantity::Pressure);
        let air = input.reader.channels().iter().position(|channel| {
            channel.name.eq_ignore_ascii_case(AMBIENT) && channel.quantity == Quantity::Temperature
        });
        let mut recording = Recording::empty(shown(name), &selection, air_sensor);
        let progress = Progress::new(self.messages);
        let read = loop {
            match input.reader.next_row() {
                Ok(Some(row)) => {
                    recording.log.time_s.push(row.time_s);
                    recording.log.values.extend(selection.readings(row));
                    let of_air = air.map(|channel| (row.time_s, row.readings[channel]));
                    recording.air.extend(of_air.filter(|(_, air_k)| air_k.is_finite()));
                    let read_pa = unknown.map_or(f64::NAN, |channel| row.readings[channel]);
                    if read_pa > 0.0 {
                        unknown = None;
                        selection.know_the_fill(read_pa, false, &mut input.reader)?;
                        recording.sensors.clone_from(&selection.sensors);
                    }
                }
                Ok(None) => break Ok(()),
                Err(error) => break Err(error),
            }
            if recording.log.time_s.len().is_multiple_of(1024) {
                progress.show(name, input.fraction());
            }
        };
        drop(progress);
        // What was strange about the log may explain an error.
        for caution in input.reader.cautions() {
            self.messages.caution(&caution.to_string());
        }
        read?;
        recording.interval_s = input.reader.sampling().usual_interval_s();
        self.inputs.record_log(&input);
        Ok(recording)
    }
}

impl Recording {
    fn empty(name: String, selection: &Selection, air_sensor: Sensor) -> Self {
        let channel = |sensor: &Sensor| Channel { name: sensor.name.clone(), quantity: sensor.quantity() };
        let channels = selection.sensors.iter().map(channel).collect();
        let log = Log { channels, ..Log::default() };
        let sensors = selection.sensors.clone();
        Self { name, log, sensors, air: Vec::new(), air_sensor, interval_s: f64::NAN }
    }

    /// The same with the first row at time 0.
    pub(super) fn beginning_at_zero(mut self) -> Self {
        let first_s = self.log.time_s.first().copied().unwrap_or(0.0);
        self.log.time_s.iter_mut().for_each(|time_s| *time_s -= first_s);
        self.air.iter_mut().for_each(|(time_s, _)| *time_s -= first_s);
        self
    }

    /// Last time, s.
    pub(super) fn end_s(&self) -> f64 {
        self.log.time_s.last().copied().unwrap_or(0.0)
    }

    /// Mean of the first reading of each thermometer, K; the air's, or 15 °C, where there is none.
    pub(super) fn first_k(&self) -> f64 {
        let firsts: Vec<f64> = self.of(Quantity::Temperature).filter_map(|at| self.first(at)).collect();
        let otherwise = self.air.first().map_or(ZERO_CELSIUS_K + 15.0, |(_, air_k)| *air_k);
        if firsts.is_empty() { otherwise } else { firsts.iter().sum::<f64>() / firsts.len() as f64 }
    }

    /// First reading of a pressure, Pa.
    pub(super) fn first_pa(&self) -> Option<f64> {
        self.of(Quantity::Pressure).find_map(|at| self.first(at))
    }

    fn of(&self, quantity: Quantity) -> impl Iterator<Item = usize> + '_ {
        (0..self.sensors.len()).filter(move |&at| self.sensors[at].quantity() == quantity)
    }

    fn first(&self, channel: usize) -> Option<f64> {
        self.log.rows().map(|(_, row)| row[channel]).find(|reading| reading.is_finite())
    }
}

//! A log of one cylinder: what its end holds.
use super::{Round, name_of};
use crate::cli::fill;
use crate::cli::fill::FillSource;
use crate::cli::selection::Selection;
use crate::cli::start;
use crate::detector::inspection::{self, Judgement};
use crate::detector::monitor::{Health, Monitor, MonitorSettings, Output};
use crate::estimator::log::Quantity;
use crate::log::LogOptions;
use crate::report::Clock;
use crate::report::inspection::{Basis, Inspected, leak_text, remedy};
use crate::report::monitor::health_text;
use crate::thermal::units::QUOTED_K;
use crate::thermal::vessel::Fill;
use anyhow::{Context, bail};
use std::path::Path;

impl Round<'_> {
    /// Judges a cylinder by a log. The mass is estimated without the fill, so that the two can differ.
    pub(super) fn of_log(&self, path: &Path) -> anyhow::Result<Inspected> {
        let filled = self.filled(None)?;
        let names = self.sensors.iter().flatten().map(|sensor| sensor.name.clone()).collect();
        let options = LogOptions { any_order: true, ..self.arguments.reading.options(names) };
        let name = path.to_string_lossy();
        let mut log = self.inputs.log(&name, &options)?;
        let mut selection =
            Selection::new(&mut log.reader, self.sensors.clone(), &self.vessel, &[], self.messages)?;
        let full_pa = self.contents.pressure_pa(filled.mass_kg, QUOTED_K)?;
        let (first, fill) =
            start::first_rows(&mut log.reader, &mut selection, FillSource::FirstPressure, &self.vessel)?;
        selection.know_the_fill(full_pa, true, &mut log.reader)?;
        let settled = self.arguments.fill.is_settled();
        let Fill::Pressure { pressure_pa } = fill else { bail!("{name}: no row has a pressure") };
        let commissioning = inspection::commissioning(pressure_pa, settled);
        let defaults = MonitorSettings::default();
        let settings = MonitorSettings { observer: fill::settings(defaults.observer, settled), ..defaults };
        let mut monitor = Monitor::new(&self.vessel, &selection.sensors, &commissioning, &settings)?;
        let mut last = None;
        let mut readings = Vec::new();
        let mut push = |row: &crate::log::Row| -> anyhow::Result<()> {
            readings.clear();
            readings.extend(selection.readings(row));
            last = monitor.step(row.time_s, &readings)?.pop().or(last.take());
            Ok(())
        };
        for row in &first {
            push(row)?;
        }
        while let Some(row) = log.reader.next_row()? {
            let row = row.clone();
            push(&row).with_context(|| log.reader.place(&row))?;
        }
        last = monitor.finish()?.pop().or(last);
        for caution in log.reader.cautions() {
            self.messages.caution(&caution.to_string());
        }
        let Some(last) = last else { bail!("{name}: no row could be used") };
        let sampling = log.reader.sampling();
        let basis = Basis::Log { duration_s: sampling.duration_s(), rows: sampling.rows() };
        let clock = Clock::new(log.reader.origin_instant(), log.reader.zone().cloned());
        let date = self.arguments.date.or_else(|| clock.day_of_log(last.stamp_s));
        let remarks = remarks(&last, &selection);
        if let Some(reason) = blind(&last, &selection) {
            let others = remarks.into_iter().filter(|remark| *remark != reason).collect();
            return Ok(Inspected { reason, ..Inspected::blank(name_of(path), date, basis, others) });
        }
        let found = self.criterion.judge(&self.contents, filled, (&last.estimate).into())?;
        let gauge_sd_pa = selection.pressure_offset_sd_pa();
        let reason = match found.judgement {
            Judgement::CannotBeTold => remedy(&found, gauge_sd_pa).to_owned(),
            Judgement::Pass | Judgement::Refill => String::new(),
        };
        Ok(Inspected {
            outcome: Some(found),
            gauge_sd_pa,
            reason,
            ..Inspected::blank(name_of(path), date, basis, remarks)
        })
    }
}

/// Why a log says nothing of the mass: no pressure that can be believed.
fn blind(last: &Output, selection: &Selection) -> Option<String> {
    let mut pressures = selection.sensors.iter().zip(&last.health);
    let good = |health: &Health| matches!(health, Health::Good | Health::Spikes);
    let of_pressure = |sensor: &crate::estimator::sensor::Sensor| sensor.quantity() == Quantity::Pressure;
    let (sensor, health) = pressures.find(|(sensor, health)| of_pressure(sensor) && !good(health))?;
    Some(format!("{} {}", sensor.name, health_text(*health, Quantity::Pressure)))
}

/// What the log shows beside the mass.
fn remarks(last: &Output, selection: &Selection) -> Vec<String> {
    let sensors = selection.sensors.iter().zip(&last.health);
    let ill = sensors.filter(|(_, health)| **health != Health::Good);
    let mut remarks: Vec<String> = ill
        .map(|(sensor, health)| format!("{} {}", sensor.name, health_text(*health, sensor.quantity())))
        .collect();
    remarks.extend(last.leak.as_ref().map(leak_text));
    remarks
}

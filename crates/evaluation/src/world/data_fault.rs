//! Faults of the fault table that happen to the data: drawn, scaled to the transmitter, and put into the rows.
//!
//! The table states pressures for a range of 250 bar; here they are the same parts of the transmitter's own range. What the air does to
//! a gauge transmitter (E7) stays as it is.
use cylwatch_estimator::log::Log;

use super::overlay::FaultRow;
use super::rows::Rows;
use super::truth::Truth;
use super::{Snapshot, WorldError};
use crate::fault::{Arrival, Fault, Record, Step, TABLE_FULL_SCALE_PA};

const AMBIENT: &str = "ambient";

/// Rows as they arrive with a fault.
pub(super) struct FaultyLog {
    pub log: Log,
    /// True times at which the rows were measured, s.
    pub time_s: Vec<f64>,
    pub historical: Vec<usize>,
    pub power_cycles: Vec<(usize, Snapshot)>,
}

/// The fault of a row of the table for a transmitter's range, Pa; `None` for what happens to the cylinder.
pub(super) fn draw(row: FaultRow, full_scale_pa: f64, seed: u64) -> Option<Fault> {
    let share = full_scale_pa / TABLE_FULL_SCALE_PA;
    let mut fault = row.draw(seed)?;
    match &mut fault {
        Fault::Offset { sensor, by: size }
        | Fault::Drift { sensor, per_s: size }
        | Fault::Span { sensor, per_k: size, .. }
        | Fault::Noise { sensor, sd: size }
        | Fault::Quantised { sensor, step: size }
        | Fault::Spikes { sensor, height: size, .. }
        | Fault::Dead { sensor, full_scale_pa: size, .. }
            if sensor == "pressure" =>
        {
            *size *= share;
        }
        Fault::Irregular { noise_pa, .. } => *noise_pa *= share,
        _ => {}
    }
    Some(fault)
}

/// Put a fault into the rows of a log.
pub(super) fn inject(
    fault: &Fault,
    log: &Log,
    rows: &Rows,
    truth: &Truth,
    onset_s: f64,
    seed: u64,
) -> Result<FaultyLog, WorldError> {
    let record = fault.inject(&record(log, rows, truth), onset_s, seed)?.without(AMBIENT);
    let mut faulty = FaultyLog {
        log: Log { channels: log.channels.clone(), ..Log::default() },
        time_s: Vec::new(),
        historical: Vec::new(),
        power_cycles: Vec::new(),
    };
    for step in &record.steps {
        match step {
            Step::PowerCycle(snapshot) => {
                faulty.power_cycles.push((faulty.time_s.len().saturating_sub(1), *snapshot));
            }
            Step::Row(row) => {
                if row.historical {
                    faulty.historical.push(faulty.time_s.len());
                }
                faulty.log.time_s.push(row.stamp_s);
                faulty.log.values.extend_from_slice(&row.readings);
                faulty.time_s.push(row.measured_s);
            }
        }
    }
    Ok(faulty)
}

/// Rows with the air beside the readings: a thermometer that comes off hangs in it.
fn record(log: &Log, rows: &Rows, truth: &Truth) -> Record {
    let mut sensors: Vec<String> = log.channels.iter().map(|channel| channel.name.clone()).collect();
    sensors.push(AMBIENT.into());
    let row = |index: usize| {
        let mut readings = log.row(index).to_vec();
        readings.push(truth.air_k[index]);
        let (stamp_s, measured_s) = (rows.stamp_s[index], rows.time_s[index]);
        Step::Row(Arrival { stamp_s, measured_s, readings, historical: false })
    };
    Record { sensors, steps: (0..rows.time_s.len()).map(row).collect() }
}

//! What a run over a log begins with: the first rows, the fill, what was learnt before.
use super::fill::FillSource;
use super::input::Inputs;
use super::selection::{Selection, USUAL_FILL_PA};
use crate::detector::prognosis::Contents;
use crate::estimator::log::Quantity;
use crate::estimator::observer::{Commissioning, Learned};
use crate::log::{LogReader, Row};
use crate::thermal::units::QUOTED_K;
use crate::thermal::vessel::Fill;
use crate::thermal::vessel::Vessel;
use anyhow::{Context, bail};
use std::path::Path;

/// Fill at 15 °C up to which there are transmitters, Pa.
const MOST_PA: f64 = 1e8;

/// Rows that are looked through for the first pressure.
const LONGEST_WAIT: usize = 10_000;

/// Reads rows until the fill is known, one row, or all up to the first pressure, and fits the range of a typical transmitter to it.
pub(super) fn first_rows(
    reader: &mut LogReader,
    selection: &mut Selection,
    source: FillSource,
    vessel: &Vessel,
) -> anyhow::Result<(Vec<Row>, Fill)> {
    let (rows, fill) = rows_up_to_the_fill(reader, selection, source)?;
    let first_k = selection.mean_temperature_k(rows.first());
    let commissioning = Commissioning { fill, mass_sd: 1.0, settled: false };
    let mass_kg = commissioning.mass_kg(vessel, first_k).ok();
    let full_pa = mass_kg.and_then(|mass_kg| Contents::of(vessel).pressure_pa(mass_kg, QUOTED_K).ok());
    // A fill that cannot be is refused with better words later on.
    let full_pa = full_pa.filter(|full_pa| *full_pa < MOST_PA).unwrap_or(USUAL_FILL_PA);
    selection.know_the_fill(full_pa, source != FillSource::FirstPressure, reader)?;
    Ok((rows, fill))
}

fn rows_up_to_the_fill(
    reader: &mut LogReader,
    selection: &Selection,
    source: FillSource,
) -> anyhow::Result<(Vec<Row>, Fill)> {
    const REMEDY: &str = "give --fill-pressure-bar and --fill-temperature-degc, or --fill-mass-kg";
    let pressure = selection.first_of(Quantity::Pressure);
    if source == FillSource::FirstPressure && pressure.is_none() {
        bail!("the log has no pressure, so that nothing says how much gas there is: {REMEDY}");
    }
    let mut rows = Vec::new();
    while let Some(row) = reader.next_row()? {
        rows.push(row.clone());
        match source {
            FillSource::Given(fill) => return Ok((rows, fill)),
            FillSource::FirstPressure => {
                let pressure_pa = pressure.map_or(f64::NAN, |channel| row.readings[channel]);
                if let (Some(channel), true) = (pressure, pressure_pa <= 0.0) {
                    let place = reader.place(&rows[rows.len() - 1]);
                    let header = &reader.columns().readings[channel].header;
                    let gauge = reader.as_gauge(channel);
                    let gauge = gauge.map_or(String::new(), |option| {
                        format!("add {option} if it counts from the air, or ")
                    });
                    bail!(
                        "{place}: {header} reads nothing or less, and how much gas there is is to follow from it: \
                         {gauge}{REMEDY}"
                    );
                }
                if pressure_pa.is_finite() {
                    return Ok((rows, Fill::Pressure { pressure_pa }));
                }
            }
        }
        if rows.len() == LONGEST_WAIT {
            break;
        }
    }
    bail!("none of the first {} rows has a pressure: {REMEDY}", rows.len())
}

/// What an earlier run has learnt of the same vessel.
pub(super) fn learned(inputs: &Inputs, path: &Path, vessel: &Vessel) -> anyhow::Result<Learned> {
    let shown = path.display();
    let text = inputs.read(&path.to_string_lossy())?;
    let document: serde_json::Value =
        serde_json::from_str(&text).with_context(|| format!("{shown} is no JSON"))?;
    let learned = serde_json::from_value::<Learned>(document["learned"].clone())
        .with_context(|| format!("{shown} is no file of --learned-out"))?;
    learned.validate(vessel).with_context(|| shown.to_string())?;
    Ok(learned)
}

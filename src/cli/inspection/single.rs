//! One reading of gauge and thermometer.
use super::Round;
use super::arguments::InspectionArguments;
use crate::detector::inspection::{Judgement, SingleReading};
use crate::report::inspection::{Basis, Inspected, remedy, rest_text};
use crate::thermal::units::{Dimension, HOUR_S};
use crate::thermal::vessel::Fill;
use anyhow::{Context, bail};
use jiff::civil::Date;

/// Times of rest that are tried where a reading does not tell, h.
const RESTS_H: [f64; 7] = [1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0];

/// A reading, and what else is known of its cylinder.
pub(super) struct Look {
    pub reading: SingleReading,
    pub date: Option<Date>,
    /// A fill of its own.
    pub fill: Option<Fill>,
}

impl Look {
    /// The reading of the options, if there is one.
    pub(super) fn of(arguments: &InspectionArguments) -> anyhow::Result<Option<Self>> {
        let given = &arguments.given;
        let pressure_pa = given.si("pressure", Dimension::Pressure)?;
        let temperature_k = given.si("temperature", Dimension::Temperature)?;
        let rested_s = given.si_from_zero("rested", Dimension::Time)?;
        let (pressure_pa, temperature_k) = match (pressure_pa, temperature_k) {
            (Some(pressure_pa), Some(temperature_k)) => (pressure_pa, temperature_k),
            (None, None) if rested_s.is_none() => return Ok(None),
            _ => {
                bail!("a reading is a pressure and a temperature: give --pressure-bar and --temperature-degc")
            }
        };
        let rested_s = rested_s.unwrap_or(0.0);
        Ok(Some(Self {
            reading: SingleReading { pressure_pa, temperature_k, rested_s },
            date: arguments.date,
            fill: None,
        }))
    }
}

impl Round<'_> {
    /// Judges a cylinder by one reading.
    pub(super) fn of_look(&self, cylinder: String, look: &Look) -> anyhow::Result<Inspected> {
        let filled = self.filled(look.fill)?;
        let with = self.instruments(filled)?;
        let judged = |rested_s: f64| {
            let reading = SingleReading { rested_s, ..look.reading };
            let now = reading.mass(&self.vessel, &with)?;
            anyhow::Ok(self.criterion.judge(&self.contents, filled, now)?)
        };
        let rested_s = look.reading.rested_s;
        let gauge_sd_pa = with.gauge.offset_sd();
        let found = judged(rested_s).context("the reading cannot be one of this vessel")?;
        let mut reason = String::new();
        if found.judgement == Judgement::CannotBeTold {
            let longer = RESTS_H.into_iter().filter(|rest_h| rest_h * HOUR_S > rested_s);
            let enough = longer
                .map(|rest_h| Ok((rest_h, judged(rest_h * HOUR_S)?.judgement)))
                .collect::<anyhow::Result<Vec<_>>>()?;
            let enough = enough.into_iter().find(|(_, judgement)| *judgement != Judgement::CannotBeTold);
            reason = match enough {
                Some((rest_h, _)) => {
                    format!(
                        "the gas may have another temperature; after {rest_h} h of rest the same reading would tell"
                    )
                }
                None => remedy(&found, gauge_sd_pa).to_owned(),
            };
        }
        Ok(Inspected {
            cylinder,
            date: look.date.or(self.arguments.date),
            basis: Basis::Reading {
                pressure_pa: look.reading.pressure_pa,
                temperature_k: look.reading.temperature_k,
                rest: rest_text(rested_s),
            },
            outcome: Some(found),
            gauge_sd_pa,
            reason,
            remarks: Vec::new(),
        })
    }
}

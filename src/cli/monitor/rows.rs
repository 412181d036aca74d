//! Outputs as rows of the data.
use super::context::RunContext;
use super::state::State;
use super::*;
use crate::cli::row_stream::RowStream;
use crate::detector::monitor::Output;
use crate::detector::prognosis::Contents;
use crate::report::monitor::{self as report, MonitorRow, Summary};
use crate::report::{Clock, Table};
use crate::thermal::units::QUOTED_K;
use crate::thermal::vessel::Vessel;
use serde_json::{Map, json};

/// Relative width of the classes of mass that share a slope of the settled pressure.
const CLASS: f64 = 1e-3;

/// Rows that are being written.
pub(super) struct Rows {
    stream: RowStream<MonitorRow>,
    slope: Slope,
}

/// Slope of the settled pressure in the mass. It depends on the class of the mass alone, not on what came before, so that a run that goes
/// on from a state writes what one run would have.
pub(super) struct Slope {
    contents: Contents,
    class: Option<i64>,
    pa_kg: f64,
}

impl Rows {
    /// Opens the output and writes what stands above the rows; `None`: no rows are wanted.
    pub(super) fn begin(
        context: &RunContext<'_>,
        log: &LogInput,
        vessel: &Vessel,
        state: Option<&State>,
    ) -> anyhow::Result<Option<Self>> {
        let RunContext { options, inputs, selection, messages, .. } = context;
        let Some(data) = &options.data else { return Ok(None) };
        let fields = report::fields(log.reader.has_dates());
        let names = selection.names();
        let stream = if options.has_table() {
            RowStream::table(data, state.is_some(), fields, inputs, &names, log, messages)?
        } else {
            RowStream::begin(data, options.format, fields, inputs, &names, log)?
        };
        Ok(Some(Self { stream, slope: Slope::of(vessel) }))
    }

    /// Writes an output.
    pub(super) fn push(&mut self, output: &Output, clock: &Clock) -> anyhow::Result<()> {
        let estimate = &output.estimate;
        let leak_pa_s = estimate.leak_kg_s * self.slope.at(estimate.mass_kg)?;
        self.stream.push(&MonitorRow::new(output, leak_pa_s, clock))
    }

    /// Takes back the rows that came after those of a state: they come again.
    pub(super) fn take_back(&mut self, length: u64) -> anyhow::Result<()> {
        self.stream.cut(length)
    }

    /// Length of the table, bytes, if all rows are there; else they wait for room.
    pub(super) fn complete_length(&self) -> Option<u64> {
        self.stream.complete_length()
    }

    /// Hands on what waits.
    pub(super) fn flush(&mut self) -> anyhow::Result<()> {
        self.stream.flush()
    }

    /// Writes what stands below the rows and ends the output; `error`: why there is no summary.
    pub(super) fn finish(
        mut self,
        inputs: &Inputs,
        log: &LogInput,
        summary: Option<&Summary>,
        error: Option<&str>,
    ) -> anyhow::Result<Option<Table>> {
        let members = [("summary", json!(summary.map(report::document))), ("error", json!(error))];
        let members = members.map(|(name, value)| (name.to_owned(), value));
        self.stream.tail(inputs, log, Map::from_iter(members))?;
        self.stream.finish()
    }
}

impl Slope {
    /// Of the gas in a vessel.
    pub(super) fn of(vessel: &Vessel) -> Self {
        Self { contents: Contents::of(vessel), class: None, pa_kg: f64::NAN }
    }

    /// Slope at a mass, Pa/kg.
    pub(super) fn at(&mut self, mass_kg: f64) -> anyhow::Result<f64> {
        let class = (mass_kg.ln() / CLASS).round() as i64;
        if self.class != Some(class) {
            let middle_kg = (class as f64 * CLASS).exp();
            (self.class, self.pa_kg) = (Some(class), self.contents.slope_pa_kg(middle_kg, QUOTED_K)?);
        }
        Ok(self.pa_kg)
    }
}

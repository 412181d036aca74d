//! The loop's body: a row in, an estimate out, everything else counted.
use super::*;
use crate::cli::row_stream::RowStream;
use crate::cli::views::RenderedViews;
use crate::estimator::observer::cylinder::Cylinder;
use crate::estimator::observer::{Estimate, Innovation};
use crate::log::{LogReader, Truth};
use crate::report::Clock;
use crate::report::estimate::{EstimateRow, FigureData, Innovations, Score, Summary};
use serde_json::Map;

/// Change of the mass, relative, after which the slope of the settled pressure is taken anew.
const SLOPE_AGES: f64 = 1e-3;
/// Step of the mass for that slope, relative.
const SLOPE_STEP: f64 = 1e-4;
/// Temperature at which pressures are compared, K: 15 °C.
const SETTLED_K: f64 = 288.15;

/// A run that is under way.
pub(super) struct Rows<'a> {
    pass: Pass,
    selection: &'a Selection,
    readings: Vec<f64>,
    results: Results,
}

/// Where estimates go.
struct Results {
    stream: RowStream<EstimateRow>,
    clock: Clock,
    figure: Option<FigureData>,
    innovations: Innovations,
    score: Score,
    last: Option<EstimateRow>,
    /// Model of the gas for the slope of its settled pressure.
    cylinder: Cylinder,
    /// Mass, kg, and slope of the settled pressure there, Pa/kg.
    slope: (f64, f64),
}

impl<'a> Rows<'a> {
    /// Opens the output and writes what stands above the rows.
    pub(super) fn begin(
        mut observer: Observer,
        selection: &'a Selection,
        options: &Options,
        inputs: &Inputs,
        log: &LogInput,
    ) -> anyhow::Result<Self> {
        let names = selection.names();
        let cylinder = observer.cylinder().clone();
        let pass = Pass::new(observer, options.smooth)?;
        let fields = report::fields(log.reader.has_dates());
        let stream = RowStream::begin(&options.data, options.format, fields, inputs, &names, log)?;
        let results = Results {
            stream,
            clock: Clock::default(),
            innovations: Innovations::new(&names),
            score: Score::default(),
            last: None,
            slope: (f64::NAN, f64::NAN),
            cylinder,
            figure: options.views.is_any_requested().then(|| FigureData::new(names)),
        };
        Ok(Self { pass, selection, readings: Vec::new(), results })
    }

    /// Takes in a row and writes the estimates that are final.
    pub(super) fn push(&mut self, row: &Row, log: &LogReader) -> anyhow::Result<()> {
        self.results.clock.set(log.origin_instant(), log.zone());
        self.readings.clear();
        self.readings.extend(self.selection.readings(row));
        let results = &mut self.results;
        self.pass.push(row, &self.readings, |estimate, truth, innovations| {
            results.take(estimate, truth, innovations)
        })
    }

    /// Ends the output; files appear here.
    pub(super) fn finish(
        self,
        title: String,
        inputs: &Inputs,
        log: &LogInput,
        options: &Options,
    ) -> anyhow::Result<Summary> {
        let mut results = self.results;
        let observer =
            self.pass.finish(|estimate, truth, innovations| results.take(estimate, truth, innovations))?;
        let summary = Summary {
            title,
            sampling: log.reader.sampling().clone(),
            cautions: log.reader.cautions().to_vec(),
            last: results.last.context("a log that was read without an error has a row")?,
            mass_change_sd_kg: observer.mass_change_sd_kg().unwrap_or(f64::NAN),
            innovations: results.innovations,
            score: results.score,
            restarts: observer.restarts(),
        };
        let summary_json = Map::from_iter([("summary".to_owned(), report::document(&summary))]);
        results.stream.tail(inputs, log, summary_json)?;
        let provenance = inputs.provenance();
        // Everything is made before any file appears.
        let clock = results.clock.clone();
        let views = match results.figure.take() {
            Some(data) => {
                let picture = || report::figure(&summary.title, &data, &clock);
                let with = |picture| {
                    let cautions =
                        summary.cautions.iter().map(ToString::to_string).chain(report::doubts(&summary));
                    report::summary(&summary).cautions(cautions).picture(picture, report::CAPTION)
                };
                options.views.make(picture, with, inputs.sources(), &provenance)?
            }
            None => RenderedViews::default(),
        };
        let learned = options.learned_out.as_ref().zip(observer.learned());
        views.write()?;
        if let Some((target, learned)) = learned {
            let document = json!({ "provenance": provenance.to_json(), "learned": learned });
            target.write(format!("{}\n", serde_json::to_string_pretty(&document)?).as_bytes())?;
        }
        results.stream.finish()?;
        Ok(summary)
    }
}

impl Results {
    /// Writes an estimate and counts it.
    fn take(&mut self, estimate: Estimate, truth: &Truth, innovations: &[Innovation]) -> anyhow::Result<()> {
        let leak_pa_s = estimate.leak_kg_s * self.slope_pa_kg(&estimate)?;
        let time = self.clock.date_of_log(estimate.time_s).unwrap_or_default();
        let row = EstimateRow { time, estimate, leak_pa_s, verdict: "" };
        self.stream.push(&row)?;
        self.innovations.push(innovations);
        self.score.push(&estimate, truth);
        if let Some(figure) = &mut self.figure {
            figure.push(&estimate, truth, innovations);
        }
        self.last = Some(row);
        Ok(())
    }

    /// Slope of the settled pressure in the mass, Pa/kg.
    fn slope_pa_kg(&mut self, estimate: &Estimate) -> anyhow::Result<f64> {
        let mass_kg = estimate.mass_kg;
        let age = (mass_kg / self.slope.0 - 1.0).abs();
        if age.is_nan() || age > SLOPE_AGES {
            let model = self.cylinder.model();
            let above = model.settled_pressure_pa(mass_kg * (1.0 + SLOPE_STEP), SETTLED_K)?;
            let below = model.settled_pressure_pa(mass_kg * (1.0 - SLOPE_STEP), SETTLED_K)?;
            self.slope = (mass_kg, (above - below) / (2.0 * SLOPE_STEP * mass_kg));
        }
        Ok(self.slope.1)
    }
}

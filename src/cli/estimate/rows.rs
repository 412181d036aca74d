//! The loop's body: a row in, an estimate out, everything else counted.
use super::*;
use crate::cli::row_stream::RowStream;
use crate::cli::views::RenderedViews;
use crate::estimator::observer::{Estimate, Innovation};
use crate::log::{LogReader, Truth};
use crate::report::estimate::{EstimateRow, FigureData, Innovations, Score, Summary};
use crate::report::{Clock, Report, Table};
use serde_json::Map;

/// A run that is under way.
pub(super) struct Rows<'a> {
    pass: Pass,
    selection: &'a Selection,
    readings: Vec<f64>,
    /// Time of the last row, s; NaN: there was none.
    last_s: f64,
    results: Results,
}

/// A run that has ended.
pub(super) struct Finished {
    /// What is left of it.
    pub summary: Summary,
    /// Rows that a caller takes.
    pub rows: Option<Table>,
    /// Report that a caller takes.
    pub report: Option<Report>,
    /// Zone in which the dates of the log are told.
    pub zone: Option<String>,
}

/// Where estimates go.
struct Results {
    stream: RowStream<EstimateRow>,
    clock: Clock,
    figure: Option<FigureData>,
    innovations: Innovations,
    score: Score,
    last: Option<EstimateRow>,
    slope: Slope,
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
            slope: Slope::of(cylinder),
            figure: options.views.is_any_requested().then(|| FigureData::new(names)),
        };
        Ok(Self { pass, selection, readings: Vec::new(), last_s: f64::NAN, results })
    }

    /// Takes in a row and writes the estimates that are final.
    pub(super) fn push(&mut self, row: &Row, log: &LogReader) -> anyhow::Result<()> {
        self.results.clock.set(log.origin_instant(), log.zone());
        check_gap(self.last_s, row.time_s)?;
        self.last_s = row.time_s;
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
    ) -> anyhow::Result<Finished> {
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
        let report = views.kept;
        let zone = log.reader.zone().map(ToString::to_string);
        Ok(Finished { rows: results.stream.finish()?, summary, report, zone })
    }
}

impl Results {
    /// Writes an estimate and counts it.
    fn take(&mut self, estimate: Estimate, truth: &Truth, innovations: &[Innovation]) -> anyhow::Result<()> {
        let row = self.slope.row(estimate, &self.clock)?;
        self.stream.push(&row)?;
        self.innovations.push(innovations);
        self.score.push(&estimate, truth);
        if let Some(figure) = &mut self.figure {
            figure.push(&estimate, truth, innovations);
        }
        self.last = Some(row);
        Ok(())
    }
}

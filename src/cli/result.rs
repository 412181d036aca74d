//! A result that is there as a whole: data, figure, report, and its summary for people.
use super::format::Format;
use super::host::Outcome;
use super::input::Inputs;
use super::message::Messages;
use super::output::Target;
use super::views::Views;
use crate::report::figure::Picture;
use crate::report::{Provenance, Report, Table};
use serde_json::Value;

/// Where a result goes, and in which format; `None`: the summary goes to stdout.
pub(super) struct Destination<'a> {
    pub data: &'a Target,
    pub format: Option<Format>,
    pub views: &'a Views,
}

/// What a result consists of; only what is asked for is made.
pub(super) struct Contents<'a> {
    pub summary: Report,
    pub csv: &'a dyn Fn(&Provenance) -> String,
    pub json: &'a dyn Fn(&Provenance) -> Value,
    pub picture: &'a dyn Fn() -> Picture,
    /// The report around the picture and the summary.
    pub report: &'a dyn Fn(Picture, Report) -> Report,
}

impl Contents<'_> {
    /// The result for a caller: nothing is written.
    pub(super) fn kept(
        self,
        rows: Table,
        inputs: &Inputs,
        provenance: Provenance,
    ) -> anyhow::Result<Outcome> {
        let summary = (self.json)(&provenance);
        let report = |picture| (self.report)(picture, self.summary);
        let views = Views::kept();
        let made = views.make(self.picture, report, inputs.sources(), &provenance)?;
        Ok(Outcome::of(rows, summary, made.kept.unwrap_or_default(), provenance))
    }
}

impl Destination<'_> {
    /// Writes the result. Everything is made before any file appears.
    pub(super) fn write(
        &self,
        contents: Contents<'_>,
        inputs: &Inputs,
        provenance: &Provenance,
        messages: &Messages,
    ) -> anyhow::Result<()> {
        let words = contents.summary.to_text();
        let text = match self.format {
            None => words.clone(),
            Some(Format::Csv) => (contents.csv)(provenance),
            Some(Format::Json) => serde_json::to_string_pretty(&(contents.json)(provenance))? + "\n",
        };
        let report = |picture| (contents.report)(picture, contents.summary);
        let views = self.views.make(contents.picture, report, inputs.sources(), provenance)?;
        self.data.write(text.as_bytes())?;
        views.write()?;
        if self.format.is_some() {
            messages.say(&words);
        }
        Ok(())
    }
}

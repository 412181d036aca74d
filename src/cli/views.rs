//! What people look at: the figure (`--plot`) and the report (`--report`) of a run.
use super::options::ViewArguments;
use super::output::Target;
use crate::report::figure::Picture;
use crate::report::{Page, Provenance, Report};
use anyhow::bail;
use std::path::Path;

/// Checked places for a figure and a report.
#[derive(Debug, Default)]
pub(super) struct Views {
    plot: Option<(Target, Format)>,
    report: Option<Target>,
    /// Whether the report is handed to a caller.
    kept: bool,
}

/// Picture format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Svg,
    Png,
}

impl Views {
    /// Checks names and places; `others` are the other results of the run.
    pub(super) fn checked(
        arguments: &ViewArguments,
        inputs: &[&Path],
        others: &[&Target],
    ) -> anyhow::Result<Self> {
        let place = |option: &str, path: &Path, others: &[&Target]| {
            let target = Target::checked(Some(path), inputs)?;
            if others.iter().any(|other| target.is_same_file(other)) {
                bail!("--{option} and another output name the same file {}: choose two", path.display());
            }
            Ok(target)
        };
        let plot = arguments.plot.as_deref().map(|path| -> anyhow::Result<(Target, Format)> {
            let format = format(path)?;
            Ok((place("plot", path, others)?, format))
        });
        let plot = plot.transpose()?;
        let others: Vec<&Target> =
            others.iter().copied().chain(plot.iter().map(|(target, _)| target)).collect();
        let report = arguments.report.report.as_deref().map(|path| {
            let ending = ending(path);
            if path != Path::new("-") && !matches!(ending.as_deref(), Some("html" | "htm")) {
                bail!("--report {}: the ending must be .html", path.display());
            }
            place("report", path, &others)
        });
        Ok(Self { plot, report: report.transpose()?, kept: false })
    }

    /// A report for a caller, who may turn it into a page, and no file.
    pub(super) fn kept() -> Self {
        Self { kept: true, ..Self::default() }
    }

    /// Whether either is wanted: what a picture is made of has to be kept during the run.
    pub(super) fn is_any_requested(&self) -> bool {
        self.plot.is_some() || self.report.is_some() || self.kept
    }

    /// Makes the requested files, so that nothing is written if one fails. The report contains the picture and gets `sources`, what was
    /// read, at its end.
    pub(super) fn make<P: Into<Picture>>(
        &self,
        picture: impl FnOnce() -> P,
        report: impl FnOnce(Picture) -> Report,
        sources: Vec<(String, String)>,
        provenance: &Provenance,
    ) -> anyhow::Result<RenderedViews<'_>> {
        let mut made = RenderedViews::default();
        if !self.is_any_requested() {
            return Ok(made);
        }
        let picture = picture().into();
        if self.kept {
            made.kept = Some(with_sources(report(picture), sources));
            return Ok(made);
        }
        if let Some((target, format)) = &self.plot {
            made.files.push((
                target,
                match format {
                    Format::Svg => picture.to_svg(provenance)?.into_bytes(),
                    Format::Png => picture.to_png(provenance)?,
                },
            ));
        }
        if let Some(target) = &self.report {
            made.files.push((target, page(report(picture), sources, provenance)?));
        }
        Ok(made)
    }

    /// Makes the report of a result without a picture.
    pub(super) fn make_report(
        &self,
        report: impl FnOnce() -> Report,
        sources: Vec<(String, String)>,
        provenance: &Provenance,
    ) -> anyhow::Result<RenderedViews<'_>> {
        let mut made = RenderedViews::default();
        if let Some(target) = &self.report {
            made.files.push((target, page(report(), sources, provenance)?));
        }
        Ok(made)
    }
}

/// Views that are made and wait to be written.
#[derive(Debug, Default)]
pub(super) struct RenderedViews<'a> {
    files: Vec<(&'a Target, Vec<u8>)>,
    /// The report of a caller.
    pub kept: Option<Report>,
}

impl RenderedViews<'_> {
    /// Writes them.
    pub(super) fn write(&self) -> anyhow::Result<()> {
        self.files.iter().try_for_each(|(target, bytes)| target.write(bytes))
    }
}

fn page(report: Report, sources: Vec<(String, String)>, provenance: &Provenance) -> anyhow::Result<Vec<u8>> {
    let report = with_sources(report, sources);
    Ok(Page { report: &report, provenance }.to_html()?.into_bytes())
}

fn with_sources(report: Report, sources: Vec<(String, String)>) -> Report {
    let report = if sources.is_empty() { report } else { report.heading("What was read") };
    sources.into_iter().fold(report, |report, (name, text)| report.source(name, text))
}

fn ending(path: &Path) -> Option<String> {
    path.extension().map(|ending| ending.to_string_lossy().to_lowercase())
}

fn format(path: &Path) -> anyhow::Result<Format> {
    match ending(path).as_deref() {
        Some("svg") => Ok(Format::Svg),
        Some("png") => Ok(Format::Png),
        _ => bail!("--plot {}: the ending must be .svg or .png", path.display()),
    }
}

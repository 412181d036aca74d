//! What people look at: the figure (`--plot`) and the report (`--report`) of a run.
use super::output::Target;
use anyhow::bail;
use cylwatch::report::figure::Picture;
use cylwatch::report::{Page, Provenance, Story};
use std::path::Path;

/// Checked places for a figure and a report.
#[derive(Debug, Default)]
pub struct Views {
    plot: Option<(Target, Format)>,
    report: Option<Target>,
}

/// Picture format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Svg,
    Png,
}

/// Where a figure and a report are wanted.
#[derive(Clone, Copy, Debug, Default)]
pub struct Wanted<'a> {
    /// `--plot`; the ending of the file's name is the format.
    pub plot: Option<&'a Path>,
    /// `--report`.
    pub report: Option<&'a Path>,
}

impl Views {
    /// Checks names and places; `others` are the other results of the run.
    pub fn checked(wanted: Wanted<'_>, inputs: &[&Path], others: &[&Target]) -> anyhow::Result<Self> {
        let place = |option: &str, path: &Path, others: &[&Target]| {
            let target = Target::checked(Some(path), inputs)?;
            if others.iter().any(|other| target.is_same_file(other)) {
                bail!("--{option} and another output name the same file {}: choose two", path.display());
            }
            Ok(target)
        };
        let plot = wanted.plot.map(|path| -> anyhow::Result<(Target, Format)> {
            let format = format(path)?;
            Ok((place("plot", path, others)?, format))
        });
        let plot = plot.transpose()?;
        let others: Vec<&Target> =
            others.iter().copied().chain(plot.iter().map(|(target, _)| target)).collect();
        let report = wanted.report.map(|path| {
            let ending = ending(path);
            if path != Path::new("-") && !matches!(ending.as_deref(), Some("html" | "htm")) {
                bail!("--report {}: the ending must be .html", path.display());
            }
            place("report", path, &others)
        });
        Ok(Self { plot, report: report.transpose()? })
    }

    /// Whether either is wanted: what a picture is made of has to be kept during the run.
    pub fn are_wanted(&self) -> bool {
        self.plot.is_some() || self.report.is_some()
    }

    /// Makes what is wanted, so that nothing is written if one fails. The story goes around the picture and gets `sources`, what was
    /// read, at its end.
    pub fn make(
        &self,
        picture: impl FnOnce() -> Picture,
        story: impl FnOnce(Picture) -> Story,
        sources: Vec<(String, String)>,
        provenance: &Provenance,
    ) -> anyhow::Result<Made<'_>> {
        let mut made = Made::default();
        if !self.are_wanted() {
            return Ok(made);
        }
        let picture = picture();
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
            made.files.push((target, page(story(picture), sources, provenance)?));
        }
        Ok(made)
    }

    /// Makes the report of a result without a picture.
    pub fn make_report(
        &self,
        story: impl FnOnce() -> Story,
        sources: Vec<(String, String)>,
        provenance: &Provenance,
    ) -> anyhow::Result<Made<'_>> {
        let mut made = Made::default();
        if let Some(target) = &self.report {
            made.files.push((target, page(story(), sources, provenance)?));
        }
        Ok(made)
    }
}

/// Views that are made and wait to be written.
#[derive(Debug, Default)]
pub struct Made<'a> {
    files: Vec<(&'a Target, Vec<u8>)>,
}

impl Made<'_> {
    /// Writes them.
    pub fn write(&self) -> anyhow::Result<()> {
        self.files.iter().try_for_each(|(target, bytes)| target.write(bytes))
    }
}

fn page(story: Story, sources: Vec<(String, String)>, provenance: &Provenance) -> anyhow::Result<Vec<u8>> {
    let story = if sources.is_empty() { story } else { story.heading("What was read") };
    let story = sources.into_iter().fold(story, |story, (name, text)| story.source(name, text));
    Ok(Page { story: &story, provenance }.to_html()?.into_bytes())
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

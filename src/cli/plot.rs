//! Figures on the command line: the ending of the file's name is the format.
use super::output::Target;
use anyhow::bail;
use cylwatch::report::Provenance;
use cylwatch::report::figure::{Figure, Sheet};
use std::path::Path;

/// A checked place for a figure.
#[derive(Debug)]
pub struct Plot {
    target: Target,
    picture: Picture,
}

/// Picture format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Picture {
    Svg,
    Png,
}

impl Plot {
    /// Checks the name and place; `others` are the other results of the run.
    pub fn checked(path: &Path, inputs: &[&Path], others: &[&Target]) -> anyhow::Result<Self> {
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        let picture = match ending.as_deref() {
            Some("svg") => Picture::Svg,
            Some("png") => Picture::Png,
            _ => bail!("--plot {}: the ending must be .svg or .png", path.display()),
        };
        let target = Target::checked(Some(path), inputs)?;
        if others.iter().any(|other| target.is_same_file(other)) {
            bail!("--plot and another output name the same file {}: choose two", path.display());
        }
        Ok(Self { target, picture })
    }

    /// The bytes of the picture.
    pub fn draw(&self, figure: &Figure, provenance: &Provenance) -> anyhow::Result<Vec<u8>> {
        Ok(match self.picture {
            Picture::Svg => figure.to_svg(provenance)?.into_bytes(),
            Picture::Png => figure.to_png(provenance)?,
        })
    }

    /// The bytes of the picture of a sheet.
    pub fn draw_sheet(&self, sheet: &Sheet, provenance: &Provenance) -> anyhow::Result<Vec<u8>> {
        Ok(match self.picture {
            Picture::Svg => sheet.to_svg(provenance)?.into_bytes(),
            Picture::Png => sheet.to_png(provenance)?,
        })
    }

    /// Writes the picture.
    pub fn write(&self, bytes: &[u8]) -> anyhow::Result<()> {
        self.target.write(bytes)
    }
}

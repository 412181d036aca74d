//! Sheets: parts of different kinds below one another in one picture.
use super::canvas::Canvas;
use super::diagram::Diagram;
use super::elevation::Elevation;
use super::grid::Grid;
use super::output::Drawn;
use super::{Figure, panel};
use crate::report::ReportError;
use plotters::prelude::DrawingBackend;

/// Parts below one another.
#[derive(Clone, Debug)]
pub struct Sheet {
    /// What a viewer of an SVG calls it; each part has a title of its own.
    pub title: String,
    /// From the top down.
    pub parts: Vec<Part>,
}

/// A part of a sheet.
#[derive(Clone, Debug)]
pub enum Part {
    /// Panels that share a horizontal axis.
    Figure(Figure),
    /// A body to scale with numbers against its height.
    Elevation(Elevation),
    /// A table.
    Grid(Grid),
    /// Blocks and signals.
    Diagram(Diagram),
}

impl Part {
    fn height(&self) -> f64 {
        match self {
            Self::Figure(figure) => figure.height(),
            Self::Elevation(elevation) => elevation.height(),
            Self::Grid(grid) => grid.height(),
            Self::Diagram(diagram) => diagram.height(),
        }
    }

    fn draw<DB: DrawingBackend>(&self, canvas: &Canvas<DB>, from: f64) -> Result<(), ReportError> {
        match self {
            Self::Figure(figure) => panel::draw(figure, canvas, from),
            Self::Elevation(elevation) => elevation.draw(canvas, from),
            Self::Grid(grid) => grid.draw(canvas, from),
            Self::Diagram(diagram) => diagram.draw(canvas, from),
        }
    }
}

impl Drawn for Sheet {
    fn title(&self) -> &str {
        &self.title
    }

    fn height(&self) -> f64 {
        self.parts.iter().map(Part::height).sum()
    }

    fn draw<DB: DrawingBackend>(&self, canvas: &Canvas<DB>) -> Result<(), ReportError> {
        let mut from = 0.0;
        for part in &self.parts {
            part.draw(canvas, from)?;
            from += part.height();
        }
        Ok(())
    }
}

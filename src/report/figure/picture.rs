//! Pictures: parts of different kinds below one another.
use super::canvas::Canvas;
use super::diagram::Diagram;
use super::elevation::Elevation;
use super::grid::Grid;
use super::{Figure, panel};
use crate::report::ReportError;
use plotters::prelude::DrawingBackend;

/// Parts below one another.
#[derive(Clone, Debug)]
pub struct Picture {
    /// What a viewer of an SVG calls it; each part has a title of its own.
    pub title: String,
    /// From the top down.
    pub parts: Vec<Part>,
}

/// A part of a picture.
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

impl Picture {
    /// Figures below one another; the title is that of the first.
    pub fn stacked(figures: Vec<Figure>) -> Self {
        let title = figures.first().map_or(String::new(), |figure| figure.title.clone());
        Self { title, parts: figures.into_iter().map(Part::Figure).collect() }
    }
}

impl From<Figure> for Picture {
    fn from(figure: Figure) -> Self {
        Self::stacked(vec![figure])
    }
}

impl Part {
    /// Height in figure units.
    pub(super) fn height(&self) -> f64 {
        match self {
            Self::Figure(figure) => figure.height(),
            Self::Elevation(elevation) => elevation.height(),
            Self::Grid(grid) => grid.height(),
            Self::Diagram(diagram) => diagram.height(),
        }
    }

    /// Draws it from a place downwards.
    pub(super) fn draw<DB: DrawingBackend>(&self, canvas: &Canvas<DB>, from: f64) -> Result<(), ReportError> {
        match self {
            Self::Figure(figure) => panel::draw(figure, canvas, from),
            Self::Elevation(elevation) => elevation.draw(canvas, from),
            Self::Grid(grid) => grid.draw(canvas, from),
            Self::Diagram(diagram) => diagram.draw(canvas, from),
        }
    }
}

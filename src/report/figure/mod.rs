//! Figures: panels above one another that share the horizontal axis, drawn as SVG or PNG.
//!
//! A [`Figure`] is plain data. A [`Picture`] puts figures below one another with parts of other kinds: a body drawn to scale
//! ([`Elevation`]), a table ([`Grid`]), blocks with signals ([`Diagram`]). plotters is named in this folder only; it draws lines, fills and
//! text. Its chart layer is not used: it has no axis shared by panels, no time axis in round minutes, hours and days, no legend beside the
//! panel, and one dash length for a series, where curves here must differ in grey. Looks are decided in [`style`] alone.
mod axis;
mod canvas;
mod correlation;
mod described;
mod diagram;
mod elevation;
mod grid;
mod key;
mod output;
mod panel;
mod path;
mod picture;
mod strip;
pub mod style;
mod ticks;

pub(crate) use correlation::correlation;
pub use diagram::{Arrow, Diagram, Form, Node};
pub use elevation::{Column, Elevation, Place, Profile, Shape};
pub use grid::{Cell, Grid};
pub use picture::{Part, Picture};
use style::Stroke;

/// A figure of panels above one another.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Title.
    pub title: String,
    /// The horizontal axis of all panels.
    pub horizontal: Horizontal,
    /// What a time axis counts from, in words; empty: a run's own beginning.
    pub since: String,
    /// Panels from the top down.
    pub panels: Vec<Panel>,
    /// Instants (or values of the horizontal axis) marked in all panels, named in the first.
    pub marks: Vec<Mark>,
}

/// The horizontal axis.
#[derive(Clone, Debug, PartialEq)]
pub enum Horizontal {
    /// Time in seconds, shown in the unit that fits.
    Time,
    /// A quantity with its name and unit.
    Quantity(String),
    /// A positive quantity with its name and unit; this axis and the vertical ones are logarithmic.
    LogLog(String),
}

/// One panel.
#[derive(Clone, Debug)]
pub struct Panel {
    /// Name and unit of the vertical axis.
    pub quantity: String,
    /// What is drawn, from the back to the front.
    pub items: Vec<Item>,
    /// Height relative to a standard panel.
    pub height: f64,
}

/// Something drawn in a panel. Horizontal values are seconds on a time axis; NaN leaves a gap; an empty name keeps it
/// out of the legend (where all are empty, the legend refers to the panel above).
#[derive(Clone, Debug)]
pub enum Item {
    /// A curve.
    Line {
        /// Name in the legend.
        name: String,
        /// Horizontal values.
        x: Vec<f64>,
        /// Vertical values.
        y: Vec<f64>,
        /// Looks.
        stroke: Stroke,
    },
    /// Measured points.
    Points {
        /// Name in the legend.
        name: String,
        /// Horizontal values.
        x: Vec<f64>,
        /// Vertical values.
        y: Vec<f64>,
        /// Looks.
        stroke: Stroke,
    },
    /// Vertical bars from a lower to an upper edge, such as the intervals of points.
    Intervals {
        /// Name in the legend.
        name: String,
        /// Horizontal values.
        x: Vec<f64>,
        /// Lower ends.
        low: Vec<f64>,
        /// Upper ends.
        high: Vec<f64>,
        /// Looks.
        stroke: Stroke,
    },
    /// A filled band.
    Band {
        /// Name in the legend.
        name: String,
        /// Horizontal values.
        x: Vec<f64>,
        /// Lower edge.
        low: Vec<f64>,
        /// Upper edge.
        high: Vec<f64>,
    },
    /// A horizontal limit, named in the panel.
    Limit {
        /// Name.
        name: String,
        /// Value.
        value: f64,
    },
    /// Stretches in the colours of what they are, over the whole height: a panel without a vertical scale.
    Strip {
        /// In the order of the horizontal axis.
        stretches: Vec<Stretch>,
    },
}

/// A stretch of a strip.
#[derive(Clone, Debug, PartialEq)]
pub struct Stretch {
    /// Where it begins.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
    /// What it is, for the legend.
    pub name: String,
    /// Colour.
    pub(crate) color: style::Rgb,
}

/// A marked instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// Where on the horizontal axis.
    pub at: f64,
    /// Name.
    pub name: String,
}

impl Figure {
    /// Panels against time.
    pub fn over_time(title: impl Into<String>, panels: Vec<Panel>) -> Self {
        Self::new(title, Horizontal::Time, panels)
    }

    /// Panels against a horizontal axis.
    pub fn new(title: impl Into<String>, horizontal: Horizontal, panels: Vec<Panel>) -> Self {
        Self { title: title.into(), horizontal, since: String::new(), panels, marks: Vec::new() }
    }

    /// With the instant that its time counts from.
    pub(crate) fn since(self, instant: Option<String>) -> Self {
        Self { since: instant.unwrap_or_default(), ..self }
    }

    /// With marked instants.
    pub fn with_marks(self, marks: Vec<Mark>) -> Self {
        Self { marks, ..self }
    }

    /// Height of title, panels and axis in figure units.
    fn height(&self) -> f64 {
        let panels: f64 = self.panels.iter().map(|panel| panel.height * style::PANEL_HEIGHT).sum();
        style::TOP + panels + style::GAP * (self.panels.len().max(1) - 1) as f64 + style::BOTTOM
    }
}

impl Panel {
    /// A panel of this height.
    pub fn new(quantity: impl Into<String>, height: f64, items: Vec<Item>) -> Self {
        Self { quantity: quantity.into(), items, height }
    }
}

impl Item {
    /// Its name; of a strip that of its first stretch.
    pub(crate) fn name(&self) -> &str {
        match self {
            Self::Line { name, .. }
            | Self::Points { name, .. }
            | Self::Intervals { name, .. }
            | Self::Band { name, .. }
            | Self::Limit { name, .. } => name,
            Self::Strip { stretches } => stretches.first().map_or("", |stretch| &stretch.name),
        }
    }

    /// A curve.
    pub fn line(
        name: impl Into<String>,
        x: &[f64],
        y: impl IntoIterator<Item = f64>,
        stroke: Stroke,
    ) -> Self {
        Self::Line { name: name.into(), x: x.to_vec(), y: y.into_iter().collect(), stroke }
    }
}

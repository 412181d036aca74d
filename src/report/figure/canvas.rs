//! Paper to draw on: figure units in, plotters' integer pixels out.
use super::path::{Point, dashes, smooth_pieces};
use super::style::{Rgb, SMALL, Sheet, Stroke};
use crate::report::ReportError;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Families in the order in which a viewer of an SVG looks for them; the program registers its own font by this name.
pub(super) const FONT: &str = "DejaVu Sans, Verdana, Arial, sans-serif";

/// Pixels per figure unit while drawing: plotters places on integers, so that curves need a fine grid.
pub(super) const FINE: f64 = 4.0;

/// Which way a text stands at its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    /// It starts at the point.
    Left,
    /// Its middle is at the point.
    Center,
    /// It ends at the point.
    Right,
}

/// A text's looks.
#[derive(Clone, Copy, Debug)]
pub(super) struct Text {
    pub size: f64,
    pub side: Side,
    pub bold: bool,
    pub upwards: bool,
    pub color: Rgb,
}

/// Small text from the point on.
pub(super) const PLAIN: Text =
    Text { size: SMALL, side: Side::Left, bold: false, upwards: false, color: Rgb::BLACK };

/// A drawing area with lengths in figure units.
pub(super) struct Canvas<'a, DB: DrawingBackend> {
    area: &'a DrawingArea<DB, Shift>,
    /// Whether it is made of pixels.
    raster: bool,
    /// How wide it is, and what stands on it.
    pub sheet: Sheet,
}

fn color(rgb: Rgb) -> RGBColor {
    RGBColor(rgb.0, rgb.1, rgb.2)
}

fn pixel(point: Point) -> (i32, i32) {
    ((point.0 * FINE).round() as i32, (point.1 * FINE).round() as i32)
}

impl<'a, DB: DrawingBackend> Canvas<'a, DB> {
    /// Paper of a vector picture, where the viewer sets the text.
    pub(super) fn vector(area: &'a DrawingArea<DB, Shift>, sheet: Sheet) -> Self {
        Self { area, raster: false, sheet }
    }

    /// Paper of pixels.
    pub(super) fn raster(area: &'a DrawingArea<DB, Shift>) -> Self {
        Self { area, raster: true, sheet: Sheet::DESK }
    }

    fn draw<E>(&self, element: &E) -> Result<(), ReportError>
    where
        for<'b> &'b E: plotters::element::PointCollection<'b, (i32, i32)>,
        E: plotters::element::Drawable<DB>,
    {
        self.area.draw(element).map_err(|error| ReportError::Drawing { reason: error.to_string() })
    }

    pub(super) fn paper(&self) -> Result<(), ReportError> {
        self.area.fill(&WHITE).map_err(|error| ReportError::Drawing { reason: error.to_string() })
    }

    /// A polyline, dashed as its stroke says.
    pub(super) fn line(&self, points: &[Point], stroke: &Stroke) -> Result<(), ReportError> {
        let style = color(stroke.color).stroke_width((stroke.width * FINE).round() as u32);
        for dash in dashes(points, stroke.dash) {
            // plotters' pixels run out into long spikes at sharp corners: there a new piece begins, under a dot.
            let pieces = if self.raster { smooth_pieces(dash) } else { vec![dash] };
            for (number, piece) in pieces.iter().enumerate() {
                if number > 0 && stroke.width > 1.0 {
                    let radius = (0.5 * stroke.width * FINE) as i32;
                    self.draw(&Circle::new(pixel(piece[0]), radius, color(stroke.color).filled()))?;
                }
                let mut pixels: Vec<(i32, i32)> = piece.iter().copied().map(pixel).collect();
                pixels.dedup();
                if pixels.len() > 1 {
                    self.draw(&PathElement::new(pixels, style))?;
                }
            }
        }
        Ok(())
    }

    /// A filled polygon.
    pub(super) fn polygon(&self, points: &[Point], fill: Rgb) -> Result<(), ReportError> {
        let pixels: Vec<(i32, i32)> = points.iter().copied().map(pixel).collect();
        self.draw(&Polygon::new(pixels, color(fill).filled()))
    }

    /// A rectangle between two corners.
    pub(super) fn rectangle(&self, a: Point, b: Point, fill: Rgb) -> Result<(), ReportError> {
        self.draw(&Rectangle::new([pixel(a), pixel(b)], color(fill).filled()))
    }

    /// A ring with white inside, the mark of a measured point.
    pub(super) fn ring(&self, at: Point, radius: f64, stroke: &Stroke) -> Result<(), ReportError> {
        let (outer, inner) = (radius * FINE, (radius - stroke.width) * FINE);
        self.draw(&Circle::new(pixel(at), outer as i32, color(stroke.color).filled()))?;
        self.draw(&Circle::new(pixel(at), inner as i32, WHITE.filled()))
    }

    /// A text whose vertical middle is at the point.
    pub(super) fn text(&self, words: &str, at: Point, text: Text) -> Result<(), ReportError> {
        let h_pos = match text.side {
            Side::Left => HPos::Left,
            Side::Center => HPos::Center,
            Side::Right => HPos::Right,
        };
        let weight = if text.bold { FontStyle::Bold } else { FontStyle::Normal };
        // plotters takes a size to be 1.24 em.
        let font = FontDesc::new(FontFamily::Name(FONT), text.size * 1.24 * FINE, weight);
        let font = if text.upwards { font.transform(FontTransform::Rotate270) } else { font };
        let ink = color(text.color);
        let style = TextStyle::from(font).color(&ink).pos(Pos::new(h_pos, VPos::Center));
        // Among pixels plotters centres the box above the baseline, which looks too high by a sixth.
        let drop = if self.raster { text.size / 6.0 } else { 0.0 };
        let at = if text.upwards { (at.0 + drop, at.1) } else { (at.0, at.1 + drop) };
        self.draw(&plotters::element::Text::new(words.to_owned(), pixel(at), style))
    }
}

//! A body of revolution drawn to scale, and beside it numbers against its height, on one axis.
use super::Mark;
use super::axis::Scale;
use super::canvas::PLAIN;
use super::canvas::{Canvas, Side, Text};
use super::path::{Point, simplified, unbroken};
use super::style::{self, Rgb, Stroke};
use super::ticks::ticks;
use crate::report::ReportError;
use plotters::prelude::DrawingBackend;

/// Largest height and width of the body on paper.
const LARGEST: (f64, f64) = (430.0, 150.0);
/// Room for the names of places beside the body.
const NAMES: f64 = 96.0;
/// Room to the right of the columns for the names of levels.
const LEVELS: f64 = 72.0;
/// Lines above the columns for their legends.
const LEGEND_LINES: f64 = 3.0;
/// Radius of the mark of a place.
const PLACE: f64 = 4.5;
const GRID: Stroke = Stroke { color: Rgb::GRID, width: 0.75, dash: &[] };
const AXIS: Stroke = Stroke { color: Rgb::BLACK, width: 1.0, dash: &[] };

/// A body and numbers against its height.
#[derive(Clone, Debug)]
pub struct Elevation {
    /// Title.
    pub title: String,
    /// Name and unit of the height.
    pub height: String,
    /// What the body is made of, from the back to the front.
    pub shapes: Vec<Shape>,
    /// Marked and named places.
    pub places: Vec<Place>,
    /// Heights that are marked across all columns, and named.
    pub levels: Vec<Mark>,
    /// Numbers against the height, side by side.
    pub columns: Vec<Column>,
}

/// A filled shape, symmetric about the axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// Radius and height of its right half, from the bottom up.
    pub contour: Vec<(f64, f64)>,
    /// Colour.
    pub fill: Rgb,
}

/// A place on the body.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// Radius and height.
    pub at: (f64, f64),
    /// Name.
    pub name: String,
}

/// Numbers against the height.
#[derive(Clone, Debug)]
pub struct Column {
    /// Name and unit of the horizontal axis.
    pub quantity: String,
    /// What is drawn.
    pub profiles: Vec<Profile>,
}

/// A number at some heights; NaN leaves a gap in the line.
#[derive(Clone, Debug)]
pub struct Profile {
    /// Name in the legend above the column.
    pub name: String,
    /// The number.
    pub values: Vec<f64>,
    /// Heights; none: one number for all heights, a vertical line.
    pub heights: Vec<f64>,
    /// Looks.
    pub stroke: Stroke,
}

/// The body on paper.
struct Body {
    per_unit: f64,
    axis: f64,
    heights: Scale,
}

impl Body {
    fn at(&self, (radius, height): (f64, f64)) -> Point {
        (self.axis + radius * self.per_unit, self.heights.at(height))
    }
}

impl Elevation {
    /// Largest radius, and highest point.
    fn size(&self) -> (f64, f64) {
        let all = self.shapes.iter().flat_map(|shape| &shape.contour);
        let (radius, height) = all.fold((0.0_f64, 0.0_f64), |size, at| (size.0.max(at.0), size.1.max(at.1)));
        (radius.max(f64::MIN_POSITIVE), height.max(f64::MIN_POSITIVE))
    }

    /// Units of paper per unit of length.
    fn per_unit(&self) -> f64 {
        let (radius, height) = self.size();
        (LARGEST.0 / height).min(0.5 * LARGEST.1 / radius)
    }

    fn top(&self) -> f64 {
        style::TOP + LEGEND_LINES * style::LEGEND_LINE
    }

    pub(super) fn height(&self) -> f64 {
        self.top() + self.size().1 * self.per_unit() + style::BOTTOM + 12.0
    }

    pub(super) fn draw<DB: DrawingBackend>(&self, canvas: &Canvas<DB>, from: f64) -> Result<(), ReportError> {
        let title = Text { size: style::LARGE, bold: true, ..PLAIN };
        canvas.text(&self.title, (style::MARGIN, from + 0.5 * style::TOP), title)?;
        let ((radius, height), per_unit) = (self.size(), self.per_unit());
        let top = from + self.top();
        let heights = Scale::linear((0.0, height), (top + height * per_unit, top));
        let body = Body { per_unit, axis: style::LEFT + 26.0 + radius * per_unit, heights };
        self.draw_body(canvas, &body)?;
        let left = body.axis + radius * per_unit + NAMES + 24.0;
        let count = self.columns.len().max(1) as f64;
        let width = (style::WIDTH - LEVELS - left - (count - 1.0) * style::GAP) / count;
        for (number, column) in self.columns.iter().enumerate() {
            let left = left + number as f64 * (width + style::GAP);
            self.draw_column(canvas, column, &body.heights, (left, left + width))?;
        }
        self.names_of_levels(canvas, &body.heights)
    }

    /// Height axis, body, places with their names.
    fn draw_body<DB: DrawingBackend>(&self, canvas: &Canvas<DB>, body: &Body) -> Result<(), ReportError> {
        let (bottom, top) = body.heights.paper;
        canvas.line(&[(style::LEFT, bottom), (style::LEFT, top)], &AXIS)?;
        let number = Text { side: Side::Right, ..PLAIN };
        let of_height = body.heights.ticks();
        for (value, label) in of_height.values.iter().zip(&of_height.labels) {
            let at = body.heights.at(*value);
            canvas.line(&[(style::LEFT - 4.0, at), (style::LEFT, at)], &AXIS)?;
            canvas.text(label, (style::LEFT - 8.0, at), number)?;
        }
        let name = Text { size: style::NORMAL, side: Side::Center, upwards: true, ..PLAIN };
        canvas.text(&self.height, (style::AXIS_NAME, 0.5 * (bottom + top)), name)?;
        for shape in &self.shapes {
            let right = shape.contour.iter().map(|&at| body.at(at));
            let left = shape.contour.iter().rev().map(|&(radius, height)| body.at((-radius, height)));
            canvas.polygon(&right.chain(left).collect::<Vec<_>>(), shape.fill)?;
        }
        let left = body.axis + self.size().0 * body.per_unit + 20.0;
        let mut places: Vec<(Point, &str)> =
            self.places.iter().map(|place| (body.at(place.at), place.name.as_str())).collect();
        places.sort_by(|a, b| a.0.1.total_cmp(&b.0.1));
        let rows = spread(&places.iter().map(|(at, _)| at.1).collect::<Vec<_>>(), style::LEGEND_LINE);
        for ((at, name), row) in places.into_iter().zip(rows) {
            canvas.line(&[at, (left - 3.0, row)], &style::EVENT)?;
            canvas.ring(at, PLACE, &Stroke { width: PLACE, ..style::CHOSEN })?;
            canvas.text(name, (left, row), PLAIN)?;
        }
        Ok(())
    }

    fn draw_column<DB: DrawingBackend>(
        &self,
        canvas: &Canvas<DB>,
        column: &Column,
        heights: &Scale,
        (left, right): (f64, f64),
    ) -> Result<(), ReportError> {
        let (bottom, top) = heights.paper;
        let x = Scale::around(
            column.profiles.iter().flat_map(|profile| profile.values.iter().copied()),
            (left, right),
        );
        let (low, high) = x.values();
        let of_x = ticks(low, high, ((right - left) / 52.0) as usize, &[]);
        for height in &heights.ticks().values {
            let at = heights.at(*height);
            canvas.line(&[(left, at), (right, at)], &GRID)?;
        }
        for (value, label) in of_x.values.iter().zip(&of_x.labels) {
            let at = x.at(*value);
            canvas.line(&[(at, bottom), (at, top)], &GRID)?;
            canvas.line(&[(at, bottom), (at, bottom + 4.0)], &AXIS)?;
            canvas.text(label, (at, bottom + 14.0), Text { side: Side::Center, ..PLAIN })?;
        }
        let name = Text { size: style::NORMAL, side: Side::Center, ..PLAIN };
        canvas.text(&column.quantity, (0.5 * (left + right), bottom + 35.0), name)?;
        for level in &self.levels {
            let at = heights.at(level.at);
            canvas.line(&[(left, at), (right, at)], &style::EVENT)?;
        }
        canvas.line(&[(left, top), (left, bottom), (right, bottom)], &AXIS)?;
        for profile in &column.profiles {
            draw_profile(canvas, profile, &x, heights)?;
        }
        for (line, profile) in column.profiles.iter().enumerate() {
            let at = top - style::LEGEND_LINE * ((column.profiles.len() - line) as f64 - 0.35);
            let sample = [(left, at), (left + style::LEGEND_SAMPLE, at)];
            canvas.line(&sample, &profile.stroke)?;
            if !profile.heights.is_empty() {
                canvas.ring(
                    (left + 0.5 * style::LEGEND_SAMPLE, at),
                    3.4,
                    &Stroke { dash: &[], ..profile.stroke },
                )?;
            }
            canvas.text(&profile.name, (left + style::LEGEND_SAMPLE + 7.0, at), PLAIN)?;
        }
        Ok(())
    }

    fn names_of_levels<DB: DrawingBackend>(
        &self,
        canvas: &Canvas<DB>,
        heights: &Scale,
    ) -> Result<(), ReportError> {
        let mut levels: Vec<(f64, &str)> =
            self.levels.iter().map(|level| (heights.at(level.at), level.name.as_str())).collect();
        levels.sort_by(|a, b| a.0.total_cmp(&b.0));
        let rows = spread(&levels.iter().map(|level| level.0).collect::<Vec<_>>(), style::LEGEND_LINE);
        for ((_, name), row) in levels.iter().zip(rows) {
            canvas.text(name, (style::WIDTH - LEVELS + 6.0, row), PLAIN)?;
        }
        Ok(())
    }
}

/// A line with rings at its points, or a vertical line for all heights.
fn draw_profile<DB: DrawingBackend>(
    canvas: &Canvas<DB>,
    profile: &Profile,
    x: &Scale,
    heights: &Scale,
) -> Result<(), ReportError> {
    if profile.heights.is_empty() {
        for value in &profile.values {
            canvas
                .line(&[(x.at(*value), heights.paper.0), (x.at(*value), heights.paper.1)], &profile.stroke)?;
        }
        return Ok(());
    }
    let place = |(&value, &height): (&f64, &f64)| (x.at(value), heights.at(height));
    for piece in unbroken(profile.values.iter().zip(&profile.heights).map(place)) {
        // Across, so that thinning by columns does not take a steep line for a step.
        let turned: Vec<Point> = piece.iter().map(|at| (at.1, at.0)).collect();
        let line: Vec<Point> = simplified(&turned).into_iter().map(|at| (at.1, at.0)).collect();
        canvas.line(&line, &profile.stroke)?;
        for at in piece {
            canvas.ring(at, 3.4, &Stroke { dash: &[], width: 1.6, ..profile.stroke })?;
        }
    }
    Ok(())
}

/// Rows near the wished ones, which increase, at least so far from each other; those that are too close move together.
fn spread(wished: &[f64], distance: f64) -> Vec<f64> {
    // Groups of neighbours: number, and mean of what each wishes its first row to be.
    let mut groups: Vec<(usize, f64)> = Vec::new();
    for &row in wished {
        groups.push((1, row));
        while let [.., (above, first), (below, next)] = groups[..] {
            if next - first >= distance * above as f64 {
                break;
            }
            let both = above + below;
            let shifted = next - distance * above as f64;
            let mean = (first * above as f64 + shifted * below as f64) / both as f64;
            groups.truncate(groups.len() - 2);
            groups.push((both, mean));
        }
    }
    groups.iter().flat_map(|&(count, first)| (0..count).map(move |k| first + distance * k as f64)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_are_too_close_move_apart_about_their_middle_and_others_stay() {
        assert_eq!(spread(&[0.0, 100.0], 10.0), [0.0, 100.0]);
        assert_eq!(spread(&[50.0, 50.0], 10.0), [45.0, 55.0]);
        let three = spread(&[48.0, 50.0, 53.0, 90.0], 10.0);
        assert!(three.windows(2).all(|pair| pair[1] - pair[0] >= 10.0 - 1e-9) && three[3] == 90.0);
        assert!(spread(&[], 10.0).is_empty());
    }
}

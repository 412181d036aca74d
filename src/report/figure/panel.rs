//! Draws the panels of a figure: axes, curves, limits, marks, legend.
use super::axis::{Abscissa, Scale, abscissa, ordinate};
use super::canvas::{Canvas, PLAIN, Side, Text};
use super::path::{Point, simplified, unbroken};
use super::style::{self, Rgb, Stroke};
use super::{Figure, Item, Mark, Panel, strip};
use crate::report::ReportError;
use plotters::prelude::DrawingBackend;

/// The frame of a panel on paper.
struct Frame<'a> {
    x: &'a Abscissa,
    y: Scale,
    marks: &'a [Mark],
}

/// Draws title, panels and axis of a figure from a place downwards.
pub(super) fn draw<DB: DrawingBackend>(
    figure: &Figure,
    canvas: &Canvas<DB>,
    from: f64,
) -> Result<(), ReportError> {
    title(canvas, &figure.title, from)?;
    let x = abscissa(figure, &canvas.sheet);
    let mut top = from + style::TOP;
    for (index, panel) in figure.panels.iter().enumerate() {
        let bottom = top + panel.height * style::PANEL_HEIGHT;
        let named: &[Mark] = if index == 0 { &figure.marks } else { &[] };
        let frame = Frame {
            x: &x,
            y: ordinate(panel, x.scale.kind, named.len(), (bottom, top)),
            marks: &figure.marks,
        };
        grid(canvas, &frame, panel)?;
        for mark in &figure.marks {
            let at = x.scale.at(mark.at);
            canvas.line(&[(at, bottom), (at, top)], &style::EVENT)?;
        }
        let mut taken = Vec::new();
        for item in &panel.items {
            match item {
                Item::Limit { name, value } => limit(canvas, &frame, panel, (name, *value), &mut taken)?,
                _ => draw_item(canvas, &frame, item)?,
            }
        }
        mark_names(canvas, &frame, named)?;
        if canvas.sheet.legend {
            legend(canvas, panel, top)?;
        }
        if index + 1 == figure.panels.len() {
            horizontal_labels(canvas, &frame)?;
        }
        top = bottom + style::GAP;
    }
    Ok(())
}

/// The title above the panels, in two smaller lines where one is too long for the sheet.
fn title<DB: DrawingBackend>(canvas: &Canvas<DB>, words: &str, from: f64) -> Result<(), ReportError> {
    let text = Text { size: style::LARGE, bold: true, ..PLAIN };
    let (left, middle) = (canvas.sheet.margins.0, from + 0.5 * style::TOP);
    if words.chars().count() <= canvas.sheet.title {
        return canvas.text(words, (left, middle), text);
    }
    let text = Text { size: style::NORMAL, ..text };
    let half = words.len() / 2;
    let spaces = words.match_indices(' ').map(|(at, _)| at);
    let Some(at) = spaces.min_by_key(|at| at.abs_diff(half)) else {
        return canvas.text(words, (style::AXIS_NAME, middle), text);
    };
    canvas.text(&words[..at], (style::AXIS_NAME, middle - 9.0), text)?;
    canvas.text(&words[at + 1..], (style::AXIS_NAME, middle + 9.0), text)
}

fn grid<DB: DrawingBackend>(canvas: &Canvas<DB>, frame: &Frame, panel: &Panel) -> Result<(), ReportError> {
    let grid = Stroke { color: Rgb::GRID, width: 0.75, dash: &[] };
    let axis = Stroke { color: Rgb::BLACK, width: 1.0, dash: &[] };
    let (left, right) = frame.x.scale.paper;
    let (bottom, top) = frame.y.paper;
    for value in &frame.x.ticks.values {
        let at = frame.x.scale.at(value * frame.x.unit);
        canvas.line(&[(at, bottom), (at, top)], &grid)?;
        canvas.line(&[(at, bottom), (at, bottom + 4.0)], &axis)?;
    }
    for value in &frame.x.ticks.small {
        let at = frame.x.scale.at(value * frame.x.unit);
        canvas.line(&[(at, bottom), (at, bottom + 2.5)], &axis)?;
    }
    let is_strip = panel.items.iter().all(|item| matches!(item, Item::Strip { .. }));
    if is_strip {
        let name = Text { side: Side::Right, ..PLAIN };
        canvas.text(&panel.quantity, (left - 8.0, 0.5 * (bottom + top)), name)?;
    } else {
        vertical_scale(canvas, frame, panel, &grid, &axis)?;
    }
    let corners = [(left, top), (right, top), (right, bottom), (left, bottom), (left, top)];
    canvas.line(&corners, &Stroke { color: Rgb::GREY, width: 0.75, dash: &[] })?;
    canvas.line(&[(left, top), (left, bottom), (right, bottom)], &axis)
}

/// Ticks, their grid and the name of the vertical axis.
fn vertical_scale<DB: DrawingBackend>(
    canvas: &Canvas<DB>,
    frame: &Frame,
    panel: &Panel,
    grid: &Stroke,
    axis: &Stroke,
) -> Result<(), ReportError> {
    let (left, right) = frame.x.scale.paper;
    let (bottom, top) = frame.y.paper;
    let ticks = frame.y.ticks();
    let number = Text { side: Side::Right, ..PLAIN };
    for (value, label) in ticks.values.iter().zip(&ticks.labels) {
        let at = frame.y.at(*value);
        canvas.line(&[(left, at), (right, at)], grid)?;
        canvas.line(&[(left - 4.0, at), (left, at)], axis)?;
        canvas.text(label, (left - 8.0, at), number)?;
    }
    for value in &ticks.small {
        let at = frame.y.at(*value);
        canvas.line(&[(left - 2.5, at), (left, at)], axis)?;
    }
    let name = Text { size: style::NORMAL, side: Side::Center, upwards: true, ..PLAIN };
    canvas.text(&panel.quantity, (style::AXIS_NAME, 0.5 * (bottom + top)), name)
}

fn horizontal_labels<DB: DrawingBackend>(canvas: &Canvas<DB>, frame: &Frame) -> Result<(), ReportError> {
    let (bottom, _) = frame.y.paper;
    let number = Text { side: Side::Center, ..PLAIN };
    for (value, label) in frame.x.ticks.values.iter().zip(&frame.x.ticks.labels) {
        let at = frame.x.scale.at(value * frame.x.unit);
        canvas.text(label, (at, bottom + 14.0), number)?;
    }
    let (left, right) = frame.x.scale.paper;
    let name = Text { size: style::NORMAL, ..number };
    canvas.text(&frame.x.name, (0.5 * (left + right), bottom + 35.0), name)
}

fn draw_item<DB: DrawingBackend>(canvas: &Canvas<DB>, frame: &Frame, item: &Item) -> Result<(), ReportError> {
    let place = |(&x, &y): (&f64, &f64)| (frame.x.scale.at(x), frame.y.at(y));
    match item {
        Item::Line { x, y, stroke, .. } => {
            for piece in unbroken(x.iter().zip(y).map(place)) {
                canvas.line(&simplified(&piece), stroke)?;
            }
        }
        Item::Points { x, y, stroke, .. } => {
            for at in unbroken(x.iter().zip(y).map(place)).concat() {
                canvas.ring(at, 3.4, stroke)?;
            }
        }
        Item::Intervals { x, low, high, stroke, .. } => {
            let full = Stroke { dash: &[], width: 1.2, ..*stroke };
            for ((x, low), high) in x.iter().zip(low).zip(high) {
                let (low, high) = (place((x, low)), place((x, high)));
                for bar in unbroken([low, high].into_iter()).iter().filter(|bar| bar.len() == 2) {
                    canvas.line(bar, &full)?;
                }
            }
        }
        Item::Band { x, low, high, .. } => {
            let there = x.iter().zip(low).map(place);
            let back = x.iter().zip(high).map(place).rev();
            let outline: Vec<Point> = there.chain(back).collect();
            canvas.polygon(&outline, Rgb::BAND)?;
        }
        // It is drawn with a look at the whole panel.
        Item::Limit { .. } => {}
        Item::Strip { stretches } => strip::draw(canvas, stretches, |x| frame.x.scale.at(x), frame.y.paper)?,
    }
    Ok(())
}

/// A limit as a dashed line with its name on it, where fewest curves pass; out of sight it is named at the edge where it lies.
fn limit<DB: DrawingBackend>(
    canvas: &Canvas<DB>,
    frame: &Frame,
    panel: &Panel,
    (name, value): (&str, f64),
    taken: &mut Vec<Extent>,
) -> Result<(), ReportError> {
    let (left, right) = frame.x.scale.paper;
    let (bottom, top) = frame.y.paper;
    let text = Text { side: Side::Right, color: style::LIMIT.color, ..PLAIN };
    let (low, high) = frame.y.values();
    if value < low {
        return canvas.text(&format!("{name} \u{2193}"), (right - 8.0, bottom - 10.0), text);
    }
    if value > high {
        return canvas.text(&format!("{name} \u{2191}"), (right - 8.0, top + 11.0), text);
    }
    let at = frame.y.at(value);
    canvas.line(&[(left, at), (right, at)], &style::LIMIT)?;
    let width = 0.62 * style::SMALL * name.chars().count() as f64;
    let steps = ((right - left - width - 16.0) / NAME_STEP).max(0.0) as usize;
    let ends = (0..=steps).map(|step| right - 8.0 - NAME_STEP * step as f64);
    let places = ends.flat_map(|end| [(end, at - 9.0), (end, at + 10.0)]);
    let places = places.filter(|(_, y)| (top + 9.0..bottom - 8.0).contains(y));
    let extent = |(end, y): Point| ((end - width, end), (y - 8.0, y + 8.0));
    let is_free = |place: &Point| !taken.iter().any(|other| overlap(*other, extent(*place)));
    let crossed = |place: &Point| crossings(frame, panel, extent(*place));
    let Some(place) = places.filter(is_free).min_by_key(crossed) else { return Ok(()) };
    let (end, y) = place;
    if crossed(&place) > 0 {
        // No place is free of curves: they go below the name.
        canvas.rectangle((end - width, y - 7.5), (end + 2.0, y + 7.5), Rgb::WHITE)?;
    }
    taken.push(extent(place));
    canvas.text(name, place, text)
}

/// Left and right end, top and bottom on paper.
type Extent = ((f64, f64), (f64, f64));

fn overlap((a, b): Extent, (c, d): Extent) -> bool {
    a.0 < c.1 && c.0 < a.1 && b.0 < d.1 && d.0 < b.1
}

/// Distance of the places that a name of a limit may have.
const NAME_STEP: f64 = 12.0;

/// Points of curves in a box on paper, looked for every other unit, and lines of marks.
fn crossings(frame: &Frame, panel: &Panel, ((left, right), (top, bottom)): Extent) -> usize {
    let of_curve = |x: &[f64], y: &[f64]| {
        let paper = x.iter().zip(y).map(|(&x, &y)| (frame.x.scale.at(x), frame.y.at(y)));
        let points: Vec<Point> = paper.filter(|(x, y)| x.is_finite() && y.is_finite()).collect();
        let inside = |(a, b): (Point, Point)| {
            let steps = (0.5 * (b.0 - a.0).hypot(b.1 - a.1)).clamp(1.0, 2000.0) as usize;
            let along = (0..=steps).map(|k| k as f64 / steps as f64);
            along
                .map(|t| (a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1)))
                .filter(|(x, y)| (left..right).contains(x) && (top..bottom).contains(y))
                .count()
        };
        points.windows(2).map(|pair| inside((pair[0], pair[1]))).sum::<usize>()
    };
    let curves = panel.items.iter().map(|item| match item {
        Item::Line { x, y, .. } | Item::Points { x, y, .. } => of_curve(x, y),
        _ => 0,
    });
    let lines = frame.marks.iter().filter(|mark| (left..right).contains(&frame.x.scale.at(mark.at)));
    curves.sum::<usize>() + lines.count()
}

/// Names of marks beside their lines, in up to three rows so that near ones do not cover each other.
fn mark_names<DB: DrawingBackend>(
    canvas: &Canvas<DB>,
    frame: &Frame,
    marks: &[Mark],
) -> Result<(), ReportError> {
    let (left, right) = frame.x.scale.paper;
    let (_, top) = frame.y.paper;
    for (index, mark) in marks.iter().enumerate() {
        let at = frame.x.scale.at(mark.at);
        let side = if at > left + 0.6 * (right - left) { Side::Right } else { Side::Left };
        let shift = if side == Side::Right { -4.0 } else { 4.0 };
        let row = top + style::LEGEND_LINE * ((index % 3) as f64 + 0.5);
        canvas.text(&mark.name, (at + shift, row), Text { side, color: Rgb(70, 70, 70), ..PLAIN })?;
    }
    Ok(())
}

/// Legend to the right of the panel, outside of it.
fn legend<DB: DrawingBackend>(canvas: &Canvas<DB>, panel: &Panel, top: f64) -> Result<(), ReportError> {
    let left = canvas.sheet.panels().1 + 14.0;
    let mut at = top + 0.5 * style::LEGEND_LINE;
    if panel.items.iter().all(|item| item.name().is_empty()) {
        return canvas.text("curves as above", (left, at), PLAIN);
    }
    for item in panel.items.iter().filter(|item| !item.name().is_empty()) {
        let sample = [(left, at), (left + style::LEGEND_SAMPLE, at)];
        let name = match item {
            Item::Strip { stretches } => {
                strip::legend(canvas, stretches, (left, at))?;
                continue;
            }
            Item::Line { name, stroke, .. } => {
                canvas.line(&sample, stroke)?;
                name
            }
            Item::Points { name, stroke, .. } => {
                canvas.ring((left + 0.5 * style::LEGEND_SAMPLE, at), 3.4, stroke)?;
                name
            }
            Item::Intervals { name, stroke, .. } => {
                let middle = left + 0.5 * style::LEGEND_SAMPLE;
                canvas.line(&[(middle, at - 7.0), (middle, at + 7.0)], &Stroke { dash: &[], ..*stroke })?;
                name
            }
            Item::Band { name, .. } => {
                canvas.rectangle((left, at - 5.0), (left + style::LEGEND_SAMPLE, at + 5.0), Rgb::BAND)?;
                name
            }
            Item::Limit { .. } => continue,
        };
        for (line, words) in name.lines().enumerate() {
            let y = at + 14.0 * line as f64;
            canvas.text(words, (left + style::LEGEND_SAMPLE + 7.0, y), PLAIN)?;
        }
        at += style::LEGEND_LINE + 14.0 * (name.lines().count().max(1) - 1) as f64;
    }
    Ok(())
}

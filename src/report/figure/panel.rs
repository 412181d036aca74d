//! Draws the panels of a figure: axes, curves, limits, marks, legend.
use super::canvas::{Canvas, Side, Text};
use super::path::{Point, simplified, unbroken};
use super::style::{self, Rgb, Stroke};
use super::ticks::{Ticks, label, ticks, time_unit};
use super::{Figure, Horizontal, Item, Mark, Panel, strip};
use crate::report::ReportError;
use plotters::prelude::DrawingBackend;

pub(super) const PLAIN: Text =
    Text { size: style::SMALL, side: Side::Left, bold: false, upwards: false, color: Rgb::BLACK };

/// A linear map from values to paper.
#[derive(Clone, Copy, Debug)]
struct Scale {
    values: (f64, f64),
    paper: (f64, f64),
}

impl Scale {
    fn at(&self, value: f64) -> f64 {
        let share = (value - self.values.0) / (self.values.1 - self.values.0);
        self.paper.0 + share * (self.paper.1 - self.paper.0)
    }
}

/// Horizontal axis: scale in its own values, ticks in its unit.
struct Abscissa {
    scale: Scale,
    unit: f64,
    ticks: Ticks,
    name: String,
}

/// The frame of a panel on paper.
struct Frame<'a> {
    x: &'a Abscissa,
    y: Scale,
}

/// Draws the whole figure with what stands below it.
pub(super) fn draw<DB: DrawingBackend>(figure: &Figure, canvas: &Canvas<DB>) -> Result<(), ReportError> {
    canvas.paper()?;
    let mut at = Some((figure, 0.0));
    while let Some((part, from)) = at {
        draw_part(part, canvas, from)?;
        at = part.below.as_deref().map(|below| (below, from + part.own_height()));
    }
    Ok(())
}

/// Draws title, panels and axis of one figure from a place downwards.
fn draw_part<DB: DrawingBackend>(figure: &Figure, canvas: &Canvas<DB>, from: f64) -> Result<(), ReportError> {
    let title = Text { size: style::LARGE, bold: true, ..PLAIN };
    canvas.text(&figure.title, (style::LEFT, from + 0.5 * style::TOP), title)?;
    let x = abscissa(figure);
    let mut top = from + style::TOP;
    for (index, panel) in figure.panels.iter().enumerate() {
        let bottom = top + panel.height * style::PANEL_HEIGHT;
        let named: &[Mark] = if index == 0 { &figure.marks } else { &[] };
        let frame = Frame { x: &x, y: ordinate(panel, named.len(), (bottom, top)) };
        grid(canvas, &frame, panel)?;
        for mark in &figure.marks {
            let at = x.scale.at(mark.at);
            canvas.line(&[(at, bottom), (at, top)], &style::EVENT)?;
        }
        for item in &panel.items {
            draw_item(canvas, &frame, item)?;
        }
        mark_names(canvas, &frame, named)?;
        legend(canvas, panel, top)?;
        if index + 1 == figure.panels.len() {
            horizontal_labels(canvas, &frame)?;
        }
        top = bottom + style::GAP;
    }
    Ok(())
}

fn abscissa(figure: &Figure) -> Abscissa {
    let all = figure.panels.iter().flat_map(|panel| &panel.items).flat_map(|item| match item {
        Item::Line { x, .. } | Item::Points { x, .. } | Item::Band { x, .. } => x.as_slice(),
        // A strip accompanies curves.
        Item::Limit { .. } | Item::Strip { .. } => &[],
    });
    let values = widened(range(all.copied()), 0.0);
    let scale = Scale { values, paper: (style::LEFT, style::WIDTH - style::RIGHT) };
    match &figure.horizontal {
        Horizontal::Time => {
            let unit = time_unit(values.1 - values.0);
            let ticks = ticks(values.0 / unit.seconds, values.1 / unit.seconds, 8, unit.steps);
            Abscissa { scale, unit: unit.seconds, ticks, name: format!("time in {}", unit.symbol) }
        }
        Horizontal::Quantity(name) => {
            let ticks = ticks(values.0, values.1, 8, &[]);
            Abscissa { scale, unit: 1.0, ticks, name: name.clone() }
        }
    }
}

/// Vertical scale of a panel: all its curves with a margin, its limits where they do not squeeze the curves, and room
/// above for the names of marks.
fn ordinate(panel: &Panel, names: usize, paper: (f64, f64)) -> Scale {
    let (low, high) = widened(range(panel.items.iter().flat_map(values)), 0.05);
    let most = 4.0 * (high - low);
    let with_limits = panel.items.iter().fold((low, high), |(low, high), item| match item {
        Item::Limit { value, .. } => {
            let (a, b) = (low.min(*value), high.max(*value));
            if b - a <= most { (a, b) } else { (low, high) }
        }
        _ => (low, high),
    });
    let (low, high) = if with_limits == (low, high) { (low, high) } else { widened(with_limits, 0.06) };
    let room = names.min(3) as f64 * style::LEGEND_LINE / (paper.0 - paper.1);
    Scale { values: (low, low + (high - low) / (1.0 - room)), paper }
}

fn values(item: &Item) -> Box<dyn Iterator<Item = f64> + '_> {
    match item {
        Item::Line { y, .. } | Item::Points { y, .. } => Box::new(y.iter().copied()),
        Item::Band { low, high, .. } => Box::new(low.iter().chain(high).copied()),
        Item::Limit { .. } | Item::Strip { .. } => Box::new(std::iter::empty()),
    }
}

fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values
        .filter(|value| value.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    if low <= high { (low, high) } else { (0.0, 1.0) }
}

/// A range that has some extent, with a margin as a share of it.
fn widened((low, high): (f64, f64), margin: f64) -> (f64, f64) {
    let least = 1e-3 * low.abs().max(high.abs()).max(1.0);
    let (low, high) = if high - low < least { (low - 0.5 * least, high + 0.5 * least) } else { (low, high) };
    let extra = margin * (high - low);
    (low - extra, high + extra)
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
    let is_strip = panel.items.iter().all(|item| matches!(item, Item::Strip { .. }));
    if is_strip {
        canvas.text(
            &panel.quantity,
            (left - 8.0, 0.5 * (bottom + top)),
            Text { side: Side::Right, ..PLAIN },
        )?;
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
    let wanted = ((bottom - top) / 42.0) as usize;
    let ticks = ticks(frame.y.values.0, frame.y.values.1, wanted.max(2), &[]);
    let number = Text { side: Side::Right, ..PLAIN };
    for &value in &ticks.values {
        let at = frame.y.at(value);
        canvas.line(&[(left, at), (right, at)], grid)?;
        canvas.line(&[(left - 4.0, at), (left, at)], axis)?;
        canvas.text(&label(value, ticks.step), (left - 8.0, at), number)?;
    }
    let name = Text { size: style::NORMAL, side: Side::Center, upwards: true, ..PLAIN };
    canvas.text(&panel.quantity, (18.0, 0.5 * (bottom + top)), name)
}

fn horizontal_labels<DB: DrawingBackend>(canvas: &Canvas<DB>, frame: &Frame) -> Result<(), ReportError> {
    let (bottom, _) = frame.y.paper;
    let number = Text { side: Side::Center, ..PLAIN };
    for &value in &frame.x.ticks.values {
        let at = frame.x.scale.at(value * frame.x.unit);
        canvas.text(&label(value, frame.x.ticks.step), (at, bottom + 14.0), number)?;
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
        Item::Band { x, low, high, .. } => {
            let there = x.iter().zip(low).map(place);
            let back = x.iter().zip(high).map(place).rev();
            let outline: Vec<Point> = there.chain(back).collect();
            canvas.polygon(&outline, Rgb::BAND)?;
        }
        Item::Limit { name, value } => limit(canvas, frame, name, *value)?,
        Item::Strip { stretches } => strip::draw(canvas, stretches, |x| frame.x.scale.at(x), frame.y.paper)?,
    }
    Ok(())
}

/// A limit as a dashed line with its name on it; out of sight it is named at the edge where it lies.
fn limit<DB: DrawingBackend>(
    canvas: &Canvas<DB>,
    frame: &Frame,
    name: &str,
    value: f64,
) -> Result<(), ReportError> {
    let (left, right) = frame.x.scale.paper;
    let (bottom, top) = frame.y.paper;
    let text = Text { side: Side::Right, color: style::LIMIT.color, ..PLAIN };
    if value < frame.y.values.0 {
        return canvas.text(&format!("{name} \u{2193}"), (right - 8.0, bottom - 10.0), text);
    }
    if value > frame.y.values.1 {
        return canvas.text(&format!("{name} \u{2191}"), (right - 8.0, top + 11.0), text);
    }
    let at = frame.y.at(value);
    canvas.line(&[(left, at), (right, at)], &style::LIMIT)?;
    let above = if at - top > 22.0 { at - 9.0 } else { at + 10.0 };
    canvas.text(name, (right - 8.0, above), text)
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
    let left = style::WIDTH - style::RIGHT + 14.0;
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

//! Diagrams: blocks on a grid and the signals between them.
//!
//! An arrow leaves its block to the right, or downwards and upwards where the next block is in the same column, and bends at most once.
use super::canvas::PLAIN;
use super::canvas::{Canvas, Side, Text};
use super::path::Point;
use super::style::{self, Rgb, Stroke};
use crate::report::ReportError;
use plotters::prelude::DrawingBackend;

/// A diagram.
#[derive(Clone, Debug)]
pub struct Diagram {
    /// Title.
    pub title: String,
    /// Blocks.
    pub nodes: Vec<Node>,
    /// Signals between them.
    pub arrows: Vec<Arrow>,
}

/// A block.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// What stands in it, in lines.
    pub words: String,
    /// Column and row, from the upper left.
    pub at: (f64, f64),
    /// Its form.
    pub form: Form,
}

/// Form of a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// A box.
    Box,
    /// A box of a sensor, filled.
    Source,
    /// A small ring.
    Sum,
}

/// A signal.
#[derive(Clone, Debug, PartialEq)]
pub struct Arrow {
    /// Block that it comes from.
    pub from: usize,
    /// Block that it goes to.
    pub to: usize,
    /// Its name; empty: none.
    pub signal: String,
    /// Whether a sum adds it; `None`: no sum.
    pub sign: Option<bool>,
}

const COLUMN: f64 = 166.0;
const ROW: f64 = 80.0;
const BOX: (f64, f64) = (128.0, 54.0);
const RING: f64 = 11.0;
const HEAD: f64 = 7.0;
const LINE: Stroke = Stroke { color: Rgb::BLACK, width: 1.2, dash: &[] };

impl Diagram {
    /// Height in figure units.
    pub(super) fn height(&self) -> f64 {
        let lowest = self.nodes.iter().map(|node| node.at.1).fold(0.0, f64::max);
        style::TOP + lowest * ROW + BOX.1 + style::MARGIN
    }

    /// Middle of a block.
    fn middle(&self, node: usize, from: f64) -> Point {
        let (column, row) = self.nodes[node].at;
        let left = style::MARGIN + 0.5 * BOX.0;
        (left + column * COLUMN, from + style::TOP + 0.5 * BOX.1 + row * ROW)
    }

    /// Half width and half height of a block.
    fn half(&self, node: usize) -> (f64, f64) {
        match self.nodes[node].form {
            Form::Sum => (RING, RING),
            Form::Box | Form::Source => (0.5 * BOX.0, 0.5 * BOX.1),
        }
    }

    pub(super) fn draw<DB: DrawingBackend>(&self, canvas: &Canvas<DB>, from: f64) -> Result<(), ReportError> {
        let title = Text { size: style::LARGE, bold: true, ..PLAIN };
        canvas.text(&self.title, (style::MARGIN, from + 0.5 * style::TOP), title)?;
        for arrow in &self.arrows {
            self.arrow(canvas, arrow, from)?;
        }
        for (index, node) in self.nodes.iter().enumerate() {
            let (x, y) = self.middle(index, from);
            if node.form == Form::Sum {
                canvas.ring((x, y), RING, &LINE)?;
                continue;
            }
            let (w, h) = self.half(index);
            let fill = if node.form == Form::Source { Rgb::BAND } else { Rgb::WHITE };
            canvas.rectangle((x - w, y - h), (x + w, y + h), fill)?;
            canvas.line(
                &[(x - w, y - h), (x + w, y - h), (x + w, y + h), (x - w, y + h), (x - w, y - h)],
                &LINE,
            )?;
            let lines: Vec<&str> = node.words.lines().collect();
            for (k, words) in lines.iter().enumerate() {
                let at = y + 15.0 * (k as f64 - 0.5 * (lines.len() - 1) as f64);
                canvas.text(words, (x, at), Text { side: Side::Center, ..PLAIN })?;
            }
        }
        Ok(())
    }

    fn arrow<DB: DrawingBackend>(
        &self,
        canvas: &Canvas<DB>,
        arrow: &Arrow,
        from: f64,
    ) -> Result<(), ReportError> {
        let (a, b) = (self.middle(arrow.from, from), self.middle(arrow.to, from));
        let (half_a, half_b) = (self.half(arrow.from), self.half(arrow.to));
        let down = (b.1 - a.1).signum();
        let path = if a.1 == b.1 {
            vec![(a.0 + half_a.0, a.1), (b.0 - half_b.0, b.1)]
        } else if a.0 == b.0 {
            vec![(a.0, a.1 + down * half_a.1), (b.0, b.1 - down * half_b.1)]
        } else {
            vec![(a.0 + half_a.0, a.1), (b.0, a.1), (b.0, b.1 - down * half_b.1)]
        };
        let (before, end) = (path[path.len() - 2], path[path.len() - 1]);
        let along = if before.1 == end.1 { (1.0, 0.0) } else { (0.0, (end.1 - before.1).signum()) };
        canvas.line(&path, &LINE)?;
        head(canvas, end, along)?;
        if !arrow.signal.is_empty() {
            let (start, next) = (path[0], path[1]);
            let text = Text { color: style::PRESSURE.color, ..PLAIN };
            if start.1 == next.1 {
                canvas.text(&arrow.signal, (start.0 + 5.0, start.1 - 10.0), text)?;
            } else {
                canvas.text(&arrow.signal, (start.0 + 7.0, start.1 + down * 13.0), text)?;
            }
        }
        if let Some(added) = arrow.sign {
            let sign = if added { "+" } else { "\u{2212}" };
            let at = if along.0 > 0.0 {
                (end.0 - 12.0, end.1 + 10.0)
            } else {
                (end.0 + 9.0, end.1 - along.1 * 11.0)
            };
            canvas.text(sign, at, Text { size: style::LARGE, bold: true, side: Side::Center, ..PLAIN })?;
        }
        Ok(())
    }

    /// The signals in words.
    pub(super) fn described(&self) -> String {
        let name = |node: usize| match self.nodes[node].words.replace('\n', " ") {
            empty if empty.is_empty() => "a sum".to_owned(),
            words => format!("\u{201c}{words}\u{201d}"),
        };
        let arrows = self.arrows.iter().map(|arrow| format!("{} to {}", name(arrow.from), name(arrow.to)));
        format!("{}. Signals: {}.", self.title, arrows.collect::<Vec<_>>().join("; "))
    }
}

/// Head of an arrow.
fn head<DB: DrawingBackend>(canvas: &Canvas<DB>, tip: Point, along: (f64, f64)) -> Result<(), ReportError> {
    let side = (0.45 * HEAD * along.1, 0.45 * HEAD * along.0);
    let back = (tip.0 - HEAD * along.0, tip.1 - HEAD * along.1);
    canvas.polygon(&[tip, (back.0 + side.0, back.1 + side.1), (back.0 - side.0, back.1 - side.1)], Rgb::BLACK)
}

//! Strips: what was when, as colours.
use super::Stretch;
use super::canvas::Canvas;
use super::canvas::PLAIN;
use super::path::Point;
use crate::report::ReportError;
use plotters::prelude::DrawingBackend;

/// Stretches between two heights; `x` places a horizontal value.
pub(super) fn draw<DB: DrawingBackend>(
    canvas: &Canvas<DB>,
    stretches: &[Stretch],
    x: impl Fn(f64) -> f64,
    (bottom, top): (f64, f64),
) -> Result<(), ReportError> {
    for stretch in stretches {
        canvas.rectangle((x(stretch.from), top), (x(stretch.to), bottom), stretch.color)?;
    }
    Ok(())
}

/// Kinds of stretches side by side, in lines that leave room to the panel below.
pub(super) fn legend<DB: DrawingBackend>(
    canvas: &Canvas<DB>,
    stretches: &[Stretch],
    (left, top): Point,
) -> Result<(), ReportError> {
    const SQUARE: f64 = 10.0;
    const COLUMN: f64 = 84.0;
    const LINE: f64 = 15.0;
    let mut kinds: Vec<&Stretch> = Vec::new();
    for stretch in stretches {
        if !kinds.iter().any(|kind| kind.name == stretch.name) {
            kinds.push(stretch);
        }
    }
    for (number, kind) in kinds.iter().enumerate() {
        let at = (left + COLUMN * (number % 2) as f64, top + LINE * (number / 2) as f64);
        canvas.rectangle((at.0, at.1 - 0.5 * SQUARE), (at.0 + SQUARE, at.1 + 0.5 * SQUARE), kind.color)?;
        canvas.text(&kind.name, (at.0 + SQUARE + 5.0, at.1), PLAIN)?;
    }
    Ok(())
}

//! Tables in a picture.
use super::canvas::PLAIN;
use super::canvas::{Canvas, Text};
use super::style::{self, Rgb, Stroke};
use crate::report::ReportError;
use plotters::prelude::DrawingBackend;

/// Mean width of a letter, in sizes of the text.
const LETTER: f64 = 0.63;
/// Distance between columns.
const BETWEEN: f64 = 12.0;

/// Rows of words under a header.
#[derive(Clone, Debug)]
pub struct Grid {
    /// Title.
    pub title: String,
    /// Names of the columns.
    pub header: Vec<String>,
    /// Rows of cells; a row may be shorter, its last cell then reaches over the rest.
    pub rows: Vec<Vec<Cell>>,
}

/// Words in a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cell {
    /// The words.
    pub words: String,
    /// Whether they stand out, as what is wrong does.
    pub stands_out: bool,
}

impl From<String> for Cell {
    fn from(words: String) -> Self {
        Self { words, stands_out: false }
    }
}

impl Grid {
    pub(super) fn height(&self) -> f64 {
        style::TOP + style::LEGEND_LINE * (self.rows.len() + 1) as f64 + 0.5 * style::BOTTOM
    }

    /// Left ends of the columns; too wide a table is squeezed into the paper.
    fn lefts(&self) -> Vec<f64> {
        let of_rows = |column: usize| {
            let full = self.rows.iter().filter(move |row| row.len() == self.header.len());
            full.map(move |row| row[column].words.chars().count()).max().unwrap_or(0)
        };
        let letters = |column: usize| self.header[column].chars().count().max(of_rows(column));
        let widths: Vec<f64> = (0..self.header.len())
            .map(|column| LETTER * style::SMALL * letters(column) as f64 + BETWEEN)
            .collect();
        let room = style::WIDTH - 2.0 * style::MARGIN;
        let squeeze = (room / widths.iter().sum::<f64>()).min(1.0);
        let mut left = style::MARGIN;
        let each = widths.iter().map(|width| {
            let at = left;
            left += squeeze * width;
            at
        });
        each.collect()
    }

    pub(super) fn draw<DB: DrawingBackend>(&self, canvas: &Canvas<DB>, from: f64) -> Result<(), ReportError> {
        let title = Text { size: style::LARGE, bold: true, ..PLAIN };
        canvas.text(&self.title, (style::MARGIN, from + 0.5 * style::TOP), title)?;
        let lefts = self.lefts();
        let mut at = from + style::TOP + 0.3 * style::LEGEND_LINE;
        for (name, left) in self.header.iter().zip(&lefts) {
            canvas.text(name, (*left, at), Text { color: Rgb::GREY, ..PLAIN })?;
        }
        let rule = Stroke { color: Rgb::GREY, width: 0.75, dash: &[] };
        let under = at + 0.5 * style::LEGEND_LINE;
        canvas.line(&[(style::MARGIN, under), (style::WIDTH - style::MARGIN, under)], &rule)?;
        for row in &self.rows {
            at += style::LEGEND_LINE;
            for (cell, left) in row.iter().zip(&lefts) {
                let text = if cell.stands_out { Text { color: style::LIMIT.color, ..PLAIN } } else { PLAIN };
                canvas.text(&cell.words, (*left, at + 3.0), text)?;
            }
        }
        Ok(())
    }
}

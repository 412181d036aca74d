//! A picture as SVG text or PNG bytes.
use super::canvas::{Canvas, FINE, FONT};
use super::style::{self, Sheet};
use super::{Part, Picture};
use crate::report::{Provenance, ReportError};
use maud::html;
use plotters::backend::{BitMapBackend, SVGBackend};
use plotters::drawing::IntoDrawingArea;
use plotters::prelude::DrawingBackend;
use plotters::style::{FontStyle, register_font};
use std::sync::OnceLock;

static SANS: &[u8] = include_bytes!("../../../assets/DejaVuSans-subset.ttf");
static SANS_BOLD: &[u8] = include_bytes!("../../../assets/DejaVuSans-Bold-subset.ttf");

/// Pixels of a PNG per figure unit: two, as a printed page or a dense screen needs.
const PNG_PER_UNIT: usize = 2;

/// Registers the embedded fonts, once.
fn fonts() -> Result<(), ReportError> {
    static REGISTERED: OnceLock<bool> = OnceLock::new();
    let good = REGISTERED.get_or_init(|| {
        register_font(FONT, FontStyle::Normal, SANS).is_ok()
            && register_font(FONT, FontStyle::Bold, SANS_BOLD).is_ok()
    });
    if *good { Ok(()) } else { Err(ReportError::Font) }
}

impl Picture {
    /// The picture as the text of an SVG file.
    ///
    /// # Errors
    /// The embedded font cannot be used, or the drawing library fails.
    pub fn to_svg(&self, provenance: &Provenance) -> Result<String, ReportError> {
        let (text, fine) = self.drawing(Sheet::DESK)?;
        let size = self.fine_size(Sheet::DESK);
        // The fine grid stays in the view box; the picture opens at its natural size.
        let shown = format!("width=\"{}\" height=\"{}\"", style::WIDTH, f64::from(size.1) / FINE);
        let about = format!(
            ">\n<title>{}</title>\n<desc>{}</desc>",
            escaped(&self.title),
            escaped(&provenance.lines())
        );
        Ok(text.replacen(&fine, &shown, 1).replacen('>', &about, 1))
    }

    /// The picture as the bytes of a PNG file.
    ///
    /// # Errors
    /// The embedded font cannot be used, or the drawing library or the encoder fails.
    pub fn to_png(&self, provenance: &Provenance) -> Result<Vec<u8>, ReportError> {
        fonts()?;
        let over = FINE as usize / PNG_PER_UNIT;
        let (width, height) = self.fine_size(Sheet::DESK);
        let mut fine = vec![255; width as usize * height as usize * 3];
        {
            let area = BitMapBackend::with_buffer(&mut fine, (width, height)).into_drawing_area();
            let canvas = Canvas::raster(&area);
            canvas.paper()?;
            self.draw(&canvas)?;
            area.present().map_err(|error| ReportError::Drawing { reason: error.to_string() })?;
        }
        let (columns, rows) = (width as usize / over, height as usize / over);
        let pixels = shrink(&fine, columns, over);
        encode(&pixels, (columns as u32, rows as u32), &provenance.lines())
    }

    /// The picture as an element of a page, as wide as its place, with its description for screen readers.
    ///
    /// # Errors
    /// As [`Picture::to_svg`].
    pub(crate) fn to_element(&self, sheet: Sheet) -> Result<String, ReportError> {
        let (text, fine) = self.drawing(sheet)?;
        let named = format!("role=\"img\" aria-label=\"{}\"", escaped(&self.described()));
        Ok(text.replacen(&fine, &named, 1))
    }

    /// Whether all of it can be drawn on any sheet.
    pub(crate) fn is_narrowable(&self) -> bool {
        self.parts.iter().all(|part| matches!(part, Part::Figure(_)))
    }

    fn fine_size(&self, sheet: Sheet) -> (u32, u32) {
        let height: f64 = self.parts.iter().map(Part::height).sum();
        ((sheet.width * FINE) as u32, (height * FINE).ceil() as u32)
    }

    /// What plotters writes, and the attributes of its size on the fine grid.
    fn drawing(&self, sheet: Sheet) -> Result<(String, String), ReportError> {
        fonts()?;
        let size = self.fine_size(sheet);
        let mut text = String::new();
        {
            let area = SVGBackend::with_string(&mut text, size).into_drawing_area();
            let canvas = Canvas::vector(&area, sheet);
            canvas.paper()?;
            self.draw(&canvas)?;
            area.present().map_err(|error| ReportError::Drawing { reason: error.to_string() })?;
        }
        Ok((text, format!("width=\"{}\" height=\"{}\"", size.0, size.1)))
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

/// A text as content or quoted attribute of an element.
fn escaped(text: &str) -> String {
    html! { (text) }.into_string()
}

/// Mean of every square of `over` by `over` pixels: what makes edges smooth.
fn shrink(fine: &[u8], columns: usize, over: usize) -> Vec<u8> {
    let (fine, _) = fine.as_chunks::<3>();
    let mut out = Vec::with_capacity(3 * fine.len() / (over * over));
    for rows in fine.chunks_exact(columns * over * over) {
        let mut sums = vec![[0_u32; 3]; columns];
        for row in rows.chunks_exact(columns * over) {
            for (sum, square) in sums.iter_mut().zip(row.chunks_exact(over)) {
                for &[red, green, blue] in square {
                    *sum = [sum[0] + u32::from(red), sum[1] + u32::from(green), sum[2] + u32::from(blue)];
                }
            }
        }
        out.extend(sums.as_flattened().iter().map(|sum| (sum / (over * over) as u32) as u8));
    }
    out
}

fn encode(pixels: &[u8], (width, height): (u32, u32), description: &str) -> Result<Vec<u8>, ReportError> {
    let failed = |error: png::EncodingError| ReportError::Drawing { reason: error.to_string() };
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.add_itxt_chunk("Description".into(), description.into()).map_err(failed)?;
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(pixels).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(bytes)
}

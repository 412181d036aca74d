//! The one place that decides how every figure looks: colours, strokes, sizes.
//!
//! Colours are the colour-blind-safe set of Okabe and Ito (2008). Curves that meet in one panel differ in dash or
//! width too, so that a figure stays legible when it is printed in grey.

/// A colour, red, green, blue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rgb(pub u8, pub u8, pub u8);

impl Rgb {
    /// Black.
    pub(crate) const BLACK: Self = Self(0, 0, 0);
    /// Orange of Okabe and Ito.
    pub(crate) const ORANGE: Self = Self(230, 159, 0);
    /// Sky blue of Okabe and Ito.
    pub(crate) const SKY: Self = Self(86, 180, 233);
    /// Bluish green of Okabe and Ito.
    pub(crate) const GREEN: Self = Self(0, 158, 115);
    /// Blue of Okabe and Ito.
    pub(crate) const BLUE: Self = Self(0, 114, 178);
    /// Vermillion of Okabe and Ito.
    pub(crate) const VERMILLION: Self = Self(213, 94, 0);
    /// Reddish purple of Okabe and Ito.
    pub(crate) const PURPLE: Self = Self(204, 121, 167);
    /// Middle grey for what stands behind the curves.
    pub(crate) const GREY: Self = Self(120, 120, 120);
    /// Light grey of the grid.
    pub(crate) const GRID: Self = Self(222, 222, 222);
    /// Fill of a measured band.
    pub(crate) const BAND: Self = Self(205, 222, 236);
    /// Paper.
    pub(crate) const WHITE: Self = Self(255, 255, 255);
}

/// How a line is drawn. Lengths in figure units (a figure is [`WIDTH`] of them wide).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stroke {
    /// Colour.
    pub(crate) color: Rgb,
    /// Width.
    pub width: f64,
    /// Lengths drawn and left out in turn; empty: a full line.
    pub dash: &'static [f64],
}

const fn stroke(color: Rgb, width: f64, dash: &'static [f64]) -> Stroke {
    Stroke { color, width, dash }
}

/// Mean gas temperature: the quantity that everything is about.
pub const GAS_MEAN: Stroke = stroke(Rgb::BLACK, 2.4, &[]);
/// Topmost gas cell.
pub(crate) const GAS_TOP: Stroke = stroke(Rgb::BLACK, 1.2, &[5.0, 2.5]);
/// Lowest gas cell.
pub(crate) const GAS_BOTTOM: Stroke = stroke(Rgb::BLACK, 1.2, &[1.5, 2.5]);
/// Air around the cylinder.
pub const AIR: Stroke = stroke(Rgb::SKY, 1.3, &[]);
/// Shoulder.
pub const SHOULDER: Stroke = stroke(Rgb::VERMILLION, 1.8, &[8.0, 3.0]);
/// Middle of the wall.
pub const WALL_MIDDLE: Stroke = stroke(Rgb::BLUE, 1.8, &[8.0, 2.5, 1.8, 2.5]);
/// Bottom of the wall.
pub const WALL_BOTTOM: Stroke = stroke(Rgb::GREEN, 1.8, &[3.5, 2.5]);
/// Valve body.
pub const VALVE: Stroke = stroke(Rgb::PURPLE, 1.8, &[1.8, 2.2]);
/// Pressure.
pub const PRESSURE: Stroke = stroke(Rgb::BLUE, 2.2, &[]);
/// A limit.
pub(crate) const LIMIT: Stroke = stroke(Rgb::VERMILLION, 1.3, &[6.0, 3.0]);
/// An event.
pub(crate) const EVENT: Stroke = stroke(Rgb::GREY, 1.0, &[2.0, 2.0]);
/// First curve of a comparison.
pub const FIRST: Stroke = stroke(Rgb::ORANGE, 2.2, &[7.0, 3.0]);
/// Second curve of a comparison.
pub(crate) const SECOND: Stroke = stroke(Rgb::BLUE, 2.2, &[]);
/// Third curve of a comparison.
pub const THIRD: Stroke = stroke(Rgb::GREEN, 1.8, &[2.0, 2.2]);
/// Fourth curve of a comparison.
pub(crate) const FOURTH: Stroke = stroke(Rgb::PURPLE, 1.8, &[8.0, 2.5, 1.8, 2.5]);
/// Middle of a measured band.
pub(crate) const MIDDLE: Stroke = stroke(Rgb(70, 70, 70), 1.2, &[1.5, 2.5]);
/// A model over readings.
pub(crate) const MODEL: Stroke = stroke(Rgb::BLACK, 1.2, &[5.0, 3.0]);
/// Measured points.
pub(crate) const MEASURED: Stroke = stroke(Rgb::BLACK, 1.2, &[]);

/// A number at rest against the place.
pub(crate) const AT_REST: Stroke = stroke(Rgb::BLUE, 1.8, &[]);
/// The same with model error.
pub(crate) const ROBUST: Stroke = stroke(Rgb::VERMILLION, 1.8, &[8.0, 3.0]);
/// What a reference that no vehicle has would give.
pub(crate) const REFERENCE: Stroke = stroke(Rgb::GREY, 1.6, &[1.5, 3.0]);
/// A place that was chosen.
pub(crate) const CHOSEN: Stroke = stroke(Rgb::VERMILLION, 2.0, &[]);
/// Layouts that others are better than.
pub(crate) const BEATEN: Stroke = stroke(Rgb::GREY, 1.0, &[]);
/// Layouts that none is better than.
pub(crate) const FRONT: Stroke = stroke(Rgb::BLUE, 2.0, &[]);
/// Steel of a drawn vessel.
pub(crate) const STEEL: Rgb = Rgb(150, 150, 150);
/// Brass of its valve.
pub(crate) const BRASS: Rgb = Rgb(222, 196, 120);

/// What cannot be passed.
pub(crate) const BOUND: Stroke = stroke(Rgb::GREY, 2.6, &[1.5, 3.0]);

/// Stroke of a detector in a comparison, the one that is proposed first.
pub(crate) fn detector(number: usize) -> Stroke {
    const STROKES: [Stroke; 6] = [
        stroke(Rgb::BLACK, 2.4, &[]),
        stroke(Rgb::ORANGE, 1.8, &[]),
        stroke(Rgb::GREEN, 1.8, &[8.0, 3.0]),
        stroke(Rgb::PURPLE, 1.8, &[1.8, 2.2]),
        stroke(Rgb::SKY, 1.8, &[8.0, 2.5, 1.8, 2.5]),
        stroke(Rgb::VERMILLION, 1.8, &[3.5, 2.5]),
    ];
    STROKES[number % STROKES.len()]
}

/// Stroke of a sensor: thin, in the colour of the place where it sits, with a dash of its own by its number.
pub(crate) fn sensor(place: &str, number: usize) -> Stroke {
    const DASHES: [&[f64]; 3] = [&[1.2, 3.2], &[12.0, 2.5], &[6.0, 2.0, 1.2, 2.0, 1.2, 2.0]];
    let color = match place {
        "shoulder" => SHOULDER.color,
        "valve" => VALVE.color,
        "middle" => WALL_MIDDLE.color,
        "bottom" => WALL_BOTTOM.color,
        _ => Rgb::ORANGE,
    };
    Stroke { color, width: 1.3, dash: DASHES[number % DASHES.len()] }
}

/// Stroke of a sensor's innovations: thin and full, since noise would blur dashes.
pub(crate) fn innovation(name: &str, number: usize) -> Stroke {
    const OTHERS: [Rgb; 3] = [Rgb::SKY, Rgb::ORANGE, Rgb::GREY];
    let color = match name {
        "shoulder" => SHOULDER.color,
        "valve" => VALVE.color,
        "wall_bottom" => WALL_BOTTOM.color,
        "pressure" => PRESSURE.color,
        _ => OTHERS[number % OTHERS.len()],
    };
    Stroke { color, width: 1.1, dash: &[] }
}

/// The same stroke for a curve with noise, which would blur dashes: thin and full.
pub(crate) fn noisy(stroke: Stroke) -> Stroke {
    Stroke { width: 1.1, dash: &[], ..stroke }
}

/// The same stroke for readings that a model is drawn over: broad, so that they show on both sides of it.
pub(crate) fn below_model(stroke: Stroke) -> Stroke {
    Stroke { width: 3.4, ..stroke }
}

/// Width of a figure on a desk.
pub const WIDTH: f64 = 860.0;
/// Height of a panel of weight 1.
pub(crate) const PANEL_HEIGHT: f64 = 250.0;
/// Room beside what has no axis.
pub(crate) const MARGIN: f64 = 24.0;
/// Where the name of a vertical axis stands.
pub(crate) const AXIS_NAME: f64 = 14.0;
/// Room on the left for tick labels and the axis name.
pub(crate) const LEFT: f64 = 84.0;

/// A width of paper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sheet {
    /// Width; an SVG opens at this many pixels.
    pub width: f64,
    /// Where panels begin, and how far from the right edge they end.
    pub margins: (f64, f64),
    /// Whether the legend stands beside the panels.
    pub legend: bool,
    /// Ticks of a horizontal axis, about.
    pub ticks: usize,
    /// Letters of a title in a line.
    pub title: usize,
}

impl Sheet {
    /// A desk, a printed page, a file of its own.
    pub(crate) const DESK: Self =
        Self { width: WIDTH, margins: (LEFT, 182.0), legend: true, ticks: 8, title: 90 };
    /// A phone: the legend is below the picture ([`Picture::keys`](super::Picture::keys)).
    pub(crate) const PHONE: Self =
        Self { width: 380.0, margins: (70.0, 14.0), legend: false, ticks: 5, title: 34 };

    /// Ends of the horizontal axes.
    pub(crate) fn panels(&self) -> (f64, f64) {
        (self.margins.0, self.width - self.margins.1)
    }
}
/// Room above the first panel for the title.
pub(crate) const TOP: f64 = 42.0;
/// Room below the last panel for tick labels and the axis name.
pub(crate) const BOTTOM: f64 = 50.0;
/// Distance between panels.
pub(crate) const GAP: f64 = 20.0;
/// Size of tick labels, legends and remarks.
pub(crate) const SMALL: f64 = 12.0;
/// Size of axis names.
pub(crate) const NORMAL: f64 = 13.0;
/// Size of the title.
pub(crate) const LARGE: f64 = 15.0;
/// Height of a legend line.
pub(crate) const LEGEND_LINE: f64 = 19.0;
/// Length of the sample in a legend.
pub(crate) const LEGEND_SAMPLE: f64 = 34.0;

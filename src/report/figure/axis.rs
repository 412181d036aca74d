//! Axes: from values to paper, and the ticks on them.
use super::style::{self, Sheet};
use super::ticks::{Ticks, logarithmic_ticks, ticks, time_unit};
use super::{Figure, Horizontal, Item, Panel};

/// A map from values to paper, linear in the values or in their logarithms.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale {
    pub kind: Kind,
    /// Ends, as [`Kind::of`] has them.
    ends: (f64, f64),
    pub paper: (f64, f64),
}

/// What is linear on an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    Linear,
    Logarithmic,
}

impl Kind {
    /// What is linear on paper; NaN for a value that a logarithmic axis does not have.
    fn of(self, value: f64) -> f64 {
        match self {
            Self::Linear => value,
            Self::Logarithmic if value > 0.0 => value.ln(),
            Self::Logarithmic => f64::NAN,
        }
    }

    fn value(self, of: f64) -> f64 {
        match self {
            Self::Linear => of,
            Self::Logarithmic => of.exp(),
        }
    }
}

impl Scale {
    /// A linear map from ends to paper.
    pub(super) fn linear(ends: (f64, f64), paper: (f64, f64)) -> Self {
        Self { kind: Kind::Linear, ends, paper }
    }

    /// A linear map that has all values with a margin.
    pub(super) fn around(values: impl Iterator<Item = f64>, paper: (f64, f64)) -> Self {
        Self::linear(widened(range(values), 0.06), paper)
    }

    pub(super) fn at(&self, value: f64) -> f64 {
        let share = (self.kind.of(value) - self.ends.0) / (self.ends.1 - self.ends.0);
        self.paper.0 + share * (self.paper.1 - self.paper.0)
    }

    /// First and last value.
    pub(super) fn values(&self) -> (f64, f64) {
        (self.kind.value(self.ends.0), self.kind.value(self.ends.1))
    }

    /// Ticks of a vertical axis.
    pub(super) fn ticks(&self) -> Ticks {
        let (bottom, top) = self.paper;
        let (low, high) = self.values();
        match self.kind {
            Kind::Linear => ticks(low, high, (((bottom - top) / 42.0) as usize).max(2), &[]),
            Kind::Logarithmic => logarithmic_ticks(low, high),
        }
    }
}

/// Horizontal axis: scale in its own values, ticks in its unit.
pub(super) struct Abscissa {
    pub scale: Scale,
    pub unit: f64,
    pub ticks: Ticks,
    pub name: String,
}

/// The horizontal axis of all panels.
pub(super) fn abscissa(figure: &Figure, sheet: &Sheet) -> Abscissa {
    let all = figure.panels.iter().flat_map(|panel| &panel.items).flat_map(|item| match item {
        Item::Line { x, .. } | Item::Points { x, .. } | Item::Intervals { x, .. } | Item::Band { x, .. } => {
            x.as_slice()
        }
        // A strip accompanies curves.
        Item::Limit { .. } | Item::Strip { .. } => &[],
    });
    let paper = sheet.panels();
    let scale = |kind: Kind, margin| {
        let ends = widened(range(all.copied().map(|value| kind.of(value))), margin);
        Scale { kind, ends, paper }
    };
    match &figure.horizontal {
        Horizontal::Time => {
            let scale = scale(Kind::Linear, 0.0);
            let unit = time_unit(scale.ends.1 - scale.ends.0);
            let ticks =
                ticks(scale.ends.0 / unit.seconds, scale.ends.1 / unit.seconds, sheet.ticks, unit.steps);
            let since = if figure.since.is_empty() { "" } else { " since " };
            let name = format!("time in {}{since}{}", unit.symbol, figure.since);
            Abscissa { scale, unit: unit.seconds, ticks, name }
        }
        Horizontal::Quantity(name) => {
            let scale = scale(Kind::Linear, 0.0);
            let ticks = ticks(scale.ends.0, scale.ends.1, sheet.ticks, &[]);
            Abscissa { scale, unit: 1.0, ticks, name: name.clone() }
        }
        Horizontal::LogLog(name) => {
            let scale = scale(Kind::Logarithmic, 0.03);
            let (low, high) = scale.values();
            Abscissa { scale, unit: 1.0, ticks: logarithmic_ticks(low, high), name: name.clone() }
        }
    }
}

/// Vertical scale of a panel: all its curves with a margin, its limits where they do not squeeze the curves, and room
/// above for the names of marks.
pub(super) fn ordinate(panel: &Panel, kind: Kind, names: usize, paper: (f64, f64)) -> Scale {
    let drawn = panel.items.iter().flat_map(values).map(|value| kind.of(value));
    let (low, high) = widened(range(drawn), 0.05);
    let most = 4.0 * (high - low);
    let with_limits = panel.items.iter().fold((low, high), |(low, high), item| match item {
        Item::Limit { value, .. } => {
            let (a, b) = (low.min(kind.of(*value)), high.max(kind.of(*value)));
            if b - a <= most { (a, b) } else { (low, high) }
        }
        _ => (low, high),
    });
    let (low, high) = if with_limits == (low, high) { (low, high) } else { widened(with_limits, 0.06) };
    let room = names.min(3) as f64 * style::LEGEND_LINE / (paper.0 - paper.1);
    Scale { kind, ends: (low, low + (high - low) / (1.0 - room)), paper }
}

fn values(item: &Item) -> Box<dyn Iterator<Item = f64> + '_> {
    match item {
        Item::Line { y, .. } | Item::Points { y, .. } => Box::new(y.iter().copied()),
        Item::Band { low, high, .. } | Item::Intervals { low, high, .. } => {
            Box::new(low.iter().chain(high).copied())
        }
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

//! A picture in words, for who cannot see it: axes, and of every curve where it starts, ends, and how far it goes.
use super::{Elevation, Figure, Grid, Horizontal, Item, Panel, Part, Picture};
use crate::report::number;

/// Digits of the values: what could be read off the picture.
const DIGITS: usize = 3;

impl Figure {
    /// The figure in words.
    fn described(&self) -> String {
        let mut parts = vec![format!("{}.", self.title)];
        parts.push(format!("Horizontal: {}.", horizontal(self)));
        parts.extend(self.panels.iter().map(panel));
        if !self.marks.is_empty() {
            let names =
                self.marks.iter().map(|mark| format!("{} at {}", mark.name, at(&self.horizontal, mark.at)));
            parts.push(format!("Marked: {}.", names.collect::<Vec<_>>().join(", ")));
        }
        parts.join(" ")
    }
}

impl Picture {
    /// The picture in words.
    pub(crate) fn described(&self) -> String {
        let of = |part: &Part| match part {
            Part::Figure(figure) => figure.described(),
            Part::Elevation(elevation) => elevation.described(),
            Part::Grid(grid) => grid.described(),
            Part::Diagram(diagram) => diagram.described(),
        };
        self.parts.iter().map(of).collect::<Vec<_>>().join(" ")
    }
}

impl Elevation {
    fn described(&self) -> String {
        format!("{}: the body to scale with its places.", self.title)
    }
}

impl Grid {
    fn described(&self) -> String {
        format!("{}: a table of {} with {} rows.", self.title, self.header.join(", "), self.rows.len())
    }
}

fn horizontal(figure: &Figure) -> String {
    let all = figure.panels.iter().flat_map(|panel| &panel.items).flat_map(horizontal_values);
    let (low, high) = extent(all);
    let name = match &figure.horizontal {
        Horizontal::Time if !figure.since.is_empty() => &format!("time since {}", figure.since),
        Horizontal::Time => "time",
        Horizontal::Quantity(name) | Horizontal::LogLog(name) => name,
    };
    if low > high {
        return name.to_owned();
    }
    format!("{name}, {} to {}", at(&figure.horizontal, low), at(&figure.horizontal, high))
}

/// A value of the horizontal axis.
fn at(horizontal: &Horizontal, value: f64) -> String {
    match horizontal {
        Horizontal::Time => crate::report::estimate::duration(value),
        Horizontal::Quantity(_) | Horizontal::LogLog(_) => number(value, DIGITS),
    }
}

fn horizontal_values(item: &Item) -> Vec<f64> {
    match item {
        Item::Line { x, .. } | Item::Points { x, .. } | Item::Intervals { x, .. } | Item::Band { x, .. } => {
            x.clone()
        }
        Item::Strip { stretches } => {
            stretches.iter().flat_map(|stretch| [stretch.from, stretch.to]).collect()
        }
        Item::Limit { .. } => Vec::new(),
    }
}

fn extent(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    let finite = values.into_iter().filter(|value| value.is_finite());
    finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
}

fn panel(panel: &Panel) -> String {
    let items: Vec<String> = panel.items.iter().filter_map(item).collect();
    format!("{}: {}.", panel.quantity, items.join("; "))
}

fn item(item: &Item) -> Option<String> {
    let name = item.name().replace('\n', " ");
    let range = |values: &[f64]| {
        let (low, high) = extent(values.iter().copied());
        format!("between {} and {}", number(low, DIGITS), number(high, DIGITS))
    };
    Some(match item {
        Item::Line { y, .. } => {
            let mut finite = y.iter().copied().filter(|y| y.is_finite());
            let first = finite.next()?;
            let last = finite.next_back().unwrap_or(first);
            format!("{name} from {} to {}, {}", number(first, DIGITS), number(last, DIGITS), range(y))
        }
        Item::Points { y, .. } => format!("{name}, {} points {}", y.len(), range(y)),
        Item::Intervals { low, high, .. } | Item::Band { low, high, .. } => {
            format!("{name} {}", range(&[low.as_slice(), high.as_slice()].concat()))
        }
        Item::Limit { value, .. } => format!("limit {name} at {}", number(*value, DIGITS)),
        Item::Strip { stretches } => {
            let mut names: Vec<&str> = stretches.iter().map(|stretch| stretch.name.as_str()).collect();
            names.dedup();
            names.join(", then ")
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::figure::{Mark, style};

    #[test]
    fn a_figure_in_words_tells_axes_ends_ranges_limits_and_marks() {
        let items = vec![
            Item::line("gas", &[0.0, 60.0, 7200.0], [20.0, f64::NAN, -24.96], style::GAS_MEAN),
            Item::Limit { name: "160 bar".into(), value: 160.0 },
        ];
        let figure = Figure::over_time("A run", vec![Panel::new("temperature in °C", 1.0, items)])
            .with_marks(vec![Mark { at: 3600.0, name: "leak".into() }]);
        assert_eq!(
            figure.described(),
            "A run. Horizontal: time, 0 s to 2 h. temperature in °C: gas from 20 to -25, between -25 and 20; limit 160 bar at 160. \
             Marked: leak at 60 min."
        );
    }
}

//! Delay against leak rate, all detectors in one figure.
use crate::evaluation::judge::table::{LeakRow, Leaks, Table};
use crate::report::figure::{Figure, Horizontal, Item, Panel, style};
use crate::thermal::units::HOUR_S;

/// Median delays with their 95 % intervals, and the shortest possible delay.
pub fn figure(table: &Table) -> Figure {
    let found = || {
        let all = table.candidates.iter().enumerate();
        all.filter_map(|(n, candidate)| Some((n, candidate.name.as_str(), super::leaks(candidate)?)))
    };
    let mut items: Vec<Item> = found().map(|(n, name, leaks)| curve(n, name, leaks)).collect();
    if let Some((_, _, leaks)) = found().next() {
        items.push(Item::line(
            "shortest possible",
            &rates(leaks),
            hours(leaks, |row| row.bound_s),
            style::BOUND,
        ));
        items.extend(horizons(&rates(leaks)));
    }
    // From the last to the first, so that the first lies on top.
    let mut points: Vec<[Item; 3]> = found().map(|(n, _, leaks)| points(n, leaks)).collect();
    points.reverse();
    items.extend(points.into_iter().flatten());
    let horizontal = Horizontal::LogLog("leak rate in % of the gas per hour".into());
    Figure::new("How soon is a leak found?", horizontal, vec![Panel::new("median delay in h", 1.9, items)])
}

/// An hour, a day and a week, thin behind the curves.
fn horizons(rates: &[f64]) -> [Item; 3] {
    let ends = [rates.first(), rates.last()].map(|end| end.copied().unwrap_or(f64::NAN));
    [("1 h, 1 d, 7 d", 1.0), ("", 24.0), ("", 168.0)]
        .map(|(name, hours)| Item::line(name, &ends, [hours; 2], style::EVENT))
}

/// Leak rates, %/h.
fn rates(leaks: &Leaks) -> Vec<f64> {
    leaks.by_rate.iter().map(|row| row.percent_h).collect()
}

/// A time of each rate in h; NaN where there is none.
fn hours(leaks: &Leaks, time_s: fn(&LeakRow) -> Option<f64>) -> Vec<f64> {
    leaks.by_rate.iter().map(|row| time_s(row).map_or(f64::NAN, |time_s| time_s / HOUR_S)).collect()
}

/// Median delays of one detector; none where fewer than half were found.
fn curve(number: usize, name: &str, leaks: &Leaks) -> Item {
    Item::line(name, &rates(leaks), hours(leaks, |row| row.delay.median_s), style::detector(number))
}

/// Intervals, curve once more, and points.
fn points(number: usize, leaks: &Leaks) -> [Item; 3] {
    let stroke = style::detector(number);
    let (x, y) = (rates(leaks), hours(leaks, |row| row.delay.median_s));
    // A bound that was not seen to be reached ends at the median.
    let low = hours(leaks, |row| row.delay.median_interval_s.0.or(row.delay.median_s));
    let high = hours(leaks, |row| row.delay.median_interval_s.1.or(row.delay.median_s));
    [
        Item::Intervals { name: String::new(), x: x.clone(), low, high, stroke },
        Item::line("", &x, y.iter().copied(), stroke),
        Item::Points { name: String::new(), x, y, stroke },
    ]
}

//! Delay against leak rate, all detectors in one figure.
use crate::evaluation::performance::bench::{Judged, Outcome};
use crate::report::BAR_PER_HOUR;
use crate::report::figure::{Figure, Horizontal, Item, Panel, style};
use crate::thermal::units::HOUR_S;

/// Median delays with their 95 % intervals, and the shortest possible delay.
pub fn figure(outcome: &Outcome) -> Figure {
    let mut items: Vec<Item> =
        outcome.judged.iter().enumerate().map(|(n, judged)| curve(n, judged)).collect();
    items.push(bound(outcome));
    items.extend(horizons(outcome));
    // From the last to the first, so that the first lies on top.
    items.extend(outcome.judged.iter().enumerate().rev().flat_map(|(n, judged)| points(n, judged)));
    let horizontal = Horizontal::LogLog("leak rate in bar/h".into());
    Figure::new("How soon is a leak found?", horizontal, vec![Panel::new("median delay in h", 1.9, items)])
}

fn bound(outcome: &Outcome) -> Item {
    let at = outcome.judged.first().map_or(&[][..], |judged| &judged.performance.sensitivity);
    let rates = rates(outcome.judged.first());
    let bounds = at.iter().map(|at| at.bound_s.map_or(f64::NAN, |bound_s| bound_s / HOUR_S));
    Item::line("shortest possible", &rates, bounds, style::BOUND)
}

/// An hour, a day and a week, thin behind the curves.
fn horizons(outcome: &Outcome) -> [Item; 3] {
    let rates = rates(outcome.judged.first());
    let ends = [rates.first(), rates.last()].map(|end| end.copied().unwrap_or(f64::NAN));
    [("1 h, 1 d, 7 d", 1.0), ("", 24.0), ("", 168.0)]
        .map(|(name, hours)| Item::line(name, &ends, [hours; 2], style::EVENT))
}

/// Leak rates, bar/h.
fn rates(judged: Option<&Judged>) -> Vec<f64> {
    let at = judged.map_or(&[][..], |judged| &judged.performance.sensitivity);
    at.iter().map(|at| at.rate_pa_s * BAR_PER_HOUR).collect()
}

/// Median delays of one detector, h; NaN where fewer than half were found.
fn medians(judged: &Judged) -> Vec<f64> {
    let hours = |seconds: Option<f64>| seconds.map_or(f64::NAN, |seconds| seconds / HOUR_S);
    judged.performance.sensitivity.iter().map(|at| hours(at.delay.median_s)).collect()
}

fn curve(number: usize, judged: &Judged) -> Item {
    let name = judged.performance.detector.clone();
    Item::line(name, &rates(Some(judged)), medians(judged), style::detector(number))
}

/// Intervals, curve once more, and points.
fn points(number: usize, judged: &Judged) -> [Item; 3] {
    let stroke = style::detector(number);
    let (x, y) = (rates(Some(judged)), medians(judged));
    // A bound that was not seen to be reached ends at the median.
    let end = |bound: Option<f64>, median: f64| bound.map_or(median, |bound| bound / HOUR_S);
    let bounds = judged.performance.sensitivity.iter().map(|at| at.delay.median_interval_s).zip(&y);
    let (low, high) = bounds.map(|((low, high), median)| (end(low, *median), end(high, *median))).unzip();
    [
        Item::Intervals { name: String::new(), x: x.clone(), low, high, stroke },
        Item::line("", &x, y.iter().copied(), stroke),
        Item::Points { name: String::new(), x, y, stroke },
    ]
}

//! Delay against leak rate, all detectors in one figure.
use super::{HOUR_S, bar_h};
use crate::detector::performance::bench::{Judged, Outcome};
use crate::report::figure::{Figure, Horizontal, Item, Panel, style};

/// Median delays with their 95 % intervals, and the shortest possible delay.
pub fn figure(outcome: &Outcome) -> Figure {
    let mut items = vec![bound(outcome)];
    for (number, judged) in outcome.judged.iter().enumerate().rev() {
        items.extend(curve(number, judged));
    }
    items.extend(
        [("1 h", 1.0), ("1 d", 24.0), ("7 d", 168.0)]
            .map(|(name, hours)| Item::Limit { name: name.into(), value: hours }),
    );
    Figure {
        title: "How soon is a leak found?".into(),
        horizontal: Horizontal::LogLog("leak rate in bar/h".into()),
        panels: vec![Panel { quantity: "median delay in h".into(), items, height: 1.9 }],
        marks: Vec::new(),
        below: None,
    }
}

fn bound(outcome: &Outcome) -> Item {
    let at = outcome.judged.first().map_or(&[][..], |judged| &judged.performance.sensitivity);
    let rates: Vec<f64> = at.iter().map(|at| bar_h(at.rate_pa_s)).collect();
    let bounds = at.iter().map(|at| at.bound_s.map_or(f64::NAN, |bound_s| bound_s / HOUR_S));
    Item::line("shortest possible", &rates, bounds, style::BOUND)
}

/// Intervals, curve and points of one detector; rates at which fewer than half were found are left out.
fn curve(number: usize, judged: &Judged) -> [Item; 3] {
    let stroke = style::detector(number);
    let at = &judged.performance.sensitivity;
    let hours = |seconds: Option<f64>| seconds.map_or(f64::NAN, |seconds| seconds / HOUR_S);
    let x: Vec<f64> = at.iter().map(|at| bar_h(at.rate_pa_s)).collect();
    let y: Vec<f64> = at.iter().map(|at| hours(at.delay.median_s)).collect();
    // A bound that was not seen to be reached ends at the median.
    let end = |k: usize, bound: Option<f64>| bound.map_or(y[k], |bound| bound / HOUR_S);
    let low = (0..at.len()).map(|k| end(k, at[k].delay.median_interval_s.0)).collect();
    let high = (0..at.len()).map(|k| end(k, at[k].delay.median_interval_s.1)).collect();
    let name = judged.performance.detector.clone();
    [
        Item::Intervals { name: String::new(), x: x.clone(), low, high, stroke },
        Item::line(name, &x, y.iter().copied(), stroke),
        Item::Points { name: String::new(), x, y, stroke },
    ]
}

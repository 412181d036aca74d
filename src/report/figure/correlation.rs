//! The panel of a correlation against the lag.
use super::style;
use super::{Item, Panel};

/// Room beside the first and the last lag.
const MARGIN: f64 = 0.5;

/// A correlation at some lags as stems, with the band in which 99 % of chance values lie: `-bound` to `bound`.
pub(crate) fn correlation(name: &str, lags: &[f64], values: &[f64], bound: f64) -> Panel {
    let percent: Vec<f64> = values.iter().map(|value| 100.0 * value).collect();
    let ends =
        lags.first().zip(lags.last()).map_or([0.0, 1.0], |(first, last)| [first - MARGIN, last + MARGIN]);
    let band = Item::Band {
        name: "99 % by chance".into(),
        x: ends.to_vec(),
        low: vec![-100.0 * bound; 2],
        high: vec![100.0 * bound; 2],
    };
    let points =
        Item::Points { name: name.into(), x: lags.to_vec(), y: percent.clone(), stroke: style::MEASURED };
    Panel::new("correlation in %", 0.6, vec![band, stems(lags, &percent), points])
}

/// A line from zero to each value.
fn stems(x: &[f64], values: &[f64]) -> Item {
    let corners = x.iter().zip(values).flat_map(|(&x, &y)| [(x, 0.0), (x, y), (f64::NAN, f64::NAN)]);
    let (x, y) = corners.unzip();
    Item::Line { name: String::new(), x, y, stroke: style::MEASURED }
}

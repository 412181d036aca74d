//! The figure of a run: temperature, mass and leak with their bands, pressure, innovations.
use super::decimation::DecimatedCurves;
use super::innovation::normalised;
use crate::estimator::observer::{Estimate, Innovation};
use crate::log::Truth;
use crate::report::figure::{Figure, Item, Panel, style};
use crate::report::{Clock, GRAM_PER_HOUR};
use crate::thermal::units::{BAR_PA, ZERO_CELSIUS_K};

/// Curves before those of the innovations.
const FIXED: usize = 14;

/// Places of the curves: value, band's edges, truth.
const GAS: [usize; 4] = [0, 1, 2, 3];
const MASS: [usize; 4] = [4, 5, 6, 7];
const LEAK: [usize; 4] = [8, 9, 10, 11];
const PRESSURE: usize = 12;
/// Pressure as read less the one that is expected.
const DIFFERENCE: usize = 13;

/// What a figure needs, collected row by row.
#[derive(Clone, Debug)]
pub(crate) struct FigureData {
    curves: DecimatedCurves,
    sensors: Vec<String>,
}

impl FigureData {
    /// For an observer with these sensors.
    pub(crate) fn new(sensors: Vec<String>) -> Self {
        Self { curves: DecimatedCurves::new(FIXED + sensors.len()), sensors }
    }

    /// Adds a row.
    pub(crate) fn push(&mut self, estimate: &Estimate, truth: &Truth, innovations: &[Innovation]) {
        let band = |value: f64, sd: f64, truth: f64| [value, value - 2.0 * sd, value + 2.0 * sd, truth];
        let gas_degc = estimate.gas_mean_k - ZERO_CELSIUS_K;
        let gas = band(gas_degc, estimate.gas_mean_sd_k, truth.gas_mean_k - ZERO_CELSIUS_K);
        let mass = band(estimate.mass_kg, estimate.mass_sd_kg, truth.mass_kg);
        let leak = band(estimate.leak_kg_s, estimate.leak_sd_kg_s, truth.outflow_kg_s);
        let leak = leak.map(|flow| flow * GRAM_PER_HOUR);
        let difference_pa = estimate.pressure_pa - estimate.pressure_expected_pa;
        let pressure = [estimate.pressure_pa, difference_pa].map(|p| p / BAR_PA);
        let fixed = [gas, mass, leak].into_iter().flatten().chain(pressure);
        self.curves.push(estimate.time_s, fixed.chain(innovations.iter().map(normalised)));
    }

    /// A panel of an estimate with its band and, if the log knows it, the truth.
    fn estimate(&self, quantity: &str, curves: [usize; 4], height: f64) -> Option<Panel> {
        let items: Vec<Item> = [
            self.curves.band_item("± 2 sd", curves),
            self.curves.item("estimate", curves[0], style::GAS_MEAN),
            self.curves.item("truth", curves[3], style::FIRST),
        ]
        .into_iter()
        .flatten()
        .collect();
        self.curves.has(curves[0]).then(|| Panel::new(quantity, height, items))
    }

    /// A panel of one curve.
    fn curve(&self, quantity: &str, name: &str, curve: usize) -> Option<Panel> {
        let line = self.curves.item(name, curve, style::SECOND)?;
        Some(Panel::new(quantity, 0.55, vec![line]))
    }

    fn innovations(&self) -> Panel {
        let (from_s, to_s) = self.curves.span_s().unwrap_or_default();
        let x = [from_s, to_s].map(|time_s| time_s - self.curves.origin_s()).to_vec();
        let band = Item::Band { name: "95 % if white".into(), x, low: vec![-1.96; 2], high: vec![1.96; 2] };
        let curve = |(index, name): (usize, &String)| {
            self.curves.item(name, FIXED + index, style::innovation(name, index))
        };
        let items = std::iter::once(band).chain(self.sensors.iter().enumerate().filter_map(curve)).collect();
        Panel::new("innovation in sd", 0.8, items)
    }
}

/// The figure of a run, whose times a clock names.
pub(crate) fn figure(title: &str, data: &FigureData, clock: &Clock) -> Figure {
    let panels = [
        data.estimate("gas temperature in °C", GAS, 1.0),
        data.estimate("gas mass in kg", MASS, 0.8),
        data.estimate("leak rate in g/h", LEAK, 0.7),
        data.curve("pressure in bar", "as read", PRESSURE),
        data.curve("difference in bar", "read \u{2212} expected", DIFFERENCE),
        Some(data.innovations()),
    ];
    Figure::over_time(title, panels.into_iter().flatten().collect())
        .since(clock.minute(data.curves.origin_s()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimator::observer::Quality;

    #[test]
    fn the_wide_band_of_the_first_rows_does_not_set_the_scale() {
        let mut data = FigureData::new(Vec::new());
        for row in 0..100 {
            let estimate = Estimate {
                time_s: f64::from(row),
                gas_mean_k: 288.15,
                gas_mean_sd_k: if row == 0 { 20.0 } else { 0.25 },
                mass_kg: 4.5,
                mass_sd_kg: 1e-3,
                leak_kg_s: f64::NAN,
                leak_sd_kg_s: f64::NAN,
                pressure_pa: 2e7,
                pressure_expected_pa: 2e7,
                p15_pa: 2e7,
                quality: Quality::Good,
            };
            data.push(&estimate, &Truth::UNKNOWN, &[]);
        }
        let Some(Item::Band { low, high, .. }) = data.curves.band_item("± 2 sd", GAS) else {
            panic!("there is a band")
        };
        // Three times 2 sd of 0.25 K beside 15 °C, and 2 sd where that is less.
        assert!((low[0] - 13.5).abs() < 1e-9 && (high[0] - 16.5).abs() < 1e-9, "{} {}", low[0], high[0]);
        assert!((low[50] - 14.5).abs() < 1e-9 && (high[50] - 15.5).abs() < 1e-9);
        // Without a leak rate there is no panel for it.
        assert_eq!(figure("", &data, &Clock::default()).panels.len(), 5);
    }
}

//! Figures of the reproduction.
use super::blowdown::{Blowdown, Variant, extreme, wall_middle_k};
use super::cylinder::{FILL_TEMPERATURE_K, SLOPE_OF_PAPER_BAR_K, TightCylinder};
use super::measured::Curve;
use crate::report::figure::{Figure, Horizontal, Item, Panel, style};
use std::collections::BTreeSet;

/// Pressure of a tight full cylinder against its gas temperature.
pub fn tight(tight: &TightCylinder) -> Figure {
    let t = &tight.temperature_degc;
    let fill_degc = FILL_TEMPERATURE_K - 273.15;
    let paper = t.iter().map(|t| 200.0 + SLOPE_OF_PAPER_BAR_K * (t - fill_degc));
    let items = vec![
        Item::Limit { name: "alarm limit 160 bar".into(), value: 160.0 },
        Item::line("ideal gas", t, tight.ideal_bar.iter().copied(), style::THIRD),
        Item::line("paper's slope,\n0.8457 bar/°C", t, paper, style::FIRST),
        Item::line("real gas", t, tight.real_bar.iter().copied(), style::SECOND),
    ];
    Figure {
        title: "A tight cylinder, 200 bar at 15 °C".into(),
        horizontal: Horizontal::Quantity("gas temperature in °C".into()),
        panels: vec![Panel { quantity: "pressure in bar".into(), items, height: 1.3 }],
        marks: Vec::new(),
        below: None,
    }
}

/// The measured blowdown beside the model.
pub fn blowdown(study: &Blowdown) -> Figure {
    let measured = &study.measured;
    let pressure = |variant: &Variant| variant.run.pressure_pa.iter().map(|p| p / 1e5).collect();
    let gas = |variant: &Variant| variant.run.gas_mean_k.iter().map(|t| t - 273.15).collect();
    let wall = |variant: &Variant| wall_middle_k(&variant.run).iter().map(|t| t - 273.15).collect();
    let mut pressure_items = models(study, "", &pressure);
    pressure_items.push(Item::Points {
        name: "measured".into(),
        x: measured.pressure_bar.time_s.clone(),
        y: measured.pressure_bar.value.clone(),
        stroke: style::MEASURED,
    });
    let mut gas_items = band("measured, coldest\nto warmest", &measured.gas_low_k, &measured.gas_high_k);
    if let Some(Item::Band { x, low, high, .. }) = gas_items.first() {
        let middle = low.iter().zip(high).map(|(low, high)| 0.5 * (low + high));
        gas_items.push(Item::line("its middle", &x.clone(), middle.collect::<Vec<_>>(), style::MIDDLE));
    }
    gas_items.extend(models(study, "mean, ", &gas));
    let stacked = &study.stacked.run;
    for (name, pick) in
        [("warmest of 40 cells,\nfitted", f64::max as fn(f64, f64) -> f64), ("coldest of them", f64::min)]
    {
        let edge = extreme(&stacked.gas_cells_k, pick).into_iter().map(|t| t - 273.15).collect::<Vec<_>>();
        gas_items.push(Item::line(name, &stacked.time_s, edge, style::THIRD));
    }
    let mut wall_items = band("measured, lowest\nto highest", &measured.wall_low_k, &measured.wall_high_k);
    wall_items.extend(models(study, "mid height, ", &wall));
    Figure {
        title: "Nitrogen blowdown I1 (Haque et al. 1992) and the model".into(),
        horizontal: Horizontal::Time,
        panels: vec![
            Panel { quantity: "pressure in bar".into(), items: pressure_items, height: 0.9 },
            Panel { quantity: "gas in °C".into(), items: gas_items, height: 0.9 },
            Panel { quantity: "inner wall in °C".into(), items: wall_items, height: 0.9 },
        ],
        marks: Vec::new(),
        below: None,
    }
}

fn models(study: &Blowdown, what: &str, values: &dyn Fn(&Variant) -> Vec<f64>) -> Vec<Item> {
    [(&study.carrier, style::FIRST), (&study.fitted, style::SECOND)]
        .map(|(variant, stroke)| {
            let name = format!("{what}Cd {:.2}", variant.coefficient);
            Item::line(name, &variant.run.time_s, values(variant), stroke)
        })
        .into()
}

/// Band between two curves at the times of both, °C.
fn band(name: &str, low_k: &Curve, high_k: &Curve) -> Vec<Item> {
    let milliseconds =
        |curve: &Curve| curve.time_s.iter().map(|t| (t * 1e3) as i64).collect::<BTreeSet<i64>>();
    let times: BTreeSet<i64> = milliseconds(low_k).union(&milliseconds(high_k)).copied().collect();
    let x: Vec<f64> = times.into_iter().map(|ms| ms as f64 * 1e-3).collect();
    let low = x.iter().map(|&t| low_k.at(t) - 273.15).collect();
    let high = x.iter().map(|&t| high_k.at(t) - 273.15).collect();
    vec![Item::Band { name: name.into(), x, low, high }]
}

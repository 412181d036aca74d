//! Figures of the reproduction.
use super::blowdown::{Blowdown, Variant, extreme, wall_middle_k};
use super::cylinder::{FILL_TEMPERATURE_K, SLOPE_OF_PAPER_BAR_K, TightCylinder};
use super::drawn_cylinders::ScenarioScore;
use super::identification::{Identification, Validation};
use super::measured::Curve;
use super::methods::METHODS;
use super::passage::{ENTRY_S, LEAK_G_H, ONSET_S, Passage};
use super::scheme::{LOSS_BAR_H, SchemeRun, THRESHOLD_BAR};
use crate::report::figure::style::Stroke;
use crate::report::figure::{Figure, Horizontal, Item, Mark, Panel, Picture, style};
use crate::thermal::units::ZERO_CELSIUS_K;
use std::collections::BTreeSet;

/// Strokes of the methods, in their order.
const STROKES: [Stroke; 3] = [style::FIRST, style::THIRD, style::GAS_MEAN];

fn line(name: &str, x: &[f64], y: &[f64], stroke: Stroke) -> Item {
    Item::line(name, x, y.iter().copied(), stroke)
}

fn mark(at: f64, name: &str) -> Mark {
    Mark { at, name: name.into() }
}

fn differences(values: &[f64], truth: &[f64]) -> Vec<f64> {
    values.iter().zip(truth).map(|(value, truth)| value - truth).collect()
}

/// Figure 2: what the models make of the shoulder on the data that they come from.
pub(super) fn figure_2(study: &Identification) -> Figure {
    let (record, t) = (&study.record, study.record.time_s());
    let [identified, published] = &study.simulated_degc;
    let gas = record.gas_degc();
    let temperatures = vec![
        line("shoulder as read", t, record.shoulder_degc(), style::SHOULDER),
        line("published,\nstart at 0 °C", t, published, style::SECOND),
        line("identified here", t, identified, style::THIRD),
        line("gas", t, gas, style::GAS_MEAN),
    ];
    let errors = vec![
        line("published,\nstart at 0 °C", t, &differences(published, gas), style::SECOND),
        line("identified here", t, &differences(identified, gas), style::THIRD),
    ];
    let panels =
        vec![Panel::new("temperature in °C", 1.1, temperatures), Panel::new("error in K", 0.8, errors)];
    Figure::over_time("Figure 2: scenarios 1 and 2, one after the other", panels)
}

/// Figure 3: the models on scenarios that they do not come from.
pub(super) fn figure_3(study: &Identification) -> Picture {
    let of = |validation: &Validation| {
        let (record, t) = (&validation.record, validation.record.time_s());
        let gas = record.gas_degc();
        let [first, zero] = &validation.published_degc;
        let identified = &validation.identified_degc[0];
        let temperatures = vec![
            line("shoulder as read", t, record.shoulder_degc(), style::SHOULDER),
            line("published,\nstart at 0 °C", t, zero, style::AIR),
            line("published, start\nat the gas", t, first, style::SECOND),
            line("gas", t, gas, style::GAS_MEAN),
        ];
        let errors = vec![
            line("published,\nstart at 0 °C", t, &clipped(&differences(zero, gas)), style::AIR),
            line("published, start\nat the gas", t, &differences(first, gas), style::SECOND),
            line("identified here", t, &differences(identified, gas), style::THIRD),
        ];
        let panels =
            vec![Panel::new("temperature in °C", 0.9, temperatures), Panel::new("error in K", 0.7, errors)];
        Figure::over_time(format!("Figure 3: scenario {}", validation.scenario), panels)
    };
    Picture::stacked(study.validations.iter().map(of).collect())
}

/// Errors of a start at zero, K, without those that would flatten all others.
fn clipped(errors: &[f64]) -> Vec<f64> {
    const CLIP_K: f64 = 4.0;
    errors.iter().map(|error| if error.abs() <= CLIP_K { *error } else { f64::NAN }).collect()
}

/// Figure 6: the tunnel, by the paper's scheme, and on a simulated cylinder.
pub(super) fn figure_6(scheme: &SchemeRun, passage: &Passage) -> Picture {
    let until = scheme.time_s.partition_point(|&t| t <= 10_800.0);
    let x = &scheme.time_s[..until];
    let own = vec![
        Panel::new(
            "temperature in °C",
            0.7,
            vec![
                line("shoulder", x, &scheme.shoulder_degc[..until], style::SHOULDER),
                line("gas, published\ntransfer function", x, &scheme.gas_degc[..until], style::GAS_MEAN),
            ],
        ),
        Panel::new(
            "pressure in bar",
            0.6,
            vec![line("expected", x, &scheme.expected_bar[..until], style::PRESSURE)],
        ),
    ];
    let marks = || vec![mark(ENTRY_S, "t1: tunnel")];
    let first = Figure::over_time("Figure 6: the paper's scheme, where model and cylinder are one", own);
    let second = method_run("a simulated tight cylinder in the same passage", passage, Vec::new());
    Picture::stacked(vec![first.with_marks(marks()), second.with_marks(marks())])
}

/// Figure 8: a leak after the tunnel, by the paper's scheme, and on a simulated cylinder, with the alarms, s, of the methods.
pub(super) fn figure_8(scheme: &SchemeRun, passage: &Passage, alarms_s: [Option<f64>; 3]) -> Picture {
    let t = &scheme.time_s;
    let mut errors = vec![
        Item::Limit { name: "threshold".into(), value: THRESHOLD_BAR },
        line("error", t, &scheme.error_bar, style::PRESSURE),
    ];
    errors.extend(alarm("alarm", t, &scheme.error_bar, scheme.alarm_s, style::PRESSURE));
    let own = vec![
        Panel::new(
            "temperature in °C",
            0.6,
            vec![
                line("shoulder", t, &scheme.shoulder_degc, style::SHOULDER),
                line("gas, published\ntransfer function", t, &scheme.gas_degc, style::GAS_MEAN),
            ],
        ),
        Panel::new(
            "pressure in bar",
            0.7,
            vec![
                line("expected, p_t", t, &scheme.expected_bar, style::FIRST),
                line("actual, p_a", t, &scheme.actual_bar, style::PRESSURE),
            ],
        ),
        Panel::new("error in bar", 0.7, errors),
    ];
    let watched_t = &passage.method_run.time_s;
    let points = alarms_s.iter().enumerate().filter_map(|(method, alarm_s)| {
        let name = if method == 2 { "alarms" } else { "" };
        alarm(name, watched_t, &passage.method_run.missing_bar[method], *alarm_s, STROKES[method])
    });
    let marks = || vec![mark(ENTRY_S, "t1: tunnel"), mark(ONSET_S, "t2: leak")];
    let title = format!("a simulated cylinder that loses {LEAK_G_H} g/h");
    let second = method_run(&title, passage, points.collect());
    let title = format!("Figure 8: the paper's scheme (figure 7) with a loss of {LOSS_BAR_H} bar/h");
    Picture::stacked(vec![Figure::over_time(title, own).with_marks(marks()), second.with_marks(marks())])
}

/// Temperatures, pressures and what seems to be missing.
fn method_run(title: &str, passage: &Passage, points: Vec<Item>) -> Figure {
    let method_run = &passage.method_run;
    let t = &method_run.time_s;
    let mut missing: Vec<Item> = (0..3)
        .map(|method| line(METHODS[method], t, &method_run.missing_bar[method], STROKES[method]))
        .collect();
    missing.extend(points);
    let expected: Vec<f64> = method_run.missing_bar[0]
        .iter()
        .zip(&method_run.pressure_bar)
        .map(|(missing, read)| missing + read)
        .collect();
    let panels = vec![
        Panel::new(
            "temperature in °C",
            0.8,
            vec![
                line("air", t, &passage.air_degc, style::AIR),
                line("shoulder as read", t, &method_run.shoulder_degc, style::SHOULDER),
                line("gas", t, &passage.gas_degc, style::GAS_MEAN),
            ],
        ),
        Panel::new(
            "pressure in bar",
            0.8,
            vec![
                line("expected,\npublished", t, &expected, style::FIRST),
                line("as read", t, &method_run.pressure_bar, style::PRESSURE),
            ],
        ),
        Panel::new("missing in bar", 0.9, missing),
    ];
    Figure::over_time(title, panels)
}

fn alarm(name: &str, t: &[f64], values: &[f64], alarm_s: Option<f64>, stroke: Stroke) -> Option<Item> {
    let row = t.iter().position(|t| Some(*t) == alarm_s)?;
    let stroke = Stroke { dash: &[], width: 1.6, ..stroke };
    Some(Item::Points { name: name.into(), x: vec![t[row]], y: vec![values[row]], stroke })
}

/// A scenario on the first of the drawn cylinders.
pub(super) fn drawn_cylinder(score: &ScenarioScore) -> Figure {
    let (run, method_run) = (&score.shown.run, &score.shown.method_run);
    let (truth, t) = (&run.trajectory, &run.trajectory.time_s);
    let celsius = |k: &[f64]| k.iter().map(|k| k - ZERO_CELSIUS_K).collect::<Vec<f64>>();
    let high: Vec<f64> = method_run.gas_sd_k.iter().map(|sd| 2.0 * sd).collect();
    let low = high.iter().map(|high| -high).collect();
    let band = Item::Band { name: "observer's\n± 2 sd".into(), x: t.clone(), low, high };
    let errors =
        (0..3).map(|method| line(METHODS[method], t, &score.shown.gas_error_k(method), STROKES[method]));
    let missing =
        (0..3).map(|method| line(METHODS[method], t, &method_run.missing_bar[method], STROKES[method]));
    let temperatures = vec![
        line("air", t, &celsius(&truth.ambient_k), style::AIR),
        line("shoulder as read", t, &method_run.shoulder_degc, style::SHOULDER),
        line("gas", t, &celsius(&truth.gas_mean_k), style::GAS_MEAN),
    ];
    let panels = vec![
        Panel::new("temperature in °C", 0.8, temperatures),
        Panel::new("gas error in K", 0.8, std::iter::once(band).chain(errors).collect()),
        Panel::new("missing in bar", 0.8, missing.collect()),
    ];
    let marks = vec![mark(run.request.chamber.change_s(), "the air changes")];
    Figure::over_time(format!("{}, one drawn cylinder", score.title), panels).with_marks(marks)
}

/// Pressure of a tight full cylinder against its gas temperature.
pub(super) fn tight(tight: &TightCylinder) -> Figure {
    let t = &tight.temperature_degc;
    let fill_degc = FILL_TEMPERATURE_K - 273.15;
    let paper = t.iter().map(|t| 200.0 + SLOPE_OF_PAPER_BAR_K * (t - fill_degc));
    let items = vec![
        Item::Limit { name: "alarm limit 160 bar".into(), value: 160.0 },
        Item::line("ideal gas", t, tight.ideal_bar.iter().copied(), style::THIRD),
        Item::line("paper's slope,\n0.8457 bar/°C", t, paper, style::FIRST),
        Item::line("real gas", t, tight.real_bar.iter().copied(), style::SECOND),
    ];
    Figure::new(
        "A tight cylinder, 200 bar at 15 °C",
        Horizontal::Quantity("gas temperature in °C".into()),
        vec![Panel::new("pressure in bar", 1.3, items)],
    )
}

/// The measured blowdown beside the model.
pub(super) fn blowdown(study: &Blowdown) -> Figure {
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
    for (name, pick, stroke) in [
        ("warmest of 40 cells,\nfitted", f64::max as fn(f64, f64) -> f64, style::THIRD),
        ("coldest of them", f64::min, style::FOURTH),
    ] {
        let edge = extreme(&stacked.gas_cells_k, pick).into_iter().map(|t| t - 273.15).collect::<Vec<_>>();
        gas_items.push(Item::line(name, &stacked.time_s, edge, stroke));
    }
    let mut wall_items = band("measured, lowest\nto highest", &measured.wall_low_k, &measured.wall_high_k);
    wall_items.extend(models(study, "mid height, ", &wall));
    let panels = vec![
        Panel::new("pressure in bar", 0.9, pressure_items),
        Panel::new("gas in °C", 0.9, gas_items),
        Panel::new("inner wall in °C", 0.9, wall_items),
    ];
    Figure::over_time("Nitrogen blowdown I1 (Haque et al. 1992) and the model", panels)
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

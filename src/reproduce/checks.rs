//! What was reached: one row per number, beside its reference and the bar it has to meet.
use super::Reproduction;
use super::blowdown::{Score, Stacked, Variant};
use super::cylinder::{ScenarioRun, time_63_s};
use crate::report::simulation::residual;
use serde_json::{Value, json};

/// A number that was computed, with what it is held against.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Check {
    /// What it is.
    pub what: String,
    /// The number.
    pub here: f64,
    /// Its unit; empty for a pure number.
    pub unit: &'static str,
    /// The number it is held against.
    pub reference: Option<f64>,
    /// Where that comes from.
    pub source: &'static str,
    /// What has to be met.
    pub bar: Bar,
}

/// What has to be met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Bar {
    /// Distance from the reference at most this.
    Within(f64),
    /// Magnitude at most this.
    AtMost(f64),
    /// Nothing: the two numbers are shown beside each other.
    Shown,
}

impl Check {
    /// Whether the bar is met; `None` where there is none.
    pub(crate) fn met(&self) -> Option<bool> {
        match (self.bar, self.reference) {
            (Bar::Within(most), Some(reference)) => Some((self.here - reference).abs() <= most),
            (Bar::AtMost(most), _) => Some(self.here.abs() <= most),
            _ => None,
        }
    }

    /// As JSON.
    pub(crate) fn to_json(&self) -> Value {
        let (kind, bar) = match self.bar {
            Bar::Within(most) => ("within", Some(most)),
            Bar::AtMost(most) => ("at most", Some(most)),
            Bar::Shown => ("shown", None),
        };
        json!({
            "what": self.what, "here": self.here, "unit": self.unit, "reference": self.reference,
            "source": self.source, "bar_kind": kind, "bar": bar, "met": self.met(),
        })
    }

    /// As a row of a table.
    pub(crate) fn cells(&self) -> Vec<String> {
        let with_unit =
            |text: String| if self.unit.is_empty() { text } else { format!("{text} {}", self.unit) };
        let reference =
            self.reference.map_or(String::new(), |value| format!("{} ({})", short(value), self.source));
        let bar = match self.bar {
            Bar::Within(most) => format!("± {}", short(most)),
            Bar::AtMost(most) => format!("≤ {}", short(most)),
            Bar::Shown => String::new(),
        };
        let met = self.met().map_or("", |met| if met { "yes" } else { "NO" });
        vec![self.what.clone(), with_unit(short(self.here)), reference, bar, met.to_owned()]
    }
}

/// Five digits, or two and an exponent for the very small.
fn short(value: f64) -> String {
    if value != 0.0 && value.abs() < 1e-4 { format!("{value:.1e}") } else { crate::report::number(value, 5) }
}

/// Names of the columns.
pub(crate) const HEADER: [&str; 5] = ["what", "here", "reference", "bar", "met"];

/// What the scenarios took and where they ended: names of columns, rows.
pub(crate) fn scenarios(results: &Reproduction) -> ([&'static str; 8], Vec<Vec<String>>) {
    let row = |scenario: &ScenarioRun| {
        let run = &scenario.run;
        let end = |values: &[f64]| values.last().copied().unwrap_or(f64::NAN);
        vec![
            scenario.name.to_owned(),
            format!("{:.2}", end(&run.gas_mean_k) - 273.15),
            format!("{:.2}", end(&run.pressure_pa) / 1e5),
            run.statistics.states.to_string(),
            run.statistics.steps.to_string(),
            format!("{:.0}", scenario.wall_time_s * 1e3),
            residual(run.ledger.mass_residual()),
            residual(run.ledger.energy_residual()),
        ]
    };
    let header = [
        "scenario",
        "gas at the end in °C",
        "pressure in bar",
        "states",
        "steps",
        "time in ms",
        "mass residual",
        "energy residual",
    ];
    (header, results.scenarios.iter().map(row).collect())
}

/// All rows of a reproduction.
pub(crate) fn checks(results: &Reproduction) -> Vec<Check> {
    let mut rows = tight_rows(results);
    rows.extend(closed_rows(results));
    rows.extend(variant_rows(
        &results.blowdown.carrier,
        "Cd 0.8",
        &VariantBars { gas_k: 4.7, pressure_bar: 3.0 },
    ));
    rows.push(Check {
        what: "I1, Cd fitted to the pressure".into(),
        here: results.blowdown.fitted.coefficient,
        unit: "",
        reference: Some(super::blowdown::CARRIER_COEFFICIENT),
        source: "HydDown's choice",
        bar: Bar::Shown,
    });
    rows.extend(variant_rows(
        &results.blowdown.fitted,
        "Cd fitted",
        &VariantBars { gas_k: 2.7, pressure_bar: 1.6 },
    ));
    rows.extend(stacked_rows(&results.blowdown.stacked));
    rows
}

fn tight_rows(results: &Reproduction) -> Vec<Check> {
    const CHECKED: &str = "CoolProp 8.0";
    let tight = &results.tight;
    let row = |what: &str, here, unit, reference, source, bar| Check {
        what: what.into(),
        here,
        unit,
        reference: Some(reference),
        source,
        bar,
    };
    vec![
        row("full cylinder at -25 °C", tight.pressure_cold_bar, "bar", 160.09, CHECKED, Bar::Within(0.02)),
        row(
            "slope at 200 bar, 15 °C, real gas",
            tight.slope_bar_k,
            "bar/K",
            0.992,
            CHECKED,
            Bar::Within(5e-4),
        ),
        row("the same against the paper", tight.slope_bar_k, "bar/K", 0.8457, "paper", Bar::Shown),
        row("the same, ideal gas", tight.slope_ideal_bar_k, "bar/K", 0.694, CHECKED, Bar::Within(5e-4)),
        row(
            "fill with the paper's slope",
            tight.fill_of_paper_bar,
            "bar",
            175.25,
            CHECKED,
            Bar::Within(0.05),
        ),
        row("gas mass, real gas", tight.mass_kg, "kg", 4.4637, CHECKED, Bar::Within(5e-4)),
        row("the same against the paper", tight.mass_kg, "kg", 4.6, "paper", Bar::Shown),
        row("gas mass, ideal gas", tight.mass_ideal_kg, "kg", 4.6, "paper", Bar::Shown),
    ]
}

fn closed_rows(results: &Reproduction) -> Vec<Check> {
    const HYDDOWN: &str = "HydDown 0.50";
    let run = &results.closed.run;
    let air_k = run.ambient_k.last().copied().unwrap_or(f64::NAN);
    let worst = |residual: fn(&crate::thermal::trajectory::Ledger) -> f64| {
        results.scenarios.iter().map(|scenario| residual(&scenario.run.ledger).abs()).fold(0.0, f64::max)
    };
    let row = |what: &str, here, unit, reference, source, bar| Check {
        what: what.into(),
        here,
        unit,
        reference,
        source,
        bar,
    };
    let end_bar = run.pressure_pa.last().map_or(f64::NAN, |p| p / 1e5);
    let time_s = time_63_s(run, air_k).unwrap_or(f64::NAN);
    vec![
        row("closed bottle, 6 h after a 20 K step", end_bar, "bar", Some(219.71), HYDDOWN, Bar::Within(0.05)),
        row("closed bottle, 63 % of the step", time_s, "s", Some(3942.0), HYDDOWN, Bar::Within(39.4)),
        row(
            "largest mass residual, scenarios",
            worst(|l| l.mass_residual()),
            "",
            None,
            "",
            Bar::AtMost(1e-9),
        ),
        row(
            "largest energy residual, scenarios",
            worst(|l| l.energy_residual()),
            "",
            None,
            "",
            Bar::AtMost(1e-9),
        ),
    ]
}

/// Bars of a one-node run: gas and pressure.
struct VariantBars {
    gas_k: f64,
    pressure_bar: f64,
}

/// HydDown 0.50 on the same points.
const HYDDOWN_SCORES: &str = "HydDown";

fn variant_rows(variant: &Variant, name: &str, bars: &VariantBars) -> Vec<Check> {
    let row = |what: &str, here, unit, reference, bar| Check {
        what: format!("I1, {what}, {name}"),
        here,
        unit,
        reference: Some(reference),
        source: HYDDOWN_SCORES,
        bar,
    };
    vec![
        row("gas mean rms", variant.gas.rms, "K", 3.9, Bar::AtMost(bars.gas_k)),
        row("gas mean bias", variant.gas.bias, "K", -2.2, Bar::Shown),
        row("pressure rms", variant.pressure.rms, "bar", 2.4, Bar::AtMost(bars.pressure_bar)),
        row("pressure bias", variant.pressure.bias, "bar", -2.1, Bar::Shown),
        row("wall, high edge rms", variant.wall_high.rms, "K", 1.0, Bar::AtMost(1.0)),
    ]
}

/// The stratified gas: its constants were fitted to this run, no peer predicts either edge.
fn stacked_rows(stacked: &Stacked) -> Vec<Check> {
    let row = |what: &str, score: &Score| Check {
        what: format!("I1, {what} rms, {} gas cells (fitted)", stacked.cells),
        here: score.rms,
        unit: "K",
        reference: None,
        source: "",
        bar: Bar::AtMost(4.0),
    };
    vec![row("gas high", &stacked.high), row("gas low", &stacked.low)]
}

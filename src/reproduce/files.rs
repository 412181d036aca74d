//! The files of a reproduction: the report, every figure, every run as columns, all numbers as JSON.
use super::blowdown::{self, Blowdown};
use super::cylinder::ScenarioRun;
use super::drawn_cylinders::{LeakScore, ScenarioScore, Spread};
use super::measured::interpolated;
use super::methods::METHODS;
use super::{Reproduction, checks, comparison};
use crate::estimator::identify::Identified;
use crate::report::figure::Picture;
use crate::report::{Digits, Page, Provenance, ReportError, Table, simulation};
use serde_json::{Map, Value, json};

/// Significant digits of the compared values.
const DIGITS: Digits = Digits::Significant(7);

/// A file to write: name and content.
pub(super) type File = (String, Vec<u8>);

impl Reproduction {
    /// All files: the report, every figure as SVG and PNG, every run as CSV, the results as JSON.
    ///
    /// # Errors
    /// A figure cannot be drawn.
    pub(crate) fn files(&self, provenance: &Provenance) -> Result<Vec<File>, ReportError> {
        let mut files = Vec::new();
        let pictures = self.pictures();
        for (name, picture) in &pictures {
            files.extend(drawn(name, picture, provenance)?);
        }
        for ScenarioRun { name, run, readings, .. } in self.scenarios.iter().chain([&self.closed]) {
            let csv = simulation::table(run, readings).to_csv(provenance, &simulation::remarks(run));
            files.push((format!("{name}.csv"), csv.into_bytes()));
        }
        files.push(("blowdown-i1.csv".into(), self.comparison().to_csv(provenance, &[]).into_bytes()));
        files.push(("results.json".into(), self.document(provenance).into_bytes()));
        let report = self.report_with(&pictures);
        files.push(("report.html".into(), Page { report: &report, provenance }.to_html()?.into_bytes()));
        Ok(files)
    }

    /// The blowdown's measured and computed values at common times.
    fn comparison(&self) -> Table {
        let Blowdown { measured, carrier, fitted, .. } = &self.blowdown;
        let times: Vec<f64> = blowdown::times_s().collect();
        let mut table = Table::new();
        table.push("time_s", DIGITS, times.iter().copied());
        let mut push = |name: &str, value: &dyn Fn(f64) -> f64| {
            table.push(name, DIGITS, times.iter().map(|&t| value(t)))
        };
        push("measured_pressure_bar", &|t| measured.pressure_bar.at(t));
        push("measured_gas_low_degc", &|t| measured.gas_low_k.at(t) - 273.15);
        push("measured_gas_high_degc", &|t| measured.gas_high_k.at(t) - 273.15);
        push("measured_wall_low_degc", &|t| measured.wall_low_k.at(t) - 273.15);
        push("measured_wall_high_degc", &|t| measured.wall_high_k.at(t) - 273.15);
        for (variant, name) in [(carrier, "carrier"), (fitted, "fitted")] {
            let run = &variant.run;
            let wall_k = blowdown::wall_middle_k(run);
            push(&format!("{name}_pressure_bar"), &|t| interpolated(&run.time_s, &run.pressure_pa, t) / 1e5);
            push(&format!("{name}_gas_mean_degc"), &|t| {
                interpolated(&run.time_s, &run.gas_mean_k, t) - 273.15
            });
            push(&format!("{name}_wall_inner_degc"), &|t| interpolated(&run.time_s, &wall_k, t) - 273.15);
        }
        table
    }

    fn document(&self, provenance: &Provenance) -> String {
        let scenario = |scenario: &ScenarioRun| {
            json!({
                "scenario": scenario.name,
                "wall_time_s": scenario.wall_time_s,
                "solver": simulation::statistics(&scenario.run),
                "ledger": simulation::ledger(&scenario.run),
            })
        };
        let study = &self.identification;
        let [shoulder, valve] = &study.rows;
        let validations: Vec<Value> = study
            .validations
            .iter()
            .map(|validation| {
                json!({
                    "scenario": validation.scenario,
                    "start": ["fitted", "first gas temperature", "zero"],
                    "published_rms_k": validation.published_rms_k,
                    "identified_rms_k": validation.identified_rms_k,
                })
            })
            .collect();
        let document = json!({
            "provenance": provenance.to_json(),
            "results": checks::checks(self).iter().map(checks::Check::to_json).collect::<Vec<_>>(),
            "answers": comparison::comparisons(self).iter().map(comparison::Comparison::to_json).collect::<Vec<_>>(),
            "table_1": {
                "shoulder": identified(shoulder), "valve": identified(valve), "refitted": identified(&study.refitted),
                "validation": validations,
            },
            "figure_8": {
                "scheme": { "alarm_s": self.scheme.alarm_s, "rate_bar_h": self.scheme.rate_bar_h, "left_h": self.scheme.left_h },
                "cylinder": self.figure_8_statements().iter().map(|said| json!({
                    "who": said.method, "threshold_bar": said.threshold_bar, "delay_min": said.delay_min,
                    "rate_bar_h": said.rate_bar_h, "left_h": said.left_h,
                })).collect::<Vec<_>>(),
            },
            "drawn_cylinders": {
                "cylinders": self.cylinders,
                "scenarios": self.drawn_cylinders.iter().map(drawn_cylinder).collect::<Vec<_>>(),
                "leaks": self.leaks.iter().map(leak).collect::<Vec<_>>(),
            },
            "scenarios": self.scenarios.iter().chain([&self.closed]).map(scenario).collect::<Vec<_>>(),
        });
        format!("{document:#}\n")
    }
}

fn identified(found: &Identified) -> Value {
    json!({
        "pole_per_s": found.derived.poles.first().map(|pole| pole.real_per_s),
        "gain": found.derived.gain,
        "statistics": found.statistics,
    })
}

/// An object with a value for each method.
fn by_method(value: impl Fn(usize) -> Value) -> Value {
    Value::Object(
        METHODS
            .iter()
            .enumerate()
            .map(|(method, name)| ((*name).to_owned(), value(method)))
            .collect::<Map<_, _>>(),
    )
}

fn spread(spread: &Spread) -> Value {
    json!({ "value": spread.value, "least": spread.low, "largest": spread.high })
}

fn drawn_cylinder(score: &ScenarioScore) -> Value {
    json!({
        "scenario": score.title,
        "gas_rms_k": by_method(|method| spread(&score.gas_k[method])),
        "missing_rms_bar": by_method(|method| spread(&score.missing_bar[method])),
        "bound_k": score.bound_k,
        "bound_bar": score.bound_bar,
        "within_2_sd": score.covered,
    })
}

fn leak(score: &LeakScore) -> Value {
    json!({
        "leak_g_h": score.leak_g_h,
        "leak_bar_h": score.leak_bar_h,
        "cylinders": score.cylinders,
        "threshold_bar": { "published": score.threshold_bar[0], "refitted": score.threshold_bar[1] },
        "alarms_before_the_leak": by_method(|method| json!(score.false_alarms[method])),
        "alarms_on_tight_cylinders": by_method(|method| json!(score.tight_alarms[method])),
        "delay_min": by_method(|method| json!(score.delay_min[method])),
        "rate_bar_h": by_method(|method| json!(score.rate_bar_h[method])),
        "bound_min": score.bound_min,
        "bound_bar_h": score.bound_bar_h,
    })
}

fn drawn(name: &str, picture: &Picture, provenance: &Provenance) -> Result<[File; 2], ReportError> {
    Ok([
        (format!("{name}.svg"), picture.to_svg(provenance)?.into_bytes()),
        (format!("{name}.png"), picture.to_png(provenance)?),
    ])
}

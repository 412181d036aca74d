//! A study as CSV, a row for each judged layout, and as JSON with all that is known; the matrices behind it.
use super::{PlacementReport, Unit};
use crate::estimator::placement::study::{BestLayouts, EvaluatedLayout, Placement};
use crate::estimator::placement::{CandidateOutput, InstrumentedCylinder, ScenarioMeasure};
use crate::report::{Digits, GRAM, GRAM_PER_HOUR, Provenance, Table};
use crate::thermal::units::HOUR_S;
use serde_json::{Map, Value, json};

/// Significant digits of the numbers.
const DIGITS: Digits = Digits::Significant(8);

impl PlacementReport<'_> {
    /// A row for each judged layout; an empty cell is a leak that is never found.
    pub(crate) fn table(&self) -> Table {
        let judged = &self.study.judged;
        let mut table = Table::new();
        table.push_integers("sensors", judged.iter().map(|one| one.sensors.len()));
        table.push_texts("layout", judged.iter().map(|one| self.names(&one.sensors)));
        let mut push = |name: &str, value: &dyn Fn(&EvaluatedLayout) -> f64| {
            table.push(name, DIGITS, judged.iter().map(value));
        };
        push("cost", &|one| one.cost);
        push("gas_sd_k", &|one| one.steady.gas_sd_k);
        push("mass_sd_g", &|one| GRAM * one.steady.mass_sd_kg);
        push("leak_sd_g_h", &|one| GRAM_PER_HOUR * one.steady.leak_sd_kg_s);
        push("smallest_leak_g_h", &|one| GRAM_PER_HOUR * one.steady.smallest_leak_kg_s);
        push("delay_h", &|one| one.delay_s.map_or(f64::NAN, |delay_s| delay_s / HOUR_S));
        for scenario in 0..self.study.scenarios.len() {
            for (name, measure) in [
                ("course_mean_k", ScenarioMeasure::Mean),
                ("course_worst_k", ScenarioMeasure::Worst),
                ("robust_mean_k", ScenarioMeasure::Schmidt),
                ("robust_worst_k", ScenarioMeasure::WorstCase),
            ] {
                let value =
                    |one: &EvaluatedLayout| one.scenarios.get(scenario).map_or(f64::NAN, |of| measure.of(of));
                push(&format!("{name}_{}", scenario + 1), &value);
            }
        }
        table
    }

    /// As CSV, the tables for people as remarks above it.
    pub(crate) fn csv(&self, provenance: &Provenance) -> String {
        let remarks: Vec<String> =
            self.text().lines().filter(|line| !line.is_empty()).map(str::to_owned).collect();
        self.table().to_csv(provenance, &remarks)
    }

    /// As JSON: the best layouts by name in units that people think in, then the whole study in SI, sensors by their
    /// index in `candidates`; what is infinite is null.
    pub(crate) fn document(&self, provenance: &Provenance) -> Value {
        let mut document = Map::new();
        let criterion = self.study.settings.criterion;
        document.insert("provenance".into(), provenance.to_json());
        document.insert("partial".into(), json!(self.is_partial()));
        let words = json!({ "name": criterion.as_str(), "words": criterion.description(), "unit": Unit::of(criterion).symbol });
        document.insert("criterion".into(), words);
        document.insert("best".into(), self.study.numbers.iter().map(|number| self.best(number)).collect());
        if let Ok(Value::Object(mut study)) = serde_json::to_value(self.study) {
            study.insert("partial".into(), json!(self.is_partial()));
            document.extend(study);
        }
        if let Some(Value::Object(settings)) = document.get_mut("settings") {
            settings.insert("closed_loop".into(), json!(self.runs));
        }
        document.insert("closed_loop".into(), json!(self.closed_loop));
        Value::Object(document)
    }

    fn best(&self, number: &BestLayouts) -> Value {
        let per_si = Unit::of(self.study.settings.criterion).per_si;
        let best = number.layouts.first();
        json!({
            "sensors": number.sensors,
            "names": best.map(|best| best.sensors.iter().map(|&sensor| self.name(sensor)).collect::<Vec<_>>()),
            "value": best.map(|best| per_si * best.value),
            "bound": per_si * number.bound,
            "gap": number.gap(),
            "relaxation_gap": number.relaxation_gap(),
        })
    }
}

/// All that layouts at rest are judged by: of the member that gives gas temperature and leak rate, and of that which gives the
/// mass. Rows of a matrix are arrays. A state in SI is its number in the matrices times its scale.
pub(crate) fn matrices(placement: &Placement, provenance: &Provenance) -> Value {
    let candidates: Vec<&str> =
        placement.candidates().list.iter().map(|candidate| &*candidate.sensor.name).collect();
    json!({
        "provenance": provenance.to_json(),
        "candidates": candidates,
        "interval_s": placement.steady().settings().conditions.interval_s,
        "gas_temperature_and_leak_rate": member(placement.steady().slow()),
        "mass": member(placement.steady().first()),
    })
}

fn member(of: &InstrumentedCylinder) -> Value {
    let [transition, process_noise] = [of.transition(), of.process_noise()].map(|matrix| {
        let rows = matrix.row_iter().map(|row| row.iter().copied().collect::<Vec<f64>>());
        rows.collect::<Vec<_>>()
    });
    let output =
        |of: &CandidateOutput| json!({ "gradient": of.gradient.as_slice(), "variance": of.variance });
    json!({
        "states": of.names(),
        "scales": of.scales(),
        "point": of.point(),
        "transition": transition,
        "process_noise": process_noise,
        "outputs": of.outputs().iter().map(output).collect::<Vec<_>>(),
    })
}

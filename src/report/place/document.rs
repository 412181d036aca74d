//! A study as CSV, a row for each judged layout, and as JSON with all that is known; the matrices behind it.
use super::{GRAMS, GRAMS_PER_HOUR, HOUR_S, Placed, Unit};
use crate::estimator::placement::study::{Judged, Numbered, Placement};
use crate::estimator::placement::{CandidateOutput, CourseNumber, SitedCylinder};
use crate::report::{Provenance, number};
use serde_json::{Map, Value, json};

/// Significant digits of the numbers.
const DIGITS: usize = 8;

impl Placed<'_> {
    /// As CSV with a row for each judged layout; an empty cell is a leak that is never found.
    pub fn csv(&self, provenance: &Provenance) -> String {
        let mut text = provenance.comment_lines();
        self.text()
            .lines()
            .filter(|line| !line.is_empty())
            .for_each(|line| text.push_str(&format!("# {line}\n")));
        text.push_str("sensors,layout,cost,gas_sd_k,mass_sd_g,leak_sd_g_h,smallest_leak_g_h,delay_h");
        for scenario in 1..=self.study.scenarios.len() {
            for name in ["course_mean_k", "course_worst_k", "robust_mean_k", "robust_worst_k"] {
                text.push_str(&format!(",{name}_{scenario}"));
            }
        }
        text.push('\n');
        for judged in &self.study.judged {
            text.push_str(&self.csv_row(judged));
        }
        text
    }

    fn csv_row(&self, judged: &Judged) -> String {
        let certainty = &judged.certainty;
        let mut values = vec![
            Some(judged.cost),
            Some(certainty.gas_sd_k),
            Some(GRAMS * certainty.mass_sd_kg),
            Some(GRAMS_PER_HOUR * certainty.leak_sd_kg_s),
            Some(GRAMS_PER_HOUR * certainty.smallest_leak_kg_s),
            judged.delay_s.map(|delay_s| delay_s / HOUR_S),
        ];
        const NUMBERS: [CourseNumber; 4] =
            [CourseNumber::Mean, CourseNumber::Worst, CourseNumber::Schmidt, CourseNumber::WorstCase];
        for along in &judged.along {
            values.extend(NUMBERS.map(|of| Some(of.of(along))));
        }
        let cell = |value: Option<f64>| value.map_or_else(String::new, |value| number(value, DIGITS));
        let cells: Vec<String> = values.into_iter().map(cell).collect();
        format!("{},{},{}\n", judged.sensors.len(), quoted(&self.names(&judged.sensors)), cells.join(","))
    }

    /// As JSON: the best layouts by name in units that people think in, then the whole study in SI, sensors by their
    /// index in `candidates`; what is infinite is null.
    pub fn document(&self, provenance: &Provenance) -> Value {
        let mut document = Map::new();
        let criterion = self.study.settings.criterion;
        document.insert("provenance".into(), provenance.to_json());
        document.insert("partial".into(), json!(self.is_partial()));
        let words = json!({ "name": criterion.as_str(), "words": criterion.words(), "unit": Unit::of(criterion).symbol });
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

    fn best(&self, number: &Numbered) -> Value {
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
pub fn matrices(placement: &Placement, provenance: &Provenance) -> Value {
    let candidates: Vec<&str> =
        placement.candidates().list.iter().map(|candidate| &*candidate.sensor.name).collect();
    json!({
        "provenance": provenance.to_json(),
        "candidates": candidates,
        "interval_s": placement.site().settings().conditions.interval_s,
        "gas_temperature_and_leak_rate": member(placement.site().slow()),
        "mass": member(placement.site().first()),
    })
}

fn member(of: &SitedCylinder) -> Value {
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

/// A cell that may hold a comma.
fn quoted(cell: &str) -> String {
    if cell.contains([',', '"']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell.to_owned() }
}

//! A bench as CSV, a row for each detector and rate, and as JSON with all that is known.
use crate::evaluation::performance::bench::{Judged, Outcome};
use crate::evaluation::performance::{CONFIDENCE, Row};
use crate::report::{BAR_PER_HOUR, Digits, Provenance, Table};
use crate::thermal::units::BAR_PA;
use crate::thermal::units::HOUR_S;
use serde_json::{Value, json};

/// Significant digits of the numbers.
const DIGITS: Digits = Digits::Significant(8);

/// A detector at a rate of loss.
struct Reached<'a> {
    judged: &'a Judged,
    row: Row,
}

/// A row for each detector and rate; an empty cell is not known.
pub fn table(outcome: &Outcome) -> Table {
    let reached: Vec<Reached<'_>> = outcome
        .judged
        .iter()
        .flat_map(|judged| judged.performance.rows().into_iter().map(move |row| Reached { judged, row }))
        .collect();
    let mut table = Table::new();
    table.push_texts("detector", reached.iter().map(|one| one.row.detector.clone()));
    table.push_texts("threshold_unit", reached.iter().map(|one| one.judged.unit.clone()));
    for (name, value) in NUMBERS {
        table.push(name, DIGITS, reached.iter().map(|one| value(one).unwrap_or(f64::NAN)));
    }
    table
}

/// A column of numbers: its name, and its value of a detector at a rate.
type Number = (&'static str, fn(&Reached<'_>) -> Option<f64>);

/// The columns behind the detector's name and the unit of its threshold.
const NUMBERS: [Number; 25] = [
    ("threshold", |one| Some(one.judged.level.threshold)),
    ("false_alarms", |one| Some(one.judged.performance.reliability.alarms as f64)),
    ("at_risk_years", |one| Some(one.judged.performance.reliability.cylinder_years())),
    ("false_alarms_per_year", |one| Some(one.judged.performance.reliability.per_year())),
    ("false_alarms_per_year_high", |one| {
        Some(one.judged.performance.reliability.per_year_interval(CONFIDENCE).1)
    }),
    ("leak_bar_h", |one| Some(one.row.rate_pa_s * BAR_PER_HOUR)),
    ("leaks", |one| Some(one.row.leaks as f64)),
    ("found", |one| Some(one.row.found as f64)),
    ("found_1h", |one| one.row.found_1h),
    ("found_24h", |one| one.row.found_24h),
    ("found_24h_low", |one| one.row.found_24h_low),
    ("found_24h_high", |one| one.row.found_24h_high),
    ("found_7d", |one| one.row.found_7d),
    ("found_30d", |one| one.row.found_30d),
    ("delay_median_h", |one| hours(one.row.median_s)),
    ("delay_median_low_h", |one| hours(one.row.median_low_s)),
    ("delay_median_high_h", |one| hours(one.row.median_high_s)),
    ("delay_p95_h", |one| hours(one.row.p95_s)),
    ("delay_mean_found_h", |one| hours(one.row.mean_found_s)),
    ("delay_bound_h", |one| hours(one.row.bound_s)),
    ("efficiency", |one| one.row.efficiency),
    ("rate_rms", |one| one.row.rate_rms),
    ("rate_covered", |one| one.row.rate_covered),
    ("onset_rms_h", |one| hours(one.row.onset_rms_s)),
    ("onset_covered", |one| one.row.onset_covered),
];

fn hours(seconds: Option<f64>) -> Option<f64> {
    seconds.map(|seconds| seconds / HOUR_S)
}

/// As JSON: plan, thresholds, measures of each detector, and every run.
pub fn document(outcome: &Outcome, provenance: &Provenance) -> Value {
    let noise = outcome.noise.map(|noise| {
        json!({ "sd_bar": noise.sd / BAR_PA, "correlation_time_h": noise.correlation_time_s / HOUR_S })
    });
    json!({
        "provenance": provenance.to_json(),
        "plan": outcome.plan,
        "noise": noise,
        "detectors": outcome.judged,
    })
}

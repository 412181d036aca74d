//! A bench as CSV, a row for each detector and rate, and as JSON with all that is known.
use super::{HOUR_S, PASCAL_PER_BAR, bar_h};
use crate::evaluation::performance::Row;
use crate::evaluation::performance::bench::{Judged, Outcome};
use crate::report::{Provenance, number};
use serde_json::{Value, json};

/// Significant digits of the numbers.
const DIGITS: usize = 8;

/// Names of the columns.
const COLUMNS: [&str; 27] = [
    "detector",
    "threshold_unit",
    "threshold",
    "false_alarms",
    "at_risk_years",
    "false_alarms_per_year",
    "false_alarms_per_year_high",
    "leak_bar_h",
    "leaks",
    "found",
    "found_1h",
    "found_24h",
    "found_24h_low",
    "found_24h_high",
    "found_7d",
    "found_30d",
    "delay_median_h",
    "delay_median_low_h",
    "delay_median_high_h",
    "delay_p95_h",
    "delay_mean_found_h",
    "delay_bound_h",
    "efficiency",
    "rate_rms",
    "rate_covered",
    "onset_rms_h",
    "onset_covered",
];

/// As CSV; an empty cell is not known. `remarks` are further comment lines, without their `#`.
pub fn csv(outcome: &Outcome, provenance: &Provenance, remarks: &[String]) -> String {
    let mut text = provenance.comment_lines();
    remarks.iter().for_each(|remark| text.push_str(&format!("# {remark}\n")));
    text.push_str(&COLUMNS.join(","));
    text.push('\n');
    for judged in &outcome.judged {
        for row in judged.performance.rows() {
            let cells =
                numbers(judged, &row).map(|cell| cell.map_or_else(String::new, |x| number(x, DIGITS)));
            text.push_str(&format!("{},{},{}\n", quoted(&row.detector), judged.unit, cells.join(",")));
        }
    }
    text
}

/// The cells behind the detector's name and the unit of its threshold.
fn numbers(judged: &Judged, row: &Row) -> [Option<f64>; 25] {
    let reliability = judged.performance.reliability;
    let hours = |seconds: Option<f64>| seconds.map(|seconds| seconds / HOUR_S);
    [
        Some(judged.level.threshold),
        Some(reliability.alarms as f64),
        Some(reliability.cylinder_years()),
        Some(reliability.per_year()),
        Some(reliability.per_year_interval(crate::evaluation::performance::CONFIDENCE).1),
        Some(bar_h(row.rate_pa_s)),
        Some(row.leaks as f64),
        Some(row.found as f64),
        row.found_1h,
        row.found_24h,
        row.found_24h_low,
        row.found_24h_high,
        row.found_7d,
        row.found_30d,
        hours(row.median_s),
        hours(row.median_low_s),
        hours(row.median_high_s),
        hours(row.p95_s),
        hours(row.mean_found_s),
        hours(row.bound_s),
        row.efficiency,
        row.rate_rms,
        row.rate_covered,
        hours(row.onset_rms_s),
        row.onset_covered,
    ]
}

/// A cell that may hold a comma.
fn quoted(cell: &str) -> String {
    if cell.contains([',', '"']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell.to_owned() }
}

/// As JSON: plan, thresholds, measures of each detector, and every run.
pub fn document(outcome: &Outcome, provenance: &Provenance) -> Value {
    let noise = outcome.noise.map(|noise| {
        json!({ "sd_bar": noise.sd / PASCAL_PER_BAR, "correlation_time_h": noise.correlation_time_s / HOUR_S })
    });
    json!({
        "provenance": provenance.to_json(),
        "plan": outcome.plan,
        "noise": noise,
        "detectors": outcome.judged,
    })
}
